// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The width of the screen's pixels in voxels.
 */
#ifndef splattingMagnification_h
#define splattingMagnification_h

#include "Geometry/View.h"

namespace splatting
{
/**
 * The number of voxels that a pixel of the viewport spans across its ray, in the direction of the
 * largest span: the minimum over the volume's corners, 0 if a corner is not before the eye.
 */
double voxelsPerPixel(const View& view);

/// Whether pixels are wider than voxels everywhere in the volume, in some direction.
bool minifiesAnyAxis(const View& view);
}

#endif
