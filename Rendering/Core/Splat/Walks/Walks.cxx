// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Parallel.h"
#include "Common/ProgressObserver.h"
#include "Splat/Walks/SliceSampler.h"
#include "Splat/Walks/WalkSpace.h"

#include <algorithm>

namespace splatting
{
namespace
{
/// Slices that are transposed at a time if there is no memory for a copy of all.
constexpr int ChunkDepth = 8 * BrickDepth;
}

int bandHeight(int rows)
{
  const int share = rows / (4 * numberOfThreads());
  return std::clamp(share / TileHeight * TileHeight, 2 * TileHeight, 8 * TileHeight);
}

void forBands(
  int height, int rows, ProgressObserver& observer, const std::function<void(int v0, int v1)>& body)
{
  const int bands = (height + rows - 1) / rows;
  observer.begin(bands);
  parallelFor(0, bands, 1,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t b = first; b < last && !observer.stopped(); ++b)
      {
        const int v0 = static_cast<int>(b) * rows;
        body(v0, std::min(v0 + rows, height));
        observer.bandDone();
      }
    });
  observer.ask();
}

void forSlices(ProjectionContext& context, int beyond, bool reversed,
  const std::function<void(const Span& slices, bool isFirst, bool isLast)>& body)
{
  const int axis = context.geometry.principalAxis(), depth = context.geometry.size().z;
  context.observer.setPart(0.0, 1.0);
  if (context.lines) // chains contain the voxels
  {
    body(Span{ 0, depth }, true, true);
    return;
  }
  if (context.index.hasSlices(axis))
  {
    context.slices = context.index.slices(axis);
    body(Span{ 0, depth }, true, true);
    return;
  }
  const int chunks = (depth + ChunkDepth - 1) / ChunkDepth;
  for (int c = 0; c < chunks && !context.observer.stopped(); ++c)
  {
    const int first = (reversed ? chunks - 1 - c : c) * ChunkDepth;
    const Span slices{ first, std::min(first + ChunkDepth, depth) };
    context.observer.setPart(c / double(chunks), (c + 1) / double(chunks));
    context.slices = context.index.someSlices(std::max(slices.begin - beyond, 0),
      std::min(slices.end + beyond, depth), context.space.chunk);
    body(slices, c == 0, c == chunks - 1);
  }
}
}
