// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/TileRuns.h"
#include "Projection/WalkSpace.h"
#include "Projection/WinnerFinder.h"
#include "Sampling/SliceSampler.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>
#include <vector>

namespace splatting
{
namespace
{
static_assert(TileWidth == BrickWidth && TileHeight == BrickHeight);

/**
 * In which order a band of image rows meets the layers of slices, and what it leaves out.
 *
 * Densely: all of them, in storage order. With bricks: for tiles of TileWidth x TileHeight pixels
 * and each layer, the largest brick that the tile's rays can meet bounds what the layer can add.
 * Layers with high bounds come first, and a tile whose bound is no more than its least pixel is
 * left out: it could not change a pixel. (Where winners are noted, a tile whose bound is its least
 * pixel may still change the winner.) What remains is walked row by row, several tiles at a
 * time, because memory is fastest where it is read in order.
 *
 * Where rays are cut, runs of pixels say where a slice counts or, where one run does not tell, bits
 * which slices of a layer count for a pixel. Tiles that have none are left out.
 */
template <class T, class P>
class BandWalk
{
public:
  using Layers = SliceSampler<T, P>;

  /// @param some  the slices to walk; whole layers
  BandWalk(const Frame& frame, const Layers& layers, BandScratch& scratch, const Span& some, int v0,
    int v1)
    : Shared(frame),
      Stack(layers),
      Traits(layers.traits()),
      Scratch(scratch),
      V0(v0),
      V1(v1)
  {
    const Span slices = common(some, slicesOf(frame.sliceGeometry, v0, v1));
    this->Range = { slices.begin / BrickDepth,
      slices.empty() ? slices.begin / BrickDepth : (slices.end - 1) / BrickDepth + 1 };
    const int layersInAll = (frame.geometry.size().z + BrickDepth - 1) / BrickDepth;
    this->Known = { std::max(this->Range.begin - this->Traits.beyond, 0),
      std::min(this->Range.end + this->Traits.beyond, layersInAll) };
    this->Tiles = (frame.image.width + TileWidth - 1) / TileWidth;
    this->Groups = (v1 - v0 + TileHeight - 1) / TileHeight;
  }

  void walkDensely()
  {
    std::vector<Span>& runs = this->Scratch.runs;
    runs.assign(1, { 0, this->Shared.image.width });
    if (this->Shared.cuts.none())
    {
      this->Stack.splatAll(this->Range, this->V0, this->V1, runs, nullptr, this->Scratch.patch);
      return;
    }
    if (this->Shared.range.special)
    {
      this->walkSamples();
      return;
    }
    if (this->Traits.takesSliceRuns && this->findSliceRuns())
    {
      this->Stack.splatAll(
        this->Range, this->V0, this->V1, runs, &this->Scratch.sliceRuns, this->Scratch.patch);
      return;
    }
    this->openBits();
    this->walkCut();
  }

  void walkBricks(const BrickMaxima& bricks)
  {
    this->findBounds(bricks);
    this->orderLayers();
    this->Scratch.minima.resize(std::size_t(this->Groups) * this->Tiles * sizeof(P));
    std::fill_n(this->minimaOf(0), this->Groups * this->Tiles, this->Stack.floor());
    this->Scratch.farthest.assign(
      this->Shared.orders ? this->Groups * this->Tiles : 0, std::int16_t(-1));
    this->openCuts();
    int walked = 0;
    for (int z : this->Scratch.order)
    {
      for (int g = 0; g < this->Groups; ++g)
      {
        this->walkGroup(z, g);
      }
      // The first layers raise the minima most.
      ++walked;
      if ((walked & (walked - 1)) == 0 || walked % 16 == 0)
      {
        this->findMinima();
      }
    }
  }

private:
  int rowsOf(int group) const
  {
    return std::min(TileHeight, this->V1 - this->V0 - group * TileHeight);
  }
  int firstRow(int group) const { return this->V0 + group * TileHeight; }
  std::ptrdiff_t place(int z, int group) const
  {
    return (std::ptrdiff_t(z - this->Known.begin) * this->Groups + group) * this->Tiles;
  }
  T* voxelBounds(int z, int group)
  {
    return reinterpret_cast<T*>(this->Scratch.voxelBounds.data()) + this->place(z, group);
  }
  P* bounds(int z, int group)
  {
    return reinterpret_cast<P*>(this->Scratch.bounds.data()) + this->place(z, group);
  }
  P* minimaOf(int group)
  {
    return reinterpret_cast<P*>(this->Scratch.minima.data()) + std::ptrdiff_t(group) * this->Tiles;
  }

  /// The farthest sample that any least pixel of each tile has its value from: a layer whose bound
  /// is that value can tie with no other pixel. At the floor all samples are equal, and the first
  /// one is known without a walk.
  std::int16_t* farthestOf(int group)
  {
    return this->Scratch.farthest.data() + std::ptrdiff_t(group) * this->Tiles;
  }

  /// Cut rays, layer by layer. Some groups of rows together, for which worksheets widen the same
  /// voxels.
  void walkCut()
  {
    const int together = this->Traits.rowsTogether / TileHeight;
    this->Scratch.rows.resize(together);
    for (int first = 0; first < this->Groups; first += together)
    {
      const int end = std::min(first + together, this->Groups);
      this->Stack.open(this->firstRow(first), this->firstRow(end - 1) + this->rowsOf(end - 1),
        { 0, this->Shared.image.width }, this->Scratch.patch);
      for (int n = 0; n < this->Range.end - this->Range.begin; ++n)
      {
        const int z = this->Shared.nth(this->Range, n);
        for (int g = first; g < end; ++g)
        {
          RowRuns& rows = this->Scratch.rows[g - first];
          rows.v0 = this->firstRow(g);
          rows.v1 = rows.v0 + this->rowsOf(g);
          std::fill_n(this->openFlags(), this->Tiles, static_cast<unsigned char>(1));
          rows.bits = this->findBits(z, g);
          rows.whole = rows.bits.origin ? this->Scratch.cuts.wholeRun() : Span{};
          this->findRuns(rows.runs);
        }
        this->Stack.splatOpened(z, this->Scratch.rows, end - first, this->Scratch.patch);
      }
    }
  }

  /// The same sample by sample, for voxels that compare with nothing.
  void walkSamples()
  {
    const RayLoops<P>& loops = this->Shared.kernels;
    const Span slices{ this->Range.begin * BrickDepth,
      std::min(this->Range.end * BrickDepth, this->Shared.geometry.size().z) };
    this->Scratch.mask.resize(this->Shared.image.width);
    this->Stack.forSamples(slices, false, this->V0, this->V1, { 0, this->Shared.image.width },
      this->Scratch.patch,
      [&](int step, int v, const Span& pixels, const P* samples, const unsigned char* present)
      {
        unsigned char* const mask = this->Scratch.mask.data();
        if (this->Shared.cuts.findMask(step / StepsPerSlice, v, pixels, mask))
        {
          narrow(mask, present, pixels);
          loops.raise(this->Shared.image.template row<P>(v) + pixels.begin, samples, mask,
            pixels.end - pixels.begin);
        }
      });
  }

  /// Of all slices that layers are taken together with.
  bool findSliceRuns()
  {
    constexpr int depth = LayersTogether * BrickDepth;
    const int begin = this->Range.begin * BrickDepth, end = this->Range.end * BrickDepth;
    const Span slices{ begin / depth * depth,
      std::min((end + depth - 1) / depth * depth, this->Shared.geometry.size().z) };
    return this->Scratch.sliceRuns.find(
      this->Shared.cuts, slices, this->V0, this->V1, this->Shared.image.spans);
  }

  void openCuts()
  {
    if (this->Shared.cuts.none())
    {
      return;
    }
    this->HasSliceRuns = this->Traits.takesSliceRuns && this->findSliceRuns();
    if (!this->HasSliceRuns)
    {
      this->openBits();
    }
  }

  void openBits()
  {
    this->Scratch.cuts.reset(
      this->Shared.cuts, this->Shared.kernels, this->V0, this->V1, this->Shared.image.width);
  }

  SliceBits findBits(int z, int group)
  {
    return this->Scratch.cuts.findBits(
      slicesOfLayer(z, this->Shared.geometry.size()), group, this->Scratch.flags.data());
  }

  /// What each layer can add to each tile.
  void findBounds(const BrickMaxima& bricks)
  {
    const std::size_t count =
      std::size_t(this->Known.end - this->Known.begin) * this->Groups * this->Tiles;
    // Rows are written in whole registers, each of which the next row overwrites.
    this->Scratch.voxelBounds.resize(count * sizeof(T) + BrickMaxima::Padding);
    for (int z = this->Known.begin; z < this->Known.end; ++z)
    {
      for (int g = 0; g < this->Groups; ++g)
      {
        this->Traits.perspective ? this->takeOwnBricks(bricks, z, g, this->voxelBounds(z, g))
                                 : this->takeBricks(bricks, z, g, this->voxelBounds(z, g));
      }
    }
    if (this->Traits.beyond == 0) // voxels as they are
    {
      this->Scratch.bounds.swap(this->Scratch.voxelBounds);
    }
    else if constexpr (std::is_same_v<P, Accumulator<T>>)
    {
      this->Scratch.bounds.resize(count * sizeof(P));
      const VoxelLoops<T>& loops = this->Shared.kernels;
      if (count > 0)
      {
        loops.widen(this->voxelBounds(this->Known.begin, 0), 0, this->bounds(this->Known.begin, 0),
          0, this->Stack.base(), count, 1, 0);
      }
      this->blendBounds();
    }
  }

  /// The largest of the bricks in the window of each tile of a group, for the layer's own slices.
  /// Beyond the ends of rows of bricks others are read: that makes some bounds higher, not wrong.
  void takeBricks(const BrickMaxima& bricks, int z, int group, T* out)
  {
    const Window window = this->Stack.window(z);
    // Where worksheets read beyond the volume they repeat its outermost voxels.
    const int bottom = this->firstRow(group), top = bottom + this->rowsOf(group) - 1;
    const int last = this->Shared.geometry.size().y - 1;
    const int low = std::clamp(bottom + window.jMin, 0, last) / BrickHeight;
    const int high = std::clamp(top + window.jMax, 0, last) / BrickHeight;
    const bool meets = top + window.jMax >= -Beside && bottom + window.jMin <= last + Beside;
    // Tile t meets bricks t + from to t + to.
    const int from = floorDivided(window.iMin, BrickWidth);
    const int to = floorDivided(TileWidth - 1 + window.iMax, BrickWidth);
    const Span tiles = meets ? common({ 0, this->Tiles }, { -to, bricks.count.x - from }) : Span{};
    if (tiles.empty())
    {
      std::fill(out, out + this->Tiles, leastValue<T>());
      return;
    }
    std::fill(out, out + tiles.begin, leastValue<T>());
    this->Scratch.count.met += tiles.end - tiles.begin;
    const T* rows[MostBricks];
    int count = 0;
    for (int j = low; j <= high; ++j)
    {
      for (int b = from; b <= to; ++b)
      {
        rows[count++] = bricks.row<T>(j, z) + b + tiles.begin;
      }
    }
    const VoxelLoops<T>& loops = this->Shared.kernels;
    loops.largest(rows, count, out + tiles.begin, tiles.end - tiles.begin);
    std::fill(out + tiles.end, out + this->Tiles, leastValue<T>());
    // The next tiles can see outermost voxels, too, that are repeated for them.
    if (tiles.begin > 0)
    {
      out[tiles.begin - 1] = out[tiles.begin];
    }
    if (tiles.end < this->Tiles)
    {
      out[tiles.end] = out[tiles.end - 1];
    }
  }

  /// The same in perspective, where each tile has a window of its own.
  void takeOwnBricks(const BrickMaxima& bricks, int z, int group, T* out)
  {
    const glm::ivec3& size = this->Shared.geometry.size();
    std::fill(out, out + this->Tiles, leastValue<T>());
    const int v0 = this->firstRow(group);
    const Span rows = this->Stack.rowsOf(z, { v0, v0 + this->rowsOf(group) });
    if (rows.end <= -Beside || rows.begin >= size.y + Beside || rows.empty())
    {
      return;
    }
    // Where worksheets read beyond the volume they repeat its outermost voxels.
    const int low = std::clamp(rows.begin, 0, size.y - 1) / BrickHeight;
    const int high = std::clamp(rows.end - 1, 0, size.y - 1) / BrickHeight;
    const T* all[MostBricks];
    for (int j = low; j <= high; ++j)
    {
      all[j - low] = bricks.row<T>(j, z);
    }
    this->Scratch.brickRow.resize(bricks.count.x * sizeof(T) + BrickMaxima::Padding);
    T* const row = reinterpret_cast<T*>(this->Scratch.brickRow.data());
    const VoxelLoops<T>& loops = this->Shared.kernels;
    loops.largest(all, high - low + 1, row, bricks.count.x);
    const Span* const windows = this->tileWindows(z);
    for (int t = 0; t < this->Tiles; ++t)
    {
      if (!windows[t].empty())
      {
        out[t] = *std::max_element(row + windows[t].begin, row + windows[t].end);
        ++this->Scratch.count.met;
      }
    }
  }

  /// The bricks along i that each tile of a layer meets.
  const Span* tileWindows(int z)
  {
    std::vector<Span>& windows = this->Scratch.tileWindows;
    if (this->WindowsOf != z)
    {
      this->WindowsOf = z;
      windows.resize(this->Tiles);
      const int size = this->Shared.geometry.size().x;
      for (int t = 0; t < this->Tiles; ++t)
      {
        const Span voxels = this->Stack.columnsOf(z, { t * TileWidth, (t + 1) * TileWidth });
        windows[t] = voxels.empty() || voxels.end <= -Beside || voxels.begin >= size + Beside
          ? Span{}
          : Span{ std::clamp(voxels.begin, 0, size - 1) / BrickWidth,
              std::clamp(voxels.end - 1, 0, size - 1) / BrickWidth + 1 };
      }
    }
    return windows.data();
  }

  /// In each direction a window is at most a tile, the drift of BrickDepth + 2 slices and a
  /// footprint wide.
  static constexpr int MostBricks = 4 * 6;

  static int floorDivided(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

  /// Worksheets also weigh voxels of the layers before and behind.
  void blendBounds()
  {
    const WorksheetLoops<P>& loops = this->Shared.kernels;
    const int row = this->Groups * this->Tiles; // of one layer
    const P slack = this->Stack.slack(), magnitude = this->Stack.magnitude();
    // In place: the layer behind is still as it was, the one before is kept.
    this->Scratch.voxelBounds.resize(std::size_t(2) * row * sizeof(P));
    P* before = reinterpret_cast<P*>(this->Scratch.voxelBounds.data());
    P* kept = before + row;
    for (int z = this->Known.begin; z < this->Known.end; ++z)
    {
      P* const own = this->bounds(z, 0);
      std::copy(own, own + row, kept);
      const bool hasBefore = z > this->Known.begin, hasAfter = z + 1 < this->Known.end;
      loops.bound(own, hasBefore ? before : kept, hasAfter ? own + row : kept, this->Stack.share(z),
        slack, magnitude, row);
      std::swap(before, kept);
    }
  }

  /// Highest first, by the mean over some of the tiles.
  void orderLayers()
  {
    constexpr int step = 13;
    std::vector<int>& order = this->Scratch.order;
    std::vector<double>& scores = this->Scratch.scores;
    order.resize(this->Range.end - this->Range.begin);
    std::iota(order.begin(), order.end(), this->Range.begin);
    scores.resize(order.size());
    const P low = static_cast<P>(this->Shared.range.low);
    for (int z : order)
    {
      const P* const b = this->bounds(z, 0);
      double sum = 0.0;
      for (int t = 0; t < this->Groups * this->Tiles; t += step)
      {
        sum += static_cast<double>(std::max(b[t], low));
      }
      scores[z - this->Range.begin] = sum;
    }
    std::sort(order.begin(), order.end(),
      [&](int a, int b)
      {
        const double x = scores[a - this->Range.begin], y = scores[b - this->Range.begin];
        return x > y || (x == y && a < b);
      });
  }

  void findMinima()
  {
    const TileLoops<P>& loops = this->Shared.kernels;
    const ShearImage& image = this->Shared.image;
    const int whole = image.width / TileWidth;
    for (int g = 0; g < this->Groups; ++g)
    {
      const P* const rows = image.row<P>(this->firstRow(g));
      P* const out = this->minimaOf(g);
      loops.minima(rows, image.width, this->rowsOf(g), whole, out);
      if (this->Shared.orders)
      {
        loops.farthest(rows, this->Shared.ordersOfRow(this->firstRow(g)), image.width,
          this->rowsOf(g), whole, out, this->Stack.floor(), this->farthestOf(g));
      }
      if (whole < this->Tiles)
      {
        this->findLastMinimum(g);
      }
    }
  }

  /// Of a tile with fewer columns than the others.
  void findLastMinimum(int group)
  {
    const ShearImage& image = this->Shared.image;
    P least = greatestValue<P>();
    for (int v = this->firstRow(group); v < this->firstRow(group) + this->rowsOf(group); ++v)
    {
      const P* const row = image.row<P>(v);
      least =
        std::min(least, *std::min_element(row + (this->Tiles - 1) * TileWidth, row + image.width));
    }
    this->minimaOf(group)[this->Tiles - 1] = least;
    if (this->Shared.orders)
    {
      // Any layer may tie.
      this->farthestOf(group)[this->Tiles - 1] =
        least > this->Stack.floor() ? std::numeric_limits<std::int16_t>::max() : std::int16_t(-1);
    }
  }

  /// Splats the tiles of a group that a layer can change.
  void walkGroup(int z, int group)
  {
    const TileLoops<P>& loops = this->Shared.kernels;
    const P* const bounds = this->bounds(z, group);
    const P* const minima = this->minimaOf(group);
    unsigned char* const flags = this->openFlags();
    this->Shared.orders ? loops.exceedsOrTies(bounds, minima, this->farthestOf(group),
                            this->Shared.nearestOrder(z), flags, this->Tiles)
                        : loops.exceeds(bounds, minima, flags, this->Tiles);
    this->splatFlagged(z, group);
  }

  /// One flag for each tile of a group, and zeros up to the next word.
  unsigned char* openFlags()
  {
    this->Scratch.flags.resize((this->Tiles + FlagsPerWord - 1) / FlagsPerWord * FlagsPerWord);
    std::fill(this->Scratch.flags.begin() + this->Tiles, this->Scratch.flags.end(),
      static_cast<unsigned char>(0));
    return this->Scratch.flags.data();
  }

  /// Splats the tiles of a group that have flags.
  void splatFlagged(int z, int group)
  {
    const int v0 = this->firstRow(group), v1 = v0 + this->rowsOf(group);
    if (this->HasSliceRuns)
    {
      this->splatFlaggedCut(z, v0, v1);
      return;
    }
    SliceBits bits;
    if (!this->Shared.cuts.none())
    {
      bits = this->findBits(z, group);
    }
    this->findRuns(this->Scratch.runs);
    if (!this->Scratch.runs.empty())
    {
      this->Stack.splat(z, v0, v1, this->Scratch.runs, bits, nullptr, this->Scratch.patch);
    }
  }

  /// The same where slices count for runs of pixels.
  void splatFlaggedCut(int z, int v0, int v1)
  {
    unsigned char* const flags = this->Scratch.flags.data();
    if (!std::memchr(flags, 1, this->Tiles))
    {
      return;
    }
    const SliceRuns::Hull hull =
      this->Scratch.sliceRuns.hull(slicesOfLayer(z, this->Shared.geometry.size()), v0, v1);
    const int begin = std::clamp(hull.any.begin / TileWidth, 0, this->Tiles);
    const int end = std::clamp((hull.any.end + TileWidth - 1) / TileWidth, begin, this->Tiles);
    std::fill(flags, flags + begin, static_cast<unsigned char>(0));
    std::fill(flags + end, flags + this->Tiles, static_cast<unsigned char>(0));
    std::vector<Span>& runs = this->Scratch.runs;
    this->findRuns(runs);
    if (!runs.empty())
    {
      const VoxelLoops<T>& loops = this->Shared.kernels;
      const int beside = static_cast<int>(loops.lanes); // sweeps may go on as far
      const bool isCut =
        runs.front().begin - beside < hull.all.begin || runs.back().end + beside > hull.all.end;
      this->Stack.splat(
        z, v0, v1, runs, {}, isCut ? &this->Scratch.sliceRuns : nullptr, this->Scratch.patch);
    }
  }

  /// The runs of tiles with flags.
  void findRuns(std::vector<Span>& runs)
  {
    this->Scratch.count.splatted += findTileRuns(this->Scratch.flags.data(), this->Tiles,
      this->Traits.runUnit, this->Shared.image.width, runs);
  }

  const Frame& Shared;
  const Layers& Stack;
  const SamplerTraits& Traits;
  BandScratch& Scratch;
  int V0, V1;
  Span Range; // of layers that are walked
  Span Known; // and that have bounds: their neighbours, too
  int Tiles, Groups;
  bool HasSliceRuns = false; // whether the scratch's say how rays are cut
  int WindowsOf = -1;        // the layer that the scratch's windows are of
};
}

template <class T, class P>
void walkBands(Frame& frame, const SliceSampler<T, P>& sampler)
{
  WalkSpace& space = frame.space;
  const bool notes = frame.image.keepsWinners();
  if (notes)
  {
    openNotes(frame);
  }
  const WinnerFinder<P> finder(frame, sampler.floor(), space.outline.crossed);
  frame.nearestFirst = notes && !frame.bricks;
  forSlices(frame, sampler.traits().beyond, notes && frame.geometry.reversed(),
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(frame.image.height, bandHeight(frame.image.height), frame.watch,
        [&](int v0, int v1)
        {
          if (isFirst)
          {
            openRows<P>(frame.image, sampler.floor(), v0, v1);
            if (notes)
            {
              openOrders(frame, v0, v1);
            }
          }
          BandWalk<T, P> band(frame, sampler, space.bands.Local(), slices, v0, v1);
          frame.bricks ? band.walkBricks(*frame.bricks) : band.walkDensely();
          if (isLast)
          {
            if (notes)
            {
              finder.find(v0, v1, space.winners.Local());
            }
            sampler.finish(v0, v1);
            closeRows<P>(frame.image, v0, v1);
          }
        });
    });
  for (BandScratch& band : space.bands)
  {
    frame.count.met += band.count.met;
    frame.count.splatted += band.count.splatted;
    band.count = {};
  }
}

#define VOXELS(T) template void walkBands(Frame&, const SliceSampler<T, T>&);
#define WORKSHEETS(T) template void walkBands(Frame&, const SliceSampler<T, Accumulator<T>>&);
SPLATTING_TYPES(VOXELS)
SPLATTING_INTEGERS(WORKSHEETS) // others are of their voxels' type
}
