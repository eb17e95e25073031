// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/Worksheets.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace splatting
{
namespace
{
/// The part of slice c, which has no columns if there is no tap.
template <class A>
FootprintPart<A> partOf(const Taps& taps, int c)
{
  int first[2] = { 3, 3 }, last[2] = { -3, -3 };
  for (const Tap& tap : taps)
  {
    if (tap.slice == c)
    {
      first[0] = std::min(first[0], tap.di);
      last[0] = std::max(last[0], tap.di);
      first[1] = std::min(first[1], tap.dj);
      last[1] = std::max(last[1], tap.dj);
    }
  }
  FootprintPart<A> part{ c, first[0], first[1], std::max(last[0] - first[0] + 1, 0),
    std::max(last[1] - first[1] + 1, 0), {} };
  for (const Tap& tap : taps)
  {
    if (tap.slice == c)
    {
      part.weights[(tap.dj - part.dj) * part.columns + tap.di - part.di] =
        static_cast<A>(tap.weight);
    }
  }
  return part;
}

template <class A>
void setTaps(SliceFootprint<A>& footprint, const Taps& taps)
{
  footprint.taps = taps;
  for (int t = 0; t < taps.size(); ++t)
  {
    footprint.weights[t] = static_cast<A>(taps[t].weight);
  }
  footprint.partCount = 0;
  for (int c = -1; c <= 1; ++c)
  {
    const FootprintPart<A> part = partOf<A>(taps, c);
    if (part.columns > 0)
    {
      footprint.parts[footprint.partCount++] = part;
    }
  }
}

bool same(const Span& a, const Span& b)
{
  return (a.begin == b.begin && a.end == b.end) || (a.empty() && b.empty());
}
}

template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  GeneralTable& table, std::vector<SliceFootprint<A>>& footprints)
{
  const glm::dvec2 shear = geometry.shear();
  if (sampling > 0)
  {
    table.set(kernel, shear, sampling);
  }
  footprints.resize(geometry.size().z);
  parallelFor(0, geometry.size().z, 8,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t k = first; k < last; ++k)
      {
        auto& footprint = footprints[k];
        const glm::dvec2 position = geometry.position(static_cast<double>(k));
        footprint.nearest = { static_cast<int>(std::floor(position.x + 0.5)),
          static_cast<int>(std::floor(position.y + 0.5)) };
        const glm::dvec2 fraction = position - glm::dvec2(footprint.nearest);
        const WeightTable weights =
          sampling > 0 ? table.weights(fraction) : closedFormWeights(kernel, shear, fraction);
        setTaps(footprint, quantisedTaps(weights, weightBits));
      }
    });
}

template <class A>
void findReach(const std::vector<SliceGeometry>& slices,
  const std::vector<SliceFootprint<A>>& footprints, WorksheetReach<A>& reach)
{
  const int count = static_cast<int>(slices.size());
  reach.layers.assign((count + BrickDepth - 1) / BrickDepth, {});
  reach.slices.assign(count, {});
  for (int k = 0; k < count; ++k)
  {
    const RayPath& path = slices[k].path;
    for (int t = 0; t < path.count; ++t)
    {
      reach.slices[k].add(path.di[t], path.dj[t]);
    }
    const SliceFootprint<A>& footprint = footprints[k];
    A outside = 0; // the weight of other layers' voxels
    for (int p = 0; p < footprint.partCount; ++p)
    {
      const FootprintPart<A>& part = footprint.parts[p];
      const int s = std::clamp(k + part.slice, 0, count - 1);
      const int di = part.di - footprint.nearest.x, dj = part.dj - footprint.nearest.y;
      reach.slices[s].add(di, dj);
      reach.slices[s].add(di + part.columns - 1, dj + part.rows - 1);
      for (int w = 0; s / BrickDepth != k / BrickDepth && w < part.rows * part.columns; ++w)
      {
        outside += part.weights[w];
      }
    }
    A& share = reach.layers[k / BrickDepth].share;
    share = std::max(share, outside);
  }
  reach.columns = reach.rows = 0;
  for (int s = 0; s < count; ++s)
  {
    const VoxelWindow& window = reach.slices[s];
    reach.layers[s / BrickDepth].window.add(window.iMin, window.jMin);
    reach.layers[s / BrickDepth].window.add(window.iMax, window.jMax);
    reach.columns = std::max(reach.columns, window.iMax - window.iMin);
    reach.rows = std::max(reach.rows, window.jMax - window.jMin);
  }
}

template void findFootprints(
  const ShearWarp&, const Kernel&, int, int, GeneralTable&, std::vector<SliceFootprint<float>>&);
template void findFootprints(
  const ShearWarp&, const Kernel&, int, int, GeneralTable&, std::vector<SliceFootprint<double>>&);
template void findReach(const std::vector<SliceGeometry>&,
  const std::vector<SliceFootprint<float>>&, WorksheetReach<float>&);
template void findReach(const std::vector<SliceGeometry>&,
  const std::vector<SliceFootprint<double>>&, WorksheetReach<double>&);

template <class T>
template <class F>
void WorksheetSampler<T>::forBlocks(int v0, int v1, const Span& columns, F&& f) const
{
  for (int v = v0; v < v1; v += this->BlockHeight)
  {
    for (int u = columns.begin; u < columns.end; u += this->BlockWidth)
    {
      f(v, std::min(v + this->BlockHeight, v1),
        Span{ u, std::min(u + this->BlockWidth, columns.end) });
    }
  }
}

template <class T>
template <class F>
void WorksheetSampler<T>::forRows(int k, int v0, int v1, const Span& columns, F&& f) const
{
  const SliceGeometry& slice = this->Context.sliceGeometry[k];
  const int end = std::min(v1, slice.vEnd);
  int first = std::max(v0, slice.vBegin);
  while (first < end)
  {
    const Span span = common(columns, this->Context.pixels(first, k));
    int v = first + 1;
    while (v < end && same(span, common(columns, this->Context.pixels(v, k))))
    {
      ++v;
    }
    if (!span.empty())
    {
      f(first, v, span);
    }
    first = v;
  }
}

template <class T>
void WorksheetSampler<T>::splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
  const Target& pixels, LoadedVoxels& loaded) const
{
  for (const Span& run : runs)
  {
    this->splatBlocks(slices, v0, v1, run, pixels, loaded);
  }
}

template <class T>
void WorksheetSampler<T>::splatBlocks(const Span& slices, int v0, int v1, const Span& run,
  const Target& target, LoadedVoxels& loaded) const
{
  this->forBlocks(v0, v1, run,
    [&](int first, int last, const Span& columns)
    {
      this->open(first, last, columns, loaded);
      this->splatBlock(slices, first, last, columns, target, loaded);
    });
}

template <class T>
void WorksheetSampler<T>::open(int v0, int v1, const Span& columns, LoadedVoxels& loaded) const
{
  loaded.resize<A>(columns.end - columns.begin + this->Reach.columns, v1 - v0 + this->Reach.rows,
    this->Context.range.nonFinite ? this->parts() : 1);
  loaded.rows = { v0, v1 };
  loaded.pixels = columns;
}

template <class T>
void WorksheetSampler<T>::forSamples(const Span& slices, bool reversed, int v0, int v1,
  const Span& columns, LoadedVoxels& loaded, const Samples& f) const
{
  this->forBlocks(v0, v1, columns,
    [&](int first, int last, const Span& block)
    {
      this->open(first, last, block, loaded);
      const Target worksheet = this->worksheetFor(first, last, block, loaded);
      for (int n = 0; n < slices.end - slices.begin; ++n)
      {
        const int k = reversed ? slices.end - 1 - n : slices.begin + n;
        this->forRows(k, first, last, block,
          [&](int begin, int end, const Span& span)
          {
            this->sample(k, reversed ? -1 : 1, begin, end, span, worksheet, loaded);
            for (int v = begin; v < end; ++v)
            {
              f(StepsPerSlice * k, v, span, worksheet.at(span.begin, v), nullptr);
            }
          });
      }
    });
}

template <class T>
void WorksheetSampler<T>::splatAll(
  const Span& layers, int v0, int v1, const std::vector<Span>& all, LoadedVoxels& loaded) const
{
  const Span slices{ layers.begin * BrickDepth,
    std::min(layers.end * BrickDepth, this->Context.geometry.size().z) };
  this->splatBlocks(slices, v0, v1, all.front(), pixelsOf<A>(this->Context.image), loaded);
}

template <class T>
void WorksheetSampler<T>::finish(int v0, int v1) const
{
  const WorksheetLoops<A>& loops = this->Context.kernels;
  for (int v = v0; v < v1; ++v)
  {
    const Span& span = this->Context.image.spans[v];
    if (!span.empty())
    {
      loops.finish(this->Context.image.template row<A>(v) + span.begin, this->Base,
        static_cast<A>(this->Context.range.low), static_cast<A>(this->Context.range.high),
        span.end - span.begin);
    }
  }
}

template <class T>
auto WorksheetSampler<T>::worksheetFor(
  int v0, int v1, const Span& columns, LoadedVoxels& loaded) const -> Target
{
  const std::ptrdiff_t stride = columns.end - columns.begin;
  loaded.worksheet.resize((v1 - v0) * stride * sizeof(A));
  A* const first = reinterpret_cast<A*>(loaded.worksheet.data());
  return { first - v0 * stride - columns.begin, stride };
}

template <class T>
void WorksheetSampler<T>::splatOne(int k, int step, int first, int end, const Span& span,
  const Target& target, LoadedVoxels& loaded) const
{
  if (!this->splatOwn(k, step, first, end, span, target, loaded))
  {
    this->load(k, step, loaded);
    this->isFinite(k, loaded) ? this->splatRows(k, first, end, span, target, loaded)
                              : this->splatNonFiniteRows(k, first, end, span, target, loaded);
  }
}

template <class T>
void WorksheetSampler<T>::splatNonFiniteRows(
  int k, int first, int end, const Span& span, const Target& target, LoadedVoxels& loaded) const
{
  this->separate(k, loaded);
  const std::ptrdiff_t width = span.end - span.begin, size = (end - first) * width;
  loaded.averages.resize(std::max(loaded.averages.size(), this->parts() * size * sizeof(A)));
  A* const worksheets = reinterpret_cast<A*>(loaded.averages.data());
  std::fill_n(worksheets, this->parts() * size, leastValue<A>());
  for (loaded.part = 0; loaded.part < this->parts(); ++loaded.part)
  {
    const Target part{ worksheets + loaded.part * size - first * width - span.begin, width };
    this->splatRows(k, first, end, span, part, loaded);
  }
  loaded.part = 0;
  const WorksheetLoops<A>& loops = this->Context.kernels;
  for (int v = first; v < end; ++v)
  {
    const A* const row = worksheets + (v - first) * width;
    const bool infinite = this->parts() == 4;
    loops.raiseAverages(
      { target.at(span.begin, v), row, row + size, this->wholeWeight(),
        infinite ? row + 2 * size : nullptr, infinite ? row + 3 * size : nullptr },
      width);
  }
}

template <class T>
bool WorksheetSampler<T>::isFinite(int k, LoadedVoxels& loaded) const
{
  bool finite = true;
  const Span sheets = this->sheetsOf(k);
  for (int s = sheets.begin; this->Context.range.nonFinite && s < sheets.end; ++s)
  {
    finite = finite && loaded.sheet(s).finite;
  }
  return finite;
}

template <class T>
bool WorksheetSampler<T>::isFinite(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const
{
  const WorksheetLoops<A>& loops = this->Context.kernels;
  for (int j = sheet.j; this->Context.range.nonFinite && j < sheet.j + sheet.rows; ++j)
  {
    if (!loops.allFinite(loaded.voxel<A>(sheet.i, j, sheet.slice), sheet.columns))
    {
      return false;
    }
  }
  return true;
}

template <class T>
void WorksheetSampler<T>::separate(int k, LoadedVoxels& loaded) const
{
  const WorksheetLoops<A>& loops = this->Context.kernels;
  const Span sheets = this->sheetsOf(k);
  for (int s = sheets.begin; s < sheets.end; ++s)
  {
    LoadedVoxels::Sheet& sheet = loaded.sheet(s);
    for (int j = sheet.j; !sheet.separated && j < sheet.j + sheet.rows; ++j)
    {
      A* rows[LoadedVoxels::MostParts] = {};
      for (loaded.part = 0; loaded.part < this->parts(); ++loaded.part)
      {
        rows[loaded.part] = loaded.voxel<A>(sheet.i, j, s);
      }
      loops.separate(rows[0], rows[1], rows[2], rows[3], sheet.columns);
    }
    sheet.separated = true;
  }
  loaded.part = 0;
}

template <class T>
void WorksheetSampler<T>::sample(int k, int step, int first, int end, const Span& span,
  const Target& worksheet, LoadedVoxels& loaded) const
{
  const A none = leastValue<A>(), nan = std::numeric_limits<A>::quiet_NaN();
  const bool nonFinite = this->Context.range.nonFinite;
  if (nonFinite)
  {
    this->load(k, step, loaded);
  }
  const bool finite = this->isFinite(k, loaded);
  for (int v = first; v < end; ++v)
  {
    std::fill(worksheet.at(span.begin, v), worksheet.at(span.end, v), finite ? none : nan);
  }
  this->splatOne(k, step, first, end, span, worksheet, loaded);
  for (int v = first; nonFinite && finite && v < end; ++v)
  {
    std::replace(worksheet.at(span.begin, v), worksheet.at(span.end, v), none, nan);
  }
}

template <class T>
void WorksheetSampler<T>::splatBlock(const Span& slices, int v0, int v1, const Span& columns,
  const Target& target, LoadedVoxels& loaded) const
{
  for (int k = slices.begin; k < slices.end; ++k)
  {
    const int step = k + 1 < slices.end ? 1 : 0;
    this->forRows(k, v0, v1, columns,
      [&](int first, int end, const Span& span)
      { this->splatOne(k, step, first, end, span, target.slice(k - slices.begin), loaded); });
  }
}

template <class T>
void WorksheetSampler<T>::load(int k, int step, LoadedVoxels& loaded) const
{
  const int last = this->Context.geometry.size().z - 1;
  const Span sheets = this->sheetsOf(k);
  for (int s = sheets.begin; s < sheets.end; ++s)
  {
    if (loaded.sheet(s).slice != s)
    {
      const bool exists = s + step >= 0 && s + step <= last;
      loaded.ahead = exists ? step * this->Context.slices.sliceStride : 0;
      loaded.sheet(s) = this->sheetOf(s, loaded.rows.begin, loaded.rows.end, loaded.pixels);
      this->loadSheet(loaded.sheet(s), loaded);
      loaded.sheet(s).finite = this->isFinite(loaded.sheet(s), loaded);
    }
  }
}

template <class T>
void WorksheetSampler<T>::loadSheet(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const
{
  // Rows inside the volume are loaded together; those beyond repeat the outermost one.
  const int height = this->Context.geometry.size().y;
  const int end = sheet.j + sheet.rows;
  const int low = std::clamp(0, sheet.j, end), high = std::clamp(height, low, end);
  for (int j = sheet.j; j < low; ++j)
  {
    this->loadRows(sheet, j, 0, 1, loaded);
  }
  if (low < high)
  {
    this->loadRows(sheet, low, low, high - low, loaded);
  }
  for (int j = high; j < end; ++j)
  {
    this->loadRows(sheet, j, height - 1, 1, loaded);
  }
}

template <class T>
void WorksheetSampler<T>::loadRows(
  const LoadedVoxels::Sheet& sheet, int to, int from, int rows, LoadedVoxels& loaded) const
{
  const int width = this->Context.geometry.size().x;
  const VoxelLoops<T>& loops = this->Context.kernels;
  const int begin = std::clamp(-sheet.i, 0, sheet.columns);
  const int end = std::clamp(width - sheet.i, begin, sheet.columns);
  const T* voxels = this->Context.template voxelRow<T>(from, sheet.slice);
  A* out = loaded.voxel<A>(sheet.i, to, sheet.slice);
  if (begin < end)
  {
    loops.widen(voxels + sheet.i + begin, this->Context.slices.rowStride, out + begin,
      loaded.rowLength, this->Base, end - begin, rows, loaded.ahead);
  }
  for (int r = 0; r < rows && (begin > 0 || end < sheet.columns); ++r)
  {
    std::fill(out, out + begin, static_cast<A>(voxels[0]) - this->Base);
    std::fill(out + end, out + sheet.columns, static_cast<A>(voxels[width - 1]) - this->Base);
    voxels += this->Context.slices.rowStride;
    out += loaded.rowLength;
  }
}

#define WORKSHEETS(T) template class WorksheetSampler<T>;
SPLATTING_TYPES(WORKSHEETS)
}
