// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Traversal.h
 * @brief   which voxels a ray crosses, in exact integer arithmetic
 */
#ifndef reference_Traversal_h
#define reference_Traversal_h

#include <array>
#include <cstdint>
#include <vector>

namespace reference
{

/**
 * Positions are integers in units of 2^-34 voxel. That holds all that the module rounds to:
 * products of slopes, multiples of 2^-24, and depths, multiples of 1/2 or 2^-10.
 */
constexpr std::int64_t WholeVoxel = std::int64_t(1) << 34;
constexpr std::int64_t HalfVoxel = WholeVoxel / 2;

/**
 * Throws std::invalid_argument for a position that is no multiple of the unit.
 */
std::int64_t inUnits(double position);

/**
 * The ray's motion along one axis: start + velocity t at time t.
 */
struct AxisMotion
{
  std::int64_t start = 0;
  std::int64_t velocity = 0;
};

/**
 * The voxels, of a grid of some size, that a ray crosses from time 0 to the end, in the order in
 * which it does. Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987.
 *
 * Ties: a voxel counts if and only if the ray crosses it over a positive length. Where a ray meets
 * several faces at once it steps along all those axes together. A ray that runs within a face
 * belongs to the higher voxels.
 */
std::vector<std::array<int, 3>> traverse(
  const std::array<AxisMotion, 3>& ray, std::int64_t end, const std::array<int, 3>& size);

} // namespace reference

#endif
