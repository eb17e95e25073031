// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/PerspectiveFootprints.h"
#include "Splat/Sampling/ValuesAtLocations.h"
#include "Splat/Sampling/Worksheets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

namespace splatting
{
namespace
{
/// The voxels that the layers of an image read, for WorksheetSampler.
template <class A>
void findReach(
  const ShearWarp& geometry, const PerspectiveFootprints<A>& footprints, WorksheetReach<A>& reach)
{
  const int count = geometry.size().z;
  reach.layers.assign((count + BrickDepth - 1) / BrickDepth, {});
  for (int k = geometry.slices().begin; k < geometry.slices().end; ++k)
  {
    A before = 0, behind = 0;
    for (int q = 0; q < footprints.parts; ++q)
    {
      before += footprints.share(k, q)[0];
      behind += footprints.share(k, q)[2];
    }
    A& share = reach.layers[k / BrickDepth].share;
    share = std::max({ share, k % BrickDepth == 0 ? before : A(0),
      k % BrickDepth == BrickDepth - 1 ? behind : A(0) });
  }
  // Pixels are narrower than voxels: as many voxels, and some for the taps and the drift of rays.
  reach.columns = reach.rows = 16;
}

/**
 * Standard and high mode in perspective views. The weights of a pixel are products, so a slice's
 * worksheet is made in two steps: rows of voxels are weighted into rows of pixels, which are then
 * weighted into the image's rows.
 */
template <class T>
class PerspectiveWorksheets : public WorksheetSampler<T>
{
public:
  using A = Accumulator<T>;

  /// @param depth  slices beyond its own that a footprint reads
  PerspectiveWorksheets(const ProjectionContext& context,
    const PerspectiveFootprints<A>& footprints, const WorksheetReach<A>& reach, int depth)
    : WorksheetSampler<T>(context, true, reach, depth),
      Own(footprints)
  {
    // Rows of voxels of two blocks are converted, blended and weighted twice.
    this->BlockHeight = 32;
  }

  Span columnsOf(int z, const Span& pixels) const override
  {
    return this->Own.columns.voxels(this->readers(this->slicesOf(z)), pixels);
  }
  Span rowsOf(int z, const Span& pixels) const override
  {
    return this->Own.rows.voxels(this->readers(this->slicesOf(z)), pixels);
  }

  /// As in ParallelWorksheets, with up to 3 + 5 + 15 products and sums and the weights' own
  /// rounding.
  A slack() const override
  {
    return (this->Context.range.nonFinite ? 2 : 1) * 60 * std::numeric_limits<A>::epsilon() / 2;
  }

private:
  using typename WorksheetSampler<T>::Target;

  Span slicesOf(int z) const { return slicesOfLayer(z, this->Context.geometry.size()); }
  /// The slices whose worksheets read some slices.
  Span readers(const Span& slices) const
  {
    return { slices.begin - this->Depth, slices.end + this->Depth };
  }

  LoadedVoxels::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const override
  {
    const Span readers = this->readers({ s, s + 1 });
    const Span i = this->Own.columns.voxels(readers, columns);
    const Span j = this->Own.rows.voxels(readers, { v0, v1 });
    return { s, i.begin, j.begin, std::max(i.end - i.begin, 0), std::max(j.end - j.begin, 0) };
  }

  void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    Span voxelRows[MostParts];
    this->resampleRows(k, { first, end }, span, loaded, voxelRows);
    const WorksheetLoops<A>& loops = this->Context.kernels;
    typename AxisFootprints<A>::Part parts[MostParts];
    A shares[MostParts];
    const A* resampled[MostParts];
    for (int q = 0; q < this->Own.parts; ++q)
    {
      parts[q] = this->Own.rows.part(k, q);
      shares[q] = this->Depth > 0 ? A(1) : this->Own.share(k, q)[1];
      resampled[q] = loaded.template resampled<A>(q, 0) + (span.begin - alignedDown(span.begin));
    }
    for (int v = first; v < end; ++v)
    {
      const A* rows[MostParts * MostTaps];
      A weights[MostParts * MostTaps];
      int count = 0;
      for (int q = 0; q < this->Own.parts; ++q)
      {
        const typename AxisFootprints<A>::Part& part = parts[q];
        const A* row = resampled[q] + (part.first[v] - voxelRows[q].begin) * loaded.resampledLength;
        const A* weight = part.weights + v;
        for (int t = 0; t < part.taps; ++t, row += loaded.resampledLength, weight += part.stride)
        {
          rows[count] = row;
          weights[count++] = shares[q] * *weight;
        }
      }
      loops.raiseBlend(rows, weights, count, target.at(span.begin, v), span.end - span.begin);
    }
  }

  /// Sums of weights are rounded, too.
  A wholeWeight() const override { return A(1) - 60 * std::numeric_limits<A>::epsilon() / 2; }

  /// Registers of pixels begin at multiples of it.
  static constexpr int Unit = 16;
  static int alignedDown(int u) { return u / Unit * Unit; }

  /// Weights the rows of voxels of some rows of pixels into rows of pixels, for each part.
  void resampleRows(
    int k, const Span& rows, const Span& span, LoadedVoxels& loaded, Span* voxelRows) const
  {
    const WorksheetLoops<A>& loops = this->Context.kernels;
    const int begin = alignedDown(span.begin), length = alignedDown(span.end - begin + Unit - 1);
    int most = 0;
    for (int q = 0; q < this->Own.parts; ++q)
    {
      voxelRows[q] = this->Own.rows.voxels(k, q, rows);
      most = std::max(most, voxelRows[q].end - voxelRows[q].begin);
    }
    loaded.template resizeResampled<A>(this->Own.parts, most, length);
    for (int q = 0; q < this->Own.parts; ++q)
    {
      const auto part = this->Own.columns.part(k, q);
      Resampling<A> resampling;
      resampling.base = part.base;
      resampling.lanes = part.lanes;
      resampling.weights = part.weights;
      resampling.stride = part.stride;
      resampling.taps = part.taps;
      resampling.rows = voxelRows[q].end - voxelRows[q].begin;
      resampling.out = loaded.template resampled<A>(q, 0) - begin;
      resampling.outStride = loaded.resampledLength;
      this->findVoxels(k, q, voxelRows[q], loaded, resampling);
      loops.resample(resampling, span.begin, span.end);
    }
  }

  /// Finds the voxels of some rows: of slice k or, in part q, blended from the slices around it.
  void findVoxels(
    int k, int q, const Span& rows, LoadedVoxels& loaded, Resampling<A>& resampling) const
  {
    if (this->Depth == 0)
    {
      // splatRows() applies the share of slice k.
      resampling.voxels = loaded.template voxel<A>(0, rows.begin, k);
      resampling.voxelStride = loaded.rowLength;
      return;
    }
    const WorksheetLoops<A>& loops = this->Context.kernels;
    const std::array<A, 3>& shares = this->Own.share(k, q);
    const int last = this->Context.geometry.size().z - 1;
    // All sheets that are read together have these columns.
    const LoadedVoxels::Sheet& own = loaded.sheet(k);
    Span columns{ own.i, own.i + own.columns };
    int slices[3];
    A weights[3];
    int count = 0;
    for (int c = -1; c <= 1; ++c)
    {
      if (shares[c + 1] != 0)
      {
        slices[count] = std::clamp(k + c, 0, last);
        const LoadedVoxels::Sheet& sheet = loaded.sheet(slices[count]);
        columns = common(columns, { sheet.i, sheet.i + sheet.columns });
        weights[count++] = shares[c + 1];
      }
    }
    const int n = columns.end - columns.begin;
    A* const out = loaded.template blended<A>(rows.end - rows.begin, n);
    for (int j = rows.begin; j < rows.end; ++j)
    {
      const A* sources[3];
      for (int c = 0; c < count; ++c)
      {
        sources[c] = loaded.template voxel<A>(columns.begin, j, slices[c]);
      }
      loops.blend(sources, weights, count, out + std::ptrdiff_t(j - rows.begin) * n, n);
    }
    resampling.voxels = out - columns.begin;
    resampling.voxelStride = n;
  }

  const PerspectiveFootprints<A>& Own;
};

template <class A>
class PerspectiveWorksheetSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    this->Footprints.find(
      context.whole, context.geometry, worksheetKernel(context.settings), context.kernels);
    findReach(context.geometry, this->Footprints, this->Reach);
    walk(context,
      PerspectiveWorksheets<T>(
        context, this->Footprints, this->Reach, worksheetDepth(context.settings)));
  }
  template <class T>
  void takeAtLocations(const AtWinners& winners) const
  {
    fillAtWinners<T>(winners,
      [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
      { return averageAtWinner<T>(voxels, this->Footprints, u, v, step / StepsPerSlice); });
  }

private:
  PerspectiveFootprints<A> Footprints;
  WorksheetReach<A> Reach;
};
}

std::unique_ptr<ProjectionMode> makePerspectiveWorksheets()
{
  return std::make_unique<TypedMode<PerspectiveWorksheetSpace>>();
}
}
