// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Validation_h
#define Validation_h

#include "vtkSplattingMIPNamespace.h"

#include <string>

VTK_ABI_NAMESPACE_BEGIN
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
class ProjectedVolume;

/**
 * Validates a mapper's input, then the reports of all ranks (collective if there are several), then
 * its properties. Loads the input into `data`.
 * @return an error message that says what to do, or an empty string
 */
std::string loadAndValidate(vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer,
  vtkVolume* volume, ProjectedVolume& data);
}

#endif
