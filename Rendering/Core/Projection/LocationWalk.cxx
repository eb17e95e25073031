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
/// The largest smaller value, if there is one.
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
 * Finds the sample that each pixel of a band of rows shows: of equal samples the nearest to the
 * viewer. For pixels at the floor, below which no sample is, this is the first sample of the ray.
 * With NaN voxels the floor is below all samples, and such pixels have no sample.
 *
 * Nothing is noted during the projection. Slices are splatted again, from the viewer on, into
 * copies of limits just below the pixels. A slice that raises a pixel above its limit has its
 * winner, and the pixel's limit becomes the largest number. With bricks only tiles are visited
 * whose bound in a layer is above the least limit of their pixels.
 */
template <class T, class P>
class LocationWalk
{
public:
  LocationWalk(const ProjectionContext& context, const SliceSampler<T, P>& sampler,
    BandScratch& scratch, int v0, int v1)
    : Context(context),
      Sampler(sampler),
      Scratch(scratch),
      Limits{ reinterpret_cast<P*>(context.space.limits.data()), context.image.width },
      Band{ v0, v1, context.image.width, context.bricks ? TileHeight : DenseHeight },
      Tiles(this->Band.tiles()),
      Reversed(context.geometry.reversed())
  {
  }

  /// Marks all pixels as without winner, except those without samples.
  void open()
  {
    const ShearImage& image = this->Context.image;
    const P floor = this->Sampler.floor();
    const std::int32_t atFloor = this->Context.range.nonFinite ? -1 : AtFloor;
    for (int v = this->Band.v0; v < this->Band.v1; ++v)
    {
      const P* const row = image.row<P>(v);
      for (int u = 0; u < image.width; ++u)
      {
        const bool covers = image.covers(u, v), isFloor = covers && !(row[u] > floor);
        *this->winner(u, v) = isFloor ? atFloor : -1;
        *this->Limits.at(u, v) = covers && !isFloor ? justBelow(row[u]) : Nothing;
      }
    }
  }

  void walk(const Span& slices)
  {
    const Span layers = layersOf(this->Context, slices, this->Band.v0, this->Band.v1);
    TileBounds<T, P> bounds(this->Context, this->Sampler, this->Band, layers, this->Scratch);
    if (this->Context.bricks)
    {
      bounds.find(*this->Context.bricks);
    }
    if (!this->Context.cuts.none())
    {
      this->Scratch.shares.reset(this->Context.cuts, this->Context.kernels, this->Band.v0,
        this->Band.v1, this->Band.width, this->Band.height);
    }
    this->Scratch.minima.resize(this->Band.count() * sizeof(P));
    this->Scratch.found.resize(this->Band.width);
    openFlags(this->Tiles, this->Scratch.flags);
    for (int g = 0; g < this->Band.groups(); ++g)
    {
      this->findMinima(g);
    }
    for (int n = 0; n < layers.end - layers.begin; ++n)
    {
      const int z = this->Reversed ? layers.end - 1 - n : layers.begin + n;
      for (int g = 0; g < this->Band.groups(); ++g)
      {
        this->walkGroup(z, g, this->Context.bricks ? bounds.bounds(z, g) : nullptr);
      }
    }
    for (int v = this->Band.v0; v < this->Band.v1; ++v)
    {
      this->findFirst(slices, v);
    }
  }

  /// Rays that cross the volume only by rounding may have no sample.
  void close()
  {
    std::replace(
      this->winner(0, this->Band.v0), this->winner(0, this->Band.v1), AtFloor, std::int32_t(-1));
  }

private:
  /// No sample is above it.
  static constexpr P Nothing = std::numeric_limits<P>::max();
  /// Marks pixels whose first sample is not found yet.
  static constexpr std::int32_t AtFloor = -2;

  std::int32_t* winner(int u, int v) const
  {
    return this->Context.image.winners.data() + std::ptrdiff_t(v) * this->Band.width + u;
  }
  Span slicesIn(int z) const { return slicesOfLayer(z, this->Context.geometry.size()); }
  P* minimaOf(int group)
  {
    return reinterpret_cast<P*>(this->Scratch.minima.data()) + std::ptrdiff_t(group) * this->Tiles;
  }
  void findMinima(int group)
  {
    this->Band.template findMinima<P>(this->Context.kernels,
      this->Limits.at(0, this->Band.firstRow(group)), group, this->minimaOf(group));
  }

  /// The tiles of a group whose pixels may have samples in a layer.
  void walkGroup(int z, int group, const P* bounds)
  {
    const TileLoops<P>& loops = this->Context.kernels;
    std::vector<unsigned char>& flags = this->Scratch.flags;
    const P* const minima = this->minimaOf(group);
    if (bounds)
    {
      loops.exceeds(bounds, minima, flags.data(), this->Tiles);
    }
    else
    {
      std::transform(minima, minima + this->Tiles, flags.data(),
        [](P least) { return static_cast<unsigned char>(least < Nothing); });
    }
    const unsigned char* const shares =
      this->Context.cuts.none() ? nullptr : this->Scratch.shares.find(this->slicesIn(z), group);
    for (int t = 0; shares && t < this->Tiles; ++t)
    {
      flags[t] = static_cast<unsigned char>(flags[t] & (shares[t] != NoSamples));
    }
    findTileRuns(flags.data(), this->Tiles, this->Sampler.traits().runUnit, this->Band.width,
      this->Scratch.runs);
    const Span rows{ this->Band.firstRow(group), this->Band.endRow(group) };
    if (!this->Scratch.runs.empty() &&
      this->findIn(this->slicesIn(z), rows, shares && this->areCut(shares)))
    {
      this->findMinima(group);
    }
  }

  /// Whether the runs have invisible samples: runs may be wider than the tiles with flags.
  bool areCut(const unsigned char* shares) const
  {
    return std::any_of(this->Scratch.runs.begin(), this->Scratch.runs.end(),
      [shares](const Span& run)
      {
        return std::any_of(shares + run.begin / TileWidth,
          shares + (run.end + TileWidth - 1) / TileWidth,
          [](unsigned char share) { return share != AllSamples; });
      });
  }

  /// Finds winners in some slices, for the runs. Returns whether there are any.
  bool findIn(const Span& slices, const Span& rows, bool isCut)
  {
    // Voxels of a slice are distinguished afterwards.
    const int count = slices.end - slices.begin;
    const int apart = this->Sampler.traits().beyond > 0 || isCut ? count : 1;
    const PixelRows<P> copies =
      this->Scratch.copies.copy(this->Limits, rows.begin, rows.end, this->Scratch.runs, apart);
    this->Sampler.splat(
      slices, rows.begin, rows.end, this->Scratch.runs, copies, this->Scratch.loaded);
    bool any = false;
    for (int n = 0; n < apart; ++n)
    {
      const int k = this->Reversed ? apart - 1 - n : n;
      const Span some = apart > 1 ? Span{ slices.begin + k, slices.begin + k + 1 } : slices;
      for (int v = rows.begin; v < rows.end; ++v)
      {
        for (const Span& run : this->Scratch.runs)
        {
          any |= this->findInRow(some, v, run, copies.slice(k).at(run.begin, v), isCut);
        }
      }
    }
    return any;
  }

  /// Finds the pixels of a row that some slices have raised.
  bool findInRow(const Span& slices, int v, const Span& run, const P* lifted, bool isCut)
  {
    const TileLoops<P>& loops = this->Context.kernels;
    const std::ptrdiff_t count = loops.exceed(
      lifted, this->Limits.at(run.begin, v), this->Scratch.found.data(), run.end - run.begin);
    bool any = false;
    for (std::ptrdiff_t n = 0; n < count; ++n)
    {
      const int u = run.begin + this->Scratch.found[n];
      P& limit = *this->Limits.at(u, v);
      if (!isCut || this->counts(u, v, slices.begin))
      {
        *this->winner(u, v) = this->Sampler.firstAbove(u, v, slices, limit);
        limit = Nothing;
        any = true;
      }
    }
    return any;
  }

  /// The pixels of a row whose rays cross slice k.
  Span pixels(int v, int k) const
  {
    const SliceGeometry& slice = this->Context.sliceGeometry[k];
    return v >= slice.vBegin && v < slice.vEnd ? slice.span(v) : Span{};
  }
  bool crosses(int u, int v, int k) const
  {
    const Span pixels = this->pixels(v, k);
    return u >= pixels.begin && u < pixels.end;
  }
  bool counts(int u, int v, int k) const
  {
    unsigned char mask;
    return this->Context.cuts.findMask(k, v, { u, u + 1 }, &mask) && mask;
  }

  /// Finds the first samples of rays whose pixels are at the floor: nearly always where they enter
  /// the volume.
  void findFirst(const Span& slices, int v)
  {
    Span before;
    for (int n = 0; n < slices.end - slices.begin; ++n)
    {
      const int k = this->Reversed ? slices.end - 1 - n : slices.begin + n;
      const Span pixels = this->pixels(v, k);
      const Span lower{ pixels.begin,
        before.empty() ? pixels.end : std::min(pixels.end, before.begin) };
      const Span upper{ before.empty() ? pixels.end : std::max(pixels.begin, before.end),
        pixels.end };
      for (const Span& entering : { lower, upper })
      {
        for (int u = entering.begin; u < entering.end; ++u)
        {
          std::int32_t& winner = *this->winner(u, v);
          winner = winner == AtFloor ? this->firstStep(u, v, k, slices) : winner;
        }
      }
      before = pixels;
    }
  }

  /// The first step of a ray that enters the volume in slice k.
  int firstStep(int u, int v, int k, const Span& slices) const
  {
    const RayIntervals& intervals = this->Context.cuts.source().intervals;
    if (!intervals.empty())
    {
      k = this->Reversed ? std::min<int>(k, intervals.last(v)[u])
                         : std::max<int>(k, intervals.first(v)[u]);
    }
    for (; k >= slices.begin && k < slices.end; k += this->Reversed ? -1 : 1)
    {
      const int sample =
        this->crosses(u, v, k) && this->counts(u, v, k) ? this->Sampler.firstSample(u, v, k) : -1;
      if (sample >= 0)
      {
        return StepsPerSlice * k + sample;
      }
    }
    return AtFloor;
  }

  const ProjectionContext& Context;
  const SliceSampler<T, P>& Sampler;
  BandScratch& Scratch;
  const PixelRows<P> Limits; // of all pixels
  const BandTiles Band;
  const int Tiles;
  const bool Reversed;
};
}

template <class T, class P>
void findWinners(ProjectionContext& context, const SliceSampler<T, P>& sampler)
{
  context.space.limits.resize(context.image.winners.size() * sizeof(P));
  forSlices(context, sampler.traits().beyond, context.geometry.reversed(), { 0.5, 1.0 },
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(context.image.height, bandHeight(context.image.height), context.observer,
        [&](int v0, int v1)
        {
          LocationWalk<T, P> band(context, sampler, context.space.bands.Local(), v0, v1);
          if (isFirst)
          {
            band.open();
          }
          band.walk(slices);
          if (isLast)
          {
            band.close();
            if (context.range.nonFinite)
            {
              dropEmpty<P>(context.image, v0, v1);
            }
            sampler.finish(v0, v1);
            closeRows<P>(context.image, v0, v1);
          }
        });
    });
}

#define VOXELS(T) template void findWinners(ProjectionContext&, const SliceSampler<T, T>&);
#define WORKSHEETS(T)                                                                              \
  template void findWinners(ProjectionContext&, const SliceSampler<T, Accumulator<T>>&);
SPLATTING_TYPES(VOXELS)
SPLATTING_INTEGERS(WORKSHEETS) // other modes have the type of the voxels
}
