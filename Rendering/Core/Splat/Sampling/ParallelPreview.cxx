// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/ValuesAtLocations.h"
#include "Splat/Walks/SliceSampler.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

namespace splatting
{
namespace
{
/// The paths of all slices of a layer.
struct PreviewLayer
{
  struct Tap
  {
    int k, di, dj;
  };
  /// See Rim.
  struct Ends
  {
    int first;
    std::array<int, MostRows> begin, end;
  };
  Span slices;
  std::array<Tap, MostRows> taps;
  int tapCount = 0;
  VoxelWindow window;
  Span valid; ///< the pixels with voxels on all paths
  Ends left, right;
  bool rimsFit = false; ///< whether a register holds a rim
};
static_assert(MostRows == StepsPerSlice * BrickDepth);

/**
 * Preview mode: the voxels that rays cross, in layers of BrickDepth slices. The rows of a layer's
 * slices are read side by side. Several memory streams keep the processor busy, and a pixel is
 * loaded and stored once for all of them.
 */
template <class T>
class ParallelPreview : public SliceSampler<T, T>
{
public:
  using typename SliceSampler<T, T>::Samples;

  /// @param storage  outlives this, and is reused by the next frame
  ParallelPreview(const ProjectionContext& context, std::vector<PreviewLayer>& storage)
    : SliceSampler<T, T>({ false, 0, TileWidth }),
      Context(context),
      Layers(storage)
  {
    this->findLayers(storage);
  }

  VoxelWindow window(int layer) const override { return this->Layers[layer].window; }

  void splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const PixelRows<T>& pixels, LoadedVoxels&) const override
  {
    const int step = pixels.sliceStride != 0 ? 1 : slices.end - slices.begin;
    for (int k = slices.begin; k < slices.end; k += step)
    {
      this->splatSome({ k, k + step }, v0, v1, runs, pixels.slice(k - slices.begin), {});
    }
  }

  void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    LoadedVoxels&, const Samples& f) const override
  {
    this->forRows(slices, reversed, v0, v1, columns,
      [&](int k, int v, const Span& span)
      {
        this->forVoxels(k, v, span, reversed,
          [&](int t, const Span& pixels, const T* voxels)
          { f(StepsPerSlice * k + t, v, pixels, voxels, nullptr); });
      });
  }

  /// In memory order: slice by slice or, if rows of all slices are adjacent, a few rows through all
  /// of them.
  void splatAll(
    const Span& layers, int v0, int v1, const std::vector<Span>& all, LoadedVoxels&) const override
  {
    const PixelRows<T> image = pixelsOf<T>(this->Context.image);
    const Slices& slices = this->Context.slices;
    const bool slicesFirst = slices.rowStride <= slices.sliceStride;
    const int height = slicesFirst ? v1 - v0 : 2 * BrickHeight;
    Reading reading;
    if (!slicesFirst)
    {
      // Long adjacent rows in a memory page are read one after the other.
      const bool longRows = slices.sliceStride * std::ptrdiff_t(sizeof(T)) >= 1024;
      reading.sideBySide = longRows ? 1 : BrickDepth;
      reading.ahead = reading.sideBySide;
    }
    for (int v = v0; v < v1; v += height)
    {
      for (int z = layers.begin; z < layers.end; ++z)
      {
        this->splatSome(this->Layers[z].slices, v, std::min(v + height, v1), all, image, reading);
      }
    }
  }

  T floor() const override { return previewFloor<T>(this->Context); }

  void finish(int, int) const override {}

private:
  using Layer = PreviewLayer;

  /// The order of the rows of slices.
  struct Reading
  {
    int sideBySide = BrickDepth; ///< slices at a time
    int ahead = 0;               ///< to the next ones, if known
  };

  /// For slices of one layer.
  void splatSome(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const PixelRows<T>& pixels, const Reading& reading) const
  {
    const Layer& layer = this->Layers[slices.begin / BrickDepth];
    const Span plain = this->plainRows(layer, v0, v1);
    this->splatSlices(slices, v0, plain.begin, runs, pixels);
    if (!plain.empty())
    {
      this->sweep(layer, slices, plain, runs, pixels, reading);
    }
    this->splatSlices(slices, plain.end, v1, runs, pixels);
  }

  /// The rows of pixels, out of some, whose voxels all exist in a layer, with further rows beside
  /// them, because a rim reads a few voxels beyond its row.
  Span plainRows(const Layer& layer, int v0, int v1) const
  {
    const int first = layer.rimsFit ? std::clamp(1 - layer.window.jMin, v0, v1) : v1;
    const int last = this->Context.geometry.size().y - 1 - layer.window.jMax;
    return { first, std::clamp(last, first, v1) };
  }

  void findLayers(std::vector<Layer>& layers) const
  {
    const int depth = this->Context.geometry.size().z;
    layers.resize((depth + BrickDepth - 1) / BrickDepth);
    for (Layer& layer : layers)
    {
      layer.tapCount = 0;
      layer.window = {};
    }
    for (int k = 0; k < depth; ++k)
    {
      Layer& layer = layers[k / BrickDepth];
      layer.slices = slicesOfLayer(k / BrickDepth, this->Context.geometry.size());
      const RayPath& path = this->Context.sliceGeometry[k].path;
      for (int t = 0; t < path.count; ++t)
      {
        layer.taps[layer.tapCount++] = { k, path.di[t], path.dj[t] };
        layer.window.add(path.di[t], path.dj[t]);
      }
    }
    for (Layer& layer : layers)
    {
      this->findRims(layer);
    }
  }

  void findRims(Layer& layer) const
  {
    const ShearImage& image = this->Context.image;
    const int width = this->Context.geometry.size().x;
    const VoxelLoops<T>& loops = this->Context.kernels;
    const int lanes = static_cast<int>(loops.lanes);
    const Span any{ -layer.window.iMax, width - layer.window.iMin };
    layer.valid = { -layer.window.iMin, width - layer.window.iMax };
    layer.rimsFit = width >= lanes && image.width >= lanes &&
      layer.valid.begin - any.begin <= lanes && any.end - layer.valid.end <= lanes &&
      !layer.valid.empty();
    layer.left.first = std::min(any.begin, image.width - lanes);
    layer.right.first = std::max(any.end - lanes, 0);
    for (int t = 0; t < layer.tapCount; ++t)
    {
      const Span sees{ -layer.taps[t].di, width - layer.taps[t].di };
      const Span left = common(sees, { any.begin, layer.valid.begin });
      const Span right = common(sees, { layer.valid.end, any.end });
      layer.left.begin[t] = left.begin - layer.left.first;
      layer.left.end[t] = left.end - layer.left.first;
      layer.right.begin[t] = right.begin - layer.right.first;
      layer.right.end[t] = right.end - layer.right.first;
    }
  }

  /// For rows whose rays stay in the layer's rows of voxels; they may leave its columns.
  void sweep(const Layer& layer, const Span& slices, const Span& rows,
    const std::vector<Span>& runs, const PixelRows<T>& pixels, const Reading& reading) const
  {
    int first = 0;
    while (first < layer.tapCount && layer.taps[first].k < slices.begin)
    {
      ++first;
    }
    while (first < layer.tapCount && layer.taps[first].k < slices.end)
    {
      const int last = std::min(layer.taps[first].k + reading.sideBySide, slices.end);
      int end = first;
      while (end < layer.tapCount && layer.taps[end].k < last)
      {
        ++end;
      }
      this->sweepTaps(layer, first, end, rows, runs, pixels, reading.ahead);
      first = end;
    }
  }

  void sweepTaps(const Layer& layer, int firstTap, int endTap, const Span& rows,
    const std::vector<Span>& runs, const PixelRows<T>& pixels, int slicesAhead) const
  {
    const int v0 = rows.begin;
    Sweep<T> sweep;
    sweep.imageStride = pixels.stride;
    sweep.image = pixels.at(0, v0);
    sweep.height = rows.end - v0;
    sweep.count = endTap - firstTap;
    const Slices& slices = this->Context.slices;
    sweep.rowStride = slices.rowStride;
    sweep.ahead = slicesAhead != 0            ? this->distance(layer.taps[firstTap], slicesAhead)
      : slices.rowStride > slices.sliceStride ? slices.rowStride
                                              : 0;
    for (int t = firstTap; t < endTap; ++t)
    {
      const Layer::Tap& tap = layer.taps[t];
      sweep.rows[t - firstTap] = this->Context.template voxelRow<T>(v0 + tap.dj, tap.k) + tap.di;
    }
    sweep.runs = runs.data();
    sweep.runCount = static_cast<int>(runs.size());
    // Pixels with voxels on all paths: all that have any if paths shift alike.
    const Layer::Tap& one = layer.taps[firstTap];
    const bool shiftAlike = std::all_of(layer.taps.begin() + firstTap, layer.taps.begin() + endTap,
      [&](const Layer::Tap& tap) { return tap.di == one.di; });
    const Span sees{ -one.di, this->Context.geometry.size().x - one.di };
    sweep.valid = shiftAlike ? sees : layer.valid;
    sweep.rimCount = 0;
    if (!shiftAlike)
    {
      if (runs.front().begin < layer.valid.begin)
      {
        sweep.rims[sweep.rimCount++] = rimOf(layer.left, firstTap);
      }
      if (runs.back().end > layer.valid.end)
      {
        sweep.rims[sweep.rimCount++] = rimOf(layer.right, firstTap);
      }
    }
    const VoxelLoops<T>& loops = this->Context.kernels;
    loops.sweep(sweep);
  }

  /// The distance from a row of voxels to the first one of the same pixels in another slice.
  std::ptrdiff_t distance(const Layer::Tap& tap, int slices) const
  {
    const int last = this->Context.geometry.size().z - 1, k = std::clamp(tap.k + slices, 0, last);
    const RayPath& path = this->Context.sliceGeometry[k].path;
    return (k - tap.k) * this->Context.slices.sliceStride +
      (path.dj[0] - tap.dj) * this->Context.slices.rowStride + path.di[0] - tap.di;
  }

  static Rim rimOf(const Layer::Ends& ends, int firstTap)
  {
    return { ends.first, ends.begin.data() + firstTap, ends.end.data() + firstTap };
  }

  /// For any rows, slice by slice.
  void splatSlices(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const PixelRows<T>& pixels) const
  {
    for (const Span& run : runs)
    {
      this->forRows(slices, false, v0, v1, run,
        [&](int k, int v, const Span& span) { this->splatRow(k, v, span, pixels.at(0, v)); });
    }
  }

  void splatRow(int k, int v, const Span& span, T* row) const
  {
    const VoxelLoops<T>& loops = this->Context.kernels;
    this->forVoxels(k, v, span, false,
      [&](int, const Span& pixels, const T* voxels)
      { loops.maximum(row + pixels.begin, &voxels, 1, pixels.end - pixels.begin); });
  }

  /// Calls f(k, v, span) for the rows and columns of pixels whose rays cross some slices.
  template <class F>
  void forRows(const Span& slices, bool reversed, int v0, int v1, const Span& columns, F&& f) const
  {
    for (int n = 0; n < slices.end - slices.begin && v0 < v1; ++n)
    {
      const int k = reversed ? slices.end - 1 - n : slices.begin + n;
      const SliceGeometry& slice = this->Context.sliceGeometry[k];
      for (int v = std::max(v0, slice.vBegin); v < std::min(v1, slice.vEnd); ++v)
      {
        const Span span = common(columns, slice.span(v));
        if (!span.empty())
        {
          f(k, v, span);
        }
      }
    }
  }

  /// Calls f(t, pixels, voxels) for each step of the rays' path in slice k.
  template <class F>
  void forVoxels(int k, int v, const Span& span, bool reversed, F&& f) const
  {
    const RayPath& path = this->Context.sliceGeometry[k].path;
    const glm::ivec3& size = this->Context.geometry.size();
    for (int n = 0; n < path.count; ++n)
    {
      const int t = reversed ? path.count - 1 - n : n;
      const int j = v + path.dj[t];
      const Span pixels = common(span, { -path.di[t], size.x - path.di[t] });
      if (j >= 0 && j < size.y && !pixels.empty())
      {
        f(t, pixels, this->Context.template voxelRow<T>(j, k) + path.di[t] + pixels.begin);
      }
    }
  }

  const ProjectionContext& Context;
  const std::vector<Layer>& Layers;
};

template <class A>
class PreviewSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    walk(context, ParallelPreview<T>(context, this->Layers));
  }
  template <class T>
  void takeAtLocations(const AtWinners& winners) const
  {
    fillAtWinners<T>(winners,
      [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
      { return voxelAtWinner(voxels, winners.slices[step / StepsPerSlice].path, u, v, step); });
  }

private:
  std::vector<PreviewLayer> Layers;
};
}

std::unique_ptr<ProjectionMode> makePreview()
{
  return std::make_unique<TypedMode<PreviewSpace>>();
}
}
