// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Previews from chains of voxels. A chain raises a run of pixels to one value. The run is longer
 * than the chain by the extent of the ray path in the chain's row.
 */
#ifndef splattingLineWalk_h
#define splattingLineWalk_h

#include "Splat/Chains/LineIndex.h"
#include "Splat/Projection/ProjectionContext.h"

#include <cmath>

namespace splatting
{
/// The pixels that show voxels of one slice: voxel (i, j) is visible in row j - dj, in pixels i -
/// iMax to i - iMin.
struct PathRows
{
  struct Row
  {
    int dj, iMin, iMax;
  };
  std::array<Row, 3> rows;
  int count = 0;
};

inline PathRows rowsOf(const RayPath& path)
{
  PathRows found;
  for (int t = 0; t < path.count; ++t)
  {
    PathRows::Row* const end = found.rows.data() + found.count;
    PathRows::Row* const row = std::find_if(
      found.rows.data(), end, [&](const PathRows::Row& r) { return r.dj == path.dj[t]; });
    if (row == end)
    {
      *row = { path.dj[t], path.di[t], path.di[t] };
      ++found.count;
    }
    // The voxels of a path are neighbours, so those of a row are consecutive.
    row->iMin = std::min(row->iMin, path.di[t]);
    row->iMax = std::max(row->iMax, path.di[t]);
  }
  return found;
}

/// Work space of a thread: for each pixel of a band, the next one of its row without a value.
using LineScratch = std::vector<int>;

template <class T>
class LinePreview
{
public:
  /// @param storage  outlives this, and is reused by the next frame
  LinePreview(
    const ProjectionContext& context, const LineIndex& index, std::vector<PathRows>& storage)
    : Context(context),
      Index(index),
      Floor(previewFloor<T>(context)),
      Paths(storage)
  {
    storage.clear();
    for (const SliceGeometry& slice : context.sliceGeometry)
    {
      storage.push_back(rowsOf(slice.path));
    }
  }

  /// Raises pixels of some rows by all slices. The pixels must have the initial value
  /// previewFloor().
  void splat(int v0, int v1, LineScratch& scratch) const
  {
    switch (this->Index.encoding().order)
    {
      case LineOrder::Lines:
        this->splatLines(v0, v1);
        break;
      case LineOrder::SortedLines:
        this->splatSortedLines(v0, v1);
        break;
      case LineOrder::SortedVolume:
        this->splatSortedVolume(v0, v1, scratch);
        break;
    }
  }

private:
  T* row(int v) const { return this->Context.image.template row<T>(v); }

  static void raise(T* row, const Span& span, T value)
  {
    for (int u = span.begin; u < span.end; ++u)
    {
      row[u] = std::max(row[u], value);
    }
  }

  /// Calls raise(v, span) for the pixels of rows [v0, v1) that show voxels [begin, end) of a row.
  template <class Raise>
  void forPixels(int begin, int end, int j, int k, int v0, int v1, Raise&& raise) const
  {
    const PathRows& path = this->Paths[k];
    for (int r = 0; r < path.count; ++r)
    {
      const PathRows::Row& row = path.rows[r];
      const int v = j - row.dj;
      if (v >= v0 && v < v1)
      {
        raise(v, common({ begin - row.iMax, end - row.iMin }, this->Context.pixels(v, k)));
      }
    }
  }

  void splatLines(int v0, int v1) const
  {
    const Span slices = slicesOf(this->Context.sliceGeometry, v0, v1);
    for (int k = slices.begin; k < slices.end; ++k)
    {
      const PathRows& path = this->Paths[k];
      for (int r = 0; r < path.count; ++r)
      {
        const PathRows::Row& row = path.rows[r];
        const int end = std::min(v1, this->Context.geometry.size().y - row.dj);
        for (int v = std::max(v0, -row.dj); v < end; ++v)
        {
          this->splatRow(row, v, k);
        }
      }
    }
  }

  void splatRow(const PathRows::Row& path, int v, int k) const
  {
    const Span pixels = this->Context.pixels(v, k);
    const LineRow<T> chains = this->Index.template row<T>(v + path.dj, k);
    T* const image = this->row(v);
    int begin = 0;
    for (std::ptrdiff_t c = 0; c < chains.count; ++c)
    {
      const int end = begin + chains.last[c] + 1;
      if (chains.values[c] > this->Floor)
      {
        raise(image, common({ begin - path.iMax, end - path.iMin }, pixels), chains.values[c]);
      }
      begin = end;
    }
  }

  /// The least of the pixels with samples; other pixels have the greatest value.
  T leastPixel(int v0, int v1) const
  {
    constexpr int most = 64;
    T minima[most]; // of tiles
    const TileLoops<T>& loops = this->Context.kernels;
    const int width = this->Context.image.width, tiles = width / TileWidth;
    T least = greatestValue<T>();
    for (int t = 0; t < tiles; t += most)
    {
      const int count = std::min(most, tiles - t);
      loops.minima(this->row(v0) + t * TileWidth, width, v1 - v0, count, minima);
      least = std::min(least, *std::min_element(minima, minima + count));
    }
    for (int v = v0; v < v1; ++v)
    {
      for (int u = tiles * TileWidth; u < width; ++u)
      {
        least = std::min(least, this->row(v)[u]);
      }
    }
    return least;
  }

  void splatSortedLines(int v0, int v1) const
  {
    const Span slices = slicesOf(this->Context.sliceGeometry, v0, v1);
    T least = this->Floor;
    for (int k = slices.begin; k < slices.end; ++k)
    {
      this->splatSortedSlice(k, v0, v1, least);
      // The first slices raise it most.
      const int walked = k + 1 - slices.begin;
      if ((walked & (walked - 1)) == 0 || walked % 16 == 0)
      {
        least = this->leastPixel(v0, v1);
      }
    }
  }

  /// Takes a slice's chains above a value.
  void splatSortedSlice(int k, int v0, int v1, T least) const
  {
    const PathRows& path = this->Paths[k];
    const auto byOffset = [](const PathRows::Row& a, const PathRows::Row& b)
    { return a.dj < b.dj; };
    const auto offsets =
      std::minmax_element(path.rows.begin(), path.rows.begin() + path.count, byOffset);
    const int jBegin = v0 + offsets.first->dj, jEnd = v1 + offsets.second->dj;
    for (std::size_t r = this->Index.runsOf(k); r < this->Index.runsOf(k + 1); ++r)
    {
      const auto run = this->Index.template run<T, SliceChain>(r);
      if (run.value <= least)
      {
        return;
      }
      const SliceChain* chain = std::lower_bound(
        run.begin, run.end, jBegin, [](const SliceChain& c, int j) { return c.j < j; });
      for (; chain < run.end && chain->j < jEnd; ++chain)
      {
        this->forPixels(chain->i, chain->i + chain->last + 1, chain->j, k, v0, v1,
          [&](int v, const Span& span) { raise(this->row(v), span, run.value); });
      }
    }
  }

  /// A pixel's first value is final. Pixels without one are linked in each row.
  void splatSortedVolume(int v0, int v1, LineScratch& scratch) const
  {
    const std::ptrdiff_t length = this->Context.image.width + 1;
    std::ptrdiff_t open = this->linkOpenPixels(v0, v1, scratch);
    const auto fill = [&](int v, const Span& span, T value)
    {
      int* const next = scratch.data() + (v - v0) * length;
      T* const image = this->row(v);
      for (int u = findOpen(next, span.begin); u < span.end; u = findOpen(next, u + 1))
      {
        image[u] = value;
        next[u] = u + 1;
        --open;
      }
    };
    for (std::size_t r = 0; r < this->Index.runsOf(1); ++r)
    {
      const auto run = this->Index.template run<T, VolumeChain>(r);
      if (run.value <= this->Floor)
      {
        return;
      }
      for (const VolumeChain* chain = run.begin; chain < run.end; ++chain)
      {
        this->forPixels(chain->i, chain->i + chain->last + 1, chain->j, chain->k, v0, v1,
          [&](int v, const Span& span)
          {
            if (!span.empty())
            {
              fill(v, span, run.value);
            }
          });
      }
      if (open == 0)
      {
        return;
      }
    }
  }

  /// Returns the number of pixels with samples.
  std::ptrdiff_t linkOpenPixels(int v0, int v1, LineScratch& scratch) const
  {
    const ShearImage& image = this->Context.image;
    const std::ptrdiff_t length = image.width + 1;
    scratch.resize((v1 - v0) * length);
    std::ptrdiff_t open = 0;
    for (int v = v0; v < v1; ++v)
    {
      int* const next = scratch.data() + (v - v0) * length;
      for (int u = 0; u < image.width; ++u)
      {
        const bool isOpen = image.covers(u, v);
        next[u] = isOpen ? u : u + 1;
        open += isOpen;
      }
      next[image.width] = image.width;
    }
    return open;
  }

  /// The first pixel from u on without a value. Halves the path for the next search.
  static int findOpen(int* next, int u)
  {
    while (next[u] != u)
    {
      next[u] = next[next[u]];
      u = next[u];
    }
    return u;
  }

  const ProjectionContext& Context;
  const LineIndex& Index;
  T Floor;
  const std::vector<PathRows>& Paths;
};
}

#endif
