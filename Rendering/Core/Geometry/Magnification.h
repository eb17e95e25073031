// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The width of the screen's pixels in voxels.
 */
#ifndef splattingMagnification_h
#define splattingMagnification_h

#include "Geometry/View.h"

#include <glm/vec2.hpp>

namespace splatting
{
/// The larger singular value of a map to a plane.
/// @param squares  the sum of the squares of its elements
/// @param area     the factor by which it scales areas
double largerStretch(double squares, double area);

/**
 * The number of voxels that a pixel of the viewport spans across its ray, in the direction of the
 * smallest and of the largest span: the minimum over the volume's corners, 0 if a corner is not
 * before the eye.
 */
glm::dvec2 voxelsPerPixel(const View& view);

/// Whether pixels are wider than voxels everywhere in the volume, in some direction ...
bool minifiesAnyAxis(const View& view);
/// ... or in all directions.
bool minifiesAllAxes(const View& view);
}

#endif
