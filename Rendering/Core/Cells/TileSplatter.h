// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingTileSplatter_h
#define splattingTileSplatter_h

#include "Cells/CellFrame.h"

#include <vector>

namespace splatting
{
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
  void finish(bool finished, CellScreen& screen) const;

private:
  void openRow(int y);
  bool isDone(std::uint32_t brick);
  bool mayRaise(std::uint32_t brick) const;
  void prefetch(std::uint32_t brick) const;
  void splatBrick(std::uint32_t brick);
  void splatBlock(const glm::ivec3& cell, A bound, bool isCut);
  bool reaches(A bound, A least, A factor) const;
  void placeRays(const ProjectedBox& seen, const glm::dvec3& middle);
  void load(const glm::ivec3& cell);
  void findSeenCells(const glm::ivec3& cell);
  A mostFactor(const ProjectedBox& seen) const;
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
}

#endif
