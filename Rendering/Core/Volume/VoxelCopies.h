// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Copies of voxels that cannot be splatted in place: interleaved components, magnitudes, hidden
 * voxels, grids with unequal steps.
 */
#ifndef splattingVoxelCopies_h
#define splattingVoxelCopies_h

#include "Common/ScalarType.h"
#include "Volume/VolumeIndex.h"

#include <cstddef>
#include <vector>

namespace splatting
{
/**
 * One component of an array: the scalar of voxel n at voxels[n * stride].
 */
struct StridedVoxels
{
  const void* voxels = nullptr;
  ScalarType type = ScalarType::UInt8;
  std::ptrdiff_t stride = 1;
};

/// Copies the voxels contiguously, in their own type.
void gather(const StridedVoxels& from, std::ptrdiff_t count, void* to);

/// The Euclidean length of each voxel's components, summed in double. `to` has averageType().
void magnitude(const std::vector<StridedVoxels>& components, std::ptrdiff_t count, void* to);

/// Copies the voxels in averageType(), with NaN where `hidden` is not 0.
void hide(const StridedVoxels& from, const unsigned char* hidden, std::ptrdiff_t count, void* to);

/**
 * The voxels of a copy along one axis of a grid with unequal steps. Voxel n lies at fraction[n]
 * between voxel below[n] and the next one; without fractions at below[n].
 */
struct ResampledAxis
{
  std::vector<int> below;
  std::vector<double> fraction;
};

/**
 * Interpolates points trilinearly in double, to averageType(). Averages exclude NaN. The result is
 * NaN where the nearest voxel is.
 */
void resamplePoints(
  const StridedVoxels& from, const glm::ivec3& size, const ResampledAxis (&axes)[3], void* to);

/// Copies the cell that contains the voxel's centre, in its own type.
void resampleCells(
  const StridedVoxels& from, const glm::ivec3& size, const ResampledAxis (&axes)[3], void* to);
}

#endif
