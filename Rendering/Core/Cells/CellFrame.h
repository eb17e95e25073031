// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingCellFrame_h
#define splattingCellFrame_h

#include "Cells/BoxProjection.h"
#include "Cells/CellIndex.h"
#include "Cells/CellProjector.h"
#include "Clipping/SurfaceOnScreen.h"

#include <glm/vec4.hpp>

#include <vector>

namespace splatting
{
/**
 * The data of one projection that its threads share.
 */
template <class T>
struct CellFrame
{
  using A = Accumulator<T>;

  CellFrame(CellIndex& index, const View& view, const ProjectionSettings& settings,
    const RayEnds& ends, bool locate, const PixelRectangle& rectangle, const PixelRays& rays);

  int tileCount() const { return this->tiles.x * this->tiles.y; }
  PixelRectangle pixelsOf(int tile) const;

  CellBox boxOfCells(const glm::ivec3& cell, int size) const;
  CellBox boxOfBrick(std::uint32_t brick) const;
  /// Whether half-spaces and cropping leave something of a box.
  bool isShown(const CellBox& box) const;

  /**
   * Sets where the rays of pixels in a row begin and end.
   * @param x  the first pixel
   */
  void findEnds(int x, int y, int count, double* near, double* far) const;

  const CellGrid& grid;
  const CellBox field;
  const CellBounds& bounds;
  const PixelRays& rays;
  const PixelRectangle rectangle;
  const glm::ivec2 tiles;
  const glm::ivec2 viewport;
  const CellKernels& kernels;
  const ValueScale<A> values;
  const double lowest;  ///< the voxel whose value is 0; 0 if voxels are infinite
  const double highest; ///< the largest voxel, of minima the least
  const std::vector<glm::dvec4>& halfSpaces;
  const ShownRegions regions;
  const bool crops;
  const SceneDepth* depth;
  SurfaceOnScreen surface;
  const A least; ///< smaller values need not be distinguished, see ProjectionSettings::floor
  const bool locates, shades;
  const double ambient, rate;
  bool cutsAll;    ///< whether rays may end in any block: by a surface or a depth buffer
  bool mayBeEmpty; ///< whether a ray in the field may have no sample
  bool isFinite;   ///< whether values are relative to the lowest voxel, none below 0
};
}

#endif
