// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the voxels of a data set lie.
 */
#ifndef VolumeGrid_h
#define VolumeGrid_h

#include "Volume/VoxelCopies.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <string>

class vtkDataSet;

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
  /// Where the first voxel lies along each axis, and the step, before a direction matrix turns
  /// them.
  glm::dvec3 first{ 0.0 };
  glm::dvec3 spacing{ 1.0 };
  /// Whether voxels are cells: the picture then ends at their boxes, not at the outermost centres.
  bool cells = false;
};

/**
 * The voxels of a vtkImageData or vtkRectilinearGrid and, where the latter has unequal steps, the
 * uniform grid that takes its place.
 */
struct GridOfDataSet
{
  /// Most voxels of a resampled grid, unless the data set itself has more.
  static constexpr double MostResampled = 1 << 26;

  VolumeGrid grid;
  /// As the data set has them; grid.dimensions unless resampled.
  glm::ivec3 dimensions{ 0 };
  bool resampled = false;
  /// Whether it was resampled to steps that are larger than the least one of an axis.
  bool coarse = false;
  ResampledAxis axes[3];
};

/**
 * Fills `result` and returns what is wrong with the data set's geometry, or an empty string. Voxels
 * are its cells or its points; an axis with one point has one layer of cells, about that point.
 *
 * Coordinates of a rectilinear grid whose points lie within a thousandth of a step of equal
 * distances are taken as they are. Others are resampled at distances of the least step of their
 * axis (a little less, so as to end with the grid): points are then interpolated, every cell has a
 * voxel. If that were more than MostResampled voxels, all distances are enlarged by one factor. No
 * axis gets more than 16384. (vtkResampleToImage does the same ten times as slowly, for all arrays,
 * and takes cells for points.)
 */
std::string describeGrid(vtkDataSet* data, bool cells, GridOfDataSet& result);
}

#endif
