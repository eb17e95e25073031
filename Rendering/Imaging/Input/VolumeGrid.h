// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The positions of a data set's voxels.
 */
#ifndef VolumeGrid_h
#define VolumeGrid_h

#include "Volume/VoxelCopies.h"

#include "vtkSplattingMIPNamespace.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <string>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataSet;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * A uniform grid of voxels.
 */
struct VolumeGrid
{
  /// Voxels along each axis.
  glm::ivec3 dimensions{ 0 };
  /// Voxel centres (the first one at 0) to the data set's coordinates.
  glm::dmat4 indexToPhysical{ 1.0 };
  /// The position of the first voxel along each axis, and the step, without direction matrix.
  glm::dvec3 first{ 0.0 };
  glm::dvec3 spacing{ 1.0 };
  /// Whether voxels are cells. The picture then ends at their boxes, not at the outermost centres.
  bool cells = false;
};

/**
 * The voxels of a vtkImageData or vtkRectilinearGrid, and the uniform grid that replaces the latter
 * if it has unequal steps.
 */
struct GridOfDataSet
{
  /// The largest number of voxels of a resampled grid, unless the data set has more.
  static constexpr double MostResampled = 1 << 26;

  VolumeGrid grid;
  /// Of the data set; grid.dimensions unless resampled.
  glm::ivec3 dimensions{ 0 };
  bool resampled = false;
  /// Whether it was resampled to steps larger than the least one of an axis.
  bool coarse = false;
  ResampledAxis axes[3];
};

/**
 * Fills `result`. Returns an error message about the data set's geometry, or an empty string.
 * Voxels are its cells or its points. An axis with one point has one layer of cells, about that
 * point.
 *
 * A rectilinear grid whose points are within a thousandth of a step of equal distances is used as
 * it is. Others are resampled at the least step of each axis. This step is reduced so that the
 * voxels end where the grid ends. Points are interpolated; every cell has a voxel. If there are
 * more than MostResampled voxels, all steps are enlarged by one factor. An axis has at most 16384
 * voxels. (vtkResampleToImage takes ten times as long, for all arrays, and treats cells as points.)
 */
std::string describeGrid(vtkDataSet* data, bool cells, GridOfDataSet& result);
}

#endif
