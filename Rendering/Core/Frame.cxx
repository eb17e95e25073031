// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Frame.h"

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

void findMask(const std::vector<SliceGeometry>& slices, const std::vector<glm::dvec4>& halfSpaces,
  ShearImage& image)
{
  vtkSMPTools::For(0, image.height, 16,
    [&](vtkIdType first, vtkIdType last)
    {
      for (int v = static_cast<int>(first); v < last; ++v)
      {
        unsigned char* const mask = &image.mask[std::ptrdiff_t(v) * image.width];
        const Span range = slicesOf(slices, v, v + 1);
        for (int k = range.begin; k < range.end; ++k)
        {
          const Span span = ShearWarp::clipped(slices[k].span(v), v, k, halfSpaces);
          std::fill(mask + span.begin, mask + std::max(span.begin, span.end),
            static_cast<unsigned char>(1));
        }
      }
    });
}
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
  const std::vector<glm::dvec4>& halfSpaces, ShearImage& image)
{
  image.width = geometry.width();
  image.height = geometry.height();
  image.spans.assign(image.height, Span{ image.width, 0 });
  findSpans(slices, image.spans);
  image.mask.assign(halfSpaces.empty() ? 0 : std::size_t(image.width) * image.height, 0);
  if (!halfSpaces.empty())
  {
    findMask(slices, halfSpaces, image);
  }
}
}
