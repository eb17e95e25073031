// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/ExactSegments.h"
#include "Sampling/Worksheets.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace splatting
{
namespace
{
template <class A>
void findReach(const std::vector<ExactPath<A>>& paths, const std::vector<ExactBox<A>>& boxes,
  WorksheetReach<A>& reach)
{
  const int count = static_cast<int>(paths.size());
  reach.slices.assign(count, {});
  reach.layers.assign((count + BrickDepth - 1) / BrickDepth, {});
  for (int k = 0; k < count; ++k)
  {
    for (const ExactSegment<A>& segment : paths[k])
    {
      for (int s : { k + segment.dk, k + segment.dk + 1 })
      {
        VoxelWindow& window = reach.slices[std::clamp(s, 0, count - 1)];
        window.add(segment.di, segment.dj);
        window.add(segment.di + 1, segment.dj + 1);
      }
    }
    const BoxSide<A>&columns = boxes[k].columns, &rows = boxes[k].rows;
    for (int s = k - 1; s <= k + 1; ++s)
    {
      VoxelWindow& window = reach.slices[std::clamp(s, 0, count - 1)];
      window.add(columns.cell, rows.cell);
      window.add(columns.cell + 1 + columns.crosses, rows.cell + 1 + rows.crosses);
    }
  }
  reach.columns = reach.rows = 0;
  for (int s = 0; s < count; ++s)
  {
    const VoxelWindow& window = reach.slices[s];
    typename WorksheetReach<A>::Layer& layer = reach.layers[s / BrickDepth];
    layer.window.add(window.iMin, window.jMin);
    layer.window.add(window.iMax, window.jMax);
    layer.share = ExactShare<A>;
    reach.columns = std::max(reach.columns, window.iMax - window.iMin);
    reach.rows = std::max(reach.rows, window.jMax - window.jMin);
  }
}

/**
 * Exact mode: a slice's worksheet is the maximum of the trilinear field along each ray's path from
 * half a slice before its middle to half a slice behind.
 */
template <class T>
class ParallelExact : public WorksheetSampler<T>
{
public:
  using typename WorksheetSampler<T>::A;
  using typename WorksheetSampler<T>::Target;

  /// @param field  of each row the pixels that see the field, see findFieldSpans()
  ParallelExact(const ProjectionContext& context, const std::vector<ExactPath<A>>& paths,
    const std::vector<ExactBox<A>>& boxes, const std::vector<Span>& field,
    const WorksheetReach<A>& reach)
    : WorksheetSampler<T>(context, false, reach, 1),
      Paths(paths),
      Boxes(boxes),
      Field(field),
      Slack(ExactBoxSlack<A> * this->largestVoxel())
  {
  }

  VoxelWindow window(int layer) const override { return this->Reach.layers[layer].window; }

  /// As in ParallelWorksheets, of 8 products and sums and the weights' own rounding.
  A slack() const override { return 24 * std::numeric_limits<A>::epsilon() / 2; }

protected:
  LoadedVoxels::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const override
  {
    const VoxelWindow& window = this->Reach.slices[s];
    return { s, columns.begin + window.iMin, v0 + window.jMin,
      columns.end - columns.begin + window.iMax - window.iMin,
      v1 - v0 + window.jMax - window.jMin };
  }

  void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    Cubics<A> cubics;
    cubics.image = target.at(0, 0);
    cubics.imageStride = target.stride;
    cubics.columns = span;
    cubics.rows = { first, end };
    cubics.field = this->Field.data();
    cubics.sourceStride = loaded.rowLength;
    cubics.nonFinite = !this->isFinite(k, loaded);
    const ExactBox<A>& box = this->Boxes[k];
    const auto firstOf = [&](int slice)
    { return this->voxel(box.columns.cell, box.rows.cell, slice, loaded); };
    cubics.box = { firstOf(k - 1), firstOf(k), firstOf(k + 1), box.columns, box.rows, this->Slack };
    cubics.count = 0;
    for (const ExactSegment<A>& segment : this->Paths[k])
    {
      cubics.segments[cubics.count++] = { this->voxel(
                                            segment.di, segment.dj, k + segment.dk, loaded),
        this->voxel(segment.di, segment.dj, k + segment.dk + 1, loaded), segment.weights.data(),
        segment.curved, segment.inField.data(), segment.inBoxes.data() };
    }
    const WorksheetLoops<A>& loops = this->Context.kernels;
    loops.raiseCubics(cubics);
  }
  void splatNonFiniteRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    this->splatRows(k, first, end, span, target, loaded);
  }

private:
  const A* voxel(int i, int j, int slice, LoadedVoxels& loaded) const
  {
    return loaded.voxel<A>(i, j, std::clamp(slice, 0, this->Context.geometry.size().z - 1));
  }
  const std::vector<ExactPath<A>>& Paths;
  const std::vector<ExactBox<A>>& Boxes;
  const std::vector<Span>& Field;
  A Slack; ///< see ExactBoxSlack
};

template <class A>
class ExactSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    findExactPaths(context.whole, context.geometry, this->Paths);
    findExactBoxes(context.whole, context.geometry, this->Boxes);
    findFieldSpans(context.whole, this->Field);
    findReach(this->Paths, this->Boxes, this->Reach);
    walk(context, ParallelExact<T>(context, this->Paths, this->Boxes, this->Field, this->Reach));
  }
  template <class T>
  void takeAtWinners(const AtWinners&) const
  {
  }

private:
  std::vector<ExactPath<A>> Paths;
  std::vector<ExactBox<A>> Boxes;
  std::vector<Span> Field;
  WorksheetReach<A> Reach;
};
}

std::unique_ptr<ProjectionMode> makeExact()
{
  return std::make_unique<TypedMode<ExactSpace>>();
}
}
