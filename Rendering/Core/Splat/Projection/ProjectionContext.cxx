// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Projection/ProjectionContext.h"

#include "Common/Parallel.h"
#include "Splat/Walks/Cuts.h"
#include "Splat/Walks/WalkSpace.h"

namespace splatting
{
namespace
{
void findParallelSlice(const ShearWarp& geometry, int k, SliceGeometry& slice)
{
  slice.path = geometry.rayPath(k);
  const auto end = slice.path.dj.begin() + slice.path.count;
  const int low = *std::min_element(slice.path.dj.begin(), end);
  const int high = *std::max_element(slice.path.dj.begin(), end);
  // The volume extends beyond the image of one pixel.
  const int rows = geometry.size().y, width = geometry.width(), height = geometry.height();
  slice.vBegin = std::clamp(-high, 0, height);
  slice.vEnd = std::clamp(rows - low, slice.vBegin, height);
  slice.innerBegin = std::clamp(-low, slice.vBegin, slice.vEnd);
  slice.innerEnd = std::clamp(rows - high, slice.innerBegin, slice.vEnd);
  const auto pixels = [&](int v) { return common(geometry.coverage(slice.path, v), { 0, width }); };
  slice.inner = pixels(-low);
  // In parallel views at most a row at either end.
  slice.lower.assign(slice.innerBegin - slice.vBegin, pixels(-high));
  slice.upper.assign(slice.vEnd - slice.innerEnd, pixels(rows - low - 1));
}

/// The pixels of a row whose rays only enter the slice, or only leave it, in a row of voxels.
Span rimOf(const AxisSteps::Slice& columns, const Span& reach, int size, bool enters, double time)
{
  const auto meets = [&](int u)
  {
    const int own = enters ? columns.first[u] : columns.last[u];
    const int corner = enters ? columns.last[u] : columns.first[u];
    if (own >= 0 && own < size)
    {
      return true;
    }
    // The ray is in the next column before it is in the next row, or still in the last one.
    return corner >= 0 && corner < size &&
      (enters ? columns.time[u] < time : time < columns.time[u]);
  };
  Span rim = reach;
  for (; rim.begin < rim.end && !meets(rim.begin); ++rim.begin)
  {
  }
  for (; rim.end > rim.begin && !meets(rim.end - 1); --rim.end)
  {
  }
  return rim;
}

void findPerspectiveSlice(
  const ShearWarp& geometry, const PerspectiveSteps& steps, int k, SliceGeometry& slice)
{
  const AxisSteps::Slice columns = steps.columns.slice(k), rows = steps.rows.slice(k);
  const Span& some = steps.rows.covered(k).some;
  const Span& all = steps.rows.covered(k).all;
  slice.vBegin = some.begin;
  slice.vEnd = some.end;
  slice.innerBegin = all.empty() ? some.end : all.begin;
  slice.innerEnd = all.empty() ? some.end : all.end;
  slice.inner = steps.columns.covered(k).some;
  const auto rim = [&](int v)
  {
    const bool enters = rows.first[v] >= 0 && rows.first[v] < geometry.size().y;
    return rimOf(columns, slice.inner, geometry.size().x, enters, rows.time[v]);
  };
  slice.lower.resize(slice.innerBegin - slice.vBegin);
  for (int v = slice.vBegin; v < slice.innerBegin; ++v)
  {
    slice.lower[v - slice.vBegin] = rim(v);
  }
  slice.upper.resize(slice.vEnd - slice.innerEnd);
  for (int v = slice.innerEnd; v < slice.vEnd; ++v)
  {
    slice.upper[v - slice.innerEnd] = rim(v);
  }
}

void extend(Span& all, const Span& span)
{
  if (span.empty())
  {
    return;
  }
  all.begin = std::min(all.begin, span.begin);
  all.end = std::max(all.end, span.end);
}

/// Finds the spans of all rows over all slices. If a row is an inner one of several slices, the
/// first and the last of these determine its span, because spans move in one direction.
void findSpans(const std::vector<SliceGeometry>& slices, std::vector<Span>& spans)
{
  // A single row need not contain the rays of the first and the last slice.
  for (std::size_t k = 0; k < slices.size() && spans.size() == 1; ++k)
  {
    extend(spans[0], slices[k].vBegin <= 0 && slices[k].vEnd > 0 ? slices[k].span(0) : Span{});
  }
  const auto extendRows = [&](int begin, int end, const Span& span)
  {
    for (int v = begin; v < end; ++v)
    {
      extend(spans[v], span);
    }
  };
  // Rows that are inner ones of a, but not of b.
  const auto extendDifference = [&](const SliceGeometry& a, const SliceGeometry& b)
  {
    extendRows(a.innerBegin, std::min(a.innerEnd, b.innerBegin), a.inner);
    extendRows(std::max(a.innerBegin, b.innerEnd), a.innerEnd, a.inner);
  };
  for (std::size_t k = 0; k < slices.size(); ++k)
  {
    const SliceGeometry& slice = slices[k];
    for (int v = slice.vBegin; v < slice.innerBegin; ++v)
    {
      extend(spans[v], slice.span(v));
    }
    for (int v = slice.innerEnd; v < slice.vEnd; ++v)
    {
      extend(spans[v], slice.span(v));
    }
    if (k > 0)
    {
      extendDifference(slice, slices[k - 1]);
      extendDifference(slices[k - 1], slice);
    }
  }
  extendRows(slices.front().innerBegin, slices.front().innerEnd, slices.front().inner);
  extendRows(slices.back().innerBegin, slices.back().innerEnd, slices.back().inner);
}

constexpr std::int16_t NoFirst = std::numeric_limits<std::int16_t>::max(), NoLast = -1;

/// Whether a sample is visible in any slice, for a row of pixels.
class SamplesLeft
{
public:
  SamplesLeft(const std::vector<SliceGeometry>& slices, const CrossedSlices& crossed,
    const CutMap& map, int width, OutlineSpace::Rows& rows)
    : Slices(slices),
      Crossed(crossed),
      Map(map),
      First(rows.first),
      Last(rows.last),
      Slice(rows.slice)
  {
    this->First.resize(width);
    this->Last.resize(width);
    this->Slice.resize(width);
  }

  void find(int v, unsigned char* mask)
  {
    if (!this->Map.crops())
    {
      this->fromIntervals(v, mask);
      return;
    }
    std::fill_n(mask, this->First.size(), static_cast<unsigned char>(0));
    if (this->Map.source().intervals.empty())
    {
      this->fromRegions(v, mask);
    }
    else
    {
      this->fromSlices(v, mask);
    }
  }

private:
  void fromIntervals(int v, unsigned char* mask)
  {
    this->Crossed.find(v, this->First.data(), this->Last.data());
    const std::int16_t* const first = this->Map.source().intervals.first(v);
    const std::int16_t* const last = this->Map.source().intervals.last(v);
    const std::int16_t* const firstCrossed = this->First.data();
    const std::int16_t* const lastCrossed = this->Last.data();
    const std::size_t width = this->First.size();
    for (std::size_t u = 0; u < width; ++u)
    {
      mask[u] = std::max(first[u], firstCrossed[u]) <= std::min(last[u], lastCrossed[u]);
    }
  }

  /// The pixels of a region move by a pixel or two from slice to slice, so those of consecutive
  /// slices form one span.
  void fromRegions(int v, unsigned char* mask)
  {
    const Span range = slicesOf(this->Slices, v, v + 1);
    const auto mark = [&](const Span& pixels)
    {
      std::fill(mask + pixels.begin, mask + std::max(pixels.begin, pixels.end),
        static_cast<unsigned char>(1));
    };
    for (int i = 0; i < 3; ++i)
    {
      Span all;
      for (int k = range.begin; k < range.end; ++k)
      {
        const SliceRegions& regions = this->Map.regions(k);
        const bool shown = regions.regionsOfRow(v) >> i & 1u;
        const Span own = shown ? common(regions.pixels(i), this->Slices[k].span(v)) : Span{};
        if (all.empty() || own.empty() || common(all, own).empty())
        {
          mark(all);
          all = own;
        }
        else
        {
          extend(all, own);
        }
      }
      mark(all);
    }
  }

  void fromSlices(int v, unsigned char* mask)
  {
    const Span range = slicesOf(this->Slices, v, v + 1);
    for (int k = range.begin; k < range.end; ++k)
    {
      const Span& span = this->Slices[k].span(v);
      if (this->Map.findMask(k, v, span, this->Slice.data()))
      {
        for (int u = span.begin; u < span.end; ++u)
        {
          mask[u] |= this->Slice[u - span.begin];
        }
      }
    }
  }

  const std::vector<SliceGeometry>& Slices;
  const CrossedSlices& Crossed;
  const CutMap& Map;
  std::vector<std::int16_t>& First;
  std::vector<std::int16_t>& Last;
  std::vector<unsigned char>& Slice;
};
}

RayPath PerspectiveSteps::path(int u, int v, int k) const
{
  const AxisSteps::Slice i = this->columns.slice(k), j = this->rows.slice(k);
  const int i0 = i.first[u], i1 = i.last[u], j0 = j.first[v], j1 = j.last[v];
  RayPath path;
  const auto add = [&](int column, int row)
  {
    path.di[path.count] = column;
    path.dj[path.count++] = row;
  };
  add(i0, j0);
  if (i0 != i1 && j0 != j1 && i.time[u] != j.time[v])
  {
    const bool columnFirst = i.time[u] < j.time[v];
    add(columnFirst ? i1 : i0, columnFirst ? j0 : j1);
  }
  if (i0 != i1 || j0 != j1)
  {
    add(i1, j1);
  }
  return path;
}

std::vector<SliceGeometry>& findSlices(
  const ShearWarp& geometry, std::vector<SliceGeometry>& slices, const PerspectiveSteps& steps)
{
  slices.resize(geometry.size().z);
  for (int k = 0; k < geometry.size().z; ++k)
  {
    SliceGeometry& slice = slices[k];
    if (!geometry.isPerspective())
    {
      findParallelSlice(geometry, k, slice);
    }
    else if (k >= geometry.slices().begin && k < geometry.slices().end &&
      !steps.columns.covered(k).some.empty() && !steps.rows.covered(k).some.empty())
    {
      findPerspectiveSlice(geometry, steps, k, slice);
    }
    else
    {
      slice = {}; // no ray crosses it
    }
  }
  return slices;
}

void CrossedSlices::reset(const std::vector<SliceGeometry>& slices, int width)
{
  this->Slices = &slices;
  this->First.assign(width, NoFirst);
  this->Last.assign(width, NoLast);
  // A ray crosses consecutive slices, and spans move by a pixel or two from one to the next. A ray
  // begins or ends only where they differ.
  const int count = static_cast<int>(slices.size());
  const auto markDifference = [](const Span& own, const Span& other, int k, std::int16_t* out)
  {
    const Span both = common(own, other);
    const Span before{ own.begin, both.empty() ? own.end : both.begin };
    const Span after{ both.empty() ? own.end : both.end, own.end };
    for (const Span& pixels : { before, after })
    {
      std::fill(
        out + pixels.begin, out + std::max(pixels.begin, pixels.end), static_cast<std::int16_t>(k));
    }
  };
  Span before;
  int kBefore = 0;
  for (int k = 0; k < count; ++k)
  {
    if (slices[k].innerBegin < slices[k].innerEnd)
    {
      markDifference(slices[k].inner, before, k, this->First.data());
      markDifference(before, slices[k].inner, kBefore, this->Last.data());
      before = slices[k].inner;
      kBefore = k;
    }
  }
  markDifference(before, {}, kBefore, this->Last.data());
}

void CrossedSlices::find(int v, std::int16_t* first, std::int16_t* last) const
{
  const std::vector<SliceGeometry>& slices = *this->Slices;
  const Span range = slicesOf(slices, v, v + 1);
  // Slices that contain the row's paths are consecutive, too.
  const auto isInner = [&](int k) { return slices[k].innerBegin <= v && v < slices[k].innerEnd; };
  int begin = range.begin, end = range.end;
  for (; begin < end && !isInner(begin); ++begin)
  {
  }
  for (; end > begin && !isInner(end - 1); --end)
  {
  }
  const int width = static_cast<int>(this->First.size());
  const std::int16_t lowest = static_cast<std::int16_t>(begin);
  const std::int16_t highest = static_cast<std::int16_t>(end - 1);
  for (int u = 0; u < width; ++u) // with 16 bits, which all instruction sets compare fast
  {
    const std::int16_t low = std::max(this->First[u], lowest);
    const std::int16_t high = std::min(this->Last[u], highest);
    first[u] = low <= high ? low : NoFirst;
    last[u] = low <= high ? high : NoLast;
  }
  const auto add = [&](int k)
  {
    const Span& span = slices[k].span(v);
    for (int u = span.begin; u < span.end; ++u)
    {
      first[u] = std::min(first[u], static_cast<std::int16_t>(k));
      last[u] = std::max(last[u], static_cast<std::int16_t>(k));
    }
  };
  for (int k = range.begin; k < begin; ++k)
  {
    add(k);
  }
  for (int k = end; k < range.end; ++k)
  {
    add(k);
  }
}

void outlineImage(const ShearWarp& geometry, const std::vector<SliceGeometry>& slices,
  const CutMap& cuts, OutlineSpace& space, ShearImage& image)
{
  image.width = geometry.width();
  image.height = geometry.height();
  image.spans.assign(image.height, Span{ image.width, 0 });
  findSpans(slices, image.spans);
  image.mask.resize(cuts.none() ? 0 : std::size_t(image.width) * image.height);
  if (cuts.none())
  {
    return;
  }
  space.crossed.reset(slices, image.width);
  parallelFor(0, image.height, 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      SamplesLeft samples(slices, space.crossed, cuts, image.width, space.rows.Local());
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        samples.find(v, &image.mask[std::ptrdiff_t(v) * image.width]);
      }
    });
}
}
