// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled once per instruction set. SPLATTING_KERNELS is the name of the table that it defines,
// and SPLATTING_VECTOR_BYTES the width of a register. It must not use inline functions from
// elsewhere except intrinsics (not even std::max): the linker keeps one copy of them for the whole
// library, and this could be a copy that only the newest processors can run. For the same reason
// everything except the table is in an anonymous namespace.
#include "Kernels/Kernels.h"
#include "Kernels/DepthKernels.h"
#include "Kernels/PerspectiveKernels.h"
#include "Kernels/RayKernels.h"
#include "Kernels/Registers.h"
#include "Kernels/ResamplingKernels.h"
#include "Kernels/SplatKernels.h"
#include "Kernels/SweepKernels.h"

#include <cstdint>
#include <cstring>

namespace splatting
{
namespace
{
template <class T>
void widen(const T* row, std::ptrdiff_t stride, Accumulator<T>* out, std::ptrdiff_t outStride,
  Accumulator<T> base, std::ptrdiff_t n, int rows, std::ptrdiff_t ahead)
{
  using A = Accumulator<T>;
  constexpr std::ptrdiff_t w = width<A>;
  constexpr std::ptrdiff_t line = 64 / sizeof(T); // of the cache
  for (int r = 0; r < rows; ++r, row += stride, out += outStride)
  {
    for (std::ptrdiff_t x = 0; x < n && ahead != 0; x += line)
    {
      prefetch(row + x + ahead);
    }
    std::ptrdiff_t x = 0;
    for (; x + w <= n; x += w)
    {
      store<A>(out + x, loadWidened(row + x) - base);
    }
    if (x < n && n >= w)
    {
      store<A>(out + n - w, loadWidened(row + n - w) - base);
      x = n;
    }
    for (; x < n; ++x)
    {
      out[x] = static_cast<A>(row[x]) - base;
    }
  }
}

/// Some columns of all rows at once, so that their maxima stay in registers.
template <class T>
struct SurveyBlock
{
  const T* const* rows;
  int count;
  T* maxima;
  Pack<T>& low;
  Pack<Integer<T>>& odd;
  template <int V>
  inline void run(std::ptrdiff_t x) const
  {
    Pack<T> high[V], least[V];
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      high[v] = load<T>(this->maxima + x + v * width<T>);
      least[v] = this->low;
    }
    for (int r = 0; r < this->count; ++r)
    {
#pragma GCC unroll 4
      for (int v = 0; v < V; ++v)
      {
        const Pack<T> value = load<T>(this->rows[r] + x + v * width<T>);
        high[v] = larger(value, high[v]);
        least[v] = smaller(value, least[v]);
        if constexpr (!std::numeric_limits<T>::is_integer)
        {
          // Only NaN and infinities differ from themselves by something other than 0.
          this->odd |= value - value != 0;
        }
      }
    }
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      store<T>(this->maxima + x + v * width<T>, high[v]);
      this->low = smaller(least[v], this->low);
    }
  }
};

template <class T>
void survey(const T* const* rows, int count, std::ptrdiff_t n, T* maxima, T& low, bool& nonFinite)
{
  Pack<T> least = Pack<T>{} + low;
  Pack<Integer<T>> odd{};
  blocks<T>(n, SurveyBlock<T>{ rows, count, maxima, least, odd },
    [&](std::ptrdiff_t x)
    {
      T high = maxima[x];
      for (int r = 0; r < count; ++r)
      {
        const T value = rows[r][x];
        high = larger(value, high);
        low = smaller(value, low);
        nonFinite = nonFinite || static_cast<T>(value - value) != static_cast<T>(0);
      }
      maxima[x] = high;
    });
  const T* const lanes = reinterpret_cast<const T*>(&least);
  for (int lane = 0; lane < width<T>; ++lane)
  {
    low = smaller(lanes[lane], low);
  }
  nonFinite = nonFinite || anyOf(odd);
}

template <class T>
void largestOfFour(const T* __restrict row, T* __restrict out, std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    out[x] = larger(larger(row[4 * x], row[4 * x + 1]), larger(row[4 * x + 2], row[4 * x + 3]));
  }
}

template <class P>
void minima(
  const P* image, std::ptrdiff_t stride, int rows, std::ptrdiff_t tiles, P* __restrict minima)
{
  constexpr std::ptrdiff_t chunk = 64; // tiles
  for (std::ptrdiff_t first = 0; first < tiles; first += chunk)
  {
    const std::ptrdiff_t count = first + chunk < tiles ? chunk : tiles - first;
    P columns[chunk * TileWidth];
    const P* row = image + first * TileWidth;
    for (std::ptrdiff_t x = 0; x < count * TileWidth; ++x)
    {
      columns[x] = row[x];
    }
    for (int r = 1; r < rows; ++r)
    {
      row += stride;
      for (std::ptrdiff_t x = 0; x < count * TileWidth; ++x)
      {
        columns[x] = smaller(row[x], columns[x]);
      }
    }
    for (std::ptrdiff_t t = 0; t < count; ++t)
    {
      const P* const c = columns + t * TileWidth;
      minima[first + t] = smaller(smaller(smaller(c[0], c[1]), smaller(c[2], c[3])),
        smaller(smaller(c[4], c[5]), smaller(c[6], c[7])));
    }
  }
}

template <class P>
void exceeds(const P* bounds, const P* minima, unsigned char* __restrict flags, std::ptrdiff_t n)
{
  for (std::ptrdiff_t t = 0; t < n; ++t)
  {
    flags[t] = bounds[t] > minima[t];
  }
}

template <class A>
void finish(A* image, A base, A low, A high, std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const A sum = image[x] + base;
    const A value = sum < low ? low : sum;
    image[x] = value > high ? high : value;
  }
}

template <class A>
void bound(A* __restrict own, const A* __restrict before, const A* __restrict after, A share,
  A slack, A magnitude, std::ptrdiff_t n)
{
  for (std::ptrdiff_t t = 0; t < n; ++t)
  {
    const A excess = larger(larger(before[t], after[t]) - own[t], A(0));
    const A value = own[t] + share * excess;
    own[t] = value + slack * larger(larger(value, -value), magnitude);
  }
}

/// The pixels that points on the screen interpolate, `chunk` points at a time: each point's pixel
/// and its three neighbours along u and v.
template <class A>
struct BilinearTaps
{
  static constexpr std::int32_t chunk = 64;
  std::int32_t at[chunk];
  A fu[chunk], fv[chunk];

  inline void set(std::int32_t x, double u, double v, std::int32_t rowLength)
  {
    const std::int32_t i = static_cast<std::int32_t>(u); // both positive, so truncation is floor
    const std::int32_t j = static_cast<std::int32_t>(v);
    this->fu[x] = static_cast<A>(u - i);
    this->fv[x] = static_cast<A>(v - j);
    this->at[x] = j * rowLength + i;
  }
  inline void mix(
    const A* __restrict image, std::int32_t rowLength, A* __restrict out, std::int32_t count) const
  {
    // Neighbours along u are fetched together, because gathering single elements takes twice as
    // long.
    struct Pair
    {
      A left, right;
    };
    Pair lower[chunk], upper[chunk];
    for (std::int32_t x = 0; x < count; ++x)
    {
      std::memcpy(lower + x, image + this->at[x], sizeof(Pair));
      std::memcpy(upper + x, image + this->at[x] + rowLength, sizeof(Pair));
    }
    for (std::int32_t x = 0; x < count; ++x)
    {
      const A below = lower[x].left + this->fu[x] * (lower[x].right - lower[x].left);
      const A above = upper[x].left + this->fu[x] * (upper[x].right - upper[x].left);
      out[x] = below + this->fv[x] * (above - below);
    }
  }
};

template <bool Projective, class A>
void interpolate(const A* __restrict image, std::ptrdiff_t stride, const double* start,
  const double* step, A* __restrict out, std::ptrdiff_t n)
{
  // In steps that each vectorise: points, then the four neighbours, then their mixture.
  const double u0 = start[0], v0 = start[1], w0 = Projective ? start[2] : 1.0;
  const double du = step[0], dv = step[1], dw = Projective ? step[2] : 0.0;
  const std::int32_t rowLength = static_cast<std::int32_t>(stride);
  BilinearTaps<A> taps;
  for (std::int32_t begin = 0; begin < n; begin += taps.chunk)
  {
    const std::int32_t left = static_cast<std::int32_t>(n) - begin;
    const std::int32_t count = left < taps.chunk ? left : taps.chunk;
    for (std::int32_t x = 0; x < count; ++x)
    {
      const double perW = Projective ? 1.0 / (w0 + (begin + x) * dw) : 1.0;
      taps.set(x, (u0 + (begin + x) * du) * perW, (v0 + (begin + x) * dv) * perW, rowLength);
    }
    taps.mix(image, rowLength, out + begin, count);
  }
}

template <class A>
void lookUp(const A* __restrict values, A low, A scale, std::int32_t last,
  const std::uint32_t* __restrict colors, std::uint32_t* __restrict out, std::ptrdiff_t n)
{
  const A top = static_cast<A>(last), zero = 0, half = static_cast<A>(0.5);
  constexpr std::ptrdiff_t chunk = 64;
  std::int32_t at[chunk];
  for (std::ptrdiff_t begin = 0; begin < n; begin += chunk)
  {
    const std::ptrdiff_t count = begin + chunk < n ? chunk : n - begin;
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      A place = (values[begin + x] - low) * scale;
      place = place > zero ? place : zero; // also NaN
      place = place < top ? place : top;
      at[x] = static_cast<std::int32_t>(place + half);
    }
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      // An assignment would be compiled to gather instructions, which are slower.
      std::memcpy(out + begin + x, colors + at[x], sizeof(std::uint32_t));
    }
    for (std::ptrdiff_t x = begin; x < begin + count; ++x)
    {
      out[x] = values[x] == values[x] ? out[x] : 0;
    }
  }
}

template <class T>
constexpr VoxelLoops<T> voxelLoops{ width<T>, Picker<T>::group, &maximum<T>, &largest<T>, &sweep<T>,
  &cross<T>, &widen<T>, splatOwn<T>(), &survey<T>, &largestOfFour<T> };
template <class P>
constexpr TileLoops<P> tileLoops{ &minima<P>, &exceeds<P> };
template <class P>
constexpr RayLoops<P> rayLoops{ &raise<P>, &lower<P>,
  static_cast<decltype(RayLoops<P>::climb)>(&climb<P>),
  static_cast<decltype(RayLoops<P>::note)>(&note<P>) };
template <class A>
constexpr WorksheetLoops<A> worksheetLoops{ Resampler<A>::group, &axisWeights<A>, &resample<A>,
  &blend<false, A>, &blend<true, A>, &splat<A, A>, &raiseAverages<A>, &allFinite<A>, &separate<A>,
  static_cast<decltype(WorksheetLoops<A>::shade)>(&shade<A>),
  static_cast<decltype(WorksheetLoops<A>::add)>(&add<A>), &finish<A>, &bound<A>,
  &interpolate<false, A>, &interpolate<true, A>, &lookUp<A> };
}

extern const Kernels SPLATTING_KERNELS;
const Kernels SPLATTING_KERNELS = { { &beginAtPlane, &endAtPlane, &slicesBetween, &tileExtremes,
                                      &tileShares },
  { &steps }, voxelLoops<std::int8_t>, voxelLoops<std::uint8_t>, voxelLoops<std::int16_t>,
  voxelLoops<std::uint16_t>, voxelLoops<std::int32_t>, voxelLoops<std::uint32_t>,
  voxelLoops<std::int64_t>, voxelLoops<std::uint64_t>, voxelLoops<float>, voxelLoops<double>,
  tileLoops<std::int8_t>, tileLoops<std::uint8_t>, tileLoops<std::int16_t>,
  tileLoops<std::uint16_t>, tileLoops<std::int32_t>, tileLoops<std::uint32_t>,
  tileLoops<std::int64_t>, tileLoops<std::uint64_t>, tileLoops<float>, tileLoops<double>,
  rayLoops<std::int8_t>, rayLoops<std::uint8_t>, rayLoops<std::int16_t>, rayLoops<std::uint16_t>,
  rayLoops<std::int32_t>, rayLoops<std::uint32_t>, rayLoops<std::int64_t>, rayLoops<std::uint64_t>,
  rayLoops<float>, rayLoops<double>, worksheetLoops<float>, worksheetLoops<double> };
}
