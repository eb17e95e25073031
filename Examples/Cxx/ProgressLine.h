// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProgressLine_h
#define ProgressLine_h

#include "vtkAlgorithm.h"

#include <chrono>
#include <string>

/**
 * A line on stderr with the progress of a long step. It appears after one second, and only if
 * stderr is a terminal.
 */
class ProgressLine
{
public:
  /**
   * Show the progress of an algorithm, if one is given.
   */
  explicit ProgressLine(const std::string& what, vtkAlgorithm* algorithm = nullptr);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /**
   * Show the fraction done, in [0, 1].
   */
  void Show(double fraction);

private:
  void ShowProgress(vtkObject*, unsigned long, void* fraction);

  std::string What;
  std::chrono::steady_clock::time_point Start;
  bool IsTerminal;
  int ShownPercent = -1;
  vtkAlgorithm* Algorithm;
  unsigned long Observer = 0;
};

#endif
