// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProgressLine_h
#define ProgressLine_h

#include <chrono>
#include <string>

/**
 * A line on stderr that says how far a long step is. It appears after the first second, because
 * short steps need none, and only where stderr is a terminal, because logs need none either.
 */
class ProgressLine
{
public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /**
   * Tell the fraction done, in [0, 1].
   */
  void Show(double fraction);

private:
  std::string What;
  std::chrono::steady_clock::time_point Start;
  bool IsTerminal;
  int ShownPercent = -1;
};

#endif
