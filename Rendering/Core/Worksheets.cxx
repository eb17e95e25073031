// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Worksheets.h"

#include <vtkSMPTools.h>

namespace splatting
{
namespace
{
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
}

template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  std::vector<SliceFootprint<A>>& footprints)
{
  const glm::dvec2 shear = geometry.shear();
  GeneralTable table;
  if (sampling > 0)
  {
    table = GeneralTable(
      kernel, shear, sampling, static_cast<int>(std::lround(1.0 / geometry.pixelSize())));
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
        const WeightTable weights = sampling > 0
          ? table.weights(fraction)
          : closedFormWeights(kernel, shear, fraction, geometry.pixelSize());
        setTaps(footprint, quantisedTaps(weights, weightBits));
      }
    });
}

template <class A>
void findReach(const std::vector<SliceGeometry>& slices,
  const std::vector<SliceFootprint<A>>& footprints, WorksheetReach<A>& reach)
{
  const int count = static_cast<int>(slices.size());
  reach.layers.assign((count + BrickDepth - 1) / BrickDepth, {});
  reach.slices.assign(count, {});
  for (int k = 0; k < count; ++k)
  {
    const RayPath& path = slices[k].path;
    for (int t = 0; t < path.count; ++t)
    {
      reach.slices[k].add(path.di[t], path.dj[t]);
    }
    const SliceFootprint<A>& footprint = footprints[k];
    A outside = 0; // the weight of other layers' voxels
    for (int p = 0; p < footprint.partCount; ++p)
    {
      const FootprintPart<A>& part = footprint.parts[p];
      const int s = std::clamp(k + part.slice, 0, count - 1);
      const int di = part.di - footprint.nearest.x, dj = part.dj - footprint.nearest.y;
      reach.slices[s].add(di, dj);
      reach.slices[s].add(di + part.columns - 1, dj + part.rows - 1);
      for (int w = 0; s / BrickDepth != k / BrickDepth && w < part.rows * part.columns; ++w)
      {
        outside += part.weights[w];
      }
    }
    A& share = reach.layers[k / BrickDepth].share;
    share = std::max(share, outside);
  }
  reach.columns = reach.rows = 0;
  for (int s = 0; s < count; ++s)
  {
    const Window& window = reach.slices[s];
    reach.layers[s / BrickDepth].window.add(window.iMin, window.jMin);
    reach.layers[s / BrickDepth].window.add(window.iMax, window.jMax);
    reach.columns = std::max(reach.columns, window.iMax - window.iMin);
    reach.rows = std::max(reach.rows, window.jMax - window.jMin);
  }
}

template void findFootprints(
  const ShearWarp&, const Kernel&, int, int, std::vector<SliceFootprint<float>>&);
template void findFootprints(
  const ShearWarp&, const Kernel&, int, int, std::vector<SliceFootprint<double>>&);
template void findReach(const std::vector<SliceGeometry>&,
  const std::vector<SliceFootprint<float>>&, WorksheetReach<float>&);
template void findReach(const std::vector<SliceGeometry>&,
  const std::vector<SliceFootprint<double>>&, WorksheetReach<double>&);
}
