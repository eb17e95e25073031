// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Standard and high mode of parallel views: footprints over copies of voxels, or over the volume's
 * voxels.
 */
#ifndef splattingParallelWorksheets_h
#define splattingParallelWorksheets_h

#include "Splat/Sampling/Worksheets.h"

namespace splatting
{
/// In parallel views all pixels have the footprints of their slices.
template <class T>
class ParallelWorksheets : public WorksheetSampler<T>
{
public:
  using typename WorksheetSampler<T>::A;
  using typename WorksheetSampler<T>::Target;

  ParallelWorksheets(const ProjectionContext& context,
    const std::vector<SliceFootprint<A>>& footprints, const WorksheetReach<A>& reach, int depth)
    : WorksheetSampler<T>(context, false, reach, depth),
      Footprints(footprints)
  {
  }

  VoxelWindow window(int layer) const override { return this->Reach.layers[layer].window; }

  /// Rounding can raise a worksheet above its largest voxel by slack() times the larger of this
  /// voxel and magnitude(). The errors are those of 75 products and sums, and of a few operations
  /// for the bound itself. Sums of 8-bit voxels are exact. With NaN voxels sums are also divided by
  /// sums of weights.
  A slack() const override
  {
    const int operations = this->Context.range.nonFinite ? 180 : 90;
    return sizeof(T) == 1 ? A(0) : operations * std::numeric_limits<A>::epsilon() / 2;
  }

protected:
  LoadedVoxels::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const override
  {
    const VoxelWindow& window = this->Reach.slices[s];
    const glm::ivec3& size = this->Context.geometry.size();
    const Span i = common(
      { columns.begin + window.iMin, columns.end + window.iMax }, { -Beside, size.x + Beside });
    const Span j = common({ v0 + window.jMin, v1 + window.jMax }, { -Beside, size.y + Beside });
    return { s, i.begin, j.begin, std::max(i.end - i.begin, 0), std::max(j.end - j.begin, 0) };
  }

  void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    const WorksheetLoops<A>& loops = this->Context.kernels;
    loops.splat(this->splatOf(k, first, end, span, target, loaded));
  }

  Splat<A> splatOf(
    int k, int first, int end, const Span& span, const Target& target, LoadedVoxels& loaded) const
  {
    const SliceFootprint<A>& footprint = this->Footprints[k];
    Splat<A> splat = this->splatInto<A>(target, first, end, span);
    splat.sourceStride = loaded.rowLength;
    splat.partCount = footprint.partCount;
    for (int p = 0; p < splat.partCount; ++p)
    {
      const FootprintPart<A>& part = footprint.parts[p];
      splat.parts[p] = { this->voxel(loaded, k, part.slice, span.begin + part.di, first + part.dj),
        part.weights.data(), part.rows, part.columns };
    }
    return splat;
  }

  /// Everything except the source.
  template <class S>
  Splat<A, S> splatInto(const Target& target, int first, int end, const Span& span) const
  {
    Splat<A, S> splat;
    splat.image = target.at(span.begin, first);
    splat.imageStride = target.stride;
    splat.width = span.end - span.begin;
    splat.height = end - first;
    return splat;
  }

  bool splatOwn(int k, int step, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    const VoxelLoops<T>& loops = this->Context.kernels;
    if (this->Depth > 0 || !loops.splatVoxels || this->Context.range.nonFinite ||
      this->Footprints[k].partCount != 1)
    {
      return false; // copies are reused by several slices, or are not slower
    }
    // Pixels whose footprints are in the volume.
    const glm::ivec3& size = this->Context.geometry.size();
    const SliceFootprint<A>& footprint = this->Footprints[k];
    const FootprintPart<A>& part = footprint.parts[0];
    const int di = part.di - footprint.nearest.x, dj = part.dj - footprint.nearest.y;
    const Span columns = common(span, { -di, size.x - di - part.columns + 1 });
    const Span rows = common({ first, end }, { -dj, size.y - dj - part.rows + 1 });
    const bool isAll = columns.begin == span.begin && columns.end == span.end;
    if (rows.empty() || (columns.end - columns.begin < LeastOwn && !(isAll && !columns.empty())))
    {
      return false;
    }
    Splat<A, T> splat = this->template splatInto<T>(target, rows.begin, rows.end, columns);
    splat.sourceStride = this->Context.slices.rowStride;
    splat.base = this->Base;
    splat.ahead = k + step >= 0 && k + step < size.z ? step * this->Context.slices.sliceStride : 0;
    splat.partCount = 1;
    splat.parts[0] = { this->Context.template voxelRow<T>(rows.begin + dj, k) + columns.begin + di,
      part.weights.data(), part.rows, part.columns };
    loops.splatVoxels(splat);
    this->splatRim(k, first, rows.begin, span, target, loaded);
    this->splatRim(k, rows.end, end, span, target, loaded);
    const int least = std::min(RimWidth, span.end - span.begin);
    if (columns.begin > span.begin)
    {
      this->splatRim(k, rows.begin, rows.end,
        { span.begin, std::max(columns.begin, span.begin + least) }, target, loaded);
    }
    if (columns.end < span.end)
    {
      this->splatRim(k, rows.begin, rows.end, { std::min(columns.end, span.end - least), span.end },
        target, loaded);
    }
    return true;
  }

private:
  /// LeastOwn: the least number of pixels inside the volume for which separate rims are faster.
  /// RimWidth: the number of pixels of a rim, at most a register of floats.
  static constexpr int LeastOwn = 64, RimWidth = 16;

  /// Splats border pixels from a copy of voxels, because their footprints read beyond the volume.
  void splatRim(int k, int first, int end, const Span& columns, const Target& target,
    LoadedVoxels& loaded) const
  {
    if (first < end)
    {
      const Span rows = loaded.rows, pixels = loaded.pixels;
      this->open(first, end, columns, loaded);
      this->load(k, 0, loaded);
      this->splatRows(k, first, end, columns, target, loaded);
      this->open(rows.begin, rows.end, pixels, loaded);
    }
  }

  /// The loaded voxel of slice k + c that is nearest to pixel (u, v) of slice k.
  const A* voxel(LoadedVoxels& loaded, int k, int c, int u, int v) const
  {
    const glm::ivec2& nearest = this->Footprints[k].nearest;
    return loaded.voxel<A>(
      u - nearest.x, v - nearest.y, std::clamp(k + c, 0, this->Context.geometry.size().z - 1));
  }

protected:
  const std::vector<SliceFootprint<A>>& Footprints;
};

/// The weights and voxels of a parallel view's worksheets.
template <class A>
struct WorksheetSpace
{
  template <class T>
  void find(const ProjectionContext& context)
  {
    findFootprints(context.geometry, worksheetKernel(context.settings),
      context.settings.footprintSampling, weightBits<T>, this->table, this->footprints);
    findReach(context.sliceGeometry, this->footprints, this->reach);
  }

  GeneralTable table;
  std::vector<SliceFootprint<A>> footprints;
  WorksheetReach<A> reach;
};
}

#endif
