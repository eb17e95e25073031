// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From what a walk has noted of each pixel to ShearImage::winners.
 *
 * Of equal samples the nearest to the viewer wins, whatever the order of a walk: Frame::orders
 * tells the nearest step whose sample is the pixel's value. Where the value is the floor, which no
 * sample is below, that is the first sample of the ray, and walks need not look for it.
 */
#ifndef splattingWinnerFinder_h
#define splattingWinnerFinder_h

#include "Clipping/Cuts.h"
#include "Projection/Frame.h"
#include "Projection/Project.h"
#include "Projection/WalkSpace.h"

#include <vector>

namespace splatting
{
/// Before a walk: room for what walks note of winners.
inline void openNotes(Frame& frame)
{
  frame.space.orders.resize(frame.image.winners.size());
  frame.orders = frame.space.orders.data();
  frame.space.outline.crossed.reset(frame.sliceGeometry, frame.image.width);
}

/// And no pixel has won anything, and none takes what is no more than the floor; those
/// without samples never will.
inline void openOrders(const Frame& frame, int v0, int v1)
{
  const ShearImage& image = frame.image;
  for (int v = v0; v < v1; ++v)
  {
    const Span& span = image.spans[v];
    std::int16_t* const row = frame.ordersOfRow(v);
    const int begin = std::min(span.begin, image.width), end = std::max(begin, span.end);
    std::fill(row, row + begin, std::int16_t(-1));
    std::fill(row + begin, row + end, std::int16_t(0));
    std::fill(row + end, row + image.width, std::int16_t(-1));
    for (int u = span.begin; u < span.end && !image.mask.empty(); ++u)
    {
      row[u] = image.covers(u, v) ? std::int16_t(0) : std::int16_t(-1);
    }
  }
}

/// In an image with pixels of type P.
template <class P>
class WinnerFinder
{
public:
  /// @param floor    what pixels start from
  /// @param crossed  for the frame's slices
  WinnerFinder(const Frame& frame, P floor, const CrossedSlices& crossed)
    : Shared(frame),
      Crossed(crossed),
      Floor(floor),
      Preview(frame.settings.quality == Quality::Preview)
  {
  }

  /// Before SliceSampler::finish().
  void find(int v0, int v1, WinnerScratch& scratch) const
  {
    for (int v = v0; v < v1; ++v)
    {
      const bool missing = this->takeNotes(v);
      if (missing)
      {
        this->Shared.cuts.none() ? this->findFirst(v, scratch) : this->findFirstCounted(v, scratch);
      }
    }
  }

private:
  bool reversed() const { return this->Shared.geometry.reversed(); }

  /// What row v has notes of. Whether it has pixels without.
  bool takeNotes(int v) const
  {
    ShearImage& image = this->Shared.image;
    const Span& span = image.spans[v];
    std::int32_t* const winners = &image.winners[std::size_t(v) * image.width];
    const std::int16_t* const orders = this->Shared.ordersOfRow(v);
    const P* const row = image.row<P>(v);
    if (span.empty())
    {
      std::fill(winners, winners + image.width, -1);
      return false;
    }
    std::fill(winners, winners + span.begin, -1);
    std::fill(winners + span.end, winners + image.width, -1);
    const RayLoops<P>& loops = this->Shared.kernels;
    return loops.settle(row + span.begin, orders + span.begin, this->Floor, this->reversed(),
      this->Shared.orderOfStep(0), winners + span.begin, span.end - span.begin);
  }

  /// The first step of a ray in slice k; -1 if it has none.
  std::int32_t stepIn(int k, int u, int v) const
  {
    const SliceGeometry& slice = this->Shared.sliceGeometry[k];
    if (v < slice.vBegin || v >= slice.vEnd || u < slice.span(v).begin || u >= slice.span(v).end)
    {
      return -1;
    }
    if (!this->Preview)
    {
      return StepsPerSlice * k;
    }
    const bool own = this->Shared.geometry.isPerspective();
    RayPath ofRay;
    if (own)
    {
      ofRay = this->Shared.steps.path(u, v, k);
    }
    const RayPath& path = own ? ofRay : slice.path;
    const glm::ivec3& size = this->Shared.geometry.size();
    for (int n = 0; n < path.count; ++n)
    {
      const int t = this->reversed() ? path.count - 1 - n : n;
      const int i = path.di[t] + (own ? 0 : u), j = path.dj[t] + (own ? 0 : v);
      if (i >= 0 && i < size.x && j >= 0 && j < size.y)
      {
        return StepsPerSlice * k + t;
      }
    }
    return -1;
  }

  void findFirst(int v, WinnerScratch& scratch) const
  {
    ShearImage& image = this->Shared.image;
    scratch.first.resize(image.width);
    scratch.last.resize(image.width);
    this->Crossed.find(v, scratch.first.data(), scratch.last.data());
    std::int32_t* const winners = &image.winners[std::size_t(v) * image.width];
    const std::int16_t* const entered =
      this->reversed() ? scratch.last.data() : scratch.first.data();
    for (int u = image.spans[v].begin; u < image.spans[v].end;)
    {
      if (winners[u] != UnknownWinner)
      {
        ++u;
        continue;
      }
      const Entry entry = this->entryInto(entered[u], v);
      if (u < entry.pixels.begin || u >= entry.pixels.end)
      {
        winners[u] = this->firstStep(scratch.first[u], scratch.last[u], u, v);
        ++u;
        continue;
      }
      const int end = static_cast<int>(std::find_if(entered + u, entered + entry.pixels.end,
                                         [=](std::int16_t k) { return k != entered[u]; }) -
        entered);
      for (; u < end; ++u)
      {
        winners[u] = winners[u] == UnknownWinner ? entry.step : winners[u];
      }
    }
  }

  /// Pixels of a row that have the same first step in a slice; not all of those that have it.
  struct Entry
  {
    Span pixels;
    std::int32_t step = -1;
  };
  Entry entryInto(int k, int v) const
  {
    Entry entry;
    const int depth = this->Shared.geometry.size().z;
    if (k < 0 || k >= depth || this->Shared.geometry.isPerspective())
    {
      return entry;
    }
    const SliceGeometry& slice = this->Shared.sliceGeometry[k];
    if (v < slice.vBegin || v >= slice.vEnd)
    {
      return entry;
    }
    if (!this->Preview)
    {
      entry.pixels = slice.span(v);
      entry.step = StepsPerSlice * k;
      return entry;
    }
    const glm::ivec3& size = this->Shared.geometry.size();
    const RayPath& path = slice.path;
    for (int n = 0; n < path.count && entry.step < 0; ++n)
    {
      const int t = this->reversed() ? path.count - 1 - n : n;
      if (v + path.dj[t] >= 0 && v + path.dj[t] < size.y)
      {
        entry.pixels = common(slice.span(v), { -path.di[t], size.x - path.di[t] });
        entry.step = StepsPerSlice * k + t;
      }
    }
    return entry;
  }

  /// The first step of a ray that crosses some slices; -1 if it has none.
  std::int32_t firstStep(int first, int last, int u, int v) const
  {
    std::int32_t step = -1;
    for (int n = 0; n <= last - first && step < 0; ++n)
    {
      step = this->stepIn(this->reversed() ? last - n : first + n, u, v);
    }
    return step;
  }

  void findFirstCounted(int v, WinnerScratch& scratch) const
  {
    ShearImage& image = this->Shared.image;
    scratch.mask.resize(image.width);
    std::int32_t* const winners = &image.winners[std::size_t(v) * image.width];
    const Span slices = slicesOf(this->Shared.sliceGeometry, v, v + 1);
    for (int n = 0; n < slices.end - slices.begin; ++n)
    {
      const int k = this->reversed() ? slices.end - 1 - n : slices.begin + n;
      const SliceGeometry& slice = this->Shared.sliceGeometry[k];
      const Span pixels = v >= slice.vBegin && v < slice.vEnd ? slice.span(v) : Span{};
      if (pixels.empty() || !this->Shared.cuts.findMask(k, v, pixels, scratch.mask.data()))
      {
        continue;
      }
      for (int u = pixels.begin; u < pixels.end; ++u)
      {
        const std::int32_t step = winners[u] == UnknownWinner && scratch.mask[u - pixels.begin]
          ? this->stepIn(k, u, v)
          : -1;
        winners[u] = step >= 0 ? step : winners[u];
      }
    }
    std::replace(winners, winners + image.width, UnknownWinner, -1);
  }

  const Frame& Shared;
  const CrossedSlices& Crossed;
  P Floor;
  bool Preview;
};
}

#endif
