// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The work space of walks, kept between frames.
 */
#ifndef splattingWalkSpace_h
#define splattingWalkSpace_h

#include "Common/Parallel.h"
#include "Splat/Projection/ProjectionContext.h"
#include "Splat/Projection/RayIntervals.h"
#include "Splat/Walks/Cuts.h"
#include "Splat/Walks/SliceSampler.h"
#include "Splat/Walks/TileRuns.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace splatting
{
/// Work space of outlineImage().
struct OutlineSpace
{
  struct Rows
  {
    std::vector<std::int16_t> first, last;
    std::vector<unsigned char> slice;
  };
  CrossedSlices crossed;
  PerThread<Rows> rows;
};

/// Copies of pixels, into which samples are taken apart from the image.
class PixelCopies
{
public:
  /// Copies runs of some rows.
  /// @param slices  the number of copies, one for each slice
  template <class P>
  PixelRows<P> copy(
    const PixelRows<P>& from, int v0, int v1, const std::vector<Span>& runs, int slices);

private:
  std::vector<unsigned char> Bytes;
};

/// Work space of a thread for a band.
struct BandScratch
{
  LoadedVoxels loaded;
  std::vector<unsigned char> voxelBounds, bounds, minima, flags;
  std::vector<int> order;
  std::vector<double> scores;
  std::vector<Span> runs;
  TileShares shares;
  PixelCopies copies;
  std::vector<unsigned char> mask, counting;
  std::vector<unsigned char> brickRow;
  std::vector<Span> tileWindows;
  TileCount count;
};

/// Work space of a thread for rays.
struct RayScratch
{
  LoadedVoxels loaded;
  std::vector<unsigned char> mask, widened, before;
};

/// State of all pixels between slices of a walk by rays, besides the image.
struct RayState
{
  std::vector<unsigned char> ended; ///< Reduction::Local: whether the maximum is found
  std::vector<double> sums;         ///< Reduction::Mean
  std::vector<std::int32_t> counts; ///< Reduction::Mean
  RayIntervals crossed;             ///< Reduction::DepthShaded: the visible slices
};

struct WalkSpace
{
  PerThread<BandScratch> bands;
  PerThread<RayScratch> rayBands;
  RayState rays;
  OutlineSpace outline;
  std::vector<unsigned char> chunk;
};

/// Calls body(slices, isFirst, isLast) with ProjectionContext::slices set: for all slices or, if
/// there is no memory for a copy of them, for some at a time, from the last on if reversed.
/// @param beyond  neighbouring slices that are also read
void forSlices(ProjectionContext& context, int beyond, bool reversed,
  const std::function<void(const Span& slices, bool isFirst, bool isLast)>& body);

template <class P>
PixelRows<P> PixelCopies::copy(
  const PixelRows<P>& from, int v0, int v1, const std::vector<Span>& runs, int slices)
{
  const std::ptrdiff_t all = (v1 - v0) * from.stride;
  this->Bytes.resize(std::max(this->Bytes.size(), slices * all * sizeof(P)));
  P* const first = reinterpret_cast<P*>(this->Bytes.data());
  const PixelRows<P> copies{ first - v0 * from.stride, from.stride, slices > 1 ? all : 0 };
  for (int n = 0; n < slices; ++n)
  {
    for (int v = v0; v < v1; ++v)
    {
      for (const Span& run : runs)
      {
        std::copy(from.at(run.begin, v), from.at(run.end, v), copies.slice(n).at(run.begin, v));
      }
    }
  }
  return copies;
}
}

#endif
