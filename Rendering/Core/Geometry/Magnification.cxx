// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/Magnification.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
/// The larger singular value of a map to a plane, from the sum of the squares of its elements and
/// how it changes areas: how much it stretches the direction that it stretches most.
double largerStretch(double squares, double area)
{
  return std::sqrt(
    0.5 * (squares + std::sqrt(std::max(squares * squares - 4.0 * area * area, 0.0))));
}
}

double voxelsPerPixel(const View& view)
{
  const glm::dmat4& m = view.indexToClip;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 8; ++n)
  {
    const glm::dvec4 corner(
      glm::dvec3(n & 1, n >> 1 & 1, n >> 2) * glm::dvec3(view.dimensions - 1), 1.0);
    const glm::dvec4 clip = m * corner;
    if (!(clip.w > 0.0))
    {
      return 0.0;
    }
    // Derivatives of the pixel's coordinates with respect to the voxel.
    const glm::dvec3 w(glm::row(m, 3));
    const glm::dvec3 x =
      0.5 * view.viewport.x / clip.w * (glm::dvec3(glm::row(m, 0)) - clip.x / clip.w * w);
    const glm::dvec3 y =
      0.5 * view.viewport.y / clip.w * (glm::dvec3(glm::row(m, 1)) - clip.y / clip.w * w);
    const double area = glm::length(glm::cross(x, y));
    const double most = largerStretch(glm::dot(x, x) + glm::dot(y, y), area);
    least = std::min(least, most / area);
  }
  return least;
}

bool minifiesAnyAxis(const View& view)
{
  // Pixels that are as wide as voxels are not wider by rounding.
  constexpr double wide = 1.0 + 1e-6;
  return voxelsPerPixel(view) > wide;
}
}
