// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Watch.h"
#include "Projection/WalkSpace.h"
#include "Sampling/SliceSampler.h"

#include <vtkSMPTools.h>

#include <algorithm>

namespace splatting
{
namespace
{
/// Slices that are transposed at a time where there is no memory for a copy of all.
constexpr int ChunkDepth = 8 * BrickDepth;
}

int bandHeight(int rows)
{
  const int share = rows / (4 * vtkSMPTools::GetEstimatedNumberOfThreads());
  return std::clamp(share / TileHeight * TileHeight, 2 * TileHeight, 8 * TileHeight);
}

void forBands(int height, int rows, Watch& watch, const std::function<void(int v0, int v1)>& body)
{
  const int bands = (height + rows - 1) / rows;
  watch.begin(bands);
  vtkSMPTools::For(0, bands, 1,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType b = first; b < last && !watch.stopped(); ++b)
      {
        const int v0 = static_cast<int>(b) * rows;
        body(v0, std::min(v0 + rows, height));
        watch.bandDone();
      }
    });
  watch.ask();
}

void forSlices(Frame& frame, int beyond, bool reversed, const Progress& progress,
  const std::function<void(const Span& slices, bool isFirst, bool isLast)>& body)
{
  const int axis = frame.geometry.principalAxis(), depth = frame.geometry.size().z;
  const double share = progress.to - progress.from;
  frame.watch.setPart(progress.from, progress.to);
  if (frame.lines) // chains hold the voxels
  {
    body(Span{ 0, depth }, true, true);
    return;
  }
  if (frame.index.hasSlices(axis))
  {
    frame.slices = frame.index.slices(axis);
    body(Span{ 0, depth }, true, true);
    return;
  }
  const int chunks = (depth + ChunkDepth - 1) / ChunkDepth;
  for (int c = 0; c < chunks && !frame.watch.stopped(); ++c)
  {
    const int first = (reversed ? chunks - 1 - c : c) * ChunkDepth;
    const Span slices{ first, std::min(first + ChunkDepth, depth) };
    frame.watch.setPart(
      progress.from + share * c / chunks, progress.from + share * (c + 1) / chunks);
    frame.slices = frame.index.someSlices(
      std::max(slices.begin - beyond, 0), std::min(slices.end + beyond, depth), frame.space.chunk);
    body(slices, c == 0, c == chunks - 1);
  }
}
}
