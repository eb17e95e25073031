// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Project.h"

#include <vtkSMPThreadLocal.h>
#include <vtkSMPTools.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

namespace splatting
{
namespace
{
/// Rows of a band. Its part of the image and of three slices stays in the second-level cache.
constexpr int BandHeight = 16;
/// Voxels repeated beyond both ends of a row: a footprint reaches three voxels out.
constexpr int Pad = 4;

/// One slice as seen by all pixels.
struct SliceGeometry
{
  RayPath path;
  int vBegin, vEnd; // image rows whose rays cross the slice
};

/// The part of a footprint that lies in one slice: the rectangle around its taps.
template <class A>
struct FootprintPart
{
  int slice;  // -1, 0 or 1
  int di, dj; // the first column and row
  int columns, rows;
  std::array<A, 25> weights; // row after row, zero where there is no tap
};

/// The footprint of one slice, with weights of the accumulator's type.
template <class A>
struct SliceFootprint
{
  glm::ivec2 nearest; // pixel minus voxel, for the voxel nearest to a pixel
  Taps taps;
  std::array<A, 75> weights; // of the taps
  std::array<FootprintPart<A>, 3> parts;
  int partCount = 0;
};

/// The part of slice c; without columns if no tap lies there.
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

/// Rows of up to three slices, widened to the accumulator's type. What footprints read beyond the
/// volume repeats its outermost voxels.
struct RowCache
{
  std::vector<unsigned char> bytes;
  std::ptrdiff_t rowLength = 0;
  int rowsPerSlice = 0;
  int first[3]; // the row of the volume (or beyond) that the slot begins with
  template <class A>
  A* row(int slice, int j)
  {
    const int slot = slice % 3;
    return reinterpret_cast<A*>(this->bytes.data()) +
      (std::ptrdiff_t(slot) * this->rowsPerSlice + (j - this->first[slot])) * this->rowLength + Pad;
  }
};

template <class T>
constexpr T emptyPixel(bool special)
{
  using Limits = std::numeric_limits<T>;
  return Limits::has_infinity ? (special ? Limits::quiet_NaN() : -Limits::infinity())
                              : Limits::lowest();
}

/// What all bands of one projection share.
template <class T>
struct Frame
{
  const ShearWarp& geometry;
  const Kernels& kernels;
  Slices slices;
  const std::vector<SliceGeometry>& sliceGeometry;
  const std::vector<glm::dvec4>& halfSpaces; // in pixels
  ShearImage& image;

  const T* voxelRow(int j, int k) const
  {
    return static_cast<const T*>(this->slices.voxels) + j * this->slices.rowStride +
      k * this->slices.sliceStride;
  }

  /// The pixels of row v that slice k counts for; they are noted in the image.
  Span pixels(int v, int k) const
  {
    Span span = this->geometry.coverage(this->sliceGeometry[k].path, v);
    if (!span.empty())
    {
      Span& all = this->image.spans[v];
      all.begin = std::min(all.begin, span.begin);
      all.end = std::max(all.end, span.end);
    }
    if (!this->halfSpaces.empty())
    {
      span = ShearWarp::clipped(span, v, k, this->halfSpaces);
      if (!span.empty())
      {
        unsigned char* mask = &this->image.mask[std::ptrdiff_t(v) * this->image.width];
        std::fill(mask + span.begin, mask + span.end, static_cast<unsigned char>(1));
      }
    }
    return span;
  }
};

/// The slices that rows [v0, v1) meet: a range, because the stack only moves one way.
Span slicesOf(const std::vector<SliceGeometry>& slices, int v0, int v1)
{
  const auto meets = [=](const SliceGeometry& s) { return s.vBegin < v1 && s.vEnd > v0; };
  const auto first = std::find_if(slices.begin(), slices.end(), meets);
  const auto last = std::find_if(slices.rbegin(), slices.rend(), meets).base();
  return { static_cast<int>(first - slices.begin()),
    static_cast<int>(std::max(first, last) - slices.begin()) };
}

/// Slice k of row v in preview mode: the voxels on the ray path, as far as they exist.
template <class T>
void previewRow(const Frame<T>& frame, int v, int k)
{
  const Span span = frame.pixels(v, k);
  if (span.empty())
  {
    return;
  }
  const RayPath& path = frame.sliceGeometry[k].path;
  const glm::ivec3& size = frame.geometry.size();
  const VoxelLoops<T>& loops = frame.kernels;
  const auto maximum = frame.image.special ? loops.maximumValid : loops.maximum;
  T* const image = frame.image.template row<T>(v);
  // The paths' voxels are different columns: all of them exist for most pixels, at the rim some.
  const T* rows[3];
  Span ranges[3];
  Span all = span;
  int count = 0;
  for (int t = 0; t < path.count; ++t)
  {
    const int j = v + path.dj[t];
    if (j >= 0 && j < size.y)
    {
      rows[count] = frame.voxelRow(j, k) + path.di[t];
      ranges[count] = { std::max(span.begin, -path.di[t]),
        std::min(span.end, size.x - path.di[t]) };
      all.begin = std::max(all.begin, ranges[count].begin);
      all.end = std::min(all.end, ranges[count].end);
      ++count;
    }
  }
  if (all.empty())
  {
    all = { span.end, span.end };
  }
  const T* shifted[3];
  for (int t = 0; t < count; ++t)
  {
    const auto part = [&](int begin, int end)
    {
      if (begin < end)
      {
        shifted[0] = rows[t] + begin;
        maximum(image + begin, shifted, 1, end - begin);
      }
    };
    part(ranges[t].begin, std::min(all.begin, ranges[t].end));
    part(std::max(all.end, ranges[t].begin), ranges[t].end);
  }
  if (!all.empty())
  {
    for (int t = 0; t < count; ++t)
    {
      shifted[t] = rows[t] + all.begin;
    }
    maximum(image + all.begin, shifted, count, all.end - all.begin);
  }
}

template <class T>
void previewBand(const Frame<T>& frame, int v0, int v1)
{
  const Span slices = slicesOf(frame.sliceGeometry, v0, v1);
  for (int k = slices.begin; k < slices.end; ++k)
  {
    const SliceGeometry& slice = frame.sliceGeometry[k];
    for (int v = std::max(v0, slice.vBegin); v < std::min(v1, slice.vEnd); ++v)
    {
      previewRow(frame, v, k);
    }
  }
}

/// A band in standard and high mode: `reach` slices and 1 + reach rows beyond.
template <class T>
class WorksheetBand
{
public:
  using A = Accumulator<T>;

  WorksheetBand(const Frame<T>& frame, const std::vector<SliceFootprint<A>>& footprints, int reach,
    const VolumeIndex::Range& range, RowCache& cache, int v0, int v1)
    : Shared(frame),
      Footprints(footprints),
      Reach(reach),
      ValueRange(range),
      Cache(cache),
      V0(v0),
      V1(v1)
  {
    cache.rowLength = frame.geometry.size().x + 2 * Pad;
    cache.rowsPerSlice = v1 - v0 + 2 * (1 + reach) + 2;
    const std::size_t bytes = std::size_t(3) * cache.rowsPerSlice * cache.rowLength * sizeof(A);
    if (cache.bytes.size() < bytes)
    {
      cache.bytes.resize(bytes);
    }
  }

  void splat()
  {
    const Span slices = slicesOf(this->Shared.sliceGeometry, this->V0, this->V1);
    const int last = this->Shared.geometry.size().z - 1;
    int loaded = std::max(slices.begin - this->Reach, 0);
    for (int k = slices.begin; k < slices.end; ++k)
    {
      for (; loaded <= std::min(k + this->Reach, last); ++loaded)
      {
        this->load(loaded);
      }
      this->splatSlice(k);
    }
    this->clampToRange();
  }

private:
  /// Widens the rows of a slice that this and the neighbouring slices' footprints read.
  void load(int slice)
  {
    const glm::ivec3& size = this->Shared.geometry.size();
    int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::lowest();
    for (int k = std::max(slice - this->Reach, 0); k <= std::min(slice + this->Reach, size.z - 1);
         ++k)
    {
      low = std::min(low, this->V0 - this->Footprints[k].nearest.y);
      high = std::max(high, this->V1 - 1 - this->Footprints[k].nearest.y);
    }
    low -= 1 + this->Reach;
    high += 1 + this->Reach;
    this->Cache.first[slice % 3] = low;
    const VoxelLoops<T>& loops = this->Shared.kernels;
    for (int j = low; j <= high; ++j)
    {
      A* const row = this->Cache.template row<A>(slice, j);
      if (j > low && (j <= 0 || j >= size.y)) // the same voxels as the row before
      {
        std::copy(row - Pad - this->Cache.rowLength, row - Pad, row - Pad);
        continue;
      }
      loops.widen(this->Shared.voxelRow(std::clamp(j, 0, size.y - 1), slice), row, size.x);
      std::fill(row - Pad, row, row[0]);
      std::fill(row + size.x, row + size.x + Pad, row[size.x - 1]);
    }
  }

  /// Splats runs of rows that cover the same columns together: nearly always all of the band.
  void splatSlice(int k)
  {
    const SliceGeometry& slice = this->Shared.sliceGeometry[k];
    const int end = std::min(this->V1, slice.vEnd);
    int first = std::max(this->V0, slice.vBegin);
    Span span = first < end ? this->Shared.pixels(first, k) : Span{};
    while (first < end)
    {
      int v = first + 1;
      Span next;
      for (; v < end; ++v)
      {
        next = this->Shared.pixels(v, k);
        if (next.begin != span.begin || next.end != span.end)
        {
          break;
        }
      }
      if (!span.empty())
      {
        this->splatRows(first, v, span, k);
      }
      first = v;
      span = next;
    }
  }

  void splatRows(int first, int end, const Span& span, int k)
  {
    if (this->Shared.image.special)
    {
      for (int v = first; v < end; ++v)
      {
        this->splatValidRow(v, span, k);
      }
      return;
    }
    const SliceFootprint<A>& footprint = this->Footprints[k];
    Splat<A> splat;
    splat.image = this->Shared.image.template row<A>(first) + span.begin;
    splat.imageStride = this->Shared.image.width;
    splat.width = span.end - span.begin;
    splat.height = end - first;
    splat.sourceStride = this->Cache.rowLength;
    splat.partCount = footprint.partCount;
    for (int p = 0; p < splat.partCount; ++p)
    {
      const FootprintPart<A>& part = footprint.parts[p];
      splat.parts[p] = { this->voxel(footprint, part.slice, part.di, part.dj, span.begin, first, k),
        part.weights.data(), part.rows, part.columns };
    }
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    loops.splat(splat);
  }

  void splatValidRow(int v, const Span& span, int k)
  {
    const SliceFootprint<A>& footprint = this->Footprints[k];
    const A* rows[75];
    const int count = footprint.taps.size();
    for (int t = 0; t < count; ++t)
    {
      const Tap& tap = footprint.taps[t];
      rows[t] = this->voxel(footprint, tap.slice, tap.di, tap.dj, span.begin, v, k);
    }
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    loops.splatValid(this->Shared.image.template row<A>(v) + span.begin, rows,
      footprint.weights.data(), count, span.end - span.begin);
  }

  /// The voxel that a tap of pixel (u, v) reads, in the cache.
  const A* voxel(
    const SliceFootprint<A>& footprint, int slice, int di, int dj, int u, int v, int k) const
  {
    return this->Cache.template row<A>(std::clamp(k + slice, 0, this->Shared.geometry.size().z - 1),
             v - footprint.nearest.y + dj) +
      (u - footprint.nearest.x + di);
  }

  /// Rounding must not show values that the data do not have.
  void clampToRange()
  {
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    for (int v = this->V0; v < this->V1; ++v)
    {
      const Span& span = this->Shared.image.spans[v];
      if (!span.empty())
      {
        loops.clamp(this->Shared.image.template row<A>(v) + span.begin,
          static_cast<A>(this->ValueRange.low), static_cast<A>(this->ValueRange.high),
          span.end - span.begin);
      }
    }
  }

  const Frame<T>& Shared;
  const std::vector<SliceFootprint<A>>& Footprints;
  int Reach;
  const VolumeIndex::Range& ValueRange;
  RowCache& Cache;
  int V0, V1;
};

void findSlices(const ShearWarp& geometry, std::vector<SliceGeometry>& slices)
{
  slices.resize(geometry.size().z);
  for (int k = 0; k < geometry.size().z; ++k)
  {
    SliceGeometry& slice = slices[k];
    slice.path = geometry.rayPath(k);
    const auto end = slice.path.dj.begin() + slice.path.count;
    slice.vBegin = -*std::max_element(slice.path.dj.begin(), end);
    slice.vEnd = geometry.size().y - *std::min_element(slice.path.dj.begin(), end);
  }
}

/// Weights are rounded so that 8-bit sums are exact, else to the accumulator's precision.
template <class T>
constexpr int weightBits = sizeof(T) == 1 ? 16
  : std::is_same_v<Accumulator<T>, float> ? 24
                                          : 48;

template <class T>
void findFootprints(const ShearWarp& geometry, const ProjectionSettings& settings,
  std::vector<SliceFootprint<Accumulator<T>>>& footprints)
{
  const Kernel kernel =
    settings.quality == Quality::Standard ? Kernel{ Reconstruction::Box } : settings.kernel;
  const glm::dvec2 shear = geometry.shear();
  GeneralTable table;
  if (settings.footprintSampling > 0)
  {
    table = GeneralTable(kernel, shear, settings.footprintSampling);
  }
  footprints.resize(geometry.size().z);
  vtkSMPTools::For(0, geometry.size().z, 8,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType k = first; k < last; ++k)
      {
        auto& footprint = footprints[k];
        const glm::dvec2 position = geometry.position(static_cast<double>(k));
        footprint.nearest = { static_cast<int>(std::floor(position.x + 0.5)),
          static_cast<int>(std::floor(position.y + 0.5)) };
        const glm::dvec2 fraction = position - glm::dvec2(footprint.nearest);
        const WeightTable weights = settings.footprintSampling > 0
          ? table.weights(fraction)
          : closedFormWeights(kernel, shear, fraction);
        setTaps(footprint, quantisedTaps(weights, weightBits<T>));
      }
    });
}

/// Sets type and size, and every pixel to "no sample".
template <class P>
void prepare(ShearImage& image, const ShearWarp& geometry, bool special, bool cut)
{
  image.type = scalarTypeOf<P>();
  image.width = geometry.width();
  image.height = geometry.height();
  image.special = special;
  const std::size_t pixels = std::size_t(image.width) * image.height;
  image.bytes.resize(pixels * sizeof(P));
  std::fill_n(image.row<P>(0), pixels, emptyPixel<P>(special));
  image.spans.assign(image.height, Span{ image.width, 0 });
  image.mask.assign(cut ? pixels : 0, 0);
}

template <class Body>
void forBands(int height, Body&& body)
{
  vtkSMPTools::For(0, (height + BandHeight - 1) / BandHeight, 1,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType b = first; b < last; ++b)
      {
        const int v0 = static_cast<int>(b) * BandHeight;
        body(v0, std::min(v0 + BandHeight, height));
      }
    });
}
}

struct Projector::Scratch
{
  vtkSMPThreadLocal<RowCache> rows;
  std::vector<SliceGeometry> slices;
  std::tuple<std::vector<SliceFootprint<float>>, std::vector<SliceFootprint<double>>> footprints;
};

Projector::Projector() : Memory(new Scratch) {}

Projector::~Projector() = default;

void Projector::project(VolumeIndex& index, const ShearWarp& geometry,
  const ProjectionSettings& settings, const std::vector<glm::dvec4>& halfSpaces, ShearImage& image)
{
  const VolumeIndex::Range& range = index.range();
  std::vector<SliceGeometry>& slices = this->Memory->slices;
  findSlices(geometry, slices);
  std::vector<glm::dvec4> bounds;
  for (const glm::dvec4& h : halfSpaces)
  {
    bounds.push_back(geometry.inPixels(h));
  }
  dispatch(index.volume().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const Frame<T> frame{ geometry, kernelsFor(settings.instructionSet),
        index.slices(geometry.principalAxis()), slices, bounds, image };
      if (settings.quality == Quality::Preview)
      {
        prepare<T>(image, geometry, range.special, !bounds.empty());
        forBands(image.height, [&](int v0, int v1) { previewBand(frame, v0, v1); });
        return;
      }
      prepare<Accumulator<T>>(image, geometry, range.special, !bounds.empty());
      auto& footprints =
        std::get<std::vector<SliceFootprint<Accumulator<T>>>>(this->Memory->footprints);
      findFootprints<T>(geometry, settings, footprints);
      const int reach = settings.quality == Quality::High ? 1 : 0;
      forBands(image.height,
        [&](int v0, int v1)
        {
          WorksheetBand<T> band(
            frame, footprints, reach, range, this->Memory->rows.Local(), v0, v1);
          band.splat();
        });
    });
}
}
