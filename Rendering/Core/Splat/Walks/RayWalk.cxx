// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Walks/SliceSampler.h"
#include "Splat/Walks/WalkSpace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace splatting
{
namespace
{
/**
 * Projections that evaluate every sample of a ray, densely and, if it matters, in the order of the
 * ray.
 */
template <class T, class P>
class RayWalk
{
public:
  using A = Accumulator<T>;

  RayWalk(const ProjectionContext& context, const SliceSampler<T, P>& sampler)
    : Context(context),
      Sampler(sampler),
      Settings(context.settings),
      State(context.space.rays),
      Base(sampler.base())
  {
  }

  void open(int v0, int v1) const
  {
    ShearImage& image = this->Context.image;
    const std::size_t begin = std::size_t(v0) * image.width, end = std::size_t(v1) * image.width;
    if (this->Settings.recordLocations)
    {
      std::fill(image.winners.begin() + begin, image.winners.begin() + end, -1);
    }
    switch (this->Settings.reduction)
    {
      case Reduction::Mean:
        std::fill(this->State.sums.begin() + begin, this->State.sums.begin() + end, 0.0);
        std::fill(this->State.counts.begin() + begin, this->State.counts.begin() + end, 0);
        break;
      case Reduction::Minimum:
        this->fill(v0, v1, greatestValue<P>());
        break;
      case Reduction::DepthShaded:
        this->fill(v0, v1, leastValue<A>());
        break;
      case Reduction::Maximum:
        this->fill(v0, v1, this->Sampler.floor());
        break;
      default:
        std::fill(this->State.ended.begin() + begin, this->State.ended.begin() + end,
          static_cast<unsigned char>(0));
        this->fill(v0, v1, leastValue<P>());
    }
  }

  /// Whether slices are walked from the last one, only if their order along the ray matters. Sums
  /// must not depend on the side of the viewer.
  bool isReversed() const
  {
    return (this->Settings.reduction == Reduction::Local || this->Settings.recordLocations) &&
      this->Context.geometry.reversed();
  }

  void walk(const Span& slices, int v0, int v1, RayScratch& scratch) const
  {
    const Span some = common(slices, slicesOf(this->Context.sliceGeometry, v0, v1));
    scratch.mask.resize(this->Context.image.width);
    scratch.widened.resize(this->Context.image.width * sizeof(A));
    this->Sampler.forSamples(some, this->isReversed(), v0, v1, { 0, this->Context.image.width },
      scratch.loaded,
      [&](int step, int v, const Span& pixels, const P* samples, const unsigned char* present)
      {
        const bool isCut = !this->Context.cuts.none();
        const int k = step / StepsPerSlice;
        if (!isCut || this->Context.cuts.findMask(k, v, pixels, scratch.mask.data()))
        {
          if (isCut)
          {
            narrow(scratch.mask.data(), present, pixels);
          }
          const Row row{ step, v, pixels, isCut ? scratch.mask.data() : present };
          this->Settings.recordLocations ? this->takeAndNote(row, samples, scratch)
                                         : this->take(row, samples, scratch);
        }
      });
  }

  void close(int v0, int v1) const
  {
    if (this->Settings.reduction == Reduction::Mean)
    {
      this->divide(v0, v1);
    }
    else if (this->Settings.reduction == Reduction::DepthShaded)
    {
      this->addBase(v0, v1);
    }
    else
    {
      this->Sampler.finish(v0, v1);
    }
  }

private:
  template <class Q>
  void fill(int v0, int v1, Q none) const
  {
    ShearImage& image = this->Context.image;
    const Q empty = image.nonFinite ? std::numeric_limits<Q>::quiet_NaN() : none;
    std::fill(image.row<Q>(v0), image.row<Q>(v1 - 1) + image.width, empty);
  }

  /// Samples of one step in one row.
  struct Row
  {
    int step, v;
    Span pixels;
    const unsigned char* mask;

    int k() const { return this->step / StepsPerSlice; }
    std::ptrdiff_t size() const { return this->pixels.end - this->pixels.begin; }
  };

  /// Takes samples, and notes the winners.
  void takeAndNote(const Row& row, const P* samples, RayScratch& scratch) const
  {
    computesWith(this->Settings.reduction) ? this->noteBeside<A>(row, samples, scratch)
                                           : this->noteBeside<P>(row, samples, scratch);
  }
  template <class Q>
  void noteBeside(const Row& row, const P* samples, RayScratch& scratch) const
  {
    const RayLoops<Q>& loops = this->Context.kernels;
    ShearImage& image = this->Context.image;
    Q* const pixels = image.row<Q>(row.v) + row.pixels.begin;
    scratch.before.resize(image.width * sizeof(Q));
    Q* const before = reinterpret_cast<Q*>(scratch.before.data());
    std::copy(pixels, pixels + row.size(), before);
    this->take(row, samples, scratch);
    const Q* compared = nullptr;
    if constexpr (std::is_same_v<P, Q>)
    {
      compared = samples;
    }
    else
    {
      compared = this->widened(samples, row.size(), scratch);
    }
    loops.note(&image.winners[std::size_t(row.v) * image.width + row.pixels.begin], row.step,
      before, pixels, compared, row.mask, row.size());
  }

  void take(const Row& row, const P* samples, RayScratch& scratch) const
  {
    const int v = row.v;
    const Span& pixels = row.pixels;
    const unsigned char* const mask = row.mask;
    const RayLoops<P>& loops = this->Context.kernels;
    const WorksheetLoops<A>& computing = this->Context.kernels;
    ShearImage& image = this->Context.image;
    const std::ptrdiff_t n = pixels.end - pixels.begin;
    const std::size_t at = std::size_t(v) * image.width + pixels.begin;
    const ProjectionSettings& s = this->Settings;
    switch (s.reduction)
    {
      case Reduction::Mean:
        computing.add(&this->State.sums[at], &this->State.counts[at], this->lowest(s.meanLow),
          this->highest(s.meanHigh), this->widened(samples, n, scratch), mask, n);
        break;
      case Reduction::DepthShaded:
        computing.shade(image.row<A>(v) + pixels.begin, this->shadeOf(row.k(), v, pixels),
          this->widened(samples, n, scratch), mask, n);
        break;
      case Reduction::Maximum:
        loops.raise(image.row<P>(v) + pixels.begin, samples, mask, n);
        break;
      case Reduction::Minimum:
        loops.lower(image.row<P>(v) + pixels.begin, samples, mask, n);
        break;
      default:
        loops.climb(image.row<P>(v) + pixels.begin, &this->State.ended[at], this->threshold(),
          samples, mask, n);
    }
  }

  const A* widened(const P* samples, std::ptrdiff_t n, RayScratch& scratch) const
  {
    if constexpr (std::is_same_v<P, A>)
    {
      (void)n;
      (void)scratch;
      return samples;
    }
    else
    {
      A* const out = reinterpret_cast<A*>(scratch.widened.data());
      const VoxelLoops<P>& loops = this->Context.kernels;
      loops.widen(samples, 0, out, 0, A(0), n, 1, 0);
      return out;
    }
  }

  /// The least value not below a bound, relative to the base.
  A lowest(double bound) const
  {
    const double wanted = bound - this->Base;
    const A found = static_cast<A>(wanted);
    return found < wanted ? std::nextafter(found, std::numeric_limits<A>::infinity()) : found;
  }
  /// The greatest value not above a bound.
  A highest(double bound) const
  {
    const double wanted = bound - this->Base;
    const A found = static_cast<A>(wanted);
    return found > wanted ? std::nextafter(found, -std::numeric_limits<A>::infinity()) : found;
  }

  P threshold() const
  {
    if constexpr (std::numeric_limits<P>::is_integer)
    {
      // The least integer not below it.
      const double least = std::ceil(this->Settings.threshold);
      using Limits = std::numeric_limits<P>;
      return least <= static_cast<double>(Limits::lowest()) ? Limits::lowest()
        : least >= static_cast<double>(Limits::max())       ? Limits::max()
                                                            : static_cast<P>(least);
    }
    else
    {
      return this->lowest(this->Settings.threshold);
    }
  }

  Shade<A> shadeOf(int k, int v, const Span& pixels) const
  {
    const double low = this->Context.range.low;
    return { std::isfinite(low) ? static_cast<A>(low) - this->Base : A(0),
      static_cast<A>(this->Settings.ambient), static_cast<A>(this->Settings.changeRate),
      this->Context.image.nonFinite ? std::numeric_limits<A>::quiet_NaN() : leastValue<A>(), k,
      this->Context.geometry.reversed(), this->State.crossed.first(v) + pixels.begin,
      this->State.crossed.last(v) + pixels.begin };
  }

  void divide(int v0, int v1) const
  {
    ShearImage& image = this->Context.image;
    const double base = this->Base;
    for (int v = v0; v < v1; ++v)
    {
      const std::size_t at = std::size_t(v) * image.width;
      A* const row = image.row<A>(v);
      for (int u = 0; u < image.width; ++u)
      {
        const std::int32_t count = this->State.counts[at + u];
        row[u] = count > 0 ? static_cast<A>(this->State.sums[at + u] / count + base)
                           : std::numeric_limits<A>::quiet_NaN();
      }
    }
  }

  /// Adds the base. Pixels without a sample show the lowest voxel, like those of a global maximum.
  void addBase(int v0, int v1) const
  {
    const WorksheetLoops<A>& loops = this->Context.kernels;
    ShearImage& image = this->Context.image;
    A* const begin = image.row<A>(v0);
    const std::ptrdiff_t count = std::ptrdiff_t(v1 - v0) * image.width;
    loops.finish(begin, this->Base, leastValue<A>(), greatestValue<A>(), count);
    // Pixels of a piece may get samples of other pieces.
    if (&this->Context.geometry == &this->Context.whole && !image.nonFinite)
    {
      std::replace(begin, begin + count, leastValue<A>(), static_cast<A>(this->Context.range.low));
    }
  }

  const ProjectionContext& Context;
  const SliceSampler<T, P>& Sampler;
  const ProjectionSettings& Settings;
  RayState& State;
  A Base;
};

/// Allocates the state of a reduction for each pixel.
void openState(const ShearImage& image, Reduction reduction, RayState& state)
{
  const std::size_t pixels = std::size_t(image.width) * image.height;
  if (reduction == Reduction::Mean)
  {
    state.sums.resize(pixels);
    state.counts.resize(pixels);
  }
  if (reduction == Reduction::Local)
  {
    state.ended.resize(pixels);
  }
}
}

template <class T, class P>
void walkRays(ProjectionContext& context, const SliceSampler<T, P>& sampler)
{
  const Reduction reduction = context.settings.reduction;
  openState(context.image, reduction, context.space.rays);
  const RayWalk<T, P> walk(context, sampler);
  forSlices(context, sampler.traits().beyond, walk.isReversed(),
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(context.image.height, bandHeight(context.image.height), context.observer,
        [&](int v0, int v1)
        {
          if (isFirst)
          {
            walk.open(v0, v1);
          }
          walk.walk(slices, v0, v1, context.space.rayBands.Local());
          if (isLast)
          {
            walk.close(v0, v1);
            computesWith(reduction) ? closeRows<Accumulator<T>>(context.image, v0, v1)
                                    : closeRows<P>(context.image, v0, v1);
          }
        });
    });
}

#define VOXELS(T) template void walkRays(ProjectionContext&, const SliceSampler<T, T>&);
#define WORKSHEETS(T)                                                                              \
  template void walkRays(ProjectionContext&, const SliceSampler<T, Accumulator<T>>&);
SPLATTING_TYPES(VOXELS)
SPLATTING_INTEGERS(WORKSHEETS) // other modes have the type of the voxels
}
