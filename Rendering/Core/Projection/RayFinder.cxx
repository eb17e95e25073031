// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/RayFinder.h"

namespace splatting
{
std::vector<glm::dvec2> depthsOf(const ShearWarp& geometry, int axis)
{
  const AxisRays& rays = axis == 0 ? geometry.columns() : geometry.rows();
  const FieldBox box(geometry);
  std::vector<glm::dvec2> depths;
  for (int n = 0; n < geometry.rayCount()[axis]; ++n)
  {
    depths.push_back(box.depths(axis, rays.at[n], rays.slope[n]));
  }
  return depths;
}
}
