// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Walks/TileBounds.h"
#include "Splat/Walks/TileRuns.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

namespace splatting
{
namespace
{
/**
 * Walks a band of image rows through the layers of slices.
 *
 * Densely: all of them, in memory order. With bricks: layers with high bounds first. A tile is
 * skipped if its bound is not above its smallest pixel, because it cannot change a pixel. The other
 * tiles are walked row by row, several at a time, because memory is fastest in order.
 *
 * Where rays are cut, tiles of a layer with all samples visible are splatted as they are. In other
 * tiles each worksheet is computed separately, and taken where its slice is visible.
 */
template <class T, class P>
class BandWalk
{
public:
  /// @param some  the slices to walk; whole layers
  BandWalk(const ProjectionContext& context, const SliceSampler<T, P>& sampler,
    BandScratch& scratch, const Span& some, int v0, int v1)
    : Context(context),
      Sampler(sampler),
      Scratch(scratch),
      Band{ v0, v1, context.image.width },
      Tiles(Band.tiles()),
      Range(layersOf(context, some, v0, v1))
  {
    if (!context.cuts.none())
    {
      scratch.shares.reset(context.cuts, context.kernels, v0, v1, context.image.width,
        context.bricks ? TileHeight : DenseHeight);
    }
  }

  void walkDensely()
  {
    if (!this->Context.cuts.none())
    {
      this->walkCut();
      return;
    }
    std::vector<Span>& runs = this->Scratch.runs;
    runs.assign(1, { 0, this->Context.image.width });
    this->Sampler.splatAll(this->Range, this->Band.v0, this->Band.v1, runs, this->Scratch.loaded);
  }

  void walkBricks(const BrickMaxima& bricks)
  {
    TileBounds<T, P> bounds(this->Context, this->Sampler, this->Band, this->Range, this->Scratch);
    bounds.find(bricks);
    this->orderLayers(bounds);
    this->Scratch.minima.resize(std::size_t(this->Band.count()) * sizeof(P));
    std::fill_n(this->minimaOf(0), this->Band.count(), this->Sampler.floor());
    int walked = 0;
    for (int z : this->Scratch.order)
    {
      for (int g = 0; g < this->Band.groups(); ++g)
      {
        this->walkGroup(z, g, bounds.bounds(z, g));
      }
      // The first layers raise the minima most.
      ++walked;
      if ((walked & (walked - 1)) == 0 || walked % 16 == 0)
      {
        this->findMinima();
      }
    }
    this->Scratch.count.met += bounds.met();
  }

private:
  P* minimaOf(int group)
  {
    return reinterpret_cast<P*>(this->Scratch.minima.data()) + std::ptrdiff_t(group) * this->Tiles;
  }
  Span slicesIn(int z) const { return slicesOfLayer(z, this->Context.geometry.size()); }

  /// Sorts layers by the mean bound of some tiles, in descending order.
  void orderLayers(TileBounds<T, P>& bounds)
  {
    constexpr int step = 13;
    std::vector<int>& order = this->Scratch.order;
    std::vector<double>& scores = this->Scratch.scores;
    order.resize(this->Range.end - this->Range.begin);
    std::iota(order.begin(), order.end(), this->Range.begin);
    scores.resize(order.size());
    const P low = static_cast<P>(this->Context.range.low);
    for (int z : order)
    {
      const P* const b = bounds.bounds(z, 0);
      double sum = 0.0;
      for (int t = 0; t < this->Band.count(); t += step)
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
    for (int g = 0; g < this->Band.groups(); ++g)
    {
      this->Band.template findMinima<P>(this->Context.kernels,
        this->Context.image.template row<P>(this->Band.firstRow(g)), g, this->minimaOf(g));
    }
  }

  /// Splats the tiles of a group that a layer can change.
  void walkGroup(int z, int group, const P* bounds)
  {
    const TileLoops<P>& loops = this->Context.kernels;
    std::vector<unsigned char>& flags = this->Scratch.flags;
    openFlags(this->Tiles, flags);
    loops.exceeds(bounds, this->minimaOf(group), flags.data(), this->Tiles);
    if (!this->Context.cuts.none())
    {
      this->splatVisible(z, group, this->Band);
      return;
    }
    this->Scratch.count.splatted += findTileRuns(flags.data(), this->Tiles,
      this->Sampler.traits().runUnit, this->Context.image.width, this->Scratch.runs);
    if (!this->Scratch.runs.empty())
    {
      this->Sampler.splat(this->slicesIn(z), this->Band.firstRow(group), this->Band.endRow(group),
        this->Scratch.runs, pixelsOf<P>(this->Context.image), this->Scratch.loaded);
    }
  }

  /// Walks all layers, where rays are cut.
  void walkCut()
  {
    BandTiles band = this->Band;
    band.height = DenseHeight;
    for (int g = 0; g < band.groups(); ++g)
    {
      for (int z = this->Range.begin; z < this->Range.end; ++z)
      {
        this->Scratch.flags.assign(this->Tiles, 1);
        this->splatVisible(z, g, band);
      }
    }
  }

  /// Splats the visible samples of the tiles of a group that have flags.
  void splatVisible(int z, int group, const BandTiles& band)
  {
    unsigned char* const kinds = this->Scratch.flags.data();
    if (!std::memchr(kinds, 1, this->Tiles))
    {
      return;
    }
    const unsigned char* const shares = this->Scratch.shares.find(this->slicesIn(z), group);
    std::transform(kinds, kinds + this->Tiles, shares, kinds,
      [](unsigned char flag, unsigned char share)
      { return static_cast<unsigned char>(flag * share); });
    this->Scratch.count.splatted += this->Tiles - std::count(kinds, kinds + this->Tiles, NoSamples);
    const Span rows{ band.firstRow(group), band.endRow(group) };
    forRunsOf(AllSamples, kinds, this->Tiles, band.width,
      [&](const Span& run) { this->splatAllVisible(z, rows, run); });
    forRunsOf(SomeSamples, kinds, this->Tiles, band.width,
      [&](const Span& run) { this->splatSomeVisible(z, rows, run); });
  }

  /// Splats pixels for which all samples of a layer are visible, and no others.
  void splatAllVisible(int z, const Span& rows, const Span& run)
  {
    const PixelRows<P> image = pixelsOf<P>(this->Context.image);
    const PixelRows<P> copies =
      this->splatSeparately(this->slicesIn(z), rows, this->inRegisters(run), 1);
    for (int v = rows.begin; v < rows.end; ++v)
    {
      std::copy(copies.at(run.begin, v), copies.at(run.end, v), image.at(run.begin, v));
    }
  }

  /// Splats pixels for which some samples of a layer are visible.
  void splatSomeVisible(int z, const Span& rows, const Span& run)
  {
    // Only worksheets of neighbouring slices share their voxels.
    const Span slices = this->slicesIn(z);
    const int step = this->Sampler.traits().beyond > 0 ? slices.end - slices.begin : 1;
    for (int k = slices.begin; k < slices.end; k += step)
    {
      this->splatMasked({ k, k + step }, rows, this->inRegisters(run));
    }
  }

  /// Whole registers around a run.
  Span inRegisters(const Span& run) const
  {
    constexpr int pixels = 64 / sizeof(P);
    const int width = this->Context.image.width, unit = this->Sampler.traits().runUnit;
    const int begin = run.begin / unit * unit, step = std::max(unit, pixels);
    return { begin, std::min(begin + (run.end - begin + step - 1) / step * step, width) };
  }

  /// As splatSomeVisible(), for some slices.
  void splatMasked(const Span& some, const Span& all, const Span& run)
  {
    const int width = run.end - run.begin;
    const auto place = [&](int k, int v)
    { return std::size_t(k - some.begin) * (all.end - all.begin) + v - all.begin; };
    this->Scratch.mask.resize(place(some.end, all.begin) * width);
    this->Scratch.counting.resize(place(some.end, all.begin));
    Span slices{ some.end, some.begin }, rows{ all.end, all.begin };
    for (int k = some.begin; k < some.end; ++k)
    {
      for (int v = all.begin; v < all.end; ++v)
      {
        const bool any =
          this->Context.cuts.findMask(k, v, run, &this->Scratch.mask[place(k, v) * width]);
        this->Scratch.counting[place(k, v)] = any;
        if (any)
        {
          slices = { std::min(slices.begin, k), k + 1 };
          rows = { std::min(rows.begin, v), std::max(rows.end, v + 1) };
        }
      }
    }
    if (slices.empty())
    {
      return;
    }
    const RayLoops<P>& loops = this->Context.kernels;
    const PixelRows<P> image = pixelsOf<P>(this->Context.image);
    const PixelRows<P> copies = this->splatSeparately(slices, rows, run, slices.end - slices.begin);
    for (int k = slices.begin; k < slices.end; ++k)
    {
      for (int v = rows.begin; v < rows.end; ++v)
      {
        if (this->Scratch.counting[place(k, v)])
        {
          loops.raise(image.at(run.begin, v), copies.slice(k - slices.begin).at(run.begin, v),
            &this->Scratch.mask[place(k, v) * width], width);
        }
      }
    }
  }

  /// Splats some slices into one copy of pixels each, or all into one copy.
  PixelRows<P> splatSeparately(const Span& slices, const Span& rows, const Span& run, int copies)
  {
    this->Scratch.runs.assign(1, run);
    const PixelRows<P> apart = this->Scratch.copies.copy(
      pixelsOf<P>(this->Context.image), rows.begin, rows.end, this->Scratch.runs, copies);
    this->Sampler.splat(
      slices, rows.begin, rows.end, this->Scratch.runs, apart, this->Scratch.loaded);
    return apart;
  }

  const ProjectionContext& Context;
  const SliceSampler<T, P>& Sampler;
  BandScratch& Scratch;
  const BandTiles Band;
  const int Tiles;
  const Span Range; // of layers
};
}

template <class T, class P>
void walkBands(ProjectionContext& context, const SliceSampler<T, P>& sampler)
{
  forSlices(context, sampler.traits().beyond, false,
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(context.image.height, bandHeight(context.image.height), context.observer,
        [&](int v0, int v1)
        {
          if (isFirst)
          {
            openRows<P>(context.image, sampler.floor(), v0, v1);
          }
          BandWalk<T, P> band(context, sampler, context.space.bands.Local(), slices, v0, v1);
          context.bricks ? band.walkBricks(*context.bricks) : band.walkDensely();
          if (isLast)
          {
            if (context.range.nonFinite)
            {
              dropEmpty<P>(context.image, v0, v1);
            }
            sampler.finish(v0, v1);
            closeRows<P>(context.image, v0, v1);
          }
        });
    });
  context.space.bands.forAll(
    [&](BandScratch& band)
    {
      context.count.met += band.count.met;
      context.count.splatted += band.count.splatted;
      band.count = {};
    });
}

#define VOXELS(T) template void walkBands(ProjectionContext&, const SliceSampler<T, T>&);
#define WORKSHEETS(T)                                                                              \
  template void walkBands(ProjectionContext&, const SliceSampler<T, Accumulator<T>>&);
SPLATTING_TYPES(VOXELS)
SPLATTING_INTEGERS(WORKSHEETS) // other modes have the type of the voxels
}
