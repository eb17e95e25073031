// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ReportedProblems_h
#define ReportedProblems_h

#include "vtkWeakPointer.h"

#include <string>
#include <vector>

class vtkRenderer;
class vtkVolume;

namespace splatting
{
/**
 * Why the last frames of views are missing, so that each reason is told once: not in every frame,
 * nor in every view that has the same.
 */
class ReportedProblems
{
public:
  /// Takes what is wrong with a view, or an empty string, and returns whether to tell it.
  bool Update(vtkRenderer* renderer, vtkVolume* volume, const std::string& problem);

private:
  struct Report
  {
    vtkWeakPointer<vtkRenderer> renderer;
    vtkWeakPointer<vtkVolume> volume;
    std::string problem;
  };
  std::vector<Report> All;
};
}

#endif
