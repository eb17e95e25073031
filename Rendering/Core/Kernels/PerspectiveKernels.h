// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The rays of perspective images, and the voxels that they cross. For Kernels.cxx only, which
 * explains the anonymous namespace.
 */
#ifndef splattingPerspectiveKernels_h
#define splattingPerspectiveKernels_h

#include "Kernels/Kernels.h"
#include "Kernels/PickKernels.h"

#include <limits>

namespace splatting
{
namespace
{
/// The least element.
template <class T>
constexpr T Least = std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity()
                                                         : std::numeric_limits<T>::lowest();

/// For numbers in the range of the integer type.
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
    // Mirrors rays that run to lower voxels.
    const double own = slope[x];
    const double turn = own < 0.0 ? -1.0 : 1.0;
    const double entry = turn * clamped(at[x] + own * from, low, high);
    const double exit = turn * clamped(at[x] + own * to, low, high);
    // A point on a face belongs to the voxel that the ray crosses beside it. A ray within a face
    // has one voxel.
    const double enters = roundedDown(entry + 0.5);
    const double before = -roundedDown(0.5 - exit);
    const double leaves = before > enters ? before : enters;
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

/// One pixel of one row, and the rows of voxels where rays enter and leave a slice.
template <class T>
struct CrossedPixel
{
  const CrossedSlice<T>& slice;
  const T* rows[2];
  bool changesRows;
  double rowTime;

  /// The voxels of its path. Returns their number.
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
  for (std::ptrdiff_t x = run.begin; x < run.end; ++x)
  {
    T voxels[3];
    const int count = own.path(x, voxels);
    raisePixel(image[x], voxels, count);
  }
}

#if defined(__AVX2__)
/// The voxels that some columns of pixels select from the most recently used rows of voxels of a
/// slice. They are kept, because rows of pixels are narrower than rows of voxels: the next row of
/// pixels mostly crosses the same rows of voxels.
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
      // A band of rows is too short for processors to predict the next slice.
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
};

/// A slice for a row of pixels. It has copies, because compilers assume that writing byte pixels
/// changes the crossing.
template <class T>
struct CrossedRow
{
  const typename PickedRows<T>::Row *first, *last; ///< where rays enter and leave
  const double* columnTime;
  const std::int16_t* columnTick;
  double rowTime;
  std::int16_t rowTick;

  /// The larger of a register of pixels and the voxels on their paths, without NaN.
  SPLATTING_INLINE Pack<T> raised(std::ptrdiff_t at, Pack<T> pixels) const
  {
    const Pack<T> entry = load<T>(this->first->entry + at);
    const Pack<T> best = larger(load<T>(this->last->exit + at), larger(entry, pixels));
    if (this->first == this->last)
    {
      return best;
    }
    // A ray that changes both its column and its row crosses a third voxel between the two changes.
    TickOrder order = orderOf<width<T>>(this->columnTick + at, this->rowTick);
    if (order.ties)
    {
      // The ticks are too coarse to find the order of the faces.
      order = orderOf<width<T>>(this->columnTime + at, this->rowTime);
    }
    const Register rowFirst = (Register)load<T>(this->last->entry + at);
    const Register columnFirst = (Register)load<T>(this->first->exit + at);
    const Register other = chosen<sizeof(T)>(order.after, (Register)entry, rowFirst);
    return larger((Pack<T>)chosen<sizeof(T)>(order.before, other, columnFirst), best);
  }
};

/// Some columns of pixels, and the slices that they cross.
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
    const bool two = this->C.count > 1;
    const CrossedRow<T> near = this->rowOf(0, v), far = two ? this->rowOf(1, v) : near;
    T* const image = this->C.image + v * this->C.imageStride + this->Begin;
    for (int n = 0; n < count; ++n)
    {
      const std::ptrdiff_t at = n * width<T>;
      const Pack<T> best = near.raised(at, load<T>(image + at));
      store<T>(image + at, two ? far.raised(at, best) : best);
    }
  }

private:
  CrossedRow<T> rowOf(int s, int v)
  {
    const CrossedSlice<T>& slice = this->C.slices[s];
    PickedRows<T>& picked = this->Slices[s];
    const std::int32_t j0 = slice.firstRow[v], j1 = slice.lastRow[v];
    const auto* const first = picked.row(j0);
    return { first, j1 == j0 ? first : picked.row(j1), slice.columnTime + this->Begin,
      slice.columnTick + this->Begin, slice.rowTime[v], slice.rowTick[v] };
  }

  const Crossing<T>& C;
  std::ptrdiff_t Begin;
  PickedRows<T> Slices[2];
};

/// Raises the registers of a run, for all rows of pixels. A register across the end of a row
/// includes pixels of the next row, and leaves them unchanged, because rays beyond an image's edge
/// cross no voxels. Returns the first row that is not complete. From this row on the caller raises
/// pixels [first, run.end).
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
  // A copy, because compilers assume that writing byte pixels changes the original.
  const Crossing<T> c = crossing;
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
