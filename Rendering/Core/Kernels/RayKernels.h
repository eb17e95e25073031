// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Loops over cuts of rays and over single samples, CutLoops and RayLoops. For Kernels.cxx only,
 * which explains the anonymous namespace.
 */
#ifndef splattingRayKernels_h
#define splattingRayKernels_h

#include "Kernels/Kernels.h"
#include "Kernels/Registers.h"

namespace splatting
{
namespace
{
void tileExtremes(const std::int16_t* first, const std::int16_t* last, std::ptrdiff_t stride,
  int rows, std::ptrdiff_t n, const TileExtremes& out)
{
  constexpr std::ptrdiff_t chunk = 64 * TileWidth;
  for (std::ptrdiff_t begin = 0; begin < n; begin += chunk)
  {
    const std::ptrdiff_t count = begin + chunk < n ? chunk : n - begin;
    std::int16_t low0[chunk], high0[chunk], low1[chunk], high1[chunk];
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      low0[x] = high0[x] = first[begin + x];
      low1[x] = high1[x] = last[begin + x];
    }
    for (int r = 1; r < rows; ++r)
    {
      const std::int16_t* const f = first + r * stride + begin;
      const std::int16_t* const l = last + r * stride + begin;
      for (std::ptrdiff_t x = 0; x < count; ++x)
      {
        low0[x] = smaller(f[x], low0[x]);
        high0[x] = larger(f[x], high0[x]);
        low1[x] = smaller(l[x], low1[x]);
        high1[x] = larger(l[x], high1[x]);
      }
    }
    for (std::ptrdiff_t x = 0; x < count; x += TileWidth)
    {
      const std::ptrdiff_t t = (begin + x) / TileWidth;
      const std::ptrdiff_t end = x + TileWidth < count ? x + TileWidth : count;
      std::int16_t a = low0[x], b = high0[x], c = low1[x], d = high1[x];
      for (std::ptrdiff_t y = x + 1; y < end; ++y)
      {
        a = smaller(low0[y], a);
        b = larger(high0[y], b);
        c = smaller(low1[y], c);
        d = larger(high1[y], d);
      }
      out.leastFirst[t] = a;
      out.greatestFirst[t] = b;
      out.leastLast[t] = c;
      out.greatestLast[t] = d;
    }
  }
}

void tileShares(
  const TileExtremes& tiles, int begin, int end, unsigned char* __restrict shares, std::ptrdiff_t n)
{
  const std::int16_t* __restrict const leastFirst = tiles.leastFirst;
  const std::int16_t* __restrict const greatestFirst = tiles.greatestFirst;
  const std::int16_t* __restrict const leastLast = tiles.leastLast;
  const std::int16_t* __restrict const greatestLast = tiles.greatestLast;
  const std::int16_t first = static_cast<std::int16_t>(begin);
  const std::int16_t last = static_cast<std::int16_t>(end - 1);
  for (std::ptrdiff_t t = 0; t < n; ++t)
  {
    const bool any = (last >= leastFirst[t]) & (first <= greatestLast[t]);
    const bool all = (first >= greatestFirst[t]) & (last <= leastLast[t]);
    shares[t] = static_cast<unsigned char>(
      static_cast<unsigned char>(any) + static_cast<unsigned char>(any & all));
  }
}

/// Loops over the visible samples that `take(x)` accepts.
template <bool Masked, class P, class Take>
inline void takeSamples(P* __restrict image, const P* __restrict samples,
  const unsigned char* __restrict mask, std::ptrdiff_t n, Take&& take)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const bool counts = (!Masked || mask[x] != 0) & (samples[x] == samples[x]);
    image[x] = (counts & take(x)) ? samples[x] : image[x];
  }
}

template <class P, class Take>
inline void takeSamples(
  P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n, Take&& take)
{
  mask ? takeSamples<true>(image, samples, mask, n, take)
       : takeSamples<false>(image, samples, mask, n, take);
}

template <class P>
void raise(P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n)
{
  takeSamples(image, samples, mask, n, [=](std::ptrdiff_t x) { return !(samples[x] <= image[x]); });
}

template <class P>
void lower(P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n)
{
  takeSamples(image, samples, mask, n, [=](std::ptrdiff_t x) { return !(samples[x] >= image[x]); });
}

template <bool Masked, class P>
void climb(P* __restrict image, unsigned char* __restrict ended, P threshold,
  const P* __restrict samples, const unsigned char* __restrict mask, std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const bool counts = (!Masked || mask[x] != 0) & (samples[x] == samples[x]);
    const bool ends = counts & (image[x] >= threshold) & (samples[x] < image[x]);
    ended[x] = static_cast<unsigned char>(ended[x] | static_cast<unsigned char>(ends));
    image[x] = (counts & (ended[x] == 0) & !(samples[x] <= image[x])) ? samples[x] : image[x];
  }
}

template <class P>
void climb(P* image, unsigned char* ended, P threshold, const P* samples, const unsigned char* mask,
  std::ptrdiff_t n)
{
  mask ? climb<true>(image, ended, threshold, samples, mask, n)
       : climb<false>(image, ended, threshold, samples, mask, n);
}

template <bool Masked, class P>
void note(std::int32_t* __restrict winners, std::int32_t place, const P* __restrict before,
  const P* __restrict image, const P* __restrict samples, const unsigned char* __restrict mask,
  std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const bool counts = (!Masked || mask[x] != 0) & (samples[x] == samples[x]);
    const bool changed = (image[x] != before[x]) & (image[x] == image[x]);
    winners[x] = changed | (counts & (winners[x] < 0)) ? place : winners[x];
  }
}

template <class P>
void note(std::int32_t* winners, std::int32_t place, const P* before, const P* image,
  const P* samples, const unsigned char* mask, std::ptrdiff_t n)
{
  mask ? note<true>(winners, place, before, image, samples, mask, n)
       : note<false>(winners, place, before, image, samples, mask, n);
}

template <bool Masked, class A>
void shade(A* __restrict image, const Shade<A>& s, const A* __restrict samples,
  const unsigned char* __restrict mask, std::ptrdiff_t n)
{
  const std::int16_t* __restrict const first = s.first;
  const std::int16_t* __restrict const last = s.last;
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const std::int32_t begin = first[x], end = last[x];
    const A place = static_cast<A>(s.reversed ? end - s.k : s.k - begin);
    const A factor = s.ambient + (A(1) - place / static_cast<A>(end - begin + 1)) * s.changeRate;
    const A sample = s.low + (samples[x] - s.low) * factor;
    const bool counts = (!Masked || mask[x] != 0) & (sample == sample) & !(samples[x] == s.none);
    image[x] = (counts & !(sample <= image[x])) ? sample : image[x];
  }
}

template <class A>
void shade(
  A* image, const Shade<A>& s, const A* samples, const unsigned char* mask, std::ptrdiff_t n)
{
  mask ? shade<true>(image, s, samples, mask, n) : shade<false>(image, s, samples, mask, n);
}

template <bool Masked, class A>
void add(double* __restrict sums, std::int32_t* __restrict counts, A low, A high,
  const A* __restrict samples, const unsigned char* __restrict mask, std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const bool counted = (!Masked || mask[x] != 0) & (samples[x] >= low) & (samples[x] <= high);
    sums[x] += counted ? static_cast<double>(samples[x]) : 0.0;
    counts[x] += counted ? 1 : 0;
  }
}

template <class A>
void add(double* sums, std::int32_t* counts, A low, A high, const A* samples,
  const unsigned char* mask, std::ptrdiff_t n)
{
  mask ? add<true>(sums, counts, low, high, samples, mask, n)
       : add<false>(sums, counts, low, high, samples, mask, n);
}
}
}

#endif
