// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Refusals_h
#define Refusals_h

#include <string>

class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;

namespace splatting
{
class ProjectedVolume;

/**
 * The gate: a sentence that says why a mapper cannot render its input as this volume and what to
 * do, or nothing. Looks at the input, then at what all ranks have to say (collective if there are
 * several), then at properties. Afterwards `data` is about the input.
 */
std::string refusalOf(vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
  ProjectedVolume& data);
}

#endif
