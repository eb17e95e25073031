// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Cuts of rays, and the remaining slices. For Kernels.cxx only, which explains the anonymous
 * namespace.
 */
#ifndef splattingDepthKernels_h
#define splattingDepthKernels_h

#include "Kernels/Kernels.h"
#include "Kernels/Registers.h"

namespace splatting
{
namespace
{
/// Rounds to the nearest integer, without a function call on baseline x86-64. The magnitude of x
/// must be far below 2^51.
template <class D>
inline D nearestInteger(D x)
{
  constexpr double unit = 0x1.8p52;
  return (x + unit) - unit;
}

void beginAtPlane(const PlaneRow& plane, double* __restrict near, std::ptrdiff_t n)
{
  for (int x = 0; x < n; ++x)
  {
    near[x] = larger((plane.slope * (plane.u + x) + plane.rest) * plane.scale, near[x]);
  }
}

void endAtPlane(const PlaneRow& plane, double* __restrict far, std::ptrdiff_t n)
{
  for (int x = 0; x < n; ++x)
  {
    far[x] = smaller((plane.slope * (plane.u + x) + plane.rest) * plane.scale, far[x]);
  }
}

/// The slices between depths, for a register or one element.
template <class D>
struct SlicesLeft
{
  D first, last;

  inline SlicesLeft(D near, D far, int begin, int end)
  {
    constexpr double rounding = DepthLimits::Rounding;
    // Also excludes infinities from the arithmetic.
    const D least = D{} + DepthLimits::Before, most = D{} + DepthLimits::Beyond;
    const D low = smaller(larger(near, least), most), high = smaller(larger(far, least), most);
    // Rounds `low` up and `high` down by adding and subtracting 0.5 first. This is correct because
    // with the margins neither is an integer. Depths are at least -1.
    const D margin = rounding * (1.0 + larger(low, -low));
    const D lowest = nearestInteger(low - margin + 0.5);
    const D highest = nearestInteger(high + rounding * (1.0 + larger(high, -high)) - 0.5);
    const auto isThin = (lowest > highest) & (high - low > margin);
    // Of two slices at the same distance the higher one is selected.
    const D middle = nearestInteger(0.5 * (low + high) + rounding);
    this->first = larger(isThin ? middle : lowest, D{} + begin);
    this->last = smaller(isThin ? middle : highest, D{} + (end - 1));
  }
};

bool slicesBetween(const double* near, const double* far, int begin, int end, std::int16_t* first,
  std::int16_t* last, std::ptrdiff_t n)
{
  std::ptrdiff_t x = 0;
  bool lost = false;
#if defined(__GNUC__)
  constexpr std::ptrdiff_t w = width<double>;
  typedef std::int32_t wide __attribute__((vector_size(4 * w)));
  typedef std::int16_t narrow __attribute__((vector_size(2 * w)));
  typedef std::int16_t loose __attribute__((vector_size(2 * w), aligned(2), may_alias));
  const auto put = [](Pack<double> depths, std::int16_t* out)
  {
    *reinterpret_cast<loose*>(out) =
      __builtin_convertvector(__builtin_convertvector(depths, wide), narrow);
  };
  Pack<Integer<double>> some{};
  for (; x + w <= n; x += w)
  {
    const SlicesLeft<Pack<double>> left(load<double>(near + x), load<double>(far + x), begin, end);
    put(left.first, first + x);
    put(left.last, last + x);
    some |= (left.first > begin) | (left.last < end - 1);
  }
  lost = anyOf(some);
#endif
  for (; x < n; ++x)
  {
    const SlicesLeft<double> left(near[x], far[x], begin, end);
    first[x] = static_cast<std::int16_t>(left.first);
    last[x] = static_cast<std::int16_t>(left.last);
    lost = lost || left.first > begin || left.last < end - 1;
  }
  return lost;
}
}
}

#endif
