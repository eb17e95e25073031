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

/// Cells are wider by this at each side: more than the rounding by which the places of a ray in two
/// neighbours differ, so that no part of a ray which runs along their face slips through.
template <class A>
constexpr A BesideFace = sizeof(A) == sizeof(float) ? A(0x1p-23) : A(0x1p-46);

/// The same where rays never leave a face: these places are as precise as views.
template <class A>
constexpr A InFace = sizeof(A) == sizeof(float) ? BesideFace<A> : A(0x1p-42);

/// Parts of rays that are shorter may be there by rounding alone. They are left out where their
/// neighbours do not have the same values: at cropping's planes and in octants.
template <class A>
constexpr A Sliver = 2 * BesideFace<A>;

/// Where a cell begins and ends that is cropped at some place.
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
