// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Voxels that cannot be splatted from where they are: interleaved components, magnitudes, hidden
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
 * One component as somebody else holds it: the scalar of voxel n at voxels[n * stride].
 */
struct StridedVoxels
{
  const void* voxels = nullptr;
  ScalarType type = ScalarType::UInt8;
  std::ptrdiff_t stride = 1;
};

/// The voxels, one after the other, in their own type.
void gather(const StridedVoxels& from, std::ptrdiff_t count, void* to);

/// The Euclidean length of each voxel's components, summed in double; `to` is of averageType().
void magnitude(const std::vector<StridedVoxels>& components, std::ptrdiff_t count, void* to);

/// The voxels in averageType(), NaN where `hidden` is not 0.
void hide(const StridedVoxels& from, const unsigned char* hidden, std::ptrdiff_t count, void* to);

/**
 * Where voxels lie along one axis of a grid with unequal steps: voxel n of the copy at the share
 * `fraction[n]` of the way from voxel below[n] to the next one. No fractions: at below[n].
 */
struct ResampledAxis
{
  std::vector<int> below;
  std::vector<double> fraction;
};

/**
 * Points: interpolated trilinearly in double, in averageType(). NaN is left out of averages, and
 * the result is NaN where the nearest voxel is.
 */
void resamplePoints(
  const StridedVoxels& from, const glm::ivec3& size, const ResampledAxis (&axes)[3], void* to);

/// Cells: the cell that holds the voxel's middle, in its own type.
void resampleCells(
  const StridedVoxels& from, const glm::ivec3& size, const ResampledAxis (&axes)[3], void* to);
}

#endif
