// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingTileSplatter_h
#define splattingTileSplatter_h

#include "Cells/CellIndex.h"
#include "Cells/CellPlaces.h"
#include "Cells/CellProjector.h"
#include "Clipping/SurfaceOnScreen.h"

#include <glm/vec4.hpp>

#include <vector>

namespace splatting
{
/**
 * What one projection knows, for all threads.
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
   * Sets where the rays of pixels in a row begin and end, and returns whether any does so after it
   * begins.
   * @param x  the first pixel
   */
  void findEnds(int x, int y, int count, double* near, double* far) const;

  const CellGrid& grid;
  const CellBounds& bounds;
  const PixelRays& rays;
  const PixelRectangle rectangle;
  const glm::ivec2 tiles;
  const glm::ivec2 viewport;
  const CellKernels& kernels;
  const ValueScale<A> values;
  const CellScale<A>& scale;
  const double lowest;  ///< the voxel whose value is 0; 0 if voxels are infinite
  const double highest; ///< the largest voxel, of minima the least
  const std::vector<glm::dvec4>& halfSpaces;
  const ShownRegions regions;
  const bool crops;
  const SceneDepth* depth;
  SurfaceOnScreen surface;
  const A least; ///< values below need not be told apart, see ProjectionSettings::floor
  const bool minima, locates, shades;
  const double ambient, rate;
  bool cutsAll;    ///< whether rays may end in any block: by a surface or a depth buffer
  bool mayBeEmpty; ///< whether a ray in the field may have no sample
  bool isFinite;   ///< whether values are relative to the lowest voxel, none below 0
};

/**
 * One thread's work on a tile.
 */
template <class T>
class TileSplatter
{
public:
  using A = Accumulator<T>;

  TileSplatter(const CellFrame<T>& frame, ScreenTile<A>& tile);

  void open(int tile);
  /// Returns whether bricks with smaller voxels than these can raise a pixel.
  bool splat(const std::vector<std::uint32_t>& bricks);
  /// Writes the tile to the screen: scalars or, for CellProjector::finish(), values.
  void finish(bool finished, ScreenScalars& screen) const;

private:
  void openRow(int y);
  bool isDone(std::uint32_t brick);
  bool mayRaise(std::uint32_t brick) const;
  void prefetch(std::uint32_t brick) const;
  void splatBrick(std::uint32_t brick);
  void splatBlock(const glm::ivec3& cell, A bound, bool isCut);
  void splatRegion(const SeenBox& seen, const CellBox& box, const CellBox* region);
  bool reaches(A bound, A least, A factor) const;
  void placeRays(const SeenBox& seen, const glm::dvec3& middle);
  void load(const glm::ivec3& cell);
  void findSeenCells(const glm::ivec3& cell);
  A mostFactor(const SeenBox& seen) const;
  bool isCutByHalfSpace(const CellBox& box) const;

  const CellFrame<T>& Frame;
  ScreenTile<A>& Tile;
  const CellLoops<A>& Loops;
  PixelRectangle Pixels;
  CellBlock<A> Block;
  /// Of the tile's rays: the least and the greatest begin, the least and the greatest end.
  double FirstNear = 0.0, LastNear = 0.0, FirstFar = 0.0, LastFar = 0.0;
  std::int32_t Seen[64][4];
  int SinceCheck = 0;
};

extern template struct CellFrame<std::int8_t>;
extern template struct CellFrame<std::uint8_t>;
extern template struct CellFrame<std::int16_t>;
extern template struct CellFrame<std::uint16_t>;
extern template struct CellFrame<std::int32_t>;
extern template struct CellFrame<std::uint32_t>;
extern template struct CellFrame<std::int64_t>;
extern template struct CellFrame<std::uint64_t>;
extern template struct CellFrame<float>;
extern template struct CellFrame<double>;
extern template class TileSplatter<std::int8_t>;
extern template class TileSplatter<std::uint8_t>;
extern template class TileSplatter<std::int16_t>;
extern template class TileSplatter<std::uint16_t>;
extern template class TileSplatter<std::int32_t>;
extern template class TileSplatter<std::uint32_t>;
extern template class TileSplatter<std::int64_t>;
extern template class TileSplatter<std::uint64_t>;
extern template class TileSplatter<float>;
extern template class TileSplatter<double>;
}

#endif
