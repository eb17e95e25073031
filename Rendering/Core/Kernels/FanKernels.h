// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The rays of perspective images and the voxels that they cross. For Kernels.cxx only, which says
 * why all of this is in an anonymous namespace.
 */
#ifndef splattingFanKernels_h
#define splattingFanKernels_h

#include "Kernels/NotingKernels.h"
#include "Kernels/PickKernels.h"

namespace splatting
{
namespace
{
/// Of numbers that fit.
inline double roundedDown(double x)
{
  const double whole = static_cast<double>(static_cast<std::int32_t>(x));
  return whole - (whole > x ? 1.0 : 0.0);
}

inline double clamped(double x, double low, double high)
{
  x = x > low ? x : low;
  return x < high ? x : high;
}

inline void steps(const double* __restrict at, const double* __restrict slope, double from,
  double to, std::int32_t size, std::int32_t* __restrict first, std::int32_t* __restrict last,
  double* __restrict time, std::int16_t* __restrict tick, std::ptrdiff_t n)
{
  const double low = -2.0, high = size + 1.0;
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    // Seen from rays that run to lower voxels everything is mirrored.
    const double own = slope[x];
    const double turn = own < 0.0 ? -1.0 : 1.0;
    const double entry = turn * clamped(at[x] + own * from, low, high);
    const double exit = turn * clamped(at[x] + own * to, low, high);
    // A point on a face belongs to the voxel that the ray runs in next to it; a ray that stays on
    // it has but one.
    const double enters = roundedDown(entry + 0.5);
    const double before = -roundedDown(0.5 - exit);
    const double leaves = own == 0.0 ? enters : before;
    const double speed = own == 0.0 ? 1.0 : turn * own;
    const double way = (enters + 0.5 - entry) / speed;
    const double passes = leaves > enters ? way : 0.0;
    first[x] = static_cast<std::int32_t>(clamped(turn * enters, -1.0, size));
    last[x] = static_cast<std::int32_t>(clamped(turn * leaves, -1.0, size));
    time[x] = passes;
  }
  for (std::ptrdiff_t x = 0; x < n; ++x)
  {
    const std::int32_t ticks = static_cast<std::int32_t>(time[x] * 32768.0);
    const std::int32_t fitting = ticks < 32767 ? ticks : 32767;
    tick[x] = static_cast<std::int16_t>(first[x] != last[x] ? fitting : -1);
  }
}

/// One pixel of one row, and the rows of voxels where rays enter a slice and leave it.
template <class T>
struct CrossedPixel
{
  const CrossedSlice<T>& slice;
  const T* rows[2];
  bool changesRows;
  double rowTime;

  /// The voxels that it sees, and how many.
  inline int path(std::ptrdiff_t x, T (&voxels)[3]) const
  {
    const Integer<T> enters = static_cast<const Integer<T>*>(this->slice.entryLanes)[x];
    const Integer<T> leaves = static_cast<const Integer<T>*>(this->slice.exitLanes)[x];
    const std::ptrdiff_t group = x / Picker<T>::group;
    const std::int32_t entry = this->slice.entryBase[group] + enters;
    const std::int32_t exit = this->slice.exitBase[group] + leaves;
    const auto at = [&](int row, bool last)
    {
      const bool inside = last ? leaves >= 0 : enters >= 0;
      return inside ? this->rows[row][last ? exit : entry] : Least<T>;
    };
    const double columnTime = this->slice.columnTime[x];
    const bool changesColumns = this->slice.columnTick[x] >= 0;
    int count = 0;
    voxels[count++] = at(0, false);
    if (this->changesRows && changesColumns && columnTime != this->rowTime)
    {
      const bool columnFirst = columnTime < this->rowTime;
      voxels[count++] = at(!columnFirst, columnFirst);
    }
    if (this->changesRows || changesColumns)
    {
      voxels[count++] = at(1, true);
    }
    return count;
  }
};

template <class T>
inline void raisePixel(T& pixel, const T (&voxels)[3], int count)
{
  for (int n = 0; n < count; ++n)
  {
    pixel = larger(voxels[n], pixel);
  }
}

/// The same where winners are noted.
template <class T>
inline void raisePixelNoting(
  T& pixel, std::int16_t& note, const T (&voxels)[3], int count, std::int16_t order, int sign)
{
  for (int n = 0; n < count; ++n)
  {
    const std::int16_t own = static_cast<std::int16_t>(order + sign * n);
    if (voxels[n] > pixel || (voxels[n] == pixel && own < note))
    {
      pixel = voxels[n];
      note = own;
    }
  }
}

/// Some pixels of a row, one by one.
template <class T>
inline void crossRow(const Crossing<T>& c, int s, const Span& run, int v)
{
  const CrossedSlice<T>& slice = c.slices[s];
  const std::int32_t j[2] = { slice.firstRow[v], slice.lastRow[v] };
  const auto row = [&](std::int32_t own)
  { return own >= 0 && own < c.rows ? slice.voxels + own * c.rowStride : c.none; };
  const CrossedPixel<T> own{ slice, { row(j[0]), row(j[1]) }, j[0] != j[1], slice.rowTime[v] };
  T* const image = c.image + v * c.imageStride;
  std::int16_t* const notes = c.noting.notes ? c.noting.notes + v * c.imageStride : nullptr;
  const unsigned char* const bits = c.bits ? c.bits + v * c.bitsStride : nullptr;

  for (std::ptrdiff_t x = run.begin; x < run.end; ++x)
  {
    if (bits && !(bits[x] & slice.bit))
    {
      continue;
    }
    T voxels[3];
    const int count = own.path(x, voxels);
    notes ? raisePixelNoting(image[x], notes[x], voxels, count, slice.order, c.reversed ? -1 : 1)
          : raisePixel(image[x], voxels, count);
  }
}

#if defined(__AVX2__)
/// What some columns of pixels pick from the rows of voxels of a slice that were met last: rows of
/// pixels are narrower than those of voxels, and the next one mostly meets the same.
template <class T>
class PickedRows
{
public:
  static constexpr std::ptrdiff_t Width = 8 * width<T>;

  /// The voxels in which rays enter the slice and leave it.
  struct Row
  {
    std::int32_t j;
    alignas(64) T entry[Width];
    alignas(64) T exit[Width];
  };

  /// @param count  of registers
  PickedRows(const Crossing<T>& crossing, int slice, std::ptrdiff_t begin, int count)
    : C(crossing),
      Slice(crossing.slices[slice]),
      Begin(begin),
      Count(count)
  {
    for (Row& row : this->Rows)
    {
      row.j = -2; // none yet
    }
  }

  /// Where rays change columns: 1, or else 0.
  const Integer<T>* moves()
  {
    if (!this->KnowsMoves)
    {
      const std::int16_t* const ticks = this->Slice.columnTick + this->Begin;
      for (std::ptrdiff_t x = 0; x < this->Count * width<T>; ++x)
      {
        this->Moves[x] = static_cast<Integer<T>>(ticks[x] >= 0);
      }
      this->KnowsMoves = true;
    }
    return this->Moves;
  }

  const Row* row(std::int32_t j)
  {
    const bool inside = j >= 0 && j < this->C.rows;
    const std::int32_t wanted = inside ? j : -1;
    Row& row = this->Rows[inside ? j & 1 : 2];
    if (row.j != wanted)
    {
      row.j = wanted;
      this->pick(inside ? this->Slice.voxels + j * this->C.rowStride : this->C.none, row);
    }
    return &row;
  }

private:
  void pick(const T* voxels, Row& row) const
  {
    const CrossedSlice<T> s = this->Slice;
    const Register none = loadRegister(this->C.none);
    const std::ptrdiff_t ahead = this->C.ahead;
    const int count = this->Count;
    for (int n = 0; n < count; ++n)
    {
      const std::ptrdiff_t x = this->Begin + n * width<T>, group = x / Picker<T>::group;
      const Register entry = loadRegister(static_cast<const Integer<T>*>(s.entryLanes) + x);
      const Register exit = loadRegister(static_cast<const Integer<T>*>(s.exitLanes) + x);
      // A band of rows is too short for processors to notice that the next slice will come.
      prefetch(voxels + ahead + s.entryBase[group]);
      store<T>(row.entry + n * width<T>,
        (Pack<T>)Picker<T>::pick(voxels, s.entryBase + group, entry, none));
      store<T>(
        row.exit + n * width<T>, (Pack<T>)Picker<T>::pick(voxels, s.exitBase + group, exit, none));
    }
  }

  const Crossing<T>& C;
  const CrossedSlice<T>& Slice;
  std::ptrdiff_t Begin;
  int Count;
  Row Rows[3]; // two neighbours, and one without voxels
  alignas(64) Integer<T> Moves[Width];
  bool KnowsMoves = false;
};

/// Where rays enter a slice, where they are between changing columns and rows, and where they
/// leave.
template <class T>
struct CrossedPath
{
  Pack<T> entry, corner, exit;
  TickOrder order;
};

/// A slice as a row of pixels sees it. Copies, because for compilers pixels that are bytes might be
/// part of the crossing.
template <class T>
struct CrossedRow
{
  const typename PickedRows<T>::Row *first, *last; ///< where rays enter and leave
  const double* columnTime;
  const std::int16_t* columnTick;
  const Integer<T>* moves; ///< only where winners are noted
  double rowTime;
  std::int16_t rowTick, order;
  Integer<T> bit;

  /// The path of a register of pixels, and its largest voxels.
  SPLATTING_INLINE Pack<T> find(std::ptrdiff_t at, CrossedPath<T>& path) const
  {
    path.entry = load<T>(this->first->entry + at);
    path.exit = load<T>(this->last->exit + at);
    const Pack<T> best = larger(path.entry, path.exit);
    if (this->first == this->last)
    {
      return best;
    }
    path.order = orderOf<width<T>>(this->columnTick + at, this->rowTick);
    if (path.order.ties)
    {
      // Which face comes first takes more digits.
      path.order = orderOf<width<T>>(this->columnTime + at, this->rowTime);
    }
    const Register rowFirst = (Register)load<T>(this->last->entry + at);
    const Register columnFirst = (Register)load<T>(this->first->exit + at);
    const Register other = chosen<sizeof(T)>(path.order.after, (Register)path.entry, rowFirst);
    path.corner = (Pack<T>)chosen<sizeof(T)>(path.order.before, other, columnFirst);
    return larger(path.corner, best);
  }

  /// Which voxel of the path the best one is, of equal ones the nearest.
  SPLATTING_INLINE Pack<Integer<T>> step(
    std::ptrdiff_t at, const CrossedPath<T>& path, Pack<T> best, bool reversed) const
  {
    const Pack<Integer<T>> start{};
    const Pack<T> nearest = reversed ? path.exit : path.entry;
    Pack<Integer<T>> end = load<Integer<T>>(this->moves + at), beyond = reversed ? start : end;
    if (this->first != this->last)
    {
      // There is a corner where both change, but not at once.
      const Pack<Integer<T>> one = start + Integer<T>(1);
      const auto differ = path.order.before | path.order.after;
      const Register met = chosen<sizeof(T)>(differ, (Register)nearest, (Register)path.corner);
      const Pack<T> corner = end != 0 ? (Pack<T>)met : nearest;
      end = (Pack<Integer<T>>)chosen<sizeof(T)>(differ, (Register)one, (Register)(end + one));
      beyond = corner == best ? one : reversed ? start : end;
    }
    return nearest == best ? (reversed ? end : start) : beyond;
  }
};

/// Some columns of pixels and the slices that they cross.
template <class T>
class CrossedColumns
{
public:
  /// @param count  of registers at most
  CrossedColumns(const Crossing<T>& crossing, std::ptrdiff_t begin, int count)
    : C(crossing),
      Begin(begin),
      Slices{ { crossing, 0, begin, count }, { crossing, crossing.count - 1, begin, count } }
  {
  }

  /// @param count  of registers
  void raise(int v, int count)
  {
    if (this->C.noting.notes)
    {
      this->C.bits ? this->raise<true, true>(v, count) : this->raise<false, true>(v, count);
    }
    else
    {
      this->C.bits ? this->raise<true, false>(v, count) : this->raise<false, false>(v, count);
    }
  }

private:
  template <bool Notes>
  CrossedRow<T> rowOf(int s, int v)
  {
    const CrossedSlice<T>& slice = this->C.slices[s];
    PickedRows<T>& picked = this->Slices[s];
    const std::int32_t j0 = slice.firstRow[v], j1 = slice.lastRow[v];
    const auto* const first = picked.row(j0);
    return { first, j1 == j0 ? first : picked.row(j1), slice.columnTime + this->Begin,
      slice.columnTick + this->Begin, Notes ? picked.moves() : nullptr, slice.rowTime[v],
      slice.rowTick[v], slice.order, static_cast<Integer<T>>(slice.bit) };
  }

  /// Some pixels' rays in one slice or two.
  struct Paths
  {
    CrossedRow<T> near, far;
    bool two, reversed;
    CrossedPath<T> nearPath, farPath;
    Pack<T> nearBest, best; ///< of the nearer slice, and of both
  };

  /// @param before  the least that counts
  template <bool Cut>
  static SPLATTING_INLINE Pack<T> bestOf(const CrossedRow<T>& row, std::ptrdiff_t at,
    const unsigned char* bits, Pack<T> before, CrossedPath<T>& path)
  {
    const Pack<T> best = larger(row.find(at, path), before);
    if constexpr (Cut)
    {
      return (loadBits<T>(bits + at) & row.bit) != 0 ? best : before;
    }
    return best;
  }

  static SPLATTING_INLINE void note(
    const Noting& noting, T* image, std::int16_t* notes, std::ptrdiff_t at, const Paths& p)
  {
    Pack<Integer<T>> steps = p.near.step(at, p.nearPath, p.best, p.reversed);
    if (p.two)
    {
      const int beyond = p.far.order - p.near.order;
      const Integer<T> slice = static_cast<Integer<T>>(p.reversed ? -beyond : beyond);
      const Pack<Integer<T>> farSteps = p.far.step(at, p.farPath, p.best, p.reversed) + slice;
      steps = p.nearBest == p.best ? steps : farSteps;
    }
    raiseRegister<T>(
      noting, image + at, notes + at, p.best, p.reversed ? Pack<Integer<T>>{} - steps : steps);
  }

  template <bool Cut, bool Notes>
  void raise(int v, int count)
  {
    const Crossing<T>& c = this->C;
    Paths p;
    p.two = c.count > 1;
    p.reversed = c.reversed;
    p.near = this->template rowOf<Notes>(0, v);
    p.far = p.two ? this->template rowOf<Notes>(1, v) : p.near;
    T* const image = c.image + v * c.imageStride + this->Begin;
    std::int16_t* const notes = Notes ? c.noting.notes + v * c.imageStride + this->Begin : nullptr;
    const unsigned char* const bits = Cut ? c.bits + v * c.bitsStride + this->Begin : nullptr;
    const Noting noting = c.noting;
    for (int n = 0; n < count; ++n)
    {
      const std::ptrdiff_t at = n * width<T>;
      const Pack<T> before = Notes ? Pack<T>{} + Least<T> : load<T>(image + at);
      p.nearBest = bestOf<Cut>(p.near, at, bits, before, p.nearPath);
      p.best =
        p.two ? larger(bestOf<Cut>(p.far, at, bits, before, p.farPath), p.nearBest) : p.nearBest;
      if constexpr (!Notes)
      {
        store<T>(image + at, p.best);
      }
      else
      {
        // Noting costs less than a guess whether any pixel wins.
        note(noting, image, notes, at, p);
      }
    }
  }

  const Crossing<T>& C;
  std::ptrdiff_t Begin;
  PickedRows<T> Slices[2];
};

/// The registers of a run, for all rows of pixels. Where rows end within one it reaches into the
/// next row, and leaves that as it is: beyond an image's edge rays meet no voxels. What the last
/// rows have in such a register is left to do: pixels [first, run.end) of rows from the result on.
template <class T>
inline int crossRegisters(const Crossing<T>& c, const Span& run, int& first)
{
  constexpr std::ptrdiff_t w = width<T>;
  const std::ptrdiff_t rest = (run.end - run.begin) % w;
  const std::ptrdiff_t rowsBeyond = rest > 0 ? (w - rest + c.imageStride - 1) / c.imageStride : 0;
  const int fullRows = static_cast<int>(c.height > rowsBeyond ? c.height - rowsBeyond : 0);
  for (std::ptrdiff_t begin = run.begin; begin < run.end; begin += PickedRows<T>::Width)
  {
    const std::ptrdiff_t left = run.end - begin;
    const std::ptrdiff_t some = left < PickedRows<T>::Width ? left : PickedRows<T>::Width;
    const int whole = static_cast<int>(some / w), all = static_cast<int>((some + w - 1) / w);
    CrossedColumns<T> columns(c, begin, all);
    for (int v = 0; v < c.height; ++v)
    {
      columns.raise(v, v < fullRows ? all : whole);
    }
  }
  first = static_cast<int>(run.end - rest);
  return rest > 0 ? fullRows : c.height;
}
#endif

template <class T>
void cross(const Crossing<T>& crossing)
{
  const Crossing<T> c = crossing; // pixels that are bytes might be part of the other one
  for (int n = 0; n < c.runCount; ++n)
  {
    Span pixels = c.runs[n];
    int row = 0;
#if defined(__AVX2__)
    if constexpr (Picker<T>::picks)
    {
      if (c.columns >= Picker<T>::group)
      {
        row = crossRegisters(c, c.runs[n], pixels.begin);
      }
    }
#endif
    for (; row < c.height; ++row)
    {
      for (int s = 0; s < c.count; ++s)
      {
        crossRow(c, s, pixels, row);
      }
    }
  }
}
}
}

#endif
