// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingRayPath_h
#define splattingRayPath_h

#include <glm/vec2.hpp>

#include <array>

namespace splatting
{
/**
 * The voxels (u + di, v + dj) that the ray of shear pixel (u, v) crosses in one slice: the same
 * offsets for every pixel, at most three because a ray moves by at most one voxel in each
 * direction.
 */
struct RayPath
{
  int count = 0;
  std::array<int, 3> di{};
  std::array<int, 3> dj{};
};

/// The voxels of a slice that a ray meets: all that it crosses, or the one that it passes nearest
/// to in the middle of the slice.
enum class Meets
{
  All,
  Nearest
};

/**
 * What a ray meets between two points, a slice apart or less, where it runs with this slope.
 */
RayPath pathBetween(
  const glm::dvec2& enter, const glm::dvec2& leave, const glm::dvec2& slope, Meets meets);
}

#endif
