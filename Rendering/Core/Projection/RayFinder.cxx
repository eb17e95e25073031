// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/RayFinder.h"

namespace splatting
{
std::vector<glm::dvec2> depthsOf(const ShearWarp& geometry, int axis)
{
  const Fan& rays = axis == 0 ? geometry.columns() : geometry.rows();
  const FieldRange sides(geometry, axis);
  const glm::dvec2 all = depthsOfField(geometry);
  std::vector<glm::dvec2> depths;
  for (int n = 0; n < geometry.rayCount()[axis]; ++n)
  {
    depths.push_back(
      commonDepths(all, depthsBetween(sides, rays.at[n], rays.slope[n], geometry.reference())));
  }
  return depths;
}
}
