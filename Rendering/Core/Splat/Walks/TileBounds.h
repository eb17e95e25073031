// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The tiles of a band of image rows, and their bounds for each layer of slices: the largest brick
 * that a tile's rays can cross in the layer.
 */
#ifndef splattingTileBounds_h
#define splattingTileBounds_h

#include "Splat/Walks/SliceSampler.h"
#include "Splat/Walks/WalkSpace.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

namespace splatting
{
static_assert(TileWidth == BrickWidth && TileHeight == BrickHeight);

/// A band of rows, divided into groups of tiles of TileWidth pixels.
struct BandTiles
{
  int v0, v1, width;
  int height = TileHeight;

  int tiles() const { return (this->width + TileWidth - 1) / TileWidth; }
  int groups() const { return (this->v1 - this->v0 + this->height - 1) / this->height; }
  int count() const { return this->tiles() * this->groups(); }
  int firstRow(int group) const { return this->v0 + group * this->height; }
  int endRow(int group) const { return std::min(this->firstRow(group) + this->height, this->v1); }

  /// The least pixel of each tile of a group.
  /// @param rows  the group's first
  template <class P>
  void findMinima(const TileLoops<P>& loops, const P* rows, int group, P* out) const
  {
    const int whole = this->width / TileWidth, height = this->endRow(group) - this->firstRow(group);
    loops.minima(rows, this->width, height, whole, out);
    if (whole == this->tiles())
    {
      return;
    }
    // The last tile has fewer columns.
    out[whole] = greatestValue<P>();
    for (int r = 0; r < height; ++r)
    {
      const P* const row = rows + std::ptrdiff_t(r) * this->width;
      out[whole] =
        std::min(out[whole], *std::min_element(row + whole * TileWidth, row + this->width));
    }
  }
};

/// Rows of tiles in dense walks: many, because rows of pixels share their voxels.
constexpr int DenseHeight = 4 * TileHeight;

/// The layers of slices that a band of rows crosses.
inline Span layersOf(const ProjectionContext& context, const Span& some, int v0, int v1)
{
  const Span slices = common(some, slicesOf(context.sliceGeometry, v0, v1));
  const int begin = slices.begin / BrickDepth;
  return { begin, slices.empty() ? begin : (slices.end - 1) / BrickDepth + 1 };
}

template <class T, class P>
class TileBounds
{
public:
  /// @param range  the layers that are needed
  TileBounds(const ProjectionContext& context, const SliceSampler<T, P>& sampler,
    const BandTiles& tiles, const Span& range, BandScratch& scratch)
    : Context(context),
      Sampler(sampler),
      Space(scratch),
      Band(tiles),
      Tiles(tiles.tiles()),
      Groups(tiles.groups())
  {
    // Worksheets also weigh voxels of the neighbouring layers.
    const int layers = (context.geometry.size().z + BrickDepth - 1) / BrickDepth;
    const int beyond = sampler.traits().beyond;
    this->Known = { std::max(range.begin - beyond, 0), std::min(range.end + beyond, layers) };
  }

  /// Finds the bounds of all tiles for all layers.
  void find(const BrickMaxima& bricks)
  {
    const std::size_t count =
      std::size_t(this->Known.end - this->Known.begin) * this->Groups * this->Tiles;
    // Rows are written in whole registers, whose ends the next row overwrites.
    this->Space.voxelBounds.resize(count * sizeof(T) + BrickMaxima::Padding);
    for (int z = this->Known.begin; z < this->Known.end; ++z)
    {
      for (int g = 0; g < this->Groups; ++g)
      {
        this->Sampler.traits().perspective
          ? this->takeOwnBricks(bricks, z, g, this->voxelBounds(z, g))
          : this->takeBricks(bricks, z, g, this->voxelBounds(z, g));
      }
    }
    if (this->Sampler.traits().beyond == 0) // single voxels
    {
      this->Space.bounds.swap(this->Space.voxelBounds);
    }
    else if constexpr (std::is_same_v<P, Accumulator<T>>)
    {
      this->Space.bounds.resize(count * sizeof(P));
      const VoxelLoops<T>& loops = this->Context.kernels;
      if (count > 0)
      {
        loops.widen(this->voxelBounds(this->Known.begin, 0), 0, this->bounds(this->Known.begin, 0),
          0, this->Sampler.base(), count, 1, 0);
      }
      this->blendBounds();
    }
  }

  /// The bounds of a group's tiles for layer z: no sample is larger.
  P* bounds(int z, int group)
  {
    return reinterpret_cast<P*>(this->Space.bounds.data()) + this->place(z, group);
  }

  /// The number of tiles that cross bricks, over all layers.
  std::int64_t met() const { return this->Met; }

private:
  std::ptrdiff_t place(int z, int group) const
  {
    return (std::ptrdiff_t(z - this->Known.begin) * this->Groups + group) * this->Tiles;
  }
  T* voxelBounds(int z, int group)
  {
    return reinterpret_cast<T*>(this->Space.voxelBounds.data()) + this->place(z, group);
  }

  /// The largest brick in the window of each tile of a group, for the layer's own slices. Beyond
  /// the ends of rows other bricks are read, which can only raise bounds.
  void takeBricks(const BrickMaxima& bricks, int z, int group, T* out)
  {
    const VoxelWindow window = this->Sampler.window(z);
    // Beyond the volume worksheets repeat its outermost voxels.
    const int bottom = this->Band.firstRow(group), top = this->Band.endRow(group) - 1;
    const int last = this->Context.geometry.size().y - 1;
    const int low = std::clamp(bottom + window.jMin, 0, last) / BrickHeight;
    const int high = std::clamp(top + window.jMax, 0, last) / BrickHeight;
    const bool meets = top + window.jMax >= -Beside && bottom + window.jMin <= last + Beside;
    // Tile t crosses bricks t + from to t + to.
    const int from = floorDivided(window.iMin, BrickWidth);
    const int to = floorDivided(TileWidth - 1 + window.iMax, BrickWidth);
    const Span tiles = meets ? common({ 0, this->Tiles }, { -to, bricks.count.x - from }) : Span{};
    if (tiles.empty())
    {
      std::fill(out, out + this->Tiles, leastValue<T>());
      return;
    }
    std::fill(out, out + tiles.begin, leastValue<T>());
    this->Met += tiles.end - tiles.begin;
    const T* rows[MostBricks];
    int count = 0;
    for (int j = low; j <= high; ++j)
    {
      for (int b = from; b <= to; ++b)
      {
        rows[count++] = bricks.row<T>(j, z) + b + tiles.begin;
      }
    }
    const VoxelLoops<T>& loops = this->Context.kernels;
    loops.largest(rows, count, out + tiles.begin, tiles.end - tiles.begin);
    std::fill(out + tiles.end, out + this->Tiles, leastValue<T>());
    // The next tiles may read repeated outermost voxels, too.
    if (tiles.begin > 0)
    {
      out[tiles.begin - 1] = out[tiles.begin];
    }
    if (tiles.end < this->Tiles)
    {
      out[tiles.end] = out[tiles.end - 1];
    }
  }

  /// The same in perspective, where each tile has its own window.
  void takeOwnBricks(const BrickMaxima& bricks, int z, int group, T* out)
  {
    const glm::ivec3& size = this->Context.geometry.size();
    std::fill(out, out + this->Tiles, leastValue<T>());
    const int v0 = this->Band.firstRow(group);
    const Span rows = this->Sampler.rowsOf(z, { v0, this->Band.endRow(group) });
    if (rows.end <= -Beside || rows.begin >= size.y + Beside || rows.empty())
    {
      return;
    }
    // Beyond the volume worksheets repeat its outermost voxels.
    const int low = std::clamp(rows.begin, 0, size.y - 1) / BrickHeight;
    const int high = std::clamp(rows.end - 1, 0, size.y - 1) / BrickHeight;
    const T* all[MostBricks];
    for (int j = low; j <= high; ++j)
    {
      all[j - low] = bricks.row<T>(j, z);
    }
    this->Space.brickRow.resize(bricks.count.x * sizeof(T) + BrickMaxima::Padding);
    T* const row = reinterpret_cast<T*>(this->Space.brickRow.data());
    const VoxelLoops<T>& loops = this->Context.kernels;
    loops.largest(all, high - low + 1, row, bricks.count.x);
    const std::vector<Span>& windows = this->tileWindows(z);
    for (int t = 0; t < this->Tiles; ++t)
    {
      if (!windows[t].empty())
      {
        out[t] = *std::max_element(row + windows[t].begin, row + windows[t].end);
        ++this->Met;
      }
    }
  }

  /// The bricks along i that each tile of a layer crosses.
  const std::vector<Span>& tileWindows(int z)
  {
    std::vector<Span>& windows = this->Space.tileWindows;
    if (this->WindowsOf != z)
    {
      this->WindowsOf = z;
      windows.resize(this->Tiles);
      const int size = this->Context.geometry.size().x;
      for (int t = 0; t < this->Tiles; ++t)
      {
        const Span voxels = this->Sampler.columnsOf(z, { t * TileWidth, (t + 1) * TileWidth });
        windows[t] = voxels.empty() || voxels.end <= -Beside || voxels.begin >= size + Beside
          ? Span{}
          : Span{ std::clamp(voxels.begin, 0, size - 1) / BrickWidth,
              std::clamp(voxels.end - 1, 0, size - 1) / BrickWidth + 1 };
      }
    }
    return windows;
  }

  /// In each direction a window is at most as wide as the sum of a tile, the drift of BrickDepth +
  /// 2 slices, and a footprint.
  static constexpr int MostBricks = 4 * 6;

  static int floorDivided(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

  /// Worksheets also weigh voxels of the neighbouring layers.
  void blendBounds()
  {
    const WorksheetLoops<P>& loops = this->Context.kernels;
    const int row = this->Groups * this->Tiles; // of one layer
    const P slack = this->Sampler.slack(), magnitude = this->Sampler.magnitude();
    // In place: the next layer is unchanged, and the previous one is copied.
    this->Space.voxelBounds.resize(std::size_t(2) * row * sizeof(P));
    P* before = reinterpret_cast<P*>(this->Space.voxelBounds.data());
    P* kept = before + row;
    for (int z = this->Known.begin; z < this->Known.end; ++z)
    {
      P* const own = this->bounds(z, 0);
      std::copy(own, own + row, kept);
      const bool hasBefore = z > this->Known.begin, hasAfter = z + 1 < this->Known.end;
      const P *const front = hasBefore ? before : kept, *const back = hasAfter ? own + row : kept;
      if (this->Context.range.nonFinite)
      {
        this->takeLargest(own, front, back, row);
      }
      else
      {
        loops.bound(own, front, back, this->Sampler.share(z), slack, magnitude, row);
      }
      std::swap(before, kept);
    }
  }

  /// If some voxels are NaN, the other voxels have larger weights. It is possible that all
  /// remaining voxels belong to a neighbouring layer.
  void takeLargest(P* own, const P* before, const P* after, int count) const
  {
    const P slack = this->Sampler.slack(), magnitude = this->Sampler.magnitude();
    for (int t = 0; t < count; ++t)
    {
      const P most = std::max({ own[t], before[t], after[t] });
      own[t] = most > leastValue<P>() ? most + slack * std::max(std::abs(most), magnitude) : most;
    }
  }

  const ProjectionContext& Context;
  const SliceSampler<T, P>& Sampler;
  BandScratch& Space;
  const BandTiles& Band;
  const int Tiles, Groups;
  Span Known;         // layers with bounds
  int WindowsOf = -1; // the layer of the scratch's windows
  std::int64_t Met = 0;
};
}

#endif
