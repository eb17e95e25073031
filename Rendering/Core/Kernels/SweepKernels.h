// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops of previews: maxima of rows of voxels. For Kernels.cxx only, which explains the
 * anonymous namespace.
 */
#ifndef splattingSweepKernels_h
#define splattingSweepKernels_h

#include "Kernels/Kernels.h"
#include "Kernels/Registers.h"

#include <limits>

namespace splatting
{
namespace
{
/// The positions of the V registers of a block: side by side, except that the last one may overlap.
template <class T, int V>
struct Registers
{
  std::ptrdiff_t x, last;
  inline std::ptrdiff_t operator[](int v) const
  {
    return v + 1 < V ? this->x + v * width<T> : this->last;
  }
};

template <class T, bool Ahead>
struct MaximumBlock
{
  T* image;
  const T* const* rows;
  int count;
  std::ptrdiff_t ahead;
  inline void single(std::ptrdiff_t x) const
  {
    for (int r = 0; r < this->count; ++r)
    {
      this->image[x] = larger(this->rows[r][x], this->image[x]);
    }
  }
  template <int V>
  inline void run(const Registers<T, V>& at) const
  {
    Pack<T> best[V];
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      best[v] = load<T>(this->image + at[v]);
    }
    for (int r = 0; r < this->count; ++r)
    {
      const T* const row = this->rows[r];
#pragma GCC unroll 4
      for (int v = 0; v < V; ++v)
      {
        best[v] = larger(load<T>(row + at[v]), best[v]);
        if constexpr (Ahead)
        {
          prefetch(row + at[v] + this->ahead);
        }
      }
    }
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      store<T>(this->image + at[v], best[v]);
    }
  }
};

/// The run's valid pixels, and possibly some valid ones beside them.
template <class T, class Block>
inline void sweepRun(const Block& block, const Span& run, const Span& valid)
{
  constexpr std::ptrdiff_t w = width<T>;
  const std::ptrdiff_t begin = run.begin > valid.begin ? run.begin : valid.begin;
  const std::ptrdiff_t end = run.end < valid.end ? run.end : valid.end;
  const std::ptrdiff_t lastRegister = valid.end - w;
  if (lastRegister < valid.begin)
  {
    for (std::ptrdiff_t x = begin; x < end; ++x)
    {
      block.single(x);
    }
    return;
  }
  std::ptrdiff_t x = begin;
  for (; end - x > 4 * w; x += 4 * w)
  {
    block.run(Registers<T, 4>{ x, x + 3 * w });
  }
  // The rest, in as few registers as possible.
  const auto last = [=](std::ptrdiff_t at) { return at < lastRegister ? at : lastRegister; };
  switch (end > x ? (end - x + w - 1) / w : 0)
  {
    case 4:
      block.run(Registers<T, 4>{ x, last(x + 3 * w) });
      break;
    case 3:
      block.run(Registers<T, 3>{ x, last(x + 2 * w) });
      break;
    case 2:
      block.run(Registers<T, 2>{ x, last(x + w) });
      break;
    case 1:
      block.run(Registers<T, 1>{ x, last(x) });
      break;
    default:
      break;
  }
}

template <class T>
void maximum(T* image, const T* const* rows, int count, std::ptrdiff_t n)
{
  const Span all{ 0, static_cast<int>(n) };
  sweepRun<T>(MaximumBlock<T, false>{ image, rows, count, 0 }, all, all);
}

template <class T>
void largest(const T* const* rows, int count, T* out, std::ptrdiff_t n)
{
  for (std::ptrdiff_t x = 0; x < n; x += width<T>)
  {
    Pack<T> best = load<T>(rows[0] + x);
    for (int r = 1; r < count; ++r)
    {
      best = larger(load<T>(rows[r] + x), best);
    }
    store<T>(out + x, best);
  }
}

/// The pixels of a rim that read each row.
template <class T>
struct RimMasks
{
  Pack<Integer<T>> rows[MostRows];

  inline void find(const Rim& rim, int count)
  {
    Pack<T> lane;
    for (int x = 0; x < width<T>; ++x)
    {
      reinterpret_cast<T*>(&lane)[x] = static_cast<T>(x);
    }
    for (int r = 0; r < count; ++r)
    {
      this->rows[r] = Pack<Integer<T>>{};
      if (rim.begin[r] < rim.end[r])
      {
        const Pack<T> begin = Pack<T>{} + static_cast<T>(rim.begin[r]);
        const Pack<T> last = Pack<T>{} + static_cast<T>(rim.end[r] - 1);
        this->rows[r] = (lane >= begin) & (lane <= last);
      }
    }
  }
};

template <class T>
inline void sweepRim(
  const Sweep<T>& s, T* image, const T* const* rows, int first, const RimMasks<T>& masks)
{
  Pack<T> best = load<T>(image + first);
  for (int r = 0; r < s.count; ++r)
  {
    const Pack<T> value = masks.rows[r] != 0 ? load<T>(rows[r] + first) : best;
    best = larger(value, best);
  }
  store<T>(image + first, best);
}

template <class T>
void sweep(const Sweep<T>& s)
{
  T* image = s.image;
  const T* rows[MostRows];
  for (int r = 0; r < s.count; ++r)
  {
    rows[r] = s.rows[r];
  }
  RimMasks<T> rims[2];
  for (int n = 0; n < s.rimCount; ++n)
  {
    rims[n].find(s.rims[n], s.count);
  }
  for (int v = 0; v < s.height; ++v)
  {
    for (int n = 0; n < s.runCount; ++n)
    {
      s.ahead
        ? sweepRun<T>(MaximumBlock<T, true>{ image, rows, s.count, s.ahead }, s.runs[n], s.valid)
        : sweepRun<T>(MaximumBlock<T, false>{ image, rows, s.count, 0 }, s.runs[n], s.valid);
    }
    for (int n = 0; n < s.rimCount; ++n)
    {
      sweepRim(s, image, rows, s.rims[n].first, rims[n]);
    }
    image += s.imageStride;
    for (int r = 0; r < s.count; ++r)
    {
      rows[r] += s.rowStride;
    }
  }
}
}
}

#endif
