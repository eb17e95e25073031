// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Numbers that decide what rounding may do at the faces of cells. For CellKernels.cxx only.
 */
#ifndef splattingCellMargins_h
#define splattingCellMargins_h

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace splatting
{
namespace
{
/// The next larger number.
template <class A>
inline A nextAbove(A value)
{
  std::conditional_t<sizeof(A) == 4, std::int32_t, std::int64_t> bits;
  if (value == 0 || !(value - value == 0))
  {
    return value == 0 ? std::numeric_limits<A>::denorm_min() : value;
  }
  std::memcpy(&bits, &value, sizeof bits);
  bits += value > 0 ? 1 : -1;
  std::memcpy(&value, &bits, sizeof bits);
  return value;
}

/// Cells are enlarged by this at each side. It exceeds the rounding errors by which the positions
/// of a ray in two neighbouring cells differ. A ray along their common face is therefore in at
/// least one of them.
template <class A>
constexpr A BesideFace = sizeof(A) == sizeof(float) ? A(0x1p-23) : A(0x1p-46);

/// The same for rays that stay within a face, whose positions are as precise as the view.
template <class A>
constexpr A InFace = sizeof(A) == sizeof(float) ? BesideFace<A> : A(0x1p-42);

/// A shorter part of a ray in a cell may result from rounding alone. It is omitted if the
/// neighbouring part may have other values: at cropping planes and in octants.
template <class A>
constexpr A Sliver = 2 * BesideFace<A>;

/// The begin and the end of a cell that is cropped at `low` or `high`.
template <class A>
inline A lowEnd(A low)
{
  return low >= 0 ? low : -BesideFace<A>;
}
template <class A>
inline A highEnd(A high)
{
  return high <= 1 ? high : 1 + BesideFace<A>;
}

/// Where rays run along a face, their reciprocal direction is limited to this, so that its products
/// are finite.
template <class A>
constexpr A Steepest = sizeof(A) == sizeof(float) ? A(0x1p60) : A(0x1p200);

/// 0, 1, 2, ...
template <class A>
alignas(64) constexpr A Ramp[16] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 };
}
}

#endif
