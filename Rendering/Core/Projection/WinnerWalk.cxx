// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/TileBounds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace splatting
{
namespace
{
/// The largest value that is less, if there is one.
template <class P>
P justBelow(P value)
{
  if constexpr (std::numeric_limits<P>::is_integer)
  {
    return value > leastValue<P>() ? static_cast<P>(value - 1) : value;
  }
  else
  {
    return std::nextafter(value, leastValue<P>());
  }
}

/**
 * Which sample each pixel of a projection shows: of equal ones the nearest to the viewer. Where a
 * pixel is the floor, which no sample is below, that is the first sample of its ray.
 *
 * Nothing is noted while an image is made. Slices are looked at once more, from the viewer on, for
 * the first sample that is as large as its pixel: above a limit just below it. With bricks only
 * tiles are looked at whose bound in a layer is above the least limit of their pixels. What has
 * been found gets a limit that nothing is above.
 */
template <class T, class P>
class WinnerWalk
{
public:
  WinnerWalk(Frame& frame, const SliceSampler<T, P>& sampler) : Shared(frame), Stack(sampler)
  {
    std::vector<unsigned char>& limits = frame.space.limits;
    limits.resize(frame.image.winners.size() * sizeof(P));
    this->Limits = reinterpret_cast<P*>(limits.data());
    if (frame.settings.acceleration != Acceleration::Dense && frame.index.hasBricks())
    {
      this->Bricks = &frame.index.bricks(frame.geometry.principalAxis());
    }
  }

  bool reversed() const { return this->Shared.geometry.reversed(); }

  /// No pixel of some rows has a winner yet, and those without samples never will.
  void open(int v0, int v1) const
  {
    ShearImage& image = this->Shared.image;
    const P floor = this->Stack.floor();
    for (int v = v0; v < v1; ++v)
    {
      const P* const row = image.row<P>(v);
      for (int u = 0; u < image.width; ++u)
      {
        const std::size_t at = this->place(u, v);
        const bool covers = image.covers(u, v), isFloor = covers && !(row[u] > floor);
        image.winners[at] = isFloor ? AtFloor : -1;
        this->Limits[at] = covers && !isFloor ? justBelow(row[u]) : Nothing;
      }
    }
  }

  void walk(const Span& slices, int v0, int v1, BandScratch& scratch) const
  {
    const BandTiles band{ v0, v1, this->Shared.image.width };
    const Span layers = layersOf(this->Shared, slices, v0, v1);
    // Long runs: to begin one costs more than to look at some tiles in vain.
    const int unit = std::max(this->Stack.traits().runUnit, LeastRun);
    scratch.block.reset(band.tiles(), unit / TileWidth, this->Shared.image.width);
    scratch.row.resize(band.width * sizeof(P));
    scratch.mask.resize(band.width);
    if (!this->Shared.cuts.none())
    {
      scratch.shares.reset(this->Shared.cuts, this->Shared.kernels, v0, v1, band.width);
    }
    TileBounds<T, P> bounds(this->Shared, this->Stack, band, layers, scratch);
    if (this->Bricks)
    {
      bounds.find(*this->Bricks);
    }
    scratch.minima.resize(band.count() * sizeof(P));
    for (int g = 0; g < band.groups(); ++g)
    {
      this->findMinima(band, g, scratch);
    }
    for (int n = 0; n < layers.end - layers.begin; ++n)
    {
      const int z = this->reversed() ? layers.end - 1 - n : layers.begin + n;
      for (int g = 0; g < band.groups(); g += TileBlock::MostGroups)
      {
        this->walkBlock(z, band, g, std::min(g + TileBlock::MostGroups, band.groups()),
          this->Bricks ? &bounds : nullptr, scratch);
      }
    }
    this->findFirst(slices, v0, v1, scratch);
  }

  /// Rays that only rounding lets meet the volume may have no sample.
  void close(int v0, int v1) const
  {
    const auto rows = this->Shared.image.winners.begin();
    std::replace(rows + this->place(0, v0), rows + this->place(0, v1), AtFloor, std::int32_t(-1));
  }

private:
  /// No sample is above.
  static constexpr P Nothing = std::numeric_limits<P>::max();
  /// Pixels; a multiple of all run units, or the other way round.
  static constexpr int LeastRun = 64;
  /// Among winners, that the first sample is still to be found.
  static constexpr std::int32_t AtFloor = -2;

  std::size_t place(int u, int v) const { return std::size_t(v) * this->Shared.image.width + u; }
  void win(int u, int v, int step) const { this->Shared.image.winners[this->place(u, v)] = step; }

  static P* minimaOf(const BandTiles& band, int group, BandScratch& scratch)
  {
    return reinterpret_cast<P*>(scratch.minima.data()) + group * band.tiles();
  }
  void findMinima(const BandTiles& band, int group, BandScratch& scratch) const
  {
    band.template findMinima<P>(this->Shared.kernels,
      this->Limits + this->place(0, band.firstRow(group)), group, minimaOf(band, group, scratch));
  }

  /// The tiles of some groups of rows whose pixels a layer may have samples for.
  void walkBlock(int z, const BandTiles& band, int first, int end, TileBounds<T, P>* bounds,
    BandScratch& scratch) const
  {
    const TileLoops<P>& loops = this->Shared.kernels;
    const Span slices = slicesOfLayer(z, this->Shared.geometry.size());
    int count = 0;
    for (int g = first; g < end; ++g)
    {
      const P* const minima = minimaOf(band, g, scratch);
      openFlags(band.tiles(), scratch.flags);
      if (bounds)
      {
        loops.exceeds(bounds->bounds(z, g), minima, scratch.flags.data(), band.tiles());
      }
      else
      {
        std::transform(minima, minima + band.tiles(), scratch.flags.data(),
          [](P least) { return static_cast<unsigned char>(least < Nothing); });
      }
      count += scratch.block.sort(g - first, scratch.flags.data(),
        this->Shared.cuts.none() ? nullptr : scratch.shares.find(slices, g));
    }
    if (count == 0)
    {
      return;
    }
    scratch.block.forWhole(end - first,
      [&](int a, int b, const std::vector<Span>& runs)
      { this->findIn(z, band.firstRow(first + a), band.endRow(first + b - 1), runs, scratch); });
    for (int g = first; g < end; ++g)
    {
      scratch.block.forPartly(g - first,
        [&](const Span& run)
        { this->findCounting(slices, band.firstRow(g), band.endRow(g), run, scratch); });
      this->findMinima(band, g, scratch);
    }
  }

  /// Pixels all of whose samples count.
  void findIn(int z, int v0, int v1, const std::vector<Span>& runs, BandScratch& scratch) const
  {
    if (this->Stack.forExceeding(z, v0, v1, runs, this->Limits, scratch.patch,
          [this](int u, int v, int step) { this->win(u, v, step); }))
    {
      return;
    }
    for (const Span& run : runs)
    {
      this->Stack.forWorksheets(slicesOfLayer(z, this->Shared.geometry.size()), this->reversed(),
        v0, v1, run, this->limits(), scratch.patch,
        [&](int k, int v, const Span& pixels, const P* values) {
          this->take(k, v, pixels, values, this->Limits + this->place(pixels.begin, v), scratch);
        });
    }
  }

  /// The same where some samples count.
  void findCounting(
    const Span& slices, int v0, int v1, const Span& columns, BandScratch& scratch) const
  {
    P* const limits = reinterpret_cast<P*>(scratch.row.data());
    this->Stack.forWorksheets(slices, this->reversed(), v0, v1, columns, this->limits(),
      scratch.patch,
      [&](int k, int v, const Span& pixels, const P* values)
      {
        const unsigned char* const mask = scratch.mask.data();
        if (this->Shared.cuts.findMask(k, v, pixels, scratch.mask.data()))
        {
          const P* const own = this->Limits + this->place(pixels.begin, v);
          std::transform(own, own + (pixels.end - pixels.begin), mask, limits,
            [](P limit, unsigned char counts) { return counts ? limit : Nothing; });
          this->take(k, v, pixels, values, limits, scratch);
        }
      });
  }

  PixelRows<P> limits() const { return { this->Limits, this->Shared.image.width }; }

  /// The worksheet of slice k for some pixels.
  void take(
    int k, int v, const Span& pixels, const P* values, P* limits, BandScratch& scratch) const
  {
    const VoxelLoops<P>& loops = this->Shared.kernels;
    std::vector<Exceeding>& found = scratch.patch.found;
    found.resize(this->Shared.image.width);
    const std::ptrdiff_t count =
      loops.exceed(&values, 1, limits, found.data(), pixels.end - pixels.begin);
    for (std::ptrdiff_t n = 0; n < count; ++n)
    {
      const int u = pixels.begin + found[n].x;
      const P limit = justBelow(this->Shared.image.template row<P>(v)[u]);
      this->win(u, v, StepsPerSlice * k + this->Stack.firstSample(u, v, k, limit));
      this->Limits[this->place(u, v)] = Nothing;
    }
  }

  /// The first samples of rays whose pixels are the floor.
  void findFirst(const Span& slices, int v0, int v1, BandScratch& scratch) const
  {
    for (int v = v0; v < v1; ++v)
    {
      std::int32_t* const row = &this->Shared.image.winners[this->place(0, v)];
      std::ptrdiff_t left = std::count(row, row + this->Shared.image.width, AtFloor);
      for (int n = 0; n < slices.end - slices.begin && left > 0; ++n)
      {
        const int k = this->reversed() ? slices.end - 1 - n : slices.begin + n;
        const SliceGeometry& slice = this->Shared.sliceGeometry[k];
        if (v >= slice.vBegin && v < slice.vEnd)
        {
          left -= this->findFirstIn(k, v, slice.span(v), row, scratch);
        }
      }
    }
  }

  /// Those that lie in slice k, and how many they are.
  int findFirstIn(int k, int v, const Span& pixels, std::int32_t* row, BandScratch& scratch) const
  {
    const bool isCut = !this->Shared.cuts.none();
    if (isCut && !this->Shared.cuts.findMask(k, v, pixels, scratch.mask.data()))
    {
      return 0;
    }
    int count = 0;
    for (int u = pixels.begin; u < pixels.end; ++u)
    {
      if (row[u] == AtFloor && (!isCut || scratch.mask[u - pixels.begin]))
      {
        const int sample = this->Stack.firstSample(u, v, k);
        row[u] = sample < 0 ? AtFloor : StepsPerSlice * k + sample;
        count += sample >= 0;
      }
    }
    return count;
  }

  Frame& Shared;
  const SliceSampler<T, P>& Stack;
  P* Limits; // of all pixels
  const BrickMaxima* Bricks = nullptr;
};
}

template <class T, class P>
void findWinners(Frame& frame, const SliceSampler<T, P>& sampler)
{
  const WinnerWalk<T, P> walk(frame, sampler);
  forSlices(frame, sampler.traits().beyond, walk.reversed(), { 0.5, 1.0 },
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(frame.image.height, bandHeight(frame.image.height), frame.watch,
        [&](int v0, int v1)
        {
          if (isFirst)
          {
            walk.open(v0, v1);
          }
          walk.walk(slices, v0, v1, frame.space.bands.Local());
          if (isLast)
          {
            walk.close(v0, v1);
            sampler.finish(v0, v1);
            closeRows<P>(frame.image, v0, v1);
          }
        });
    });
}

#define VOXELS(T) template void findWinners(Frame&, const SliceSampler<T, T>&);
#define WORKSHEETS(T) template void findWinners(Frame&, const SliceSampler<T, Accumulator<T>>&);
SPLATTING_TYPES(VOXELS)
SPLATTING_INTEGERS(WORKSHEETS) // others are of their voxels' type
}
