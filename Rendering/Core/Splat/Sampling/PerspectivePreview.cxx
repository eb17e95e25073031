// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/ValuesAtLocations.h"
#include "Splat/Walks/SliceSampler.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace splatting
{
namespace
{
/**
 * Preview mode in perspective views: the voxels that rays cross, for each ray separately.
 */
template <class T>
class PerspectivePreview : public SliceSampler<T, T>
{
  static constexpr int RunUnit = 64 / sizeof(T);
  static_assert(RunUnit % TileWidth == 0);

public:
  using typename SliceSampler<T, T>::Samples;

  /// @param windows  of the columns
  /// @param none     work space
  PerspectivePreview(
    const ProjectionContext& context, const AxisPicks& picks, std::vector<unsigned char>& none)
    : SliceSampler<T, T>({ true, 0, RunUnit }),
      Context(context),
      Picks(picks)
  {
    // A row without voxels, as long as a register at least.
    const std::size_t count = std::max<std::size_t>(context.geometry.size().x, 64);
    none.resize(count * sizeof(T));
    this->None = reinterpret_cast<T*>(none.data());
    std::fill_n(reinterpret_cast<T*>(none.data()), count, leastValue<T>());
  }

  Span columnsOf(int z, const Span& pixels) const override
  {
    return this->Context.steps.columns.voxels(this->slices(z), pixels);
  }
  Span rowsOf(int z, const Span& pixels) const override
  {
    return this->Context.steps.rows.voxels(this->slices(z), pixels);
  }

  void splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const PixelRows<T>& pixels, LoadedVoxels& loaded) const override
  {
    const Span some = common(slices, this->Context.geometry.slices());
    const VoxelLoops<T>& loops = this->Context.kernels;
    // Two slices at a time, so that the image is read and written once.
    const int step = pixels.sliceStride != 0 ? 1 : 2;
    for (int k = some.begin; k < some.end; k += step)
    {
      const int last = std::min(k + step, some.end) - 1;
      const Span rows = this->findRuns(k, last, { v0, v1 }, runs, loaded.runs);
      if (!rows.empty() && !loaded.runs.empty())
      {
        loops.cross(this->crossingOf(k, last, rows, loaded.runs, pixels.slice(k - slices.begin)));
      }
    }
  }

  void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all,
    LoadedVoxels& loaded) const override
  {
    for (int z = layers.begin; z < layers.end; ++z)
    {
      this->splat(slicesOfLayer(z, this->Context.geometry.size()), v0, v1, all,
        pixelsOf<T>(this->Context.image), loaded);
    }
  }

  void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    LoadedVoxels& loaded, const Samples& f) const override
  {
    const Span some = common(slices, this->Context.geometry.slices());
    for (int n = 0; n < some.end - some.begin; ++n)
    {
      const int k = reversed ? some.end - 1 - n : some.begin + n;
      const SliceGeometry& slice = this->Context.sliceGeometry[k];
      for (int v = std::max(v0, slice.vBegin); v < std::min(v1, slice.vEnd); ++v)
      {
        const Span pixels = common(columns, slice.span(v));
        for (int t = 0; t < StepsPerSlice && !pixels.empty(); ++t)
        {
          const int step = reversed ? StepsPerSlice - 1 - t : t;
          if (this->findStep(k, v, step, pixels, loaded))
          {
            f(StepsPerSlice * k + step, v, pixels,
              reinterpret_cast<const T*>(loaded.worksheet.data()), loaded.present.data());
          }
        }
      }
    }
  }

  T floor() const override { return previewFloor<T>(this->Context); }
  void finish(int, int) const override {}

private:
  Span slices(int z) const
  {
    return common(slicesOfLayer(z, this->Context.geometry.size()), this->Context.geometry.slices());
  }

  /// Whole registers around pixels, within the image.
  Span unitsOf(const Span& pixels) const
  {
    return { pixels.begin / RunUnit * RunUnit,
      std::min((pixels.end + RunUnit - 1) / RunUnit * RunUnit, this->Context.image.width) };
  }

  /// The rows of two slices, and their runs of pixels, in whole registers.
  Span findRuns(int near, int far, const Span& rows, const std::vector<Span>& runs,
    std::vector<Span>& covered) const
  {
    const SliceGeometry& a = this->Context.sliceGeometry[near];
    const SliceGeometry& b = this->Context.sliceGeometry[far];
    const Span registers =
      this->unitsOf({ std::min(a.inner.begin, b.inner.begin), std::max(a.inner.end, b.inner.end) });
    covered.clear();
    for (const Span& run : runs)
    {
      const Span some = common(run, registers);
      if (!some.empty())
      {
        covered.push_back(some);
      }
    }
    return common(rows, { std::min(a.vBegin, b.vBegin), std::max(a.vEnd, b.vEnd) });
  }

  CrossedSlice<T> sliceOf(int k, int v0) const
  {
    const PerspectiveSteps& steps = this->Context.steps;
    const AxisSteps::Slice columns = steps.columns.slice(k), rows = steps.rows.slice(k);
    const AxisPicks::Picks entry = this->Picks.entering(k), exit = this->Picks.leaving(k);
    CrossedSlice<T> s;
    s.voxels = this->Context.template voxelRow<T>(0, k);
    s.firstRow = rows.first + v0;
    s.lastRow = rows.last + v0;
    s.rowTime = rows.time + v0;
    s.rowTick = rows.tick + v0;
    s.columnTime = columns.time;
    s.columnTick = columns.tick;
    s.entryBase = entry.base;
    s.entryLanes = entry.lanes;
    s.exitBase = exit.base;
    s.exitLanes = exit.lanes;
    return s;
  }

  /// Of a slice and the next one, or the same.
  Crossing<T> crossingOf(int k, int next, const Span& rows, const std::vector<Span>& runs,
    const PixelRows<T>& pixels) const
  {
    Crossing<T> c;
    c.imageStride = pixels.stride;
    c.image = pixels.at(0, rows.begin);
    c.height = rows.end - rows.begin;
    c.count = next - k + 1;
    c.slices[0] = this->sliceOf(k, rows.begin);
    c.slices[1] = this->sliceOf(next, rows.begin);
    c.rowStride = this->Context.slices.rowStride;
    c.ahead = 2 * (next - k) * this->Context.slices.sliceStride;
    c.columns = this->Context.geometry.size().x;
    c.rows = this->Context.geometry.size().y;
    c.none = this->None;
    c.runs = runs.data();
    c.runCount = static_cast<int>(runs.size());
    return c;
  }

  /// Computes one step of the rays of some pixels, into loaded.worksheet and loaded.present.
  /// Returns whether there is any.
  bool findStep(int k, int v, int step, const Span& pixels, LoadedVoxels& loaded) const
  {
    const glm::ivec3& size = this->Context.geometry.size();
    const AxisSteps::Slice columns = this->Context.steps.columns.slice(k);
    const AxisSteps::Slice rows = this->Context.steps.rows.slice(k);
    const int count = pixels.end - pixels.begin;
    loaded.worksheet.resize(std::size_t(this->Context.image.width) * sizeof(T));
    loaded.present.resize(this->Context.image.width);
    T* const out = reinterpret_cast<T*>(loaded.worksheet.data());
    const int j0 = rows.first[v], j1 = rows.last[v];
    const bool inside[2] = { j0 >= 0 && j0 < size.y, j1 >= 0 && j1 < size.y };
    const T* const first = this->Context.template voxelRow<T>(inside[0] ? j0 : 0, k);
    const T* const last = this->Context.template voxelRow<T>(inside[1] ? j1 : 0, k);
    unsigned any = 0;
    for (int x = 0; x < count; ++x)
    {
      const int u = pixels.begin + x;
      const int i0 = columns.first[u], i1 = columns.last[u];
      const bool moves = i0 != i1 || j0 != j1;
      const double a = columns.time[u], b = rows.time[v];
      const bool corner = i0 != i1 && j0 != j1 && a != b;
      // The path is first, (corner), last.
      const bool atCorner = corner && step == 1;
      const bool takesLast = atCorner ? a < b : step > 0;    // of columns
      const bool takesNext = atCorner ? !(a < b) : step > 0; // of rows
      const bool exists = step == 0 || (moves && (step == 1 || corner));
      const int i = takesLast ? i1 : i0;
      const bool has = exists && inside[takesNext] && i >= 0 && i < size.x;
      out[x] = has ? (takesNext ? last : first)[i] : T(0);
      loaded.present[x] = has;
      any |= has;
    }
    return any != 0;
  }

  const ProjectionContext& Context;
  const AxisPicks& Picks;
  const T* None;
};

template <class A>
class PerspectivePreviewSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    const VoxelLoops<T>& loops = context.kernels;
    this->Picks.find(context.steps.columns, loops.group, sizeof(T));
    walk(context, PerspectivePreview<T>(context, this->Picks, this->None));
  }
  template <class T>
  void takeAtLocations(const AtWinners& winners) const
  {
    fillAtWinners<T>(winners,
      [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
      { return voxelAtWinner(voxels, winners.geometry, u, v, step); });
  }

private:
  AxisPicks Picks;
  std::vector<unsigned char> None;
};
}

std::unique_ptr<ProjectionMode> makePerspectivePreview()
{
  return std::make_unique<TypedMode<PerspectivePreviewSpace>>();
}
}
