// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled once per instruction set, as Kernels.cxx, which says what must not be used here.
#include "Cells/Kernels/CellSplatter.h"

namespace splatting
{
namespace
{
template <class A>
A leastOf(const ScreenTile<A>& tile, int x0, int x1, int y0, int y1)
{
  using R = Registers<A>;
  x0 >>= 2;
  x1 >>= 2;
  const typename R::Value all = R::set(CellValue<A>::Outside);
  typename R::Value least = all;
  for (int y = y0 >> 2; y <= y1 >> 2; ++y)
  {
    for (int x = x0; x <= x1; x += R::N)
    {
      const typename R::Value values = R::load(tile.least + y * tile.PatchStride + x);
      least = R::smaller(least, R::choose(firstLanes<A>(x1 - x + 1), values, all));
    }
  }
  A lanes[R::N];
  R::store(lanes, least);
  A result = lanes[0];
  for (int n = 1; n < R::N; ++n)
  {
    result = lanes[n] < result ? lanes[n] : result;
  }
  return result;
}

template <class A>
void splatBlock(ScreenTile<A>& tile, const CellBlock<A>& block)
{
  if (block.perspective)
  {
    splatWith<A, true>(tile, block);
  }
  else
  {
    splatWith<A, false>(tile, block);
  }
}

template <class T>
inline Accumulator<T> valueOf(T voxel, const CellScale<Accumulator<T>>& scale)
{
  using A = Accumulator<T>;
  A value = fused(scale.factor, static_cast<A>(voxel), scale.offset);
  if constexpr (!std::numeric_limits<T>::is_integer)
  {
    if (scale.holes)
    {
      value = value > CellValue<A>::Highest ? CellValue<A>::Highest : value;
      value = value < CellValue<A>::Lowest ? CellValue<A>::Lowest : value;
      value = value == value ? value : CellValue<A>::None;
    }
  }
  return value;
}

template <class T>
void loadBlock(const T* const (*rows)[5], const std::ptrdiff_t x[5],
  const CellScale<Accumulator<T>>& scale, CellBlock<Accumulator<T>>& block)
{
  using A = Accumulator<T>;
  const bool inOrder = x[0] + 1 == x[1] && x[1] + 1 == x[2] && x[2] + 1 == x[3] && x[3] + 1 == x[4];
  for (int z = 0; z < 5; ++z)
  {
    for (int y = 0; y < 5; ++y)
    {
      A* const left = block.left[z] + 4 * y;
      A* const right = block.right[z] + 4 * y;
      const T* const row = rows[z][y] + x[0];
      if (inOrder)
      {
        T voxels[5];
        std::memcpy(voxels, row, sizeof voxels);
#pragma GCC unroll 4
        for (int n = 0; n < 4; ++n)
        {
          left[n] = valueOf<T>(voxels[n], scale);
        }
#pragma GCC unroll 4
        for (int n = 0; n < 4; ++n)
        {
          right[n] = valueOf<T>(voxels[n + 1], scale);
        }
        continue;
      }
      for (int n = 0; n < 4; ++n)
      {
        left[n] = valueOf<T>(rows[z][y][x[n]], scale);
        right[n] = valueOf<T>(rows[z][y][x[n + 1]], scale);
      }
    }
  }
}

/// Directions below this do not change a coordinate within any volume.
constexpr double Flat = 1e-13;
/// Voxels by which rays may pass outside of a face that they run within.
constexpr double Beside = 1e-9;
constexpr double Infinite = std::numeric_limits<double>::infinity();

void within(double* near, double* far, int first, int n, double start, double step, double forward,
  double turn, double low, double high)
{
  for (int x = 0; x < n; ++x)
  {
    const double p = start + (first + x) * step, d = forward + (first + x) * turn;
    const double a = (low - p) / d, b = (high - p) / d;
    const bool isFlat = d < Flat && d > -Flat;
    const bool isInside = p >= low - Beside && p <= high + Beside;
    const double enter = isFlat ? (isInside ? -Infinite : Infinite) : (a < b ? a : b);
    const double leave = isFlat ? Infinite : (a < b ? b : a);
    near[x] = near[x] > enter ? near[x] : enter;
    far[x] = far[x] < leave ? far[x] : leave;
  }
}

void before(double* near, double* far, int first, int n, double start, double step, double forward,
  double turn)
{
  for (int x = 0; x < n; ++x)
  {
    const double p = start + (first + x) * step, d = forward + (first + x) * turn;
    const double t = -p / d;
    const double enter = d > 0.0 ? t : p < -Beside && d == 0.0 ? Infinite : -Infinite;
    const double leave = d < 0.0 ? t : Infinite;
    near[x] = near[x] > enter ? near[x] : enter;
    far[x] = far[x] < leave ? far[x] : leave;
  }
}

template <class A>
constexpr CellLoops<A> cellLoops{ &leastOf<A>, &refresh<A>, &splatBlock<A> };
template <class T>
constexpr BlockLoops<T> blockLoops{ &loadBlock<T> };
}

extern const CellKernels SPLATTING_CELL_KERNELS;
const CellKernels SPLATTING_CELL_KERNELS = { { &within, &before }, cellLoops<float>,
  cellLoops<double>, blockLoops<std::int8_t>, blockLoops<std::uint8_t>, blockLoops<std::int16_t>,
  blockLoops<std::uint16_t>, blockLoops<std::int32_t>, blockLoops<std::uint32_t>,
  blockLoops<std::int64_t>, blockLoops<std::uint64_t>, blockLoops<float>, blockLoops<double> };
}
