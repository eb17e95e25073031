// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The cells of a slice of a block, and those of them whose field is not interpolated. For
 * CellKernels.cxx only.
 */
#ifndef splattingCellOctants_h
#define splattingCellOctants_h

#include "Cells/Kernels/CellLoops.h"
#include "Cells/Kernels/CellMargins.h"
#include "Cells/Kernels/CellRegisters.h"
#include "Cells/Kernels/ScreenTilePixels.h"

#include <cmath>

namespace splatting
{
namespace
{
/**
 * Positions of the 16 cells of a slice. Lengths are those of CellBlock.
 */
template <class A>
struct CellSlice
{
  static constexpr int Cells = 16;

  explicit CellSlice(const CellBlock<A>& block)
  {
    for (int n = 0; n < Cells; ++n)
    {
      this->Corner[0][n] = A((n & 3) - 2);
      this->Corner[1][n] = A((n >> 2) - 2);
      this->Place[0][n] = block.start[0].most - this->Corner[0][n];
      this->Place[1][n] = block.start[1].most - this->Corner[1][n];
    }
  }

  alignas(64) A Corner[2][Cells]; ///< the first corner of each cell
  alignas(64) A Place[2][Cells];  ///< where the block's ray begins, relative to that
  A PlaceZ = 0;
  alignas(64) A Low[2][Cells], High[2][Cells]; ///< the part that cropping leaves, if it cuts
  A LowZ = -BesideFace<A>, HighZ = 1 + BesideFace<A>;
  alignas(64) A MiddleT[Cells]; ///< t - reference of the middle of each cell
  alignas(64) A X0[Cells], X1[Cells], Y0[Cells],
    Y1[Cells]; ///< the pixels whose rays may cross each cell
};

/**
 * Splats cells with a hidden or infinite corner: each octant has the value of its nearest voxel.
 * The parameters are those of CellSplatter.
 */
template <class A, bool Perspective, bool Cut, bool Located, bool Shaded>
class CellOctants
{
  using R = Registers<A>;
  using M = typename R::Mask;
  static constexpr int Cells = CellSlice<A>::Cells;

public:
  CellOctants(ScreenTile<A>& tile, const CellBlock<A>& block, const CellSlice<A>& slice)
    : Tile(tile),
      Block(block),
      Slice(slice)
  {
  }

  /// Splats the cells of slice z with a corner that is hidden or infinite, and removes them from
  /// `alive`.
  void splat(int z, M alive[])
  {
    for (int n = 0; n < Cells; ++n)
    {
      if (!(alive[n / R::N] >> n % R::N & 1))
      {
        continue;
      }
      A corners[8];
      bool hole = false;
      for (int c = 0; c < 8; ++c)
      {
        const A* const slice =
          c & 1 ? this->Block.right[z + (c >> 2)] : this->Block.left[z + (c >> 2)];
        corners[c] = slice[n + 4 * (c >> 1 & 1)];
        hole |= corners[c] >= CellValue<A>::Highest || corners[c] <= CellValue<A>::Lowest;
      }
      for (int c = 0; c < 8 && hole; ++c)
      {
        corners[c] = this->isInField(n, z, c) ? corners[c] : CellValue<A>::None;
      }
      if (hole)
      {
        alive[n / R::N] = static_cast<M>(alive[n / R::N] & ~(1u << n % R::N));
        for (int y = static_cast<int>(this->Slice.Y0[n]); y <= static_cast<int>(this->Slice.Y1[n]);
             ++y)
        {
          for (int x = static_cast<int>(this->Slice.X0[n]);
               x <= static_cast<int>(this->Slice.X1[n]); ++x)
          {
            this->splatOctants(n, corners, x, y);
          }
        }
      }
    }
  }

private:
  /// Whether an octant lies in the field, which ends in the middle of the outermost cells. Rays end
  /// there, too, but because of rounding a short part may remain outside the field.
  bool isInField(int n, int z, int octant) const
  {
    const A first[3] = { this->Slice.Corner[0][n], this->Slice.Corner[1][n], A(z - 2) };
    bool inside = true;
    for (int a = 0; a < 3; ++a)
    {
      const A middle = first[a] + (octant >> a & 1 ? A(0.75) : A(0.25));
      inside = inside && middle > this->Block.fieldLow[a] && middle < this->Block.fieldHigh[a];
    }
    return inside;
  }

  struct Segment
  {
    A enter, leave;

    /// Cuts off what is outside of [low, high] along one axis.
    void clip(A o, A d, A low, A high)
    {
      if (d == 0)
      {
        const bool isInside = o >= low - InFace<A> && o <= high + InFace<A>;
        this->leave = isInside ? this->leave : -std::numeric_limits<A>::max();
        return;
      }
      const A p = (low - o) / d, q = (high - o) / d;
      const A begin = p < q ? p : q, end = p < q ? q : p;
      this->enter = begin > this->enter ? begin : this->enter;
      this->leave = end < this->leave ? end : this->leave;
    }
  };

  /// Splats the octants of a cell, each with the value of its voxel, to a pixel.
  void splatOctants(int n, const A (&corners)[8], int px, int py)
  {
    const CellBlock<A>& b = this->Block;
    const int at = py * this->Tile.Stride + px;
    if (this->Tile.values[at] == CellValue<A>::Outside)
    {
      return;
    }
    const A x = A(px - b.x), y = A(py - b.y), middle = this->Slice.MiddleT[n];
    A o[3], d[3];
    for (int a = 0; a < 3; ++a)
    {
      const A place = a == 2 ? this->Slice.PlaceZ : this->Slice.Place[a][n];
      const A start = fused(x, b.startAcross[a].most, fused(y, b.startUp[a].most, place));
      const A startRest =
        fused(x, b.startAcross[a].rest, fused(y, b.startUp[a].rest, b.start[a].rest));
      A most = b.forward[a].most, rest = b.forward[a].rest;
      if (Perspective)
      {
        most = fused(x, b.forwardAcross[a].most, fused(y, b.forwardUp[a].most, most));
        rest = fused(x, b.forwardAcross[a].rest, fused(y, b.forwardUp[a].rest, rest));
      }
      o[a] = fused(most, middle, start) + fused(rest, middle, startRest);
      const A direction = most + rest;
      const bool isFlat = Perspective ? std::fabs(direction) < A(0x1p-43) : b.flat[a];
      d[a] = isFlat ? A(0) : direction;
    }
    Segment ray{ -std::numeric_limits<A>::max(), std::numeric_limits<A>::max() };
    A near = 0, far = 0;
    if (Cut)
    {
      near = this->Tile.nears[at] - b.reference - middle + this->Tile.nearRests[at];
      far = this->Tile.fars[at] - b.reference - middle + this->Tile.farRests[at];
      ray = { near, far };
      for (int a = 0; a < 3; ++a)
      {
        ray.clip(o[a], d[a], a == 2 ? this->Slice.LowZ : this->Slice.Low[a][n],
          a == 2 ? this->Slice.HighZ : this->Slice.High[a][n]);
      }
    }
    for (int c = 0; c < 8; ++c)
    {
      Segment part = ray;
      for (int a = 0; a < 3; ++a)
      {
        const bool upper = c >> a & 1;
        part.clip(
          o[a], d[a], upper ? A(0.5) : -BesideFace<A>, upper ? A(1) + BesideFace<A> : A(0.5));
      }
      if (!(part.leave - part.enter > Sliver<A>) || corners[c] == CellValue<A>::None)
      {
        continue;
      }
      A value = corners[c];
      if (Shaded)
      {
        A share = fused(A(0.5), part.leave - part.enter, part.enter - near) / (far - near);
        share = share > 0 ? share < 1 ? share : A(1) : A(0);
        const bool finite = value < CellValue<A>::Highest && value > CellValue<A>::Lowest;
        value = finite ? value * fused(A(1) - share, b.rate, b.ambient) : value;
      }
      raise<A, Located>(this->Tile, px, py, value, part.enter + middle + b.reference);
    }
  }

  ScreenTile<A>& Tile;
  const CellBlock<A>& Block;
  const CellSlice<A>& Slice;
};
}
}

#endif
