// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops over segments of the screen's rays: placeSegments and findLargest of WorksheetLoops.
 * For Kernels.cxx only, which is compiled for several instruction sets and says why all of this is
 * in an anonymous namespace.
 */
#ifndef splattingSegmentKernels_h
#define splattingSegmentKernels_h

#include "Kernels/ExactKernels.h"

#include <limits>

namespace splatting
{
namespace
{
/// One side, column or row, of the voxels that segments need.
template <class A>
inline void placeSide(const double* __restrict at, const double* __restrict slope,
  const double* __restrict begin, const double* __restrict end,
  const std::int32_t* __restrict slice, double start, std::int32_t last,
  std::int32_t* __restrict first, A* __restrict x, A* __restrict dx, std::ptrdiff_t n)
{
  for (std::ptrdiff_t p = 0; p < n; ++p)
  {
    const double k = static_cast<double>(slice[p]);
    const double place = at[p] + slope[p] * (k - start);
    const double from = place + (begin[p] - k) * slope[p];
    const double to = place + (end[p] - k) * slope[p];
    const double low = to < from ? to : from;
    const std::int32_t whole = static_cast<std::int32_t>(low);
    const std::int32_t floor = whole - (low < static_cast<double>(whole));
    first[p] = smaller(larger(floor, -FieldSegments<A>::beyond), last);
    x[p] = static_cast<A>(place - static_cast<double>(first[p]));
    dx[p] = static_cast<A>(slope[p]);
  }
}

template <class A>
void placeSegments(FieldSegments<A>& segments, double start, const std::int32_t last[2])
{
  for (int a = 0; a < 2; ++a)
  {
    placeSide(segments.at[a], segments.slope[a], segments.begin, segments.end, segments.first[2],
      start, last[a], segments.first[a], segments.place[a], segments.way[a], segments.count);
  }
  for (std::ptrdiff_t p = 0; p < segments.count; ++p)
  {
    const double k = static_cast<double>(segments.first[2][p]);
    segments.from[p] = static_cast<A>(segments.begin[p] - k);
    segments.to[p] = static_cast<A>(segments.end[p] - k);
  }
}

/// The field along a register of segments of rays.
template <class A, bool NonFinite>
class SegmentLoop
{
public:
  using R = Pack<A>;
  using L = Lanes<A, R>;
  using M = typename L::M;

  SegmentLoop(const FieldSegments<A>& segments, std::ptrdiff_t n)
    : Segments(segments),
      At(n),
      From(L::loadFrom(segments.from + n)),
      To(L::loadFrom(segments.to + n)),
      X(segments.place[0] + n, segments.way[0] + n, From, To),
      Y(segments.place[1] + n, segments.way[1] + n, From, To)
  {
  }

  /// In up to three cells, one after the other.
  inline R largest() const
  {
    const M columnFirst = this->X.change < this->Y.change;
    const R first = smaller(this->X.change, this->Y.change);
    const R second = larger(this->X.change, this->Y.change);
    R best = L::all(-std::numeric_limits<A>::infinity());
    best = this->take(this->X.before, this->Y.before, this->From, first, best);
    best = this->take(columnFirst ? this->X.behind : this->X.before,
      columnFirst ? this->Y.before : this->Y.behind, first, second, best);
    return this->take(this->X.behind, this->Y.behind, second, this->To, best);
  }

private:
  /// Columns or rows of cells: whether a segment is in the upper of two, before and behind a
  /// change.
  struct Side
  {
    R at, way, change;
    M before, behind;

    inline Side(const A* x, const A* dx, R from, R to) : at(L::loadFrom(x)), way(L::loadFrom(dx))
    {
      const R one = L::all(A(1)), zero = L::all(A(0));
      const R begin = this->at + this->way * from, end = this->at + this->way * to;
      const M rises = this->way > zero, crosses = larger(begin, end) > one;
      this->change = crosses ? smaller(larger((one - this->at) / this->way, from), to) : to;
      this->before = crosses & ~rises;
      this->behind = crosses & rises;
    }
    inline R share(M upper, R depth) const
    {
      const R one = L::all(A(1)), zero = L::all(A(0));
      const R place = (this->at - (upper ? one : zero)) + this->way * depth;
      return smaller(larger(place, zero), one);
    }
  };

  inline R take(M upperColumn, M upperRow, R from, R to, R best) const
  {
    if (!anyLarger(to, from))
    {
      return best;
    }
    R corners[8];
#pragma GCC unroll 2
    for (int z = 0; z < 2; ++z)
    {
      R rows[2][3];
#pragma GCC unroll 3
      for (int x = 0; x < 3; ++x)
      {
        const auto& voxels = this->Segments.voxels[z];
        const R middle = L::loadFrom(voxels[1][x] + this->At);
        rows[0][x] = upperRow ? middle : L::loadFrom(voxels[0][x] + this->At);
        rows[1][x] = upperRow ? L::loadFrom(voxels[2][x] + this->At) : middle;
      }
#pragma GCC unroll 2
      for (int y = 0; y < 2; ++y)
      {
        corners[4 * z + 2 * y] = upperColumn ? rows[y][1] : rows[y][0];
        corners[4 * z + 2 * y + 1] = upperColumn ? rows[y][2] : rows[y][1];
      }
    }
    const R most = L::template largestOf<false>(corners);
    M counts = from < to;
    if constexpr (NonFinite)
    {
      R sum = corners[0];
      for (int n = 1; n < 8; ++n)
      {
        sum = sum + corners[n];
      }
      counts = counts & (sum - sum == L::all(A(0)));
    }
    if (!anyOf(counts & (most > best)))
    {
      return best;
    }
    const R found = largestOnWay<A>(corners,
      { this->X.share(upperColumn, from), this->Y.share(upperRow, from), from },
      { this->X.share(upperColumn, to), this->Y.share(upperRow, to), to },
      L::all(-std::numeric_limits<A>::infinity()));
    return counts ? larger(smaller(found, most), best) : best;
  }

  const FieldSegments<A>& Segments;
  const std::ptrdiff_t At;
  const R From, To;
  const Side X, Y;
};

template <class A>
void findLargest(FieldSegments<A>& segments)
{
  // Beyond the last one there is room, and something.
  for (std::ptrdiff_t n = 0; n < segments.count; n += width<A>)
  {
    store<A>(segments.largest + n,
      segments.nonFinite ? SegmentLoop<A, true>(segments, n).largest()
                         : SegmentLoop<A, false>(segments, n).largest());
  }
}
}
}

#endif
