// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/AxisCells.h"
#include "Sampling/ExactSegments.h"
#include "Sampling/Worksheets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

namespace splatting
{
namespace
{
/// What the layers of an image read, as far as WorksheetSampler asks for it.
template <class A>
void findExactReach(const ShearWarp& geometry, WorksheetReach<A>& reach)
{
  reach.layers.assign((geometry.size().z + BrickDepth - 1) / BrickDepth, {});
  for (typename WorksheetReach<A>::Layer& layer : reach.layers)
  {
    layer.share = ExactShare<A>;
  }
  // Pixels are narrower than voxels: as many voxels, and some for what rays move.
  reach.columns = reach.rows = 16;
}

/**
 * Exact mode in perspective views: as ParallelExact, but each pixel's ray runs through the cells
 * in its own way.
 */
template <class T>
class PerspectiveExact : public WorksheetSampler<T>
{
public:
  using typename WorksheetSampler<T>::A;
  using typename WorksheetSampler<T>::Target;

  PerspectiveExact(const ProjectionContext& context, const AxisCells<A>& columns,
    const AxisCells<A>& rows, const WorksheetReach<A>& reach)
    : WorksheetSampler<T>(context, true, reach, 1),
      Columns(columns),
      Rows(rows),
      Depths(context.whole, 2),
      Slack(ExactBoxSlack<A> * this->largestVoxel())
  {
  }

  Span columnsOf(int z, const Span& pixels) const override
  {
    return this->Columns.voxels(this->readers(slicesOfLayer(z, this->size())), pixels);
  }
  Span rowsOf(int z, const Span& pixels) const override
  {
    return this->Rows.voxels(this->readers(slicesOfLayer(z, this->size())), pixels);
  }

  /// As in ParallelWorksheets, of three interpolations one after the other, with up to five
  /// roundings each, and the mean of three.
  A slack() const override { return 60 * std::numeric_limits<A>::epsilon() / 2; }

protected:
  LoadedVoxels::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const override
  {
    const Span readers = this->readers({ s, s + 1 });
    const Span i = this->Columns.voxels(readers, columns);
    const Span j = this->Rows.voxels(readers, { v0, v1 });
    return { s, i.begin, j.begin, std::max(i.end - i.begin, 0), std::max(j.end - j.begin, 0) };
  }

  void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    const WorksheetLoops<A>& loops = this->Context.kernels;
    const AxisCellArrays<A> rows = this->Rows.slice(k);
    const int slice = k + this->Context.geometry.first().z;
    const glm::dvec2 faces = this->Context.whole.faces(slice);
    // Rays that touch the field have next to nothing of it.
    constexpr A shortest = A(1e-3);
    PerspectiveCubicRow<A> row;
    row.pixels = span;
    row.columns = this->Columns.slice(k);
    row.nonFinite = !this->isFinite(k, loaded);
    row.shortest = shortest;
    row.sourceStride = loaded.rowLength;
    for (int v = first; v < end; ++v)
    {
      row.image = target.at(0, v);
      row.slope = rows.slope[v];
      row.fieldBegin = std::max(rows.fieldBegin[v], static_cast<A>(this->Depths.begin - slice));
      row.fieldEnd = std::min(rows.fieldEnd[v], static_cast<A>(this->Depths.end - slice));
      row.boxesBegin = rows.boxesBegin[v];
      row.boxesEnd = rows.boxesEnd[v];
      row.fieldNear = std::max(rows.fieldNear[v], this->nearest());
      row.fieldFar = std::min(rows.fieldFar[v], this->farthest());
      this->findSegments(k, v, faces - double(slice), rows, loaded, row);
      if (row.count > 0)
      {
        this->findBox(k, v, rows, loaded, row);
        loops.raisePerspectiveCubics(row);
      }
    }
  }
  void splatNonFiniteRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    this->splatRows(k, first, end, span, target, loaded);
  }

private:
  const glm::ivec3& size() const { return this->Context.geometry.size(); }
  /// The slices whose worksheets read some slices.
  static Span readers(const Span& slices) { return { slices.begin - 1, slices.end + 1 }; }

  /// The depths of the field before the eye.
  A nearest() const
  {
    const Span& slices = this->Context.whole.slices();
    return static_cast<A>(std::max(this->Depths.begin, this->Context.whole.faces(slices.begin).x));
  }
  A farthest() const
  {
    const Span& slices = this->Context.whole.slices();
    return static_cast<A>(std::min(this->Depths.end, this->Context.whole.faces(slices.end - 1).y));
  }

  /// Cuts the path of a row's rays in the slice's middle and where they leave a row of cells.
  void findSegments(int k, int v, const glm::dvec2& faces, const AxisCellArrays<A>& rows,
    LoadedVoxels& loaded, PerspectiveCubicRow<A>& row) const
  {
    const A from = static_cast<A>(faces.x), to = static_cast<A>(faces.y);
    const A crossing = rows.crossing[v];
    const bool crosses = crossing < A(1);
    A cuts[4] = { from, std::clamp(A(0), from, to), crosses ? std::clamp(crossing, from, to) : to,
      to };
    std::sort(cuts, cuts + 4);
    const bool falls = rows.slope[v] < 0;
    const int last = this->size().z - 1;
    row.count = 0;
    for (int n = 0; n < 3; ++n)
    {
      if (!(cuts[n] < cuts[n + 1]))
      {
        continue;
      }
      PerspectiveCubicSegment<A>& segment = row.segments[row.count++];
      segment.from = cuts[n];
      segment.to = cuts[n + 1];
      const bool isBefore = crosses && segment.to <= crossing;
      const int upper = crosses && (isBefore ? falls : !falls);
      const int j = rows.cell[v] + upper, low = segment.to <= A(0) ? k - 1 : k;
      segment.y = rows.at[v] - static_cast<A>(upper);
      segment.z = static_cast<A>(k - low);
      for (int r = 0; r < 4; ++r)
      {
        segment.rows[r] = loaded.template voxel<A>(0, j + r % 2, std::clamp(low + r / 2, 0, last));
      }
    }
  }

  /// What the row's rays pass between the ends of its segments.
  void findBox(int k, int v, const AxisCellArrays<A>& rows, LoadedVoxels& loaded,
    PerspectiveCubicRow<A>& row) const
  {
    const int last = this->size().z - 1;
    const auto firstOf = [&](int slice)
    { return loaded.template voxel<A>(0, rows.cell[v], std::clamp(slice, 0, last)); };
    row.box = { firstOf(k - 1), firstOf(k), firstOf(k + 1), {}, {}, this->Slack };
    const auto share = [](A x) { return std::clamp(x, A(0), A(1)); };
    const A near = rows.at[v] + rows.slope[v] * row.segments[0].from;
    const A far = rows.at[v] + rows.slope[v] * row.segments[row.count - 1].to;
    const bool crosses = std::max(near, far) > A(1);
    row.box.rows = { 0, share(std::min(near, far)),
      share(std::max(near, far) - static_cast<A>(crosses)), crosses };
  }

  const AxisCells<A>& Columns;
  const AxisCells<A>& Rows;
  FieldRange Depths;
  A Slack; ///< of boxes
};

template <class A>
class PerspectiveExactSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    this->Columns.find(context.whole, context.geometry, 0);
    this->Rows.find(context.whole, context.geometry, 1);
    findExactReach(context.geometry, this->Reach);
    walk(context, PerspectiveExact<T>(context, this->Columns, this->Rows, this->Reach));
  }
  template <class T>
  void takeAtWinners(const AtWinners&) const
  {
  }

private:
  AxisCells<A> Columns, Rows;
  WorksheetReach<A> Reach;
};
}

std::unique_ptr<ProjectionMode> makePerspectiveExact()
{
  return std::make_unique<TypedMode<PerspectiveExactSpace>>();
}
}
