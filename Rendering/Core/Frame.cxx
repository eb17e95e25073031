// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Frame.h"

#include "Cuts.h"

#include <vtkSMPTools.h>

namespace splatting
{
namespace
{
SliceGeometry sliceOf(const ShearWarp& geometry, int k)
{
  SliceGeometry slice;
  slice.path = geometry.rayPath(k);
  const auto end = slice.path.dj.begin() + slice.path.count;
  const int low = *std::min_element(slice.path.dj.begin(), end);
  const int high = *std::max_element(slice.path.dj.begin(), end);
  slice.vBegin = -high;
  slice.vEnd = geometry.size().y - low;
  slice.innerBegin = -low;
  slice.innerEnd = std::max(geometry.size().y - high, slice.innerBegin);
  slice.lower = geometry.coverage(slice.path, slice.vBegin);
  slice.inner = geometry.coverage(slice.path, slice.innerBegin);
  slice.upper = geometry.coverage(slice.path, slice.vEnd - 1);
  return slice;
}

void extend(Span& all, const Span& span)
{
  all.begin = std::min(all.begin, span.begin);
  all.end = std::max(all.end, span.end);
}

/// The spans of all rows over all slices. Where a row is an inner one of several slices, the first
/// and the last decide, because the slices' spans move one way.
void findSpans(const std::vector<SliceGeometry>& slices, std::vector<Span>& spans)
{
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
    extendRows(slice.vBegin, slice.innerBegin, slice.lower);
    extendRows(slice.innerEnd, slice.vEnd, slice.upper);
    if (k > 0)
    {
      extendDifference(slice, slices[k - 1]);
      extendDifference(slices[k - 1], slice);
    }
  }
  extendRows(slices.front().innerBegin, slices.front().innerEnd, slices.front().inner);
  extendRows(slices.back().innerBegin, slices.back().innerEnd, slices.back().inner);
}

/// Whether a sample is left in any slice, for a row of pixels.
class SamplesLeft
{
public:
  SamplesLeft(const std::vector<SliceGeometry>& slices, const Cuts& cuts, const CutMap& map)
    : Crossed(slices),
      Source(cuts),
      Map(map)
  {
  }

  void find(int v, int width, unsigned char* mask)
  {
    if (!this->Source.cropping.cuts())
    {
      this->fromIntervals(v, width, mask);
    }
    else if (this->Source.intervals.empty())
    {
      this->fromRegions(v, mask);
    }
    else
    {
      this->fromSlices(v, width, mask);
    }
  }

private:
  void fromIntervals(int v, int width, unsigned char* mask)
  {
    this->First.resize(width);
    this->Last.resize(width);
    findCrossedSlices(this->Crossed, v, width, this->First.data(), this->Last.data());
    const std::int16_t* const first = this->Source.intervals.first(v);
    const std::int16_t* const last = this->Source.intervals.last(v);
    for (int u = 0; u < width; ++u)
    {
      mask[u] = std::max(first[u], this->First[u]) <= std::min(last[u], this->Last[u]);
    }
  }

  /// The pixels of a region move by a pixel or two from slice to slice, so that those of
  /// consecutive slices make one span.
  void fromRegions(int v, unsigned char* mask)
  {
    const Span range = slicesOf(this->Crossed, v, v + 1);
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
        const Span own = shown ? common(regions.pixels(i), this->Crossed[k].span(v)) : Span{};
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

  void fromSlices(int v, int width, unsigned char* mask)
  {
    this->Slice.resize(width);
    const Span range = slicesOf(this->Crossed, v, v + 1);
    for (int k = range.begin; k < range.end; ++k)
    {
      const Span& span = this->Crossed[k].span(v);
      if (this->Map.findMask(k, v, span, this->Slice.data()))
      {
        for (int u = span.begin; u < span.end; ++u)
        {
          mask[u] |= this->Slice[u - span.begin];
        }
      }
    }
  }

  const std::vector<SliceGeometry>& Crossed;
  const Cuts& Source;
  const CutMap& Map;
  std::vector<std::int16_t> First, Last;
  std::vector<unsigned char> Slice;
};
}

std::vector<SliceGeometry>& findSlices(
  const ShearWarp& geometry, std::vector<SliceGeometry>& slices)
{
  slices.resize(geometry.size().z);
  for (int k = 0; k < geometry.size().z; ++k)
  {
    slices[k] = sliceOf(geometry, k);
  }
  return slices;
}

void outlineImage(const ShearWarp& geometry, const std::vector<SliceGeometry>& slices,
  const CutMap& cuts, ShearImage& image)
{
  image.width = geometry.width();
  image.height = geometry.height();
  image.spans.assign(image.height, Span{ image.width, 0 });
  findSpans(slices, image.spans);
  image.mask.assign(cuts.none() ? 0 : std::size_t(image.width) * image.height, 0);
  if (cuts.none())
  {
    return;
  }
  vtkSMPTools::For(0, image.height, 16,
    [&](vtkIdType begin, vtkIdType end)
    {
      SamplesLeft samples(slices, cuts.source(), cuts);
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        samples.find(v, image.width, &image.mask[std::ptrdiff_t(v) * image.width]);
      }
    });
}
}
