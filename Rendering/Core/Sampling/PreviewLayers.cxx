// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/Carry.h"
#include "Sampling/SliceSampler.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

namespace splatting
{
namespace
{
/// The paths of all slices of a layer; from the viewer on if winners are noted.
struct PreviewLayer
{
  struct Tap
  {
    int k, t, di, dj;
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
  Window window;
  Span valid; ///< the pixels that see voxels along all paths
  Ends left, right;
  bool rimsFit = false; ///< whether a register holds a rim
  /// What Sweep says of each tap's row, ready to be handed over.
  std::array<unsigned char, MostRows> bit, slice;
  std::array<Span, MostRows> sees;
  std::array<std::int8_t, MostRows> offsets;
};
static_assert(MostRows == LayersTogether * StepsPerSlice * BrickDepth);

/// All layers of a volume; for walks that note winners also groups of layers, where these can be
/// swept: what it costs to note is paid once for all of them.
struct PreviewStorage
{
  std::vector<PreviewLayer> layers, groups;
};

/**
 * Preview mode: the voxels that rays cross, in layers of BrickDepth slices. The rows of a layer's
 * slices are read side by side: that keeps several streams through memory busy, and a pixel is
 * loaded and stored once for all of them.
 */
template <class T>
class PreviewLayers : public SliceSampler<T, T>
{
public:
  using typename SliceSampler<T, T>::Samples;

  /// `storage` outlives this, and is kept for the next frame.
  PreviewLayers(const Frame& frame, PreviewStorage& storage)
    : SliceSampler<T, T>({ false, 0, 32, TileWidth, true }),
      Shared(frame),
      Layers(storage.layers),
      Groups(storage.groups)
  {
    this->find(BrickDepth, storage.layers);
    storage.groups.clear();
    if (frame.image.keepsWinners())
    {
      this->find(this->layersTogether() * BrickDepth, storage.groups);
    }
    const auto fits = [](const Layer& group) { return group.rimsFit; };
    if (!std::all_of(storage.groups.begin(), storage.groups.end(), fits))
    {
      storage.groups.clear();
    }
  }

  Window window(int layer) const override { return this->Layers[layer].window; }

  void splat(int z, int v0, int v1, const std::vector<Span>& runs, const SliceBits& bits,
    const SliceRuns* cuts, Patch& patch) const override
  {
    this->splatLayer(this->Layers[z], v0, v1, runs, {}, { bits, cuts }, {}, patch);
  }

  void open(int, int, const Span&, Patch&) const override {}
  void splatOpened(int z, std::vector<RowRuns>& rows, int count, Patch& patch) const override
  {
    for (int r = 0, end = 0; r < count; r = end)
    {
      // Rows go together for long streams through memory: those without cuts, and those with bits,
      // which say what counts between the first run and the last.
      RowRuns& first = rows[r];
      for (end = r + 1; end < count && goTogether(first, rows[end]); ++end)
      {
        if (first.bits.origin)
        {
          first.runs.front().begin =
            std::min(first.runs.front().begin, rows[end].runs.front().begin);
          first.runs.back().end = std::max(first.runs.back().end, rows[end].runs.back().end);
          first.whole = common(first.whole, rows[end].whole);
        }
      }
      if (first.runs.empty())
      {
        continue;
      }
      if (first.bits.origin)
      {
        first.runs.assign(1, { first.runs.front().begin, first.runs.back().end });
      }
      this->splatLayer(this->Layers[z], first.v0, rows[end - 1].v1, first.runs, {},
        { first.bits, nullptr }, first.whole, patch);
    }
  }

  void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns, Patch&,
    const Samples& f) const override
  {
    for (int n = 0; n < slices.end - slices.begin; ++n)
    {
      const int k = reversed ? slices.end - 1 - n : slices.begin + n;
      const SliceGeometry& slice = this->Shared.sliceGeometry[k];
      for (int v = std::max(v0, slice.vBegin); v < std::min(v1, slice.vEnd); ++v)
      {
        this->forVoxels(k, v, common(columns, this->Shared.pixels(v, k)), reversed,
          [&](int t, const Span& pixels, const T* voxels)
          { f(StepsPerSlice * k + t, v, pixels, voxels, nullptr); });
      }
    }
  }

  /// In the order of memory: slice after slice, or, where rows of all slices lie side by side, a
  /// few rows through all of them.
  void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all,
    const SliceRuns* cuts, Patch& patch) const override
  {
    const RowCuts by{ {}, cuts };
    const Slices& slices = this->Shared.slices;
    const bool slicesFirst = slices.rowStride <= slices.sliceStride;
    const int height = slicesFirst ? v1 - v0 : 2 * BrickHeight;
    Reading reading;
    if (!slicesFirst)
    {
      // Long rows that lie side by side in a page of memory are read one after the other.
      const bool longRows = slices.sliceStride * std::ptrdiff_t(sizeof(T)) >= 1024;
      reading.sideBySide = longRows ? 1 : BrickDepth;
      reading.ahead = reading.sideBySide * this->step();
    }
    const bool grouped = !this->Groups.empty();
    const int together = this->layersTogether();
    const Span some =
      grouped ? Span{ layers.begin / together, (layers.end + together - 1) / together } : layers;
    for (int v = v0; v < v1; v += height)
    {
      for (int n = 0; n < some.end - some.begin; ++n)
      {
        const int z = this->Shared.nth(some, n), end = std::min(v + height, v1);
        grouped ? this->splatGroup(z, v, end, all, by, patch)
                : this->splatLayer(this->Layers[z], v, end, all, reading, by, {}, patch);
      }
    }
  }

  T floor() const override { return previewFloor<T>(this->Shared); }

  void finish(int, int) const override {}

private:
  using Layer = PreviewLayer;

  /// Which slices count for the pixels of some rows, by bits or by runs: all of them without.
  struct RowCuts
  {
    SliceBits bits;
    const SliceRuns* runs = nullptr;
  };

  /// In which order the rows of slices are read.
  struct Reading
  {
    int sideBySide = BrickDepth; ///< slices at a time
    int ahead = 0;               ///< to those that come next, if that is known
  };

  struct Runs
  {
    const Span* first;
    int count;
  };
  static Runs all(const std::vector<Span>& runs)
  {
    return { runs.data(), static_cast<int>(runs.size()) };
  }

  /// Whether so many pixels, all of whose samples count, are worth a sweep without bits.
  static bool isLong(const Span& whole) { return whole.end - whole.begin >= 64; }

  /// Whether rows are alike, and a long whole run remains one.
  static bool goTogether(const RowRuns& a, const RowRuns& b)
  {
    const bool isOne = isLong(common(a.whole, b.whole));
    return !a.bits.origin == !b.bits.origin && a.runs.empty() == b.runs.empty() &&
      isLong(a.whole) == isOne && isLong(b.whole) == isOne;
  }

  ShearImage& image() const { return this->Shared.image; }

  /// From one slice to the next.
  int step() const { return this->Shared.nth({ 0, 2 }, 1) - this->Shared.nth({ 0, 2 }, 0); }

  /// @param whole  pixels of a single run for which all bits are set
  void splatLayer(const Layer& layer, int v0, int v1, const std::vector<Span>& runs,
    const Reading& reading, const RowCuts& cuts, const Span& whole, Patch& patch) const
  {
    const Span plain = this->plainRows(layer, v0, v1);
    this->splatSlices(layer.slices, v0, plain.begin, runs, cuts, patch);
    if (!plain.empty())
    {
      const Span inner = common(whole, layer.valid); // rims have pixels beside it
      isLong(inner) ? this->sweepAround(layer, plain, runs.front(), reading, cuts, inner)
                    : this->sweep(layer, plain, all(runs), everything(), reading, cuts);
    }
    this->splatSlices(layer.slices, plain.end, v1, runs, cuts, patch);
  }

  /// A run by parts: pixels in the middle of which all samples count, and, by bits, the others.
  void sweepAround(const Layer& layer, const Span& rows, const Span& run, const Reading& reading,
    const RowCuts& cuts, const Span& whole) const
  {
    this->sweep(layer, rows, { &whole, 1 }, whole, reading, {});
    const Span sides[2] = { { run.begin, whole.begin }, { whole.end, run.end } };
    for (const Span& side : sides)
    {
      if (!side.empty())
      {
        this->sweep(layer, rows, { &side, 1 }, everything(), reading, cuts);
      }
    }
  }

  /// The rows of pixels, of some, whose voxels all exist in a layer, and beside which there are
  /// others: a rim reads a few voxels beyond its row.
  Span plainRows(const Layer& layer, int v0, int v1) const
  {
    const bool plain = layer.rimsFit && !this->Shared.range.special;
    const int first = plain ? std::clamp(1 - layer.window.jMin, v0, v1) : v1;
    const int last = this->Shared.geometry.size().y - 1 - layer.window.jMax;
    return { first, std::clamp(last, first, v1) };
  }

  void splatGroup(
    int z, int v0, int v1, const std::vector<Span>& runs, const RowCuts& cuts, Patch& patch) const
  {
    const Layer& group = this->Groups[z];
    const Span plain = this->plainRows(group, v0, v1);
    const auto splatEach = [&](int begin, int end)
    {
      const int together = this->layersTogether();
      const Span own{ together * z,
        std::min(together * (z + 1), static_cast<int>(this->Layers.size())) };
      for (int n = 0; n < own.end - own.begin && begin < end; ++n)
      {
        const Layer& layer = this->Layers[this->Shared.nth(own, n)];
        this->splatLayer(layer, begin, end, runs, {}, cuts, {}, patch);
      }
    };
    splatEach(v0, plain.begin);
    if (!plain.empty())
    {
      this->sweep(
        group, plain, all(runs), everything(), { this->layersTogether() * BrickDepth }, cuts);
    }
    splatEach(plain.end, v1);
  }

  /// Large slices are read from memory, which does not like too many rows side by side.
  int layersTogether() const { return this->isSmall() ? LayersTogether : 2; }

  /// Whether caches rather than memory set the pace. Then asking whether any pixel wins costs more
  /// than noting it, as answers are hard to foretell.
  bool isSmall() const
  {
    constexpr std::size_t slice = 128 * 1024;
    const glm::ivec3& size = this->Shared.geometry.size();
    return sizeof(T) * size.x * size.y <= slice;
  }

  /// Layers of so many slices.
  void find(int depth, std::vector<Layer>& layers) const
  {
    const glm::ivec3& size = this->Shared.geometry.size();
    layers.resize((size.z + depth - 1) / depth);
    for (Layer& layer : layers)
    {
      layer.tapCount = 0;
      layer.window = {};
    }
    const bool fromLast = this->Shared.image.keepsWinners() && this->Shared.geometry.reversed();
    for (int n = 0; n < size.z; ++n)
    {
      const int k = fromLast ? size.z - 1 - n : n;
      Layer& layer = layers[k / depth];
      layer.slices = { k / depth * depth, std::min((k / depth + 1) * depth, size.z) };
      const RayPath& path = this->Shared.sliceGeometry[k].path;
      for (int m = 0; m < path.count; ++m)
      {
        const int t = fromLast ? path.count - 1 - m : m;
        layer.taps[layer.tapCount++] = { k, t, path.di[t], path.dj[t] };
        layer.window.add(path.di[t], path.dj[t]);
      }
    }
    for (Layer& layer : layers)
    {
      this->findRims(layer);
      this->findRows(layer);
    }
  }

  void findRows(Layer& layer) const
  {
    const int order = layer.tapCount > 0 ? this->orderOf(layer) : 0;
    for (int t = 0; t < layer.tapCount; ++t)
    {
      const Layer::Tap& tap = layer.taps[t];
      layer.bit[t] = static_cast<unsigned char>(1u << tap.k % BrickDepth);
      layer.slice[t] = static_cast<unsigned char>(tap.k - layer.slices.begin);
      layer.sees[t] = { -tap.di, this->Shared.geometry.size().x - tap.di };
      layer.offsets[t] =
        static_cast<std::int8_t>(this->Shared.orderOfStep(StepsPerSlice * tap.k + tap.t) - order);
    }
  }

  std::int16_t orderOf(const Layer& layer) const
  {
    return this->Shared.nearestOrder(layer.taps[0].k / BrickDepth);
  }

  void findRims(Layer& layer) const
  {
    const ShearImage& image = this->Shared.image;
    const int width = this->Shared.geometry.size().x;
    const VoxelLoops<T>& loops = this->Shared.kernels;
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

  static constexpr Span everything()
  {
    return { std::numeric_limits<int>::min(), std::numeric_limits<int>::max() };
  }

  /// Rows whose rays stay in the layer's rows of voxels; they may leave its columns. Besides the
  /// runs other pixels within the `limits` may be swept.
  void sweep(const Layer& layer, const Span& rows, const Runs& runs, const Span& limits,
    const Reading& reading, const RowCuts& cuts) const
  {
    for (int first = 0, end = 0; first < layer.tapCount; first = end)
    {
      while (end < layer.tapCount &&
        std::abs(layer.taps[end].k - layer.taps[first].k) < reading.sideBySide)
      {
        ++end;
      }
      this->sweepTaps(layer, first, end, rows, runs, limits, reading.ahead, cuts);
    }
  }

  void sweepTaps(const Layer& layer, int firstTap, int endTap, const Span& rows, const Runs& runs,
    const Span& limits, int slicesAhead, const RowCuts& cuts) const
  {
    const int v0 = rows.begin;
    Sweep<T> sweep;
    sweep.bits = cuts.bits.origin ? cuts.bits.at(0, v0) : nullptr;
    sweep.bitsStride = cuts.bits.stride;
    sweep.sliceRuns = cuts.runs ? &cuts.runs->at(layer.slices.begin, v0) : nullptr;
    sweep.sliceRunsStride = cuts.runs ? cuts.runs->stride() : 0;
    sweep.imageStride = this->Shared.image.width;
    sweep.image = this->image().template row<T>(v0);
    sweep.noting.notes = this->Shared.orders ? this->Shared.ordersOfRow(v0) : nullptr;
    sweep.noting.order = this->orderOf(layer);
    sweep.noting.nearestFirst = this->Shared.nearestFirst;
    sweep.height = rows.end - v0;
    sweep.count = endTap - firstTap;
    sweep.bit = layer.bit.data() + firstTap;
    sweep.slice = layer.slice.data() + firstTap;
    sweep.sees = layer.sees.data() + firstTap;
    sweep.offsets = layer.offsets.data() + firstTap;
    const Slices& slices = this->Shared.slices;
    sweep.rowStride = slices.rowStride;
    // Runs that end anywhere are not foreseen. What lies in caches may be fetched in vain.
    const bool isWhole = runs.first->end - runs.first->begin == this->Shared.image.width;
    const bool fetchesWhole = cuts.runs && this->isSmall() && isWhole;
    const bool jumps = cuts.runs || slices.rowStride > slices.sliceStride;
    sweep.ahead = fetchesWhole ? 0
      : slicesAhead != 0       ? this->distance(layer.taps[firstTap], slicesAhead)
      : jumps                  ? slices.rowStride
                               : 0;
    sweep.wholeAhead = fetchesWhole ? 2 * slices.rowStride : 0;
    sweep.winsOften = this->isSmall() || !this->Shared.nearestFirst;
    for (int t = firstTap; t < endTap; ++t)
    {
      const Layer::Tap& tap = layer.taps[t];
      sweep.rows[t - firstTap] = this->Shared.template voxelRow<T>(v0 + tap.dj, tap.k) + tap.di;
    }
    sweep.runs = runs.first;
    sweep.runCount = runs.count;
    // Pixels that see voxels along all paths, which all do that see any if paths shift alike.
    const bool shiftAlike = std::all_of(layer.taps.begin() + firstTap, layer.taps.begin() + endTap,
      [&](const Layer::Tap& tap) { return tap.di == layer.taps[firstTap].di; });
    sweep.valid = common(limits, shiftAlike ? layer.sees[firstTap] : layer.valid);
    sweep.rimCount = 0;
    if (!shiftAlike && !cuts.runs)
    {
      if (runs.first->begin < layer.valid.begin)
      {
        sweep.rims[sweep.rimCount++] = rimOf(layer.left, firstTap);
      }
      if (runs.first[runs.count - 1].end > layer.valid.end)
      {
        sweep.rims[sweep.rimCount++] = rimOf(layer.right, firstTap);
      }
    }
    const VoxelLoops<T>& loops = this->Shared.kernels;
    loops.sweep(sweep);
  }

  /// From a row of voxels to the one that the same pixels see first in another slice.
  std::ptrdiff_t distance(const Layer::Tap& tap, int slices) const
  {
    const int last = this->Shared.geometry.size().z - 1, k = std::clamp(tap.k + slices, 0, last);
    const RayPath& path = this->Shared.sliceGeometry[k].path;
    return (k - tap.k) * this->Shared.slices.sliceStride +
      (path.dj[0] - tap.dj) * this->Shared.slices.rowStride + path.di[0] - tap.di;
  }

  static Rim rimOf(const Layer::Ends& ends, int firstTap)
  {
    return { ends.first, ends.begin.data() + firstTap, ends.end.data() + firstTap };
  }

  /// Any rows, slice by slice.
  void splatSlices(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const RowCuts& cuts, Patch& patch) const
  {
    for (int k = slices.begin; k < slices.end && v0 < v1; ++k)
    {
      const SliceGeometry& slice = this->Shared.sliceGeometry[k];
      for (int v = std::max(v0, slice.vBegin); v < std::min(v1, slice.vEnd); ++v)
      {
        for (const Span& run : runs)
        {
          const Span pixels = common(run, this->Shared.pixels(v, k));
          const Span span = cuts.runs ? common(pixels, cuts.runs->at(k, v)) : pixels;
          this->Shared.orders ? this->noteSlice(k, v, span, cuts)
                              : this->splatSlice(k, v, span, cuts, patch);
        }
      }
    }
  }

  void splatSlice(int k, int v, const Span& span, const RowCuts& cuts, Patch& patch) const
  {
    const unsigned char* mask = nullptr;
    if (cuts.bits.origin && !span.empty())
    {
      patch.worksheet.resize(this->image().width);
      const unsigned char bit = static_cast<unsigned char>(1u << k % BrickDepth);
      std::transform(cuts.bits.at(span.begin, v), cuts.bits.at(span.end, v),
        patch.worksheet.data() + span.begin,
        [bit](unsigned char b) { return static_cast<unsigned char>(b & bit); });
      mask = patch.worksheet.data();
    }
    T* const row = this->image().template row<T>(v);
    this->forVoxels(k, v, span, false,
      [&](int, const Span& pixels, const T* voxels)
      {
        T* const image = row + pixels.begin;
        const std::ptrdiff_t n = pixels.end - pixels.begin;
        if (mask || this->Shared.range.special)
        {
          const RayLoops<T>& loops = this->Shared.kernels;
          loops.raise(image, voxels, mask ? mask + pixels.begin : nullptr, n);
        }
        else
        {
          const VoxelLoops<T>& loops = this->Shared.kernels;
          loops.maximum(image, &voxels, 1, n);
        }
      });
  }

  void noteSlice(int k, int v, const Span& span, const RowCuts& cuts) const
  {
    const RayLoops<T>& loops = this->Shared.kernels;
    this->forVoxels(k, v, span, false,
      [&](int t, const Span& pixels, const T* voxels)
      {
        const int order = this->Shared.orderOfStep(StepsPerSlice * k + t);
        loops.raiseNoting(this->image().template row<T>(v) + pixels.begin,
          this->Shared.ordersOfRow(v) + pixels.begin, static_cast<std::int16_t>(order), voxels,
          cuts.bits.origin ? cuts.bits.at(pixels.begin, v) : nullptr,
          static_cast<unsigned char>(1u << k % BrickDepth), pixels.end - pixels.begin);
      });
  }

  /// Calls f(t, pixels, voxels) for each step of the rays' path in slice k.
  template <class F>
  void forVoxels(int k, int v, const Span& span, bool reversed, F&& f) const
  {
    const RayPath& path = this->Shared.sliceGeometry[k].path;
    const glm::ivec3& size = this->Shared.geometry.size();
    for (int n = 0; n < path.count; ++n)
    {
      const int t = reversed ? path.count - 1 - n : n;
      const int j = v + path.dj[t];
      const Span pixels = common(span, { -path.di[t], size.x - path.di[t] });
      if (j >= 0 && j < size.y && !pixels.empty())
      {
        f(t, pixels, this->Shared.template voxelRow<T>(j, k) + path.di[t] + pixels.begin);
      }
    }
  }

  const Frame& Shared;
  const std::vector<Layer>& Layers;
  const std::vector<Layer>& Groups; ///< none if they are not to be used
};

class PreviewMode : public ProjectionMode
{
public:
  void project(Frame& frame) override
  {
    dispatch(frame.index.volume().type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        walk(frame, PreviewLayers<T>(frame, this->Layers));
      });
  }

  void carry(const Carrying& c) const override
  {
    dispatch(c.other.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        carryValues<T>(c,
          [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
          { return carriedVoxel(voxels, c.slices[step / StepsPerSlice].path, u, v, step); });
      });
  }

private:
  PreviewStorage Layers;
};
}

std::unique_ptr<ProjectionMode> makePreview()
{
  return std::make_unique<PreviewMode>();
}
}
