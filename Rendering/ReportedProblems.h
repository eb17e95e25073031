// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ReportedProblems_h
#define ReportedProblems_h

#include "vtkSplattingMIPNamespace.h"
#include "vtkWeakPointer.h"

#include <set>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkObject;
class vtkRenderer;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * The errors of the last frames of views, and the causes of warnings, so that each is reported
 * once, and not in each frame or view.
 */
class ReportedProblems
{
public:
  /// Sets the error of a view, or none (an empty string). Returns whether to report it.
  bool Update(vtkRenderer* renderer, vtkVolume* volume, const std::string& problem);

  /// Warns of a cause if it holds now, and did not in the last call.
  /// @param source  the warning's object
  void Warn(vtkObject* source, const std::string& cause, bool holds, const std::string& text);

private:
  struct Report
  {
    vtkWeakPointer<vtkRenderer> renderer;
    vtkWeakPointer<vtkVolume> volume;
    std::string problem;
  };
  std::vector<Report> All;
  std::set<std::string> Causes; ///< that hold
};
}

#endif
