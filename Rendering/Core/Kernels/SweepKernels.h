// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops of previews: maxima of rows of voxels, and which voxels these are. For Kernels.cxx
 * only, which says why all of this is in an anonymous namespace.
 */
#ifndef splattingSweepKernels_h
#define splattingSweepKernels_h

#include "Kernels/NotingKernels.h"

namespace splatting
{
namespace
{
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

/// The same where bits say which rows count.
template <class T>
struct CutBlock
{
  T* image;
  const T* const* rows;
  int count;
  const unsigned char* bits;
  const unsigned char* bit;
  template <int V>
  inline void run(const Registers<T, V>& at) const
  {
    Pack<T> best[V];
    Pack<Integer<T>> counts[V];
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      best[v] = load<T>(this->image + at[v]);
      counts[v] = loadBits<T>(this->bits + at[v]);
    }
    for (int r = 0; r < this->count; ++r)
    {
      const T* const row = this->rows[r];
      const Pack<Integer<T>> mine = Pack<Integer<T>>{} + static_cast<Integer<T>>(this->bit[r]);
#pragma GCC unroll 4
      for (int v = 0; v < V; ++v)
      {
        const Pack<T> value = (counts[v] & mine) != 0 ? load<T>(row + at[v]) : best[v];
        best[v] = larger(value, best[v]);
      }
    }
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      store<T>(this->image + at[v], best[v]);
    }
  }
  inline void single(std::ptrdiff_t x) const
  {
    for (int r = 0; r < this->count; ++r)
    {
      this->image[x] =
        this->bits[x] & this->bit[r] ? larger(this->rows[r][x], this->image[x]) : this->image[x];
    }
  }
};

/// The run's valid pixels, and perhaps some valid ones beside them.
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
  // What is left, in as few registers as it takes.
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

template <int V, class T>
inline void raiseRegisters(const Sweep<T>& s, T* image, std::int16_t* notes,
  const Registers<T, V>& at, const Pack<T> (&best)[V], const Pack<Integer<T>> (&offset)[V])
{
#pragma GCC unroll 4
  for (int v = 0; v < V; ++v)
  {
    raiseRegister<T>(s.noting, image + at[v], notes + at[v], best[v], offset[v]);
  }
}

/// Raises V registers of pixels, and notes the nearest of the rows that raise them, which come
/// before the others. sample(v, r, other) is register v of row r, or `other` where it does not
/// count.
template <int V, class T, class Sample>
inline void raiseInOnePass(
  const Sweep<T>& s, T* image, std::int16_t* notes, const Registers<T, V>& at, Sample&& sample)
{
  Pack<T> best[V];
  Pack<Integer<T>> offset[V]{};
#pragma GCC unroll 4
  for (int v = 0; v < V; ++v)
  {
    best[v] = Pack<T>{} + Least<T>;
  }
  for (int r = 0; r < s.count; ++r)
  {
    const Pack<Integer<T>> own = Pack<Integer<T>>{} + static_cast<Integer<T>>(s.offsets[r]);
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      const Pack<T> value = sample(v, r, best[v]);
      offset[v] = value > best[v] ? own : offset[v];
      best[v] = larger(value, best[v]);
    }
  }
  // What bricks let pass raises something more often than not.
  if (!s.noting.nearestFirst || anyLarger<V>(image, at, best))
  {
    raiseRegisters<V>(s, image, notes, at, best, offset);
  }
}

/// The same where the nearest rows of all come first and few registers are raised: the maxima come
/// first, and then, if they win, the rows that have them. Samples that do not count are the least
/// value, which raises nothing.
template <int V, class T, class Sample>
inline void raiseInTwoPasses(
  const Sweep<T>& s, T* image, std::int16_t* notes, const Registers<T, V>& at, Sample&& sample)
{
  Pack<T> best[V];
  Pack<Integer<T>> offset[V]{};
#pragma GCC unroll 4
  for (int v = 0; v < V; ++v)
  {
    best[v] = Pack<T>{} + Least<T>;
  }
  for (int r = 0; r < s.count; ++r)
  {
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      best[v] = larger(sample(v, r, best[v]), best[v]);
    }
  }
  if (!anyLarger<V>(image, at, best))
  {
    return;
  }
  const Pack<T> least = Pack<T>{} + Least<T>;
  for (int r = s.count - 1; r >= 0; --r)
  {
    const Pack<Integer<T>> own = Pack<Integer<T>>{} + static_cast<Integer<T>>(s.offsets[r]);
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      offset[v] = sample(v, r, least) == best[v] ? own : offset[v];
    }
  }
  raiseRegisters<V>(s, image, notes, at, best, offset);
}

template <int V, class T, class Sample>
inline void raiseNoting(
  const Sweep<T>& s, T* image, std::int16_t* notes, const Registers<T, V>& at, Sample&& sample)
{
  s.winsOften ? raiseInOnePass<V>(s, image, notes, at, sample)
              : raiseInTwoPasses<V>(s, image, notes, at, sample);
}

/// CutBlock, or without bits MaximumBlock, where winners are noted.
template <class T, bool Cut>
struct NotingBlock
{
  const Sweep<T>& sweep;
  T* image;
  std::int16_t* notes;
  const T* const* rows;
  const unsigned char* bits;
  template <int V>
  inline void run(const Registers<T, V>& at) const
  {
    Pack<Integer<T>> counts[V]{};
    for (int v = 0; v < V && Cut; ++v)
    {
      counts[v] = loadBits<T>(this->bits + at[v]);
    }
    raiseNoting<V>(this->sweep, this->image, this->notes, at,
      [&](int v, int r, Pack<T> other)
      {
        const Pack<T> value = load<T>(this->rows[r] + at[v]);
        prefetch(this->rows[r] + at[v] + this->sweep.ahead);
        if constexpr (Cut)
        {
          return (counts[v] & this->bit(r)) != 0 ? value : other;
        }
        else
        {
          return value;
        }
      });
  }
  inline void single(std::ptrdiff_t x) const
  {
    for (int r = 0; r < this->sweep.count; ++r)
    {
      const T value = this->rows[r][x];
      const std::int16_t own =
        static_cast<std::int16_t>(this->sweep.noting.order + this->sweep.offsets[r]);
      const bool nearer = value == this->image[x] && own < this->notes[x];
      if ((!Cut || this->bits[x] & this->sweep.bit[r]) && (value > this->image[x] || nearer))
      {
        this->image[x] = value;
        this->notes[x] = own;
      }
    }
  }

private:
  inline Pack<Integer<T>> bit(int r) const
  {
    return Pack<Integer<T>>{} + static_cast<Integer<T>>(this->sweep.bit[r]);
  }
};

/// Which pixels of a rim see which rows.
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
inline void sweepRim(const Sweep<T>& s, T* image, std::int16_t* notes, const T* const* rows,
  const unsigned char* bits, int first, const RimMasks<T>& masks)
{
  const Pack<Integer<T>> shown =
    bits ? loadBits<T>(bits + first) : Pack<Integer<T>>{} - static_cast<Integer<T>>(1);
  const auto seen = [&](int r) -> Pack<Integer<T>>
  {
    const Integer<T> own = static_cast<Integer<T>>(bits ? s.bit[r] : 1);
    return masks.rows[r] & ((shown & own) != 0);
  };
  const auto sample = [&](int, int r, Pack<T> other)
  {
    const Pack<T> value = load<T>(rows[r] + first);
    return seen(r) != 0 ? value : other;
  };
  if (notes)
  {
    raiseNoting<1>(s, image, notes, Registers<T, 1>{ first, first }, sample);
    return;
  }
  Pack<T> best = load<T>(image + first);
  for (int r = 0; r < s.count; ++r)
  {
    best = larger(sample(0, r, best), best);
  }
  store<T>(image + first, best);
}

/// The runs and rims of one row of pixels.
template <class T>
inline void sweepRow(const Sweep<T>& s, T* image, std::int16_t* notes, const T* const* rows,
  const unsigned char* bits, const RimMasks<T>* rims)
{
  for (int n = 0; n < s.runCount; ++n)
  {
    const Span& run = s.runs[n];
    if (notes)
    {
      bits ? sweepRun<T>(NotingBlock<T, true>{ s, image, notes, rows, bits }, run, s.valid)
           : sweepRun<T>(NotingBlock<T, false>{ s, image, notes, rows, bits }, run, s.valid);
    }
    else if (bits)
    {
      sweepRun<T>(CutBlock<T>{ image, rows, s.count, bits, s.bit }, run, s.valid);
    }
    else
    {
      s.ahead ? sweepRun<T>(MaximumBlock<T, true>{ image, rows, s.count, s.ahead }, run, s.valid)
              : sweepRun<T>(MaximumBlock<T, false>{ image, rows, s.count, 0 }, run, s.valid);
    }
  }
  for (int n = 0; n < s.rimCount; ++n)
  {
    sweepRim(s, image, notes, rows, bits, s.rims[n].first, rims[n]);
  }
}

/// Rows of pixels for runs of which slices count: all of most runs lies in each of the others, and
/// what does not is swept with masks, a register at a time.
template <class T>
class CutSweep
{
public:
  explicit CutSweep(const Sweep<T>& sweep) : Shared(sweep)
  {
    for (int r = 0; r < sweep.count; ++r)
    {
      const int slice = sweep.slice[r];
      this->Any = widened(this->Any, sweep.sees[r]);
      this->All = narrowed(this->All, sweep.sees[r]);
      this->Slices = widened(this->Slices, { slice, slice + 1 });
      this->Everywhere.rows[r] = Picks::everything();
    }
    const int end =
      static_cast<int>(this->Any.end < sweep.imageStride ? this->Any.end : sweep.imageStride);
    this->LastRegister = end - static_cast<int>(width<T>);
  }

  /// @param runs  of the slices for this row of pixels
  inline void row(const Span* runs, T* image, std::int16_t* notes, const T* const* rows)
  {
    Span any = nothing(), all = everything();
    for (int k = this->Slices.begin; k < this->Slices.end; ++k)
    {
      any = widened(any, runs[k]);
      all = narrowed(all, runs[k]);
    }
    any = narrowed(any, this->Any);
    all = narrowed(all, this->All);
    if (any.end <= any.begin)
    {
      return;
    }
    this->Runs = runs;
    const Sweep<T>& s = this->Shared;
    // Whole rows, as what runs leave out would interrupt the processor's own reading ahead. (Not in
    // a function of its own: GCC drops calls of functions that only fetch.)
    for (int r = 0; r < s.count && s.wholeAhead; ++r)
    {
      const bool isNew = r == 0 || s.slice[r] != s.slice[r - 1];
      for (int x = this->All.begin; x < this->All.end && isNew; x += static_cast<int>(width<T>))
      {
        prefetch(rows[r] + x + s.wholeAhead);
      }
    }
    for (int n = 0; n < s.runCount; ++n)
    {
      this->sweepRun(narrowed(any, s.runs[n]), narrowed(all, s.runs[n]), image, notes, rows);
    }
  }

private:
  using Picks = LanePicker<T>;
  using Lanes = typename Picks::Run;

  /// Which elements of the register at x see each row.
  struct Seen
  {
    int x = std::numeric_limits<int>::min();
    Lanes rows[MostRows];
  };

  static constexpr Span nothing() { return { std::numeric_limits<int>::max(), 0 }; }
  static constexpr Span everything() { return { 0, std::numeric_limits<int>::max() }; }
  static inline Span widened(const Span& a, const Span& b)
  {
    return { a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end };
  }
  static inline Span narrowed(const Span& a, const Span& b)
  {
    return { a.begin > b.begin ? a.begin : b.begin, a.end < b.end ? a.end : b.end };
  }

  /// Pixels of a run that see any rows, and those that see all.
  inline void sweepRun(
    const Span& any, const Span& all, T* image, std::int16_t* notes, const T* const* rows)
  {
    const Sweep<T>& s = this->Shared;
    if (all.end - all.begin < width<T>)
    {
      this->sweepPartly(any, image, notes, rows);
      return;
    }
    this->sweepPartly({ any.begin, all.begin }, image, notes, rows);
    this->sweepPartly({ all.end, any.end }, image, notes, rows);
    if (notes)
    {
      splatting::sweepRun<T>(NotingBlock<T, false>{ s, image, notes, rows, nullptr }, all, all);
    }
    else
    {
      s.ahead
        ? splatting::sweepRun<T>(MaximumBlock<T, true>{ image, rows, s.count, s.ahead }, all, all)
        : splatting::sweepRun<T>(MaximumBlock<T, false>{ image, rows, s.count, 0 }, all, all);
    }
  }

  /// Pixels that see some of the rows.
  inline void sweepPartly(const Span& pixels, T* image, std::int16_t* notes, const T* const* rows)
  {
    for (int x = pixels.begin; x < pixels.end; x += static_cast<int>(width<T>))
    {
      this->sweepRegister(x < this->LastRegister ? x : this->LastRegister, image, notes, rows);
    }
  }

  inline void sweepRegister(int x, T* image, std::int16_t* notes, const T* const* rows)
  {
    const Sweep<T>& s = this->Shared;
    Lanes counting[MostRows]; // in each slice
    for (int k = this->Slices.begin; k < this->Slices.end; ++k)
    {
      counting[k] = lanesOf(this->Runs[k], x);
    }
    const Lanes* const seen = this->seenAt(x).rows;
    const auto sample = [&](int, int r, Pack<T> other)
    {
      const Pack<T> value = load<T>(rows[r] + x);
      if (s.ahead)
      {
        prefetch(rows[r] + x + s.ahead);
      }
      return this->Pick.pick(Picks::common(counting[s.slice[r]], seen[r]), value, other);
    };
    if (notes)
    {
      raiseNoting<1>(s, image, notes, Registers<T, 1>{ x, x }, sample);
      return;
    }
    Pack<T> best = load<T>(image + x);
    for (int r = 0; r < s.count; ++r)
    {
      best = larger(sample(0, r, best), best);
    }
    store<T>(image + x, best);
  }

  /// The elements of a register at x that lie in a run.
  static inline Lanes lanesOf(const Span& run, int x)
  {
    return Picks::run(run.begin - x, run.end - x);
  }

  /// Most registers of either side of the volume are at the same place in all rows.
  inline const Seen& seenAt(int x)
  {
    if (x >= this->All.begin && x + static_cast<int>(width<T>) <= this->All.end)
    {
      return this->Everywhere;
    }
    Seen& seen = x < this->All.begin ? this->Left : this->Right;
    for (int r = 0; r < this->Shared.count && seen.x != x; ++r)
    {
      seen.rows[r] = lanesOf(this->Shared.sees[r], x);
    }
    seen.x = x;
    return seen;
  }

  const Sweep<T>& Shared;
  Picks Pick;
  Span Slices = nothing(), Any = nothing(), All = everything();
  Seen Everywhere, Left, Right;
  int LastRegister; ///< registers beyond would leave the image, or read more than rims do
  const Span* Runs = nullptr;
};

template <class T>
void sweepCut(const Sweep<T>& s)
{
  CutSweep<T> cut(s);
  const T* rows[MostRows];
  for (int v = 0; v < s.height; ++v)
  {
    for (int r = 0; r < s.count; ++r)
    {
      rows[r] = s.rows[r] + v * s.rowStride;
    }
    const std::ptrdiff_t first = v * s.imageStride;
    cut.row(s.sliceRuns + v * s.sliceRunsStride, s.image + first,
      s.noting.notes ? s.noting.notes + first : nullptr, rows);
  }
}

template <class T>
void sweep(const Sweep<T>& s)
{
  if (s.sliceRuns)
  {
    sweepCut(s);
    return;
  }
  T* image = s.image;
  std::int16_t* notes = s.noting.notes;
  const unsigned char* bits = s.bits;
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
    sweepRow(s, image, notes, rows, bits, rims);
    image += s.imageStride;
    notes = notes ? notes + s.imageStride : nullptr;
    bits = bits ? bits + s.bitsStride : nullptr;
    for (int r = 0; r < s.count; ++r)
    {
      rows[r] += s.rowStride;
    }
  }
}
}
}

#endif
