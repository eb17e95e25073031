// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingRayPath_h
#define splattingRayPath_h

#include <glm/vec2.hpp>

#include <array>

namespace splatting
{
/**
 * The voxels (u + di, v + dj) that the ray of shear pixel (u, v) crosses in one slice. The offsets
 * are the same for all pixels, at most three, because a ray moves by at most one voxel in each
 * direction.
 */
struct RayPath
{
  int count = 0;
  std::array<int, 3> di{};
  std::array<int, 3> dj{};
};

/**
 * The path of a ray with this slope between two points, at most a slice apart.
 */
RayPath pathBetween(const glm::dvec2& enter, const glm::dvec2& leave, const glm::dvec2& slope);
}

#endif
