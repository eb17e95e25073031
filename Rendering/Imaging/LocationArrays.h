// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef LocationArrays_h
#define LocationArrays_h

#include "Projection/Locations.h"

class vtkImageData;

namespace splatting
{
/**
 * Gives an image the point arrays "Voxel" (three ints), "Depth" (float) and "Position" (three
 * doubles), for now those of pixels without a sample: -1 and NaN. Returns where to write others.
 */
Locator::Arrays addLocationArrays(vtkImageData* image);
}

#endif
