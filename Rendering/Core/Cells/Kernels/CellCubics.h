// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The field of a cell along rays: a cubic. For CellKernels.cxx only.
 */
#ifndef splattingCellCubics_h
#define splattingCellCubics_h

#include "Cells/Kernels/CellRegisters.h"

namespace splatting
{
namespace
{
/**
 * The largest value on the parts of rays between enter and leave.
 * @param k      coefficients of the field: 1, x, y, z, xy, xz, yz, xyz
 * @param top    the largest corner, which no value exceeds
 * @param now    Values that do not exceed it need not be found, unless samples are shaded.
 * @param depth  set to the parameter of the sample if it is wanted
 */
template <class A, bool Located, bool Shaded, class R = Registers<A>>
SPLATTING_INLINE typename R::Value largestOnRay(const typename R::Value (&k)[8],
  typename R::Value top, const typename R::Value (&o)[3], const typename R::Value (&d)[3],
  typename R::Value enter, typename R::Value leave, typename R::Value now, typename R::Mask on,
  typename R::Value& depth)
{
  using V = typename R::Value;
  using M = typename R::Mask;
  const V &k0 = k[0], &kx = k[1], &ky = k[2], &kz = k[3];
  const V &kxy = k[4], &kxz = k[5], &kyz = k[6], &kxyz = k[7];
  const V length = R::sub(leave, enter);
  const V x = R::fma(d[0], enter, o[0]), y = R::fma(d[1], enter, o[1]);
  const V z = R::fma(d[2], enter, o[2]);
  const V ex = R::mul(d[0], length), ey = R::mul(d[1], length), ez = R::mul(d[2], length);
  // Slopes of the field where the ray enters, and the cubic c0 + c1 s + c2 s^2 + c3 s^3.
  const V gyz = R::fma(kxyz, x, kyz), gxz = R::fma(kxyz, y, kxz), gxy = R::fma(kxyz, z, kxy);
  const V hy = R::fma(kxy, x, ky), hz = R::fma(kxz, x, kz);
  const V gx = R::fma(kxy, y, R::fma(z, gxz, kx)), gy = R::fma(z, gyz, hy);
  const V gz = R::fma(y, gyz, hz);
  const V c0 = R::fma(x, kx, R::fma(y, hy, R::fma(z, gz, k0)));
  const V c1 = R::fma(ex, gx, R::fma(ey, gy, R::mul(ez, gz)));
  const V exy = R::mul(ex, ey);
  const V c2 = R::fma(exy, gxy, R::fma(R::mul(ex, ez), gxz, R::mul(R::mul(ey, ez), gyz)));
  const V c3 = R::mul(R::mul(exy, ez), kxyz);
  // Its Bernstein coefficients: c0, inner1, inner2, end.
  const V third = R::set(A(1) / A(3)), two = R::set(2);
  const V end = R::add(R::add(c0, c1), R::add(c2, c3));
  const V inner1 = R::fma(c1, third, c0);
  const V inner2 = R::fma(R::fma(two, c1, c2), third, c0);
  const V inner = R::larger(inner1, inner2);
  V value = c0;
  V where = R::set(0);
  M more = static_cast<M>(on & R::above(inner, R::larger(c0, end)));
  if (!Shaded)
  {
    more = static_cast<M>(more & (Located ? R::atLeast(inner, now) : R::above(inner, now)));
  }
  if (more)
  {
    // The root of c1 + 2 c2 s + 3 c3 s^2 at which the cubic has its maximum.
    const V zero = R::set(0);
    const V square = R::fma(c2, c2, R::mul(R::mul(R::set(-3), c1), c3));
    const V root = R::root(R::larger(square, zero));
    const M falls = R::above(zero, c2);
    const V s = R::div(R::choose(falls, c1, R::sub(R::sub(zero, c2), root)),
      R::choose(falls, R::sub(root, c2), R::mul(R::set(3), c3)));
    V peak = R::fma(s, R::fma(s, R::fma(s, c3, c2), c1), c0);
    // Without rounding it is never above the bound.
    peak = R::smaller(peak, inner);
    const M found = static_cast<M>(more & R::above(square, zero) & R::above(s, zero) &
      R::above(R::set(1), s) & R::above(peak, value));
    value = R::choose(found, peak, value);
    where = Located ? R::choose(found, s, where) : where;
  }
  if (Located)
  {
    const M last = R::above(end, value);
    where = R::choose(last, R::set(1), where);
    depth = R::fma(where, length, enter);
  }
  else
  {
    depth = where;
  }
  value = R::larger(value, end);
  return R::smaller(value, top);
}
}
}

#endif
