// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MapperProperties_h
#define MapperProperties_h

#include "Splat/Projection/Project.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkSplattingMIPVolumeMapper;
class vtkVolumeProperty;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/// As in ProjectionProperties.h. Checks the mapper's clipping planes and final colour window, too,
/// and in blend mode SLICE the property's slice function.
const char* validate(vtkSplattingMIPVolumeMapper* mapper, vtkVolumeProperty* property);

/// Returns whether sample positions are needed.
bool needsLocations(vtkSplattingMIPVolumeMapper* mapper);

/// As in ProjectionProperties.h, with sample positions if they are needed.
ProjectionSettings settingsOf(vtkSplattingMIPVolumeMapper* mapper, int mode, const View& view);
}

#endif
