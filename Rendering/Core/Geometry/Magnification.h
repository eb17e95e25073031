// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How wide the screen's pixels are in voxels.
 */
#ifndef splattingMagnification_h
#define splattingMagnification_h

#include "Geometry/View.h"

#include <glm/vec2.hpp>

namespace splatting
{
/// The larger singular value of a map to a plane, from the sum of the squares of its elements and
/// how it changes areas: how much it stretches the direction that it stretches most.
double largerStretch(double squares, double area);

/**
 * How many voxels a pixel of the viewport spans, across its ray, in the direction in which it spans
 * fewest and in that in which it spans most: the least of the volume's corners, 0 if one of them is
 * not before the eye.
 */
glm::dvec2 voxelsPerPixel(const View& view);

/// Whether all of a volume is seen in pixels wider than voxels in some direction, ...
bool isOverview(const View& view);
/// ... or in all directions.
bool isCoarse(const View& view);
}

#endif
