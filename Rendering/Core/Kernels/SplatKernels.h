// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Footprints over voxels: the worksheets of parallel views, a few rows of a slice at a time, in
 * registers. For Kernels.cxx only, which explains the anonymous namespace.
 */
#ifndef splattingSplatKernels_h
#define splattingSplatKernels_h

#include "Kernels/Kernels.h"
#include "Kernels/Registers.h"

#include <limits>

namespace splatting
{
namespace
{
/// Whether footprints weigh voxels of this type without a copy in the accumulator's type.
template <class T>
constexpr bool weighsOwn = std::is_same_v<Accumulator<T>, float> && sizeof(T) <= 4;

/// A register of voxels in the accumulator's type.
template <class A, class S>
inline Pack<A> fetch(const Splat<A, S>& s, const S* voxels)
{
  if constexpr (std::is_same_v<A, S>)
  {
    (void)s;
    return load<A>(voxels);
  }
  else
  {
    return loadWidened(voxels) - s.base;
  }
}

/// Replaces V registers of voxels, which begin one voxel before `row`, by those that begin at
/// `row`. If voxels must be converted, shifting the registers is cheaper than loading. The last
/// register is loaded, because shifting it would read voxels that are not needed.
template <int V, class A, class S>
inline void nextColumn(const Splat<A, S>& s, const S* row, Pack<A> (&voxels)[V])
{
  constexpr int advances = AdvancesRegisters && !std::is_same_v<A, S> ? V - 1 : 0;
#pragma GCC unroll 4
  for (int v = 0; v < V; ++v)
  {
    voxels[v] = v < advances ? advanced(voxels[v], voxels[v + 1 < V ? v + 1 : v])
                             : fetch<A, S>(s, row + v * width<A>);
  }
}

/// Adds one part of the footprint to the worksheets of Rows x V registers. Rows of pixels share
/// rows of voxels, so each register of voxels is loaded once for all of them. A pixel's sum still
/// adds the weights row by row.
template <int Rows, int V, int WeightRows, class A, class S>
inline void addPart(
  const Splat<A, S>& s, const SplatPart<A, S>& part, const S* source, Pack<A> (&sum)[Rows][V])
{
  const A* const weights = part.weights;
  const int columns = part.columns;
#pragma GCC unroll 8
  for (int r = 0; r < Rows + WeightRows - 1; ++r)
  {
    const S* const row = source + r * s.sourceStride;
    for (int v = 0; v < V && !std::is_same_v<A, S>; ++v)
    {
      prefetch(row + v * width<A> + s.ahead);
    }
    Pack<A> voxels[V];
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      voxels[v] = fetch<A, S>(s, row + v * width<A>);
    }
    for (int i = 0;;)
    {
#pragma GCC unroll 4
      for (int o = 0; o < Rows; ++o)
      {
        if (r - o >= 0 && r - o < WeightRows)
        {
          const A weight = weights[(r - o) * columns + i];
#pragma GCC unroll 4
          for (int v = 0; v < V; ++v)
          {
            sum[o][v] += weight * voxels[v];
          }
        }
      }
      if (++i == columns)
      {
        break;
      }
      nextColumn<V, A, S>(s, row + i, voxels);
    }
  }
}

/// Raises Rows x V registers of pixels to their sums.
template <class A, int Rows, int V, class S>
inline void raiseTile(const Splat<A, S>& s, std::ptrdiff_t x, int y, const Pack<A> (&sum)[Rows][V])
{
#pragma GCC unroll 4
  for (int o = 0; o < Rows; ++o)
  {
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      A* const at = s.image + (y + o) * s.imageStride + x + v * width<A>;
      store<A>(at, larger(sum[o][v], load<A>(at)));
    }
  }
}

/// Rows x V registers of pixels, from (x, y) of the rectangle.
template <class A, int Rows, int V, class S>
inline void splatTile(const Splat<A, S>& s, std::ptrdiff_t x, int y)
{
  Pack<A> sum[Rows][V];
#pragma GCC unroll 4
  for (int o = 0; o < Rows; ++o)
  {
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      sum[o][v] = Pack<A>{};
    }
  }
  for (int p = 0; p < s.partCount; ++p)
  {
    const SplatPart<A, S>& part = s.parts[p];
    const S* const source = part.source + y * s.sourceStride + x;
    switch (part.rows)
    {
      case 1:
        addPart<Rows, V, 1>(s, part, source, sum);
        break;
      case 2:
        addPart<Rows, V, 2>(s, part, source, sum);
        break;
      case 3:
        addPart<Rows, V, 3>(s, part, source, sum);
        break;
      case 4:
        addPart<Rows, V, 4>(s, part, source, sum);
        break;
      default:
        addPart<Rows, V, 5>(s, part, source, sum);
        break;
    }
  }
  raiseTile<A, Rows, V>(s, x, y, sum);
}

template <class A, class S>
inline void splatPixel(const Splat<A, S>& s, std::ptrdiff_t x, int y)
{
  A sum = 0;
  for (int p = 0; p < s.partCount; ++p)
  {
    const SplatPart<A, S>& part = s.parts[p];
    for (int j = 0; j < part.rows; ++j)
    {
      for (int i = 0; i < part.columns; ++i)
      {
        const A voxel = static_cast<A>(part.source[(y + j) * s.sourceStride + x + i]);
        sum += part.weights[j * part.columns + i] * (std::is_same_v<A, S> ? voxel : voxel - s.base);
      }
    }
  }
  A& pixel = s.image[y * s.imageStride + x];
  pixel = larger(sum, pixel);
}

template <class A, int Rows, class S>
struct SplatBlock
{
  const Splat<A, S>& splat;
  int y;
  template <int V>
  inline void run(std::ptrdiff_t x) const
  {
    // Rows x V sums must fit into the registers: 32 with AVX-512, 16 without.
    if constexpr (V == 4 && Rows == 4 && SPLATTING_VECTOR_BYTES < 64)
    {
      this->run<2>(x);
      this->run<2>(x + 2 * width<A>);
    }
    else
    {
      splatTile<A, Rows, V>(this->splat, x, this->y);
    }
  }
};

template <class A, int Rows, class S>
inline void splatRows(const Splat<A, S>& s, int y)
{
  blocks<A>(s.width, SplatBlock<A, Rows, S>{ s, y },
    [&](std::ptrdiff_t x)
    {
      for (int o = 0; o < Rows; ++o)
      {
        splatPixel(s, x, y + o);
      }
    });
}

template <class A, class S>
void splat(const Splat<A, S>& s)
{
  int y = 0;
  for (; y + 4 <= s.height; y += 4)
  {
    splatRows<A, 4>(s, y);
  }
  for (; y < s.height; ++y)
  {
    splatRows<A, 1>(s, y);
  }
}

/// The average of the valid voxels, for a register of pixels or one element.
template <class A>
struct AverageLoop
{
  const Averages<A>& a;

  template <class R, class Fetch>
  inline R raised(R image, Fetch&& fetch) const
  {
    const R zero = R{}, sum = fetch(this->a.sums), weight = fetch(this->a.weights);
    const R quotient = sum / weight; // NaN without valid voxels
    R average = weight >= this->a.whole ? sum : quotient;
    if (this->a.positive)
    {
      const R up = fetch(this->a.positive), down = fetch(this->a.negative);
      const R infinite = zero + std::numeric_limits<A>::infinity();
      average = up > zero ? infinite : average;
      // Opposite infinities have no average.
      average = down > zero ? (up > zero ? infinite - infinite : -infinite) : average;
    }
    const R first = image == image ? image : average;
    return average > first ? average : first;
  }
  template <int V>
  inline void run(std::ptrdiff_t x) const
  {
    for (int v = 0; v < V; ++v, x += width<A>)
    {
      A* const at = this->a.image + x;
      store<A>(at, this->raised<Pack<A>>(load<A>(at), [x](const A* p) { return load<A>(p + x); }));
    }
  }
  inline void single(std::ptrdiff_t x) const
  {
    A& pixel = this->a.image[x];
    pixel = this->raised<A>(pixel, [x](const A* p) { return p[x]; });
  }
};

template <class A>
void raiseAverages(const Averages<A>& averages, std::ptrdiff_t n)
{
  const AverageLoop<A> loop{ averages };
  blocks<A>(n, loop, [&](std::ptrdiff_t x) { loop.single(x); });
}

/// Differences of infinities and NaN are NaN, and so are sums with them.
template <class A>
bool allFinite(const A* voxels, std::ptrdiff_t n)
{
  Pack<A> differences = {};
  std::ptrdiff_t x = 0;
  for (; x + width<A> <= n; x += width<A>)
  {
    const Pack<A> value = load<A>(voxels + x);
    differences += value - value;
  }
  A last = 0;
  for (; x < n; ++x)
  {
    last += voxels[x] - voxels[x];
  }
  return last == last && !anyOf(differences != differences);
}

template <class A>
void separate(A* __restrict voxels, A* __restrict finite, A* __restrict positive,
  A* __restrict negative, std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const A value = voxels[x];
    const bool counts = value - value == A(0);
    finite[x] = counts ? A(1) : A(0);
    voxels[x] = counts ? value : A(0);
    if (positive)
    {
      positive[x] = !counts && value > A(0) ? A(1) : A(0);
      negative[x] = !counts && value < A(0) ? A(1) : A(0);
    }
  }
}

template <class T>
constexpr decltype(VoxelLoops<T>::splatVoxels) splatOwn()
{
  if constexpr (weighsOwn<T>)
  {
    return &splat<Accumulator<T>, T>;
  }
  else
  {
    return nullptr;
  }
}
}
}

#endif
