// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef LocationArrays_h
#define LocationArrays_h

#include "Display/Locations.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Adds the point arrays "Voxel" (three ints), "Depth" (float) and "Position" (three doubles) to an
 * image, with the values of pixels without a sample: -1 and NaN. Returns their addresses.
 */
Locator::Arrays addLocationArrays(vtkImageData* image);
}

#endif
