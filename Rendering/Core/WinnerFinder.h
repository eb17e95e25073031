// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From what a walk has noted of each pixel to ShearImage::winners.
 *
 * Of equal samples the nearest to the viewer wins, whatever the order of a walk: Frame::orders
 * tells the nearest slice whose worksheet is the pixel's value, or the nearest layer that has such
 * a voxel. Where the value is the floor, which no sample is below, that is the first sample of the
 * ray, and walks need not look for it.
 */
#ifndef splattingWinnerFinder_h
#define splattingWinnerFinder_h

#include "Carry.h"
#include "Cuts.h"
#include "Frame.h"

#include <vector>

namespace splatting
{
/// A thread's work space.
struct WinnerScratch
{
  std::vector<std::int16_t> first, last;
  std::vector<unsigned char> mask;
};

/// Before a walk: no pixel has won anything; those without samples never will.
template <class T>
void openOrders(const Frame<T>& frame, int v0, int v1)
{
  const ShearImage& image = frame.image;
  for (int v = v0; v < v1; ++v)
  {
    const Span& span = image.spans[v];
    std::int16_t* const row = frame.ordersOfRow(v);
    std::fill(row, row + image.width, std::int16_t(-1));
    for (int u = span.begin; u < span.end; ++u)
    {
      row[u] = image.covers(u, v) ? std::numeric_limits<std::int16_t>::max() : std::int16_t(-1);
    }
  }
}

template <class Stack>
class WinnerFinder
{
public:
  using T = typename Stack::Voxel;
  using P = typename Stack::Pixel;

  /// @param volume   where the frame's slices come from
  /// @param crossed  for the frame's slices
  /// @param preview  whether samples are voxels
  WinnerFinder(const Frame<T>& frame, const Stack& layers, const VoxelArray& volume,
    const CrossedSlices& crossed, bool preview)
    : Shared(frame),
      Voxels(volume, frame.geometry),
      Crossed(crossed),
      Floor(layers.floor()),
      Preview(preview)
  {
    if (preview && !frame.geometry.isPerspective())
    {
      this->findTaps();
    }
  }

  /// Before Layers::finish().
  void find(int v0, int v1, WinnerScratch& scratch) const
  {
    ShearImage& image = this->Shared.image;
    for (int v = v0; v < v1; ++v)
    {
      const Span& span = image.spans[v];
      std::int32_t* const winners = &image.winners[std::size_t(v) * image.width];
      const std::int16_t* const orders = this->Shared.ordersOfRow(v);
      const P* const row = image.row<P>(v);
      std::fill(winners, winners + image.width, -1);
      bool missing = false;
      for (int u = span.begin; u < span.end; ++u)
      {
        const bool noted = row[u] > this->Floor && orders[u] >= 0;
        winners[u] = noted ? this->noted(u, v, orders[u], row[u]) : orders[u] < 0 ? -1 : Unknown;
        missing |= winners[u] == Unknown;
      }
      if (missing)
      {
        this->Shared.cuts.none() ? this->findFirst(v, scratch) : this->findFirstCounted(v, scratch);
      }
    }
  }

private:
  static constexpr std::int32_t Unknown = -2;

  /// What all pixels cross in a layer of a parallel preview, from the viewer on.
  struct Taps
  {
    struct Tap
    {
      std::ptrdiff_t place; // from voxel (u, v, 0)
      std::int32_t step;
    };
    std::array<Tap, MostRows> taps;
    int count = 0;
    Span columns, rows; // the pixels that have voxels at all of them

    bool isWithin(int u, int v) const
    {
      return u >= this->columns.begin && u < this->columns.end && v >= this->rows.begin &&
        v < this->rows.end;
    }
    std::int32_t stepOf(const T* voxels, std::ptrdiff_t at, P value) const
    {
      for (int n = 0; n < this->count; ++n)
      {
        if (static_cast<P>(voxels[at + this->taps[n].place]) == value)
        {
          return this->taps[n].step;
        }
      }
      return -1;
    }
  };

  void findTaps()
  {
    const glm::ivec3& size = this->Shared.geometry.size();
    this->Layers.resize((size.z + BrickDepth - 1) / BrickDepth);
    for (int n = 0; n < size.z; ++n)
    {
      const int k = this->reversed() ? size.z - 1 - n : n;
      const RayPath& path = this->Shared.sliceGeometry[k].path;
      Taps& layer = this->Layers[k / BrickDepth];
      if (layer.count == 0)
      {
        layer.columns = { std::numeric_limits<int>::lowest(), std::numeric_limits<int>::max() };
        layer.rows = layer.columns;
      }
      for (int m = 0; m < path.count; ++m)
      {
        const int t = this->reversed() ? path.count - 1 - m : m, di = path.di[t], dj = path.dj[t];
        layer.taps[layer.count++] = { this->Voxels.place(di, dj, k), StepsPerSlice * k + t };
        layer.columns = common(layer.columns, { -di, size.x - di });
        layer.rows = common(layer.rows, { -dj, size.y - dj });
      }
    }
  }

  bool reversed() const { return this->Shared.geometry.reversed(); }

  std::int32_t noted(int u, int v, std::int16_t order, P value) const
  {
    const int depth = this->Shared.geometry.size().z;
    if (!this->Preview)
    {
      return StepsPerSlice * (this->reversed() ? depth - 1 - order : order);
    }
    const int layers = (depth + BrickDepth - 1) / BrickDepth;
    const int layer = this->reversed() ? layers - 1 - order : order;
    if (!this->Layers.empty() && this->Shared.cuts.none() && this->Layers[layer].isWithin(u, v))
    {
      return this->Layers[layer].stepOf(
        this->Voxels.pointer(0, 0, 0), this->Voxels.place(u, v, 0), value);
    }
    const Span slices = slicesOfLayer(layer, this->Shared.geometry.size());
    for (int n = 0; n < slices.end - slices.begin; ++n)
    {
      const int k = this->reversed() ? slices.end - 1 - n : slices.begin + n;
      const std::int32_t step = this->stepIn(k, u, v, &value);
      unsigned char counts = 1;
      if (step >= 0 &&
        (this->Shared.cuts.none() ||
          (this->Shared.cuts.findMask(k, v, { u, u + 1 }, &counts) && counts)))
      {
        return step;
      }
    }
    return -1;
  }

  /// The first step of a ray in slice k, of this value if there is one; -1 if it has none.
  std::int32_t stepIn(int k, int u, int v, const P* value) const
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
      ofRay = this->Shared.geometry.voxelsOnRay(u, v, k);
    }
    const RayPath& path = own ? ofRay : slice.path;
    const glm::ivec3& size = this->Shared.geometry.size();
    for (int n = 0; n < path.count; ++n)
    {
      const int t = this->reversed() ? path.count - 1 - n : n;
      const int i = path.di[t] + (own ? 0 : u), j = path.dj[t] + (own ? 0 : v);
      if (i >= 0 && i < size.x && j >= 0 && j < size.y &&
        (!value || static_cast<P>(this->Voxels.at(i, j, k)) == *value))
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
    for (int u = image.spans[v].begin; u < image.spans[v].end; ++u)
    {
      if (winners[u] == Unknown)
      {
        winners[u] = -1;
        const int first = scratch.first[u], last = scratch.last[u];
        for (int n = 0; n <= last - first && winners[u] < 0; ++n)
        {
          winners[u] = this->stepIn(this->reversed() ? last - n : first + n, u, v, nullptr);
        }
      }
    }
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
        const std::int32_t step = winners[u] == Unknown && scratch.mask[u - pixels.begin]
          ? this->stepIn(k, u, v, nullptr)
          : -1;
        winners[u] = step >= 0 ? step : winners[u];
      }
    }
    std::replace(winners, winners + image.width, Unknown, -1);
  }

  const Frame<T>& Shared;
  PermutedVoxels<T> Voxels;
  const CrossedSlices& Crossed;
  P Floor;
  bool Preview;
  std::vector<Taps> Layers;
};
}

#endif
