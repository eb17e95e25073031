// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops of exact mode in perspective. For Kernels.cxx only, which says why all of this is in an
 * anonymous namespace.
 */
#ifndef splattingPerspectiveExactKernels_h
#define splattingPerspectiveExactKernels_h

#include "Kernels/ExactKernels.h"

#include <limits>

namespace splatting
{
namespace
{
/// Columns of voxels under a row of pixels in perspective, and what the field is at most where the
/// row's rays pass them.
template <class A>
class PerspectiveColumns
{
public:
  PerspectiveColumns(const PerspectiveCubicRow<A>& row, std::ptrdiff_t begin, std::ptrdiff_t end)
    : First(row.columns.cell[begin] - 1),
      Count(row.columns.cell[end - 1] + 4 - First)
  {
    constexpr std::ptrdiff_t w = width<A>;
    for (std::ptrdiff_t c = 0; c < this->Count && this->known(); c += w)
    {
      const std::ptrdiff_t at = c + w <= this->Count ? c : this->Count - w;
      store<A>(this->Largest + at, largest(row, this->First + at));
    }
  }

  /// Pixels are narrower than voxels: there is room.
  bool known() const { return this->Count >= width<A> && this->Count <= Room; }
  /// From a column on.
  const A* from(std::int32_t column) const { return this->Largest + (column - this->First); }

private:
  static constexpr std::ptrdiff_t Room = 512;

  static inline Pack<A> largest(const PerspectiveCubicRow<A>& row, std::ptrdiff_t at)
  {
    const PathBox<A>& box = row.box;
    const Pack<A> a = largestAt<A, Pack<A>>(box, at);
    const Pack<A> b = largestAt<A, Pack<A>>(box, at + row.sourceStride);
    return largestBetween(
      box.rows, a, b, box.rows.crosses ? largestAt<A, Pack<A>>(box, at + 2 * row.sourceStride) : b);
  }

  std::ptrdiff_t First, Count;
  A Largest[Room + 4 * width<A>]; // loops read whole registers
};

/// The cubics of a perspective view: each pixel has a place of its own in the cells, that of a row
/// of cells goes for all.
template <class A, class R, bool NonFinite>
struct PerspectiveCubicLoop : Lanes<A, R>
{
  using typename Lanes<A, R>::M;
  using typename Lanes<A, R>::I;
  using Lanes<A, R>::all;
  using Lanes<A, R>::loadFrom;
  static constexpr bool single = Lanes<A, R>::single;
  const PerspectiveCubicRow<A>& row;

  explicit PerspectiveCubicLoop(const PerspectiveCubicRow<A>& own) : row(own) {}

  static inline R clampedShare(R x) { return smaller(larger(x, all(A(0))), all(A(1))); }

  /// The pixels' cells, as the least of them and how far the others are from it.
  struct Cells
  {
    std::int32_t least;
    LaneOf<A> lanes[single ? 1 : width<A>];

    explicit Cells(const std::int32_t* cells) : least(cells[0])
    {
      constexpr std::ptrdiff_t count = single ? 1 : width<A>;
      // They ascend, but for the rounding of rays that meet in the eye.
      for (std::ptrdiff_t n = 1; n < count; ++n)
      {
        this->least = smaller(cells[n], this->least);
      }
      for (std::ptrdiff_t n = 0; n < count; ++n)
      {
        this->lanes[n] = cells[n] - this->least;
      }
    }

    /// @param voxels  of column 0
    inline R pick(const A* voxels) const { return this->pickFrom(voxels + this->least); }
    /// @param first  the voxel of the least cell
    inline R pickFrom(const A* first) const
    {
      if constexpr (single)
      {
        return *first;
      }
      else
      {
#if defined(__AVX2__)
        if constexpr (Resampler<A>::picks)
        {
          return Resampler<A>::pick(first, loadRegister(this->lanes));
        }
#endif
        R picked;
        for (std::ptrdiff_t n = 0; n < width<A>; ++n)
        {
          picked[n] = first[this->lanes[n]];
        }
        return picked;
      }
    }
  };

  /// The largest of the cubics from one depth to another.
  inline R largestFrom(const PerspectiveCubicSegment<A>& segment, const R (&corners)[8], R x,
    R slope, R from, R to, R best, M counts) const
  {
    const R x0 = clampedShare(x + slope * from), x1 = clampedShare(x + slope * to);
    const R y0 = clampedShare(segment.y + this->row.slope * from),
            y1 = clampedShare(segment.y + this->row.slope * to);
    const R z0 = clampedShare(segment.z + from), z1 = clampedShare(segment.z + to);
    const R raised = largestOnWay<A>(corners, { x0, y0, z0 }, { x1, y1, z1 }, best);
    const R limited =
      Lanes<A, R>::limitedTo(raised, Lanes<A, R>::template largestOf<NonFinite>(corners), best);
    return counts ? limited : best;
  }

  /// Whether a sample can be above its pixel: whether the largest value in its box is.
  inline bool canRaise(const PerspectiveColumns<A>& columns, std::ptrdiff_t x) const
  {
    const R one = all(A(1));
    const R at = loadFrom(this->row.columns.at + x), slope = loadFrom(this->row.columns.slope + x);
    const R near = at + slope * this->row.segments[0].from;
    const R far = at + slope * this->row.segments[this->row.count - 1].to;
    const R begin = smaller(near, far), end = larger(near, far);
    const Cells cells(this->row.columns.cell + x);
    const A* const voxels = columns.from(cells.least);
    const R a = cells.pickFrom(voxels), b = cells.pickFrom(voxels + 1),
            c = cells.pickFrom(voxels + 2);
    const R first = between(a, b, clampedShare(begin));
    const R last = end > one ? larger(b, between(b, c, clampedShare(end - one)))
                             : between(a, b, clampedShare(end));
    return anyLarger(larger(first, last) + this->row.box.slack, loadFrom(this->row.image + x));
  }

  inline void run(std::ptrdiff_t x) const
  {
    const AxisCellArrays<A>& c = this->row.columns;
    const R before = loadFrom(this->row.image + x);
    R best = Lanes<A, R>::template opened<NonFinite>(before);
    // Rays beside the field see boxes.
    const R near = larger(loadFrom(c.fieldNear + x), all(this->row.fieldNear));
    const R far = smaller(loadFrom(c.fieldFar + x), all(this->row.fieldFar));
    const M inField = far - near > this->row.shortest;
    const R begin = inField ? larger(loadFrom(c.fieldBegin + x), all(this->row.fieldBegin))
                            : larger(loadFrom(c.boxesBegin + x), all(this->row.boxesBegin));
    const R end = inField ? smaller(loadFrom(c.fieldEnd + x), all(this->row.fieldEnd))
                          : smaller(loadFrom(c.boxesEnd + x), all(this->row.boxesEnd));
    const R at = loadFrom(c.at + x), slope = loadFrom(c.slope + x),
            crossing = loadFrom(c.crossing + x);
    const R zero = all(A(0)), one = all(A(1));
    const Cells cells(c.cell + x);
    // Rays that fall begin in the upper of their two cells.
    const M falls = (slope < zero) & (crossing < one);
    for (int p = 0; p < this->row.count; ++p)
    {
      const PerspectiveCubicSegment<A>& segment = this->row.segments[p];
      const R from = larger(begin, all(segment.from)), to = smaller(end, all(segment.to));
      const R change = larger(from, smaller(crossing, to));
      const M first = from < change, second = change < to;
      if (!anyOf(first | second))
      {
        continue;
      }
      R voxels[4][3];
      const R most = pick(cells, segment.rows, voxels);
      if (!anyLarger(most, best))
      {
        continue;
      }
      const R atMost = larger(most, best);
      R corners[8];
      if (anyOf(first))
      {
        choose(voxels, falls, corners);
        const R start = at - (falls ? one : zero);
        best = this->largestFrom(segment, corners, start, slope, from, change, best, first);
      }
      if (anyOf(second))
      {
        choose(voxels, slope > zero, corners);
        const R start = at - (slope > zero ? one : zero);
        best = this->largestFrom(segment, corners, start, slope, change, to, best, second);
      }
      best = smaller(best, atMost); // as in parallel views
    }
    Lanes<A, R>::template close<NonFinite>(this->row.image + x, before, best);
  }

  /// The voxels of both cells; returns the largest.
  static inline R pick(const Cells& cells, const A* const (&rows)[4], R (&voxels)[4][3])
  {
    R most = all(-std::numeric_limits<A>::infinity());
    for (int n = 0; n < 4; ++n)
    {
      for (int t = 0; t < 3; ++t)
      {
        voxels[n][t] = cells.pick(rows[n] + t);
        most = larger(voxels[n][t], most);
      }
    }
    return most;
  }

  /// The voxels of the upper or the lower cell.
  static inline void choose(const R (&voxels)[4][3], const M& upper, R (&corners)[8])
  {
#pragma GCC unroll 4
    for (int n = 0; n < 4; ++n)
    {
      corners[2 * n] = upper ? voxels[n][1] : voxels[n][0];
      corners[2 * n + 1] = upper ? voxels[n][2] : voxels[n][1];
    }
  }
};

constexpr std::ptrdiff_t MostAtOnce = 256; ///< pixels of a row

/// Some pixels: a register or more.
template <class A>
inline void raiseAboveBoxes(
  const PerspectiveCubicRow<A>& row, std::ptrdiff_t begin, std::ptrdiff_t end)
{
  const PerspectiveCubicLoop<A, Pack<A>, false> loop(row);
  const PerspectiveColumns<A> columns(row, begin, end);
  // All are asked before the first is raised, so that no answer is waited for.
  std::ptrdiff_t found[MostAtOnce / width<A>];
  int count = 0;
  for (std::ptrdiff_t x = begin; x < end; x += width<A>)
  {
    const std::ptrdiff_t at = x + width<A> <= end ? x : end - width<A>;
    found[count] = at;
    count += !columns.known() || loop.canRaise(columns, at);
  }
  for (int n = 0; n < count; ++n)
  {
    loop.run(found[n]);
  }
}

template <class A, bool NonFinite>
inline void raisePerspectiveCubicRow(const PerspectiveCubicRow<A>& row)
{
  constexpr std::ptrdiff_t w = width<A>, most = NonFinite ? w : MostAtOnce;
  const std::ptrdiff_t begin = row.pixels.begin, end = row.pixels.end;
  for (std::ptrdiff_t x = begin; end - begin < w && x < end; ++x)
  {
    PerspectiveCubicLoop<A, A, NonFinite>(row).run(x);
  }
  for (std::ptrdiff_t x = begin; end - begin >= w && x < end; x += most)
  {
    const std::ptrdiff_t last = x + most < end ? x + most : end;
    const std::ptrdiff_t first = last - x >= w ? x : last - w;
    if constexpr (NonFinite)
    {
      PerspectiveCubicLoop<A, Pack<A>, true>(row).run(first);
    }
    else
    {
      raiseAboveBoxes(row, first, last);
    }
  }
}

template <class A>
void raisePerspectiveCubics(const PerspectiveCubicRow<A>& row)
{
  row.nonFinite ? raisePerspectiveCubicRow<A, true>(row) : raisePerspectiveCubicRow<A, false>(row);
}
}
}

#endif
