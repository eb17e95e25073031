// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * A block of cells onto the pixels of a tile. For CellKernels.cxx only.
 *
 * Sixteen cells, those of a slice, are taken at a time: their largest corners, then the pixels that
 * may see them, then the pairs of a cell and a pixel that is below the cell's largest corner. Pairs
 * are collected until they fill a register; for these the cubics are computed. A pair's value
 * depends on the pair alone.
 */
#ifndef splattingCellSplatter_h
#define splattingCellSplatter_h

#include "Cells/Kernels/CellCubics.h"
#include "Cells/Kernels/CellLoops.h"
#include "Cells/Kernels/CellMargins.h"
#include "Cells/Kernels/CellOctants.h"
#include "Cells/Kernels/CellRegisters.h"
#include "Cells/Kernels/ScreenTilePixels.h"

#include <cmath>
#include <cstring>

namespace splatting
{
namespace
{
/**
 * @tparam Cut      whether rays or the field end within the block
 * @tparam Located  whether the parameters of the samples are wanted
 * @tparam Shaded   whether samples are shaded by their depth; only with Cut, which has rays' ends
 */
template <class A, bool Perspective, bool Cut, bool Located, bool Shaded>
class CellSplatter
{
  using R = Registers<A>;
  using V = typename R::Value;
  using M = typename R::Mask;
  using I = typename R::Index;
  static constexpr int Cells = CellSlice<A>::Cells;
  static constexpr bool Split = sizeof(A) < sizeof(double);
  static_assert(Cut || !Shaded);

  /// See CellSum.
  struct Sum
  {
    V most, rest;

    SPLATTING_INLINE V whole() const { return Split ? R::add(this->most, this->rest) : this->most; }
    /// o + t d
    static SPLATTING_INLINE V at(const Sum& o, const Sum& d, V t)
    {
      const V most = R::fma(d.most, t, o.most);
      return Split ? R::add(most, R::fma(d.rest, t, o.rest)) : most;
    }
  };

public:
  CellSplatter(ScreenTile<A>& tile, const CellBlock<A>& block)
    : Tile(tile),
      Block(block),
      Slice(block)
  {
    for (int n = 0; n < Cells; ++n)
    {
      const int x = n & 3, y = n >> 2;
      bool valid =
        x >= block.begin[0] && x < block.end[0] && y >= block.begin[1] && y < block.end[1];
      for (int a = 0; a < 2 && Cut; ++a)
      {
        this->Slice.Low[a][n] = lowEnd(block.low[a] - this->Slice.Corner[a][n]);
        this->Slice.High[a][n] = highEnd(block.high[a] - this->Slice.Corner[a][n]);
        valid = valid && this->Slice.Low[a][n] < this->Slice.High[a][n];
      }
      this->Valid[n] = valid ? CellValue<A>::Outside : CellValue<A>::None;
    }
  }

  void run()
  {
    V before[Groups];
    this->findSliceMaxima(this->Block.begin[2], before);
    for (int z = this->Block.begin[2]; z < this->Block.end[2]; ++z)
    {
      V after[Groups];
      this->findSliceMaxima(z + 1, after);
      M alive[Groups];
      M any = 0;
      for (int g = 0; g < Groups; ++g)
      {
        V top = R::larger(before[g], after[g]);
        before[g] = after[g];
        top = R::smaller(top, R::load(this->Valid + g * R::N));
        R::store(this->Top + g * R::N, top);
        alive[g] = this->mayRaise(top, this->Block.least);
        any |= alive[g];
      }
      if (any)
      {
        this->splatSlice(z, alive);
      }
    }
    if (this->Tile.firstChanged <= this->Tile.lastChanged)
    {
      refresh(this->Tile);
    }
  }

private:
  static constexpr int Groups = Cells / R::N;

  SPLATTING_INLINE M mayRaise(V top, A least) const
  {
    // Cells that the volume does not have, or all of whose voxels are hidden, raise nothing.
    const M exists = R::above(top, R::set(CellValue<A>::None));
    if (Shaded)
    {
      top = this->Block.bounded ? R::mul(top, R::set(this->Block.mostFactor))
                                : R::set(CellValue<A>::Highest);
    }
    return static_cast<M>(
      exists & (Located ? R::atLeast(top, R::set(least)) : R::above(top, R::set(least))));
  }

  SPLATTING_INLINE void findSliceMaxima(int z, V maxima[]) const
  {
    const A *const left = this->Block.left[z], *const right = this->Block.right[z];
    for (int g = 0; g < Groups; ++g)
    {
      const int n = g * R::N;
      maxima[g] = R::larger(R::larger(R::load(left + n), R::load(right + n)),
        R::larger(R::load(left + n + 4), R::load(right + n + 4)));
    }
  }

  void splatSlice(int z, M alive[])
  {
    if (Cut)
    {
      this->Slice.LowZ = lowEnd(this->Block.low[2] - A(z - 2));
      this->Slice.HighZ = highEnd(this->Block.high[2] - A(z - 2));
      if (!(this->Slice.LowZ < this->Slice.HighZ))
      {
        return;
      }
    }
    if (this->Block.seen)
    {
      this->takeSeen(z, alive);
    }
    else
    {
      this->findSeen(z, alive);
    }
    M any = 0;
    for (int g = 0; g < Groups; ++g)
    {
      any |= alive[g];
    }
    if (!any)
    {
      return;
    }
    this->findPolynomials(z);
    this->prepareSlice(z);
    if (this->Block.holes)
    {
      CellOctants<A, Perspective, Cut, Located, Shaded>(this->Tile, this->Block, this->Slice)
        .splat(z, alive);
    }
    int pending = 0;
    for (int g = 0; g < Groups; ++g)
    {
      alive[g] = this->listSmallCells(g, alive[g], pending);
    }
    for (int g = 0; g < Groups; ++g)
    {
      for (unsigned cells = alive[g]; cells; cells &= cells - 1)
      {
        this->listCell(g * R::N + __builtin_ctz(cells), pending);
      }
    }
    if (pending > 0)
    {
      this->evaluate(this->Pairs, firstLanes<A>(pending));
    }
  }

  /// Finds the pixels whose rays may cross each cell.
  void findSeen(int z, M alive[])
  {
    const CellBlock<A>& b = this->Block;
    const V margin = R::set(b.margin);
    const V restX = R::set(fused(b.across[2], A(z - 2), b.acrossStart));
    const V restY = R::set(fused(b.up[2], A(z - 2), b.upStart));
    for (int g = 0; g < Groups; ++g)
    {
      if (!alive[g])
      {
        continue;
      }
      const int n = g * R::N;
      // The part of each cell that narrow() leaves: its middle, relative to the cell's first
      // corner, and half its sides.
      V m[3], h[3];
      this->narrow(z, n, m, h);
      const V cx = R::add(R::load(this->Slice.Corner[0] + n), m[0]);
      const V cy = R::add(R::load(this->Slice.Corner[1] + n), m[1]);
      const V mx = R::fma(R::set(b.across[0]), cx,
        R::fma(R::set(b.across[1]), cy, R::fma(R::set(b.across[2]), m[2], restX)));
      const V my = R::fma(
        R::set(b.up[0]), cx, R::fma(R::set(b.up[1]), cy, R::fma(R::set(b.up[2]), m[2], restY)));
      const V reachX = reachOf(b.across, h), reachY = reachOf(b.up, h);
      V x0 = R::sub(mx, reachX), x1 = R::add(mx, reachX);
      V y0 = R::sub(my, reachY), y1 = R::add(my, reachY);
      if (Perspective)
      {
        const V p = R::set(b.inverses[0]), q = R::set(b.inverses[1]);
        x0 = R::smaller(R::mul(x0, p), R::mul(x0, q));
        x1 = R::larger(R::mul(x1, p), R::mul(x1, q));
        y0 = R::smaller(R::mul(y0, p), R::mul(y0, q));
        y1 = R::larger(R::mul(y1, p), R::mul(y1, q));
      }
      const V atX = R::set(A(b.x)), atY = R::set(A(b.y));
      x0 = R::larger(R::ceil(R::sub(R::add(x0, atX), margin)), R::set(A(b.columns[0])));
      x1 = R::smaller(R::floor(R::add(R::add(x1, atX), margin)), R::set(A(b.columns[1])));
      y0 = R::larger(R::ceil(R::sub(R::add(y0, atY), margin)), R::set(A(b.rows[0])));
      y1 = R::smaller(R::floor(R::add(R::add(y1, atY), margin)), R::set(A(b.rows[1])));
      alive[g] = static_cast<M>(alive[g] & R::atLeast(x1, x0) & R::atLeast(y1, y0));
      R::store(this->Slice.X0 + n, x0);
      R::store(this->Slice.X1 + n, x1);
      R::store(this->Slice.Y0 + n, y0);
      R::store(this->Slice.Y1 + n, y1);
    }
  }

  static SPLATTING_INLINE V reachOf(const A (&row)[3], const V h[3])
  {
    return R::fma(R::set(std::fabs(row[0])), h[0],
      R::fma(R::set(std::fabs(row[1])), h[1], R::mul(R::set(std::fabs(row[2])), h[2])));
  }

  /// The part of cells in which the field may exceed all pixels that see the block. For any x the
  /// field is not above the interpolation between the largest corner at x = 0 and the largest
  /// corner at x = 1.
  SPLATTING_INLINE void narrow(int z, int n, V middle[3], V half[3]) const
  {
    const V point5 = R::set(A(0.5));
    for (int a = 0; a < 3; ++a)
    {
      middle[a] = half[a] = point5;
    }
    if (Shaded || this->Block.holes)
    {
      return;
    }
    const V a000 = R::load(this->Block.left[z] + n), a100 = R::load(this->Block.right[z] + n);
    const V a010 = R::load(this->Block.left[z] + n + 4);
    const V a110 = R::load(this->Block.right[z] + n + 4);
    const V a001 = R::load(this->Block.left[z + 1] + n);
    const V a101 = R::load(this->Block.right[z + 1] + n);
    const V a011 = R::load(this->Block.left[z + 1] + n + 4);
    const V a111 = R::load(this->Block.right[z + 1] + n + 4);
    const V x0 = R::larger(R::larger(a000, a010), R::larger(a001, a011));
    const V x1 = R::larger(R::larger(a100, a110), R::larger(a101, a111));
    const V y0 = R::larger(R::larger(a000, a100), R::larger(a001, a101));
    const V y1 = R::larger(R::larger(a010, a110), R::larger(a011, a111));
    const V z0 = R::larger(R::larger(a000, a100), R::larger(a010, a110));
    const V z1 = R::larger(R::larger(a001, a101), R::larger(a011, a111));
    this->narrow(x0, x1, middle[0], half[0]);
    this->narrow(y0, y1, middle[1], half[1]);
    this->narrow(z0, z1, middle[2], half[2]);
  }

  /// From the bounds at both ends of an axis.
  SPLATTING_INLINE void narrow(V first, V last, V& middle, V& half) const
  {
    const V least = R::set(this->Block.least), zero = R::set(0), one = R::set(1);
    const V margin = R::set(A(1e-3)), point5 = R::set(A(0.5));
    const M begins = Located ? R::atLeast(first, least) : R::above(first, least);
    const M ends = Located ? R::atLeast(last, least) : R::above(last, least);
    const V crossing = R::div(R::sub(least, first), R::sub(last, first));
    V low = R::choose(begins, zero, R::sub(crossing, margin));
    V high = R::choose(ends, one, R::add(crossing, margin));
    low = R::smaller(R::larger(low, zero), one);
    high = R::smaller(R::larger(high, low), one);
    middle = R::mul(R::add(low, high), point5);
    half = R::mul(R::sub(high, low), point5);
  }

  void takeSeen(int z, M alive[])
  {
    for (int n = 0; n < Cells; ++n)
    {
      const std::int32_t* const seen = this->Block.seen[z * Cells + n];
      this->Slice.X0[n] = A(seen[0]);
      this->Slice.X1[n] = A(seen[1]);
      this->Slice.Y0[n] = A(seen[2]);
      this->Slice.Y1[n] = A(seen[3]);
      if (seen[0] > seen[1] || seen[2] > seen[3])
      {
        alive[n / R::N] = static_cast<M>(alive[n / R::N] & ~(1u << n % R::N));
      }
    }
  }

  /// The field of each cell as a polynomial in x, y, z from its first corner.
  void findPolynomials(int z)
  {
    const A *const l0 = this->Block.left[z], *const r0 = this->Block.right[z];
    const A *const l1 = this->Block.left[z + 1], *const r1 = this->Block.right[z + 1];
    for (int n = 0; n < Cells; n += R::N)
    {
      const V a000 = R::load(l0 + n), a100 = R::load(r0 + n);
      const V a010 = R::load(l0 + n + 4), a110 = R::load(r0 + n + 4);
      const V a001 = R::load(l1 + n), a101 = R::load(r1 + n);
      const V a011 = R::load(l1 + n + 4), a111 = R::load(r1 + n + 4);
      const V x = R::sub(a100, a000), y = R::sub(a010, a000), w = R::sub(a001, a000);
      const V xy = R::sub(R::sub(a110, a100), y), xz = R::sub(R::sub(a101, a001), x);
      const V yz = R::sub(R::sub(a011, a001), y);
      const V xyz = R::sub(R::add(R::sub(R::sub(a111, a101), a011), a001), xy);
      R::store(this->K[0] + n, a000);
      R::store(this->K[1] + n, x);
      R::store(this->K[2] + n, y);
      R::store(this->K[3] + n, w);
      R::store(this->K[4] + n, xy);
      R::store(this->K[5] + n, xz);
      R::store(this->K[6] + n, yz);
      R::store(this->K[7] + n, xyz);
    }
  }

  void prepareSlice(int z)
  {
    const A corner = A(z - 2);
    const A middle = fused(this->Block.alongT[2], corner + A(0.5), this->Block.middleT);
    this->Slice.PlaceZ = this->Block.start[2].most - corner;
    for (int n = 0; n < Cells; ++n)
    {
      this->Slice.MiddleT[n] = fused(this->Block.alongT[0], this->Slice.Corner[0][n] + A(0.5),
        fused(this->Block.alongT[1], this->Slice.Corner[1][n] + A(0.5), middle));
      A bound = Shaded ? this->Top[n] * this->Block.mostFactor : this->Top[n];
      bound = Shaded && !this->Block.bounded ? CellValue<A>::Highest : bound;
      if (Located && bound >= this->Block.tiesFrom)
      {
        bound = nextAbove(bound);
      }
      this->Bound[n] = bound;
    }
  }

  /// Lists the pairs of cells that few pixels see. Each step lists one pixel for all of these
  /// cells. Returns the other cells.
  M listSmallCells(int g, M alive, int& pending)
  {
    constexpr A most = A(6.5);
    if (!alive)
    {
      return 0;
    }
    const int n = g * R::N;
    const V one = R::set(1);
    const V x0 = R::load(this->Slice.X0 + n), x1 = R::load(this->Slice.X1 + n),
            y1 = R::load(this->Slice.Y1 + n);
    V x = x0, y = R::load(this->Slice.Y0 + n);
    const V count = R::mul(R::add(R::sub(x1, x0), one), R::add(R::sub(y1, y), one));
    M small = static_cast<M>(alive & R::above(R::set(most), count));
    if (__builtin_popcount(small) < 4)
    {
      return alive;
    }
    const M others = static_cast<M>(alive & ~small);
    const V bound = R::load(this->Bound + n), stride = R::set(A(this->Tile.Stride));
    V lane = R::load(Ramp<A>);
    lane = R::add(lane, R::set(A(n)));
    do
    {
      const V value =
        R::gather(this->Tile.values, R::fma(y, stride, x), small, R::set(CellValue<A>::Outside));
      const M on = static_cast<M>(small & R::above(bound, value));
      const V id = R::fma(y, R::set(A(4096)), R::fma(x, R::set(A(16)), lane));
      this->append(R::compress(this->Pairs + pending, id, on), pending);
      x = R::add(x, one);
      const M over = R::above(x, x1);
      y = R::choose(over, R::add(y, one), y);
      x = R::choose(over, x0, x);
      small = static_cast<M>(small & R::atLeast(y1, y));
    } while (small);
    return others;
  }

  void listCell(int n, int& pending)
  {
    const int x0 = static_cast<int>(this->Slice.X0[n]), x1 = static_cast<int>(this->Slice.X1[n]);
    const int y0 = static_cast<int>(this->Slice.Y0[n]), y1 = static_cast<int>(this->Slice.Y1[n]);
    const V bound = R::set(this->Bound[n]);
    for (int x = x0; x <= x1; x += R::N)
    {
      const M columns = firstLanes<A>(x1 - x + 1);
      const A* row = this->Tile.values + y0 * this->Tile.Stride + x;
      std::int32_t id = n | x << 4 | y0 << 12;
      for (int y = y0; y <= y1; ++y, row += this->Tile.Stride, id += 1 << 12)
      {
        const M on = static_cast<M>(R::above(bound, R::load(row)) & columns);
        this->append(R::compress(this->Pairs + pending, id, 16, on), pending);
      }
    }
  }

  SPLATTING_INLINE void append(int count, int& pending)
  {
    pending += count;
    if (pending >= R::N)
    {
      pending -= R::N;
      this->evaluate(this->Pairs + pending, firstLanes<A>(R::N));
    }
  }

  /// place + rest + x across + y up
  static SPLATTING_INLINE Sum along(
    V x, V y, const CellSum<A>& across, const CellSum<A>& up, V place, A rest)
  {
    return { R::fma(x, R::set(across.most), R::fma(y, R::set(up.most), place)),
      !Split ? R::set(0)
             : R::fma(x, R::set(across.rest), R::fma(y, R::set(up.rest), R::set(rest))) };
  }

  /// The part of rays within cells along one axis.
  SPLATTING_INLINE void clip(int a, V o, V d, V low, V high, V& enter, V& leave, M& on) const
  {
    if (!Perspective && this->Block.flat[a])
    {
      const V beside = R::set(InFace<A>);
      on = static_cast<M>(
        on & R::atLeast(R::add(o, beside), low) & R::atLeast(R::add(high, beside), o));
      return;
    }
    V inverse = R::set(this->Block.inverse[a]);
    if (Perspective)
    {
      inverse = R::smaller(R::div(R::set(1), d), R::set(Steepest<A>));
      inverse = R::larger(inverse, R::set(-Steepest<A>));
      if (!Split)
      {
        const M isFlat =
          R::above(R::larger(inverse, R::sub(R::set(0), inverse)), R::set(A(0x1p43)));
        const V beside = R::choose(isFlat, R::set(InFace<A>), R::set(0));
        low = R::sub(low, beside);
        high = R::add(high, beside);
      }
    }
    V p = R::mul(R::sub(low, o), inverse), q = R::mul(R::sub(high, o), inverse);
    if (Cut && this->Block.crops)
    {
      // Corrects rounding errors, because the largest value of a ray may be the one at its end.
      // Rays along a plane are not corrected, because their positions are not precise enough.
      const V zero = R::set(0), steep = R::set(1024);
      const M crosses = R::above(steep, R::larger(inverse, R::sub(zero, inverse)));
      const V step = R::choose(crosses, inverse, zero);
      p = R::fma(R::sub(low, R::fma(d, p, o)), step, p);
      q = R::fma(R::sub(high, R::fma(d, q, o)), step, q);
    }
    enter = R::larger(enter, R::smaller(p, q));
    leave = R::smaller(leave, R::larger(p, q));
  }

  /// Raises the pixels of some pairs, as many as a register has lanes.
  void evaluate(const std::int32_t* pairs, M on)
  {
    const CellBlock<A>& b = this->Block;
    const I id = R::loadIndex(pairs);
    const V pixelX = R::part(id, 4, 0xff), pixelY = R::part(id, 12, 0xff);
    const V at = R::fma(pixelY, R::set(A(this->Tile.Stride)), pixelX);
    const V now = R::gather(this->Tile.values, at, on, R::set(CellValue<A>::Outside));
    const V px = R::sub(pixelX, R::set(A(b.x))), py = R::sub(pixelY, R::set(A(b.y)));
    // Parameters relative to the cell's middle are small, and therefore precise.
    const V middle = R::pick(this->Slice.MiddleT, id);
    V o[3], d[3];
    for (int a = 0; a < 3; ++a)
    {
      const Sum start = this->along(px, py, b.startAcross[a], b.startUp[a],
        a == 2 ? R::set(this->Slice.PlaceZ) : R::pick(this->Slice.Place[a], id), b.start[a].rest);
      Sum direction{ R::set(b.forward[a].most), R::set(b.forward[a].rest) };
      if (Perspective)
      {
        direction = this->along(
          px, py, b.forwardAcross[a], b.forwardUp[a], direction.most, b.forward[a].rest);
      }
      o[a] = Sum::at(start, direction, middle);
      d[a] = direction.whole();
    }
    V enter = R::set(-std::numeric_limits<A>::max()), leave = R::set(std::numeric_limits<A>::max());
    V near = enter, far = leave;
    if (Cut)
    {
      const V zero = R::set(0), reference = R::set(b.reference);
      near = R::sub(R::sub(R::gather(this->Tile.nears, at, on, zero), reference), middle);
      near = R::add(near, R::gather(this->Tile.nearRests, at, on, zero));
      far = R::sub(R::sub(R::gather(this->Tile.fars, at, on, zero), reference), middle);
      far = R::add(far, R::gather(this->Tile.farRests, at, on, zero));
    }
    for (int a = 0; a < 3; ++a)
    {
      const bool isConstant = !Cut || a == 2;
      const V low = isConstant ? R::set(this->Slice.LowZ) : R::pick(this->Slice.Low[a], id);
      const V high = isConstant ? R::set(this->Slice.HighZ) : R::pick(this->Slice.High[a], id);
      this->clip(a, o[a], d[a], low, high, enter, leave, on);
    }
    if (Cut)
    {
      enter = R::larger(enter, near);
      leave = R::smaller(leave, far);
    }
    const V least = R::set(Cut && b.crops ? Sliver<A> : A(0));
    on = static_cast<M>(on & R::above(R::sub(leave, enter), least));
    if (!on)
    {
      return;
    }
    V depth;
    V k[8];
    for (int n = 0; n < 8; ++n)
    {
      k[n] = R::pick(this->K[n], id);
    }
    V value = largestOnRay<A, Located, Shaded>(
      k, R::pick(this->Top, id), o, d, enter, leave, now, on, depth);
    depth = Located ? R::add(R::add(depth, middle), R::set(b.reference)) : depth;
    if (Shaded)
    {
      // Relative to the ray's beginning, so that short rays are shaded right.
      const V place = R::fma(R::set(A(0.5)), R::sub(leave, enter), R::sub(enter, near));
      V share = R::div(place, R::sub(far, near));
      share = R::smaller(R::larger(share, R::set(0)), R::set(1));
      value = R::mul(value, R::fma(R::sub(R::set(1), share), R::set(b.rate), R::set(b.ambient)));
    }
    const M raised = static_cast<M>(on & (Located ? R::atLeast(value, now) : R::above(value, now)));
    if (raised)
    {
      this->raisePixels(id, value, depth, raised);
    }
  }

  SPLATTING_INLINE void raisePixels(I id, V value, V depth, M raised)
  {
    A values[R::N], depths[R::N];
    std::int32_t pairs[R::N];
    R::store(values, value);
    std::memcpy(pairs, &id, sizeof pairs);
    if (Located)
    {
      R::store(depths, depth);
    }
    for (unsigned lanes = raised; lanes; lanes &= lanes - 1)
    {
      const int n = __builtin_ctz(lanes);
      raise<A, Located>(this->Tile, pairs[n] >> 4 & 0xff, pairs[n] >> 12 & 0xff, values[n],
        Located ? depths[n] : A(0));
    }
  }

  ScreenTile<A>& Tile;
  const CellBlock<A>& Block;
  CellSlice<A> Slice;
  alignas(64) A Valid[Cells], Top[Cells], Bound[Cells], K[8][Cells];
  alignas(64) std::int32_t Pairs[64] = {};
};

template <class A, bool Perspective>
void splatWith(ScreenTile<A>& tile, const CellBlock<A>& block)
{
  if (block.shaded)
  {
    CellSplatter<A, Perspective, true, true, true>(tile, block).run();
  }
  else if (block.cut)
  {
    block.located ? CellSplatter<A, Perspective, true, true, false>(tile, block).run()
                  : CellSplatter<A, Perspective, true, false, false>(tile, block).run();
  }
  else
  {
    block.located ? CellSplatter<A, Perspective, false, true, false>(tile, block).run()
                  : CellSplatter<A, Perspective, false, false, false>(tile, block).run();
  }
}
}
}

#endif
