// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Standard and high mode: the footprints of all slices, and worksheets in layers of BrickDepth
 * slices. A worksheet lives for a few rows of one slice, in registers.
 */
#ifndef splattingWorksheets_h
#define splattingWorksheets_h

#include "Footprint.h"
#include "Frame.h"
#include "Patch.h"
#include "PreviewLayers.h"

#include <cmath>

namespace splatting
{
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

/// Weights are rounded so that 8-bit sums are exact, else to the accumulator's precision.
template <class T>
constexpr int weightBits = sizeof(T) == 1 ? 16
  : std::is_same_v<Accumulator<T>, float> ? 24
                                          : 48;

/// The footprints of all slices; `sampling` as ProjectionSettings::footprintSampling.
template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  std::vector<SliceFootprint<A>>& footprints);

/// What the worksheets of all slices read.
template <class A>
struct WorksheetReach
{
  struct Layer
  {
    Window window; ///< of the layer's own voxels, by all worksheets that read them
    A share = 0;   ///< how much of a worksheet its neighbours' voxels can weigh
  };
  std::vector<Layer> layers;
  std::vector<Window> slices; ///< the same for each slice's voxels
  int columns = 0, rows = 0;  ///< the largest of the slices' windows
};

template <class A>
void findReach(const std::vector<SliceGeometry>& slices,
  const std::vector<SliceFootprint<A>>& footprints, WorksheetReach<A>& reach);

template <class T>
class WorksheetLayers
{
public:
  using A = Accumulator<T>;
  using Voxel = T;
  using Pixel = A;

  /// @param depth  how many slices beyond its own a footprint reads
  WorksheetLayers(const Frame<T>& frame, const std::vector<SliceFootprint<A>>& footprints,
    const WorksheetReach<A>& reach, int depth)
    : Shared(frame),
      Footprints(footprints),
      Reach(reach),
      Depth(depth),
      Base(baseOf(frame.range))
  {
  }
  virtual ~WorksheetLayers() = default;

  const Window& window(int layer) const { return this->Reach.layers[layer].window; }
  A share(int layer) const { return this->Reach.layers[layer].share; }

  /// What is subtracted from voxels before they are weighed, so that a flat background of the
  /// lowest value is 0 and its sums are exact.
  A base() const { return this->Base; }

  /// Rounding can take a worksheet beyond its largest voxel by slack() times the larger of that and
  /// magnitude(): 75 products and sums, and a few operations for the bound itself. Sums of 8-bit
  /// voxels are exact.
  A slack() const { return sizeof(T) == 1 ? A(0) : 90 * std::numeric_limits<A>::epsilon() / 2; }
  A magnitude() const { return std::abs(static_cast<A>(this->Shared.range.low) - this->Base); }

  /// Splats a layer's worksheets into the pixels of some rows and runs of columns.
  void splat(int z, int v0, int v1, const std::vector<Span>& runs, Patch& patch) const
  {
    // Pieces of the image whose patch stays in the first-level cache.
    constexpr int width = 256, height = 16;
    for (int v = v0; v < v1; v += height)
    {
      for (const Span& run : runs)
      {
        for (int u = run.begin; u < run.end; u += width)
        {
          this->splatPiece(
            z, v, std::min(v + height, v1), { u, std::min(u + width, run.end) }, patch);
        }
      }
    }
  }

  /// Adds the base; rounding must not show values that the data do not have.
  void finish(int v0, int v1) const
  {
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    for (int v = v0; v < v1; ++v)
    {
      const Span& span = this->Shared.image.spans[v];
      if (!span.empty())
      {
        loops.finish(this->Shared.image.template row<A>(v) + span.begin, this->Base,
          static_cast<A>(this->Shared.range.low), static_cast<A>(this->Shared.range.high),
          span.end - span.begin);
      }
    }
  }

private:
  static A baseOf(const VolumeIndex::Range& range)
  {
    // Only where the difference is exact: 64-bit integers have more bits than double.
    return std::numeric_limits<T>::is_integer && sizeof(T) < 8 ? static_cast<A>(range.low) : A(0);
  }

  void splatPiece(int z, int v0, int v1, const Span& columns, Patch& patch) const
  {
    patch.resize<A>(columns.end - columns.begin + this->Reach.columns, v1 - v0 + this->Reach.rows);
    const Span slices = slicesOfLayer(z, this->Shared.geometry.size());
    for (int k = slices.begin; k < slices.end; ++k)
    {
      const SliceGeometry& slice = this->Shared.sliceGeometry[k];
      const int end = std::min(v1, slice.vEnd);
      int first = std::max(v0, slice.vBegin);
      while (first < end)
      {
        // Runs of rows that cover the same columns go together: nearly always all of them.
        const Span span = common(columns, this->Shared.pixels(first, k));
        int v = first + 1;
        while (v < end && same(span, common(columns, this->Shared.pixels(v, k))))
        {
          ++v;
        }
        if (!span.empty())
        {
          this->load(k, v0, v1, columns, patch);
          this->splatRows(k, first, v, span, patch);
        }
        first = v;
      }
    }
  }

  static bool same(const Span& a, const Span& b)
  {
    return (a.begin == b.begin && a.end == b.end) || (a.empty() && b.empty());
  }

  /// Widens the voxels that worksheet k reads, as far as the patch does not have them.
  void load(int k, int v0, int v1, const Span& columns, Patch& patch) const
  {
    const int last = this->Shared.geometry.size().z - 1;
    for (int s = std::max(k - this->Depth, 0); s <= std::min(k + this->Depth, last); ++s)
    {
      Patch::Sheet& sheet = patch.sheet(s);
      if (sheet.slice != s)
      {
        const Window& window = this->Reach.slices[s];
        sheet = { s, columns.begin + window.iMin, v0 + window.jMin,
          columns.end - columns.begin + window.iMax - window.iMin,
          v1 - v0 + window.jMax - window.jMin };
        this->loadSheet(sheet, patch);
      }
    }
  }

protected:
  virtual void loadSheet(const Patch::Sheet& sheet, Patch& patch) const
  {
    const glm::ivec3& size = this->Shared.geometry.size();
    const VoxelLoops<T>& loops = this->Shared.kernels;
    const int begin = std::clamp(-sheet.i, 0, sheet.columns);
    const int end = std::clamp(size.x - sheet.i, begin, sheet.columns);
    // The rows of the volume, and the first and last of them again for those beyond.
    const int low = std::clamp(sheet.j, 0, size.y - 1);
    const int high = std::clamp(sheet.j + sheet.rows, low + 1, size.y);
    // A sheet can lie beyond all of them, and then holds one all over.
    const int shift = std::clamp(low, sheet.j, sheet.j + sheet.rows - 1) - low;
    A* const rows = patch.voxel<A>(sheet.i, low + shift, sheet.slice);
    const T* const voxels = this->Shared.voxelRow(low, sheet.slice);
    if (begin < end)
    {
      loops.widen(voxels + sheet.i + begin, this->Shared.slices.rowStride, rows + begin,
        patch.rowLength, this->Base, end - begin, high - low);
    }
    for (int j = low; j < high && (begin > 0 || end < sheet.columns); ++j)
    {
      A* const row = patch.voxel<A>(sheet.i, j + shift, sheet.slice);
      const T* const ends = this->Shared.voxelRow(j, sheet.slice);
      std::fill(row, row + begin, static_cast<A>(ends[0]) - this->Base);
      std::fill(row + end, row + sheet.columns, static_cast<A>(ends[size.x - 1]) - this->Base);
    }
    const int first = low + shift, last = high - 1 + shift;
    for (int j = sheet.j; j < sheet.j + sheet.rows; ++j)
    {
      if (j < first || j > last)
      {
        const A* const from = patch.voxel<A>(sheet.i, j < first ? first : last, sheet.slice);
        std::copy(from, from + sheet.columns, patch.voxel<A>(sheet.i, j, sheet.slice));
      }
    }
  }

  virtual void splatRows(int k, int first, int end, const Span& span, Patch& patch) const
  {
    if (this->Shared.image.special)
    {
      for (int v = first; v < end; ++v)
      {
        this->splatValidRow(k, v, span, patch);
      }
      return;
    }
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    loops.splat(this->splatOf(k, first, end, span, patch));
  }

  Splat<A> splatOf(int k, int first, int end, const Span& span, Patch& patch) const
  {
    const SliceFootprint<A>& footprint = this->Footprints[k];
    Splat<A> splat;
    splat.image = this->Shared.image.template row<A>(first) + span.begin;
    splat.imageStride = this->Shared.image.width;
    splat.width = span.end - span.begin;
    splat.height = end - first;
    splat.sourceStride = patch.rowLength;
    splat.partCount = footprint.partCount;
    for (int p = 0; p < splat.partCount; ++p)
    {
      const FootprintPart<A>& part = footprint.parts[p];
      splat.parts[p] = { this->voxel(patch, k, part.slice, span.begin + part.di, first + part.dj),
        part.weights.data(), part.rows, part.columns };
    }
    return splat;
  }

private:
  void splatValidRow(int k, int v, const Span& span, Patch& patch) const
  {
    const SliceFootprint<A>& footprint = this->Footprints[k];
    const A* rows[75];
    const int count = footprint.taps.size();
    for (int t = 0; t < count; ++t)
    {
      const Tap& tap = footprint.taps[t];
      rows[t] = this->voxel(patch, k, tap.slice, span.begin + tap.di, v + tap.dj);
    }
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    loops.splatValid(this->Shared.image.template row<A>(v) + span.begin, rows,
      footprint.weights.data(), count, span.end - span.begin);
  }

  /// The voxel of slice k + c that is nearest to pixel (u, v) of slice k, in the patch.
  const A* voxel(Patch& patch, int k, int c, int u, int v) const
  {
    const glm::ivec2& nearest = this->Footprints[k].nearest;
    return patch.voxel<A>(
      u - nearest.x, v - nearest.y, std::clamp(k + c, 0, this->Shared.geometry.size().z - 1));
  }

protected:
  const Frame<T>& Shared;
  const std::vector<SliceFootprint<A>>& Footprints;
  const WorksheetReach<A>& Reach;
  int Depth;
  A Base;
};
}

#endif
