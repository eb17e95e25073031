// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The rays of perspective images and the voxels that they cross. For Kernels.cxx only, which says
 * why all of this is in an anonymous namespace.
 */
#ifndef splattingFanKernels_h
#define splattingFanKernels_h

#include "NotingKernels.h"

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

/// Picks voxels for a register of pixels. In general not at all: `group` is any, and `picks` tells.
template <class T, int Size = sizeof(T)>
struct Picker
{
  static constexpr int group = 16 / Size;
  static constexpr bool picks = false;
};

#if defined(__AVX512F__)
using Register = __m512i;
inline Register loadRegister(const void* p)
{
  return _mm512_loadu_si512(p);
}
#if defined(__AVX512VBMI__)
template <class T>
struct Picker<T, 1>
{
  static constexpr int group = 64;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const Register picked = _mm512_permutexvar_epi8(lanes, loadRegister(row + base[0]));
    return _mm512_mask_blend_epi8(_mm512_movepi8_mask(lanes), picked, none);
  }
};
#else
template <class T>
struct Picker<T, 1>
{
  static constexpr int group = 16;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const auto four = [=](int n)
    { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + base[n])); };
    Register voxels = _mm512_castsi128_si512(four(0));
    voxels = _mm512_inserti32x4(voxels, four(1), 1);
    voxels = _mm512_inserti32x4(voxels, four(2), 2);
    voxels = _mm512_inserti32x4(voxels, four(3), 3);
    const Register picked = _mm512_shuffle_epi8(voxels, lanes);
    return _mm512_mask_blend_epi8(_mm512_movepi8_mask(lanes), picked, none);
  }
};
#endif
template <class T>
struct Picker<T, 2>
{
  static constexpr int group = 32;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const Register picked = _mm512_permutexvar_epi16(lanes, loadRegister(row + base[0]));
    return _mm512_mask_blend_epi16(_mm512_movepi16_mask(lanes), picked, none);
  }
};
template <class T>
struct Picker<T, 4>
{
  static constexpr int group = 16;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const Register picked = _mm512_permutexvar_epi32(lanes, loadRegister(row + base[0]));
    return _mm512_mask_blend_epi32(_mm512_movepi32_mask(lanes), picked, none);
  }
};
template <class T>
struct Picker<T, 8>
{
  static constexpr int group = 8;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const Register picked = _mm512_permutexvar_epi64(lanes, loadRegister(row + base[0]));
    return _mm512_mask_blend_epi64(_mm512_movepi64_mask(lanes), picked, none);
  }
};
#elif defined(__AVX2__)
using Register = __m256i;
inline Register loadRegister(const void* p)
{
  return _mm256_loadu_si256(static_cast<const __m256i*>(p));
}
/// Two groups, each from its own half.
template <class T>
inline Register loadHalves(const T* row, const std::int32_t* base)
{
  return _mm256_inserti128_si256(
    _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(row + base[0]))),
    _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + base[1])), 1);
}
template <class T>
struct Picker<T, 1>
{
  static constexpr int group = 16;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const Register picked = _mm256_shuffle_epi8(loadHalves(row, base), lanes);
    return _mm256_blendv_epi8(picked, none, lanes);
  }
};
template <class T>
struct Picker<T, 2>
{
  static constexpr int group = 8;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    // Lane n is bytes 2 n and 2 n + 1.
    const Register bytes = _mm256_add_epi16(
      _mm256_mullo_epi16(lanes, _mm256_set1_epi16(0x0202)), _mm256_set1_epi16(0x0100));
    const Register picked = _mm256_shuffle_epi8(loadHalves(row, base), bytes);
    return _mm256_blendv_epi8(picked, none, _mm256_srai_epi16(lanes, 15));
  }
};
template <class T>
struct Picker<T, 4>
{
  static constexpr int group = 8;
  static constexpr bool picks = true;
  static inline Register pick(const T* row, const std::int32_t* base, Register lanes, Register none)
  {
    const Register picked = _mm256_permutevar8x32_epi32(loadRegister(row + base[0]), lanes);
    return _mm256_blendv_epi8(picked, none, _mm256_srai_epi32(lanes, 31));
  }
};
#endif

/// One pixel of one row; rows[0] and rows[1] are those of voxels where rays enter and leave.
template <class T>
inline void crossPixel(const Crossing<T>& c, T* image, const unsigned char* bits,
  const T* const (&rows)[2], double rowTime, std::ptrdiff_t x)
{
  if (bits && !(bits[x] & c.bit))
  {
    return;
  }
  const Integer<T> enters = static_cast<const Integer<T>*>(c.entryLanes)[x];
  const Integer<T> leaves = static_cast<const Integer<T>*>(c.exitLanes)[x];
  const std::ptrdiff_t group = x / Picker<T>::group;
  const std::int32_t entry = c.entryBase[group] + enters, exit = c.exitBase[group] + leaves;
  if (enters >= 0)
  {
    image[x] = larger(rows[0][entry], image[x]);
  }
  if (leaves >= 0)
  {
    image[x] = larger(rows[1][exit], image[x]);
  }
  if (leaves >= 0 && c.columnTime[x] < rowTime)
  {
    image[x] = larger(rows[0][exit], image[x]);
  }
  if (enters >= 0 && rowTime < c.columnTime[x])
  {
    image[x] = larger(rows[1][entry], image[x]);
  }
}

/// The same where winners are noted: voxel by voxel along the path.
template <class T>
inline void crossPixelNoting(const Crossing<T>& c, T* image, std::int16_t* notes,
  const unsigned char* bits, const T* const (&rows)[2], bool changesRows, double rowTime,
  std::ptrdiff_t x)
{
  if (bits && !(bits[x] & c.bit))
  {
    return;
  }
  const Integer<T> enters = static_cast<const Integer<T>*>(c.entryLanes)[x];
  const Integer<T> leaves = static_cast<const Integer<T>*>(c.exitLanes)[x];
  const std::ptrdiff_t group = x / Picker<T>::group;
  const auto at = [&](int row, bool last)
  {
    const Integer<T> lane = last ? leaves : enters;
    return lane >= 0 ? rows[row][(last ? c.exitBase : c.entryBase)[group] + lane] : Least<T>;
  };
  const bool changesColumns = c.columnTick[x] >= 0, columnFirst = c.columnTime[x] < rowTime;
  T path[3] = { at(0, false) };
  int count = 1;
  if (changesRows && changesColumns && c.columnTime[x] != rowTime)
  {
    path[count++] = columnFirst ? at(0, true) : at(1, false);
  }
  if (changesRows || changesColumns)
  {
    path[count++] = at(1, true);
  }
  for (int n = 0; n < count; ++n)
  {
    const std::int16_t own =
      static_cast<std::int16_t>(c.reversed ? c.noting.order - n : c.noting.order + n);
    if (path[n] > image[x] || (path[n] == image[x] && own < notes[x]))
    {
      image[x] = path[n];
      notes[x] = own;
    }
  }
}

#if defined(__AVX2__)
/// Of a register of pixels, those that change columns before the ray changes rows, those that
/// change them after it, and whether any are neither or cannot be told by their ticks.
#if defined(__AVX512F__)
struct TickOrder
{
  std::uint64_t before, after;
  bool ties;
};

template <int Pixels>
inline TickOrder orderOf(const std::int16_t* ticks, std::int16_t tick)
{
  if constexpr (Pixels == 64)
  {
    const TickOrder low = orderOf<32>(ticks, tick), high = orderOf<32>(ticks + 32, tick);
    return { low.before | high.before << 32, low.after | high.after << 32, low.ties || high.ties };
  }
  else if constexpr (Pixels == 32)
  {
    const Register own = loadRegister(ticks), other = _mm512_set1_epi16(tick);
    const std::uint32_t before = _mm512_cmplt_epi16_mask(own, other);
    const std::uint32_t after = _mm512_cmpgt_epi16_mask(own, other);
    return { before, after, (before | after) != 0xffffffffu };
  }
  else if constexpr (Pixels == 16)
  {
    const __m256i own = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(ticks));
    const __m256i other = _mm256_set1_epi16(tick);
    const std::uint32_t before = _mm256_cmplt_epi16_mask(own, other);
    const std::uint32_t after = _mm256_cmpgt_epi16_mask(own, other);
    return { before, after, (before | after) != 0xffffu };
  }
  else
  {
    const __m128i own = _mm_loadu_si128(reinterpret_cast<const __m128i*>(ticks));
    const __m128i other = _mm_set1_epi16(tick);
    const std::uint32_t before = _mm_cmplt_epi16_mask(own, other);
    const std::uint32_t after = _mm_cmpgt_epi16_mask(own, other);
    return { before, after, (before | after) != 0xffu };
  }
}

/// The same from the times themselves, which tell all but ties.
template <int Pixels>
inline TickOrder orderOf(const double* times, double time)
{
  std::uint64_t before = 0, after = 0;
  const __m512d other = _mm512_set1_pd(time);
#pragma GCC unroll 8
  for (int n = 0; n < Pixels; n += 8)
  {
    const __m512d own = _mm512_loadu_pd(times + n);
    before |= std::uint64_t(_mm512_cmp_pd_mask(own, other, _CMP_LT_OQ)) << n;
    after |= std::uint64_t(_mm512_cmp_pd_mask(own, other, _CMP_GT_OQ)) << n;
  }
  return { before, after, false };
}

/// b where there are bits, else a.
template <int Bytes>
inline Register chosen(std::uint64_t bits, Register a, Register b)
{
  if constexpr (Bytes == 1)
  {
    return _mm512_mask_blend_epi8(bits, a, b);
  }
  else if constexpr (Bytes == 2)
  {
    return _mm512_mask_blend_epi16(static_cast<__mmask32>(bits), a, b);
  }
  else if constexpr (Bytes == 4)
  {
    return _mm512_mask_blend_epi32(static_cast<__mmask16>(bits), a, b);
  }
  else
  {
    return _mm512_mask_blend_epi64(static_cast<__mmask8>(bits), a, b);
  }
}
#else
struct TickOrder
{
  Register before, after;
  bool ties;
};

template <int Pixels>
inline TickOrder orderOf(const std::int16_t* ticks, std::int16_t tick)
{
  TickOrder order;
  const Register other = _mm256_set1_epi16(tick);
  if constexpr (Pixels == 32)
  {
    const Register low = loadRegister(ticks), high = loadRegister(ticks + 16);
    // Packed within halves.
    const auto packed = [](Register a, Register b)
    { return _mm256_permute4x64_epi64(_mm256_packs_epi16(a, b), 0xD8); };
    order.before = packed(_mm256_cmpgt_epi16(other, low), _mm256_cmpgt_epi16(other, high));
    order.after = packed(_mm256_cmpgt_epi16(low, other), _mm256_cmpgt_epi16(high, other));
  }
  else if constexpr (Pixels == 16)
  {
    const Register own = loadRegister(ticks);
    order.before = _mm256_cmpgt_epi16(other, own);
    order.after = _mm256_cmpgt_epi16(own, other);
  }
  else
  {
    const Register own =
      _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(ticks)));
    order.before = _mm256_cmpgt_epi32(_mm256_set1_epi32(tick), own);
    order.after = _mm256_cmpgt_epi32(own, _mm256_set1_epi32(tick));
  }
  order.ties = _mm256_movemask_epi8(_mm256_or_si256(order.before, order.after)) != -1;
  return order;
}

/// The same from the times themselves, which tell all but ties.
template <int Pixels>
inline TickOrder orderOf(const double* times, double time)
{
  typename IntegerOf<32 / Pixels>::type before[Pixels], after[Pixels];
  for (int n = 0; n < Pixels; ++n)
  {
    before[n] = static_cast<typename IntegerOf<32 / Pixels>::type>(-(times[n] < time));
    after[n] = static_cast<typename IntegerOf<32 / Pixels>::type>(-(times[n] > time));
  }
  return { loadRegister(before), loadRegister(after), false };
}

template <int>
inline Register chosen(Register bits, Register a, Register b)
{
  return _mm256_blendv_epi8(a, b, bits);
}
#endif

/// Some columns of pixels, and what they pick from the rows of voxels that were met last: rows of
/// pixels are narrower than those of voxels, and the next one mostly meets the same.
template <class T>
class PickedRows
{
public:
  static constexpr std::ptrdiff_t Width = 8 * width<T>;

  PickedRows(const Crossing<T>& crossing, std::ptrdiff_t begin, std::ptrdiff_t end)
    : C(crossing),
      Begin(begin),
      Count(static_cast<int>((end - begin) / width<T>))
  {
    for (Row& row : this->Rows)
    {
      row.j = -2; // none yet
    }
  }

  void cross(int v)
  {
    if (this->C.noting.notes)
    {
      this->C.bits ? this->cross<true, true>(v) : this->cross<false, true>(v);
    }
    else
    {
      this->C.bits ? this->cross<true, false>(v) : this->cross<false, false>(v);
    }
  }

private:
  /// The voxels in which rays enter the slice and leave it.
  struct Row
  {
    std::int32_t j;
    alignas(64) T entry[Width];
    alignas(64) T exit[Width];
  };

  template <bool Cut, bool Notes>
  void cross(int v)
  {
    const std::int32_t j0 = this->C.firstRow[v], j1 = this->C.lastRow[v];
    const Row* const first = this->row(j0);
    const Row* const last = j1 == j0 ? first : this->row(j1);
    j0 == j1 ? this->raise<false, Cut, Notes>(v, first, last)
             : this->raise<true, Cut, Notes>(v, first, last);
  }

  const Row* row(std::int32_t j)
  {
    const bool inside = j >= 0 && j < this->C.rows;
    const std::int32_t wanted = inside ? j : -1;
    Row& row = this->Rows[inside ? j & 1 : 2];
    if (row.j != wanted)
    {
      row.j = wanted;
      this->pick(inside ? this->C.voxels + j * this->C.rowStride : this->C.none, row);
    }
    return &row;
  }

  void pick(const T* voxels, Row& row) const
  {
    const Crossing<T>& c = this->C;
    const Register none = loadRegister(c.none);
    for (int n = 0; n < this->Count; ++n)
    {
      const std::ptrdiff_t x = this->Begin + n * width<T>, group = x / Picker<T>::group;
      const Register entry = loadRegister(static_cast<const Integer<T>*>(c.entryLanes) + x);
      const Register exit = loadRegister(static_cast<const Integer<T>*>(c.exitLanes) + x);
      // A band of rows is too short for processors to notice that the next slice will come.
      __builtin_prefetch(voxels + c.ahead + c.entryBase[group]);
      store<T>(row.entry + n * width<T>,
        (Pack<T>)Picker<T>::pick(voxels, c.entryBase + group, entry, none));
      store<T>(
        row.exit + n * width<T>, (Pack<T>)Picker<T>::pick(voxels, c.exitBase + group, exit, none));
    }
  }

  template <bool TwoRows, bool Cut, bool Notes>
  void raise(int v, const Row* first, const Row* last) const
  {
    const Crossing<T>& c = this->C;
    T* const image = c.image + v * c.imageStride + this->Begin;
    std::int16_t* const notes = Notes ? c.noting.notes + v * c.imageStride + this->Begin : nullptr;
    const unsigned char* const bits = Cut ? c.bits + v * c.bitsStride + this->Begin : nullptr;
    for (int n = 0; n < this->Count; ++n)
    {
      const std::ptrdiff_t at = n * width<T>;
      const Pack<T> entry = load<T>(first->entry + at), exit = load<T>(last->exit + at);
      Pack<T> best = larger(entry, exit), corner = entry;
      TickOrder order{};
      if constexpr (TwoRows)
      {
        order = this->orderAt(v, at);
        const Register rowFirst = (Register)load<T>(last->entry + at);
        const Register columnFirst = (Register)load<T>(first->exit + at);
        corner = (Pack<T>)chosen<sizeof(T)>(
          order.before, chosen<sizeof(T)>(order.after, (Register)entry, rowFirst), columnFirst);
        best = larger(corner, best);
      }
      const Pack<T> before = Notes ? Pack<T>{} + Least<T> : load<T>(image + at);
      best = larger(best, before);
      if constexpr (Cut)
      {
        const Pack<Integer<T>> own = loadBits<T>(bits + at);
        best = (own & static_cast<Integer<T>>(c.bit)) != 0 ? best : before;
      }
      if constexpr (!Notes)
      {
        store<T>(image + at, best);
      }
      else if (mayWin<1, T>(c.noting, image, notes, Registers<T, 1>{ at, at }, { best }))
      {
        const Pack<Integer<T>> steps =
          this->stepsOf<TwoRows>(at, order, { entry, corner, exit }, best);
        raiseRegister<T>(
          c.noting, image + at, notes + at, best, c.reversed ? Pack<Integer<T>>{} - steps : steps);
      }
    }
  }

  TickOrder orderAt(int v, std::ptrdiff_t at) const
  {
    const Crossing<T>& c = this->C;
    const TickOrder order = orderOf<width<T>>(c.columnTick + this->Begin + at, c.rowTick[v]);
    // Which face comes first may take more digits.
    return order.ties ? orderOf<width<T>>(c.columnTime + this->Begin + at, c.rowTime[v]) : order;
  }

  /// Where rays enter a slice, where they are between changing columns and rows, and where they
  /// leave.
  struct Path
  {
    Pack<T> entry, corner, exit;
  };

  /// Which voxel of their path in the slice the best one is, of equal ones the nearest.
  template <bool TwoRows>
  Pack<Integer<T>> stepsOf(
    std::ptrdiff_t at, const TickOrder& order, const Path& path, Pack<T> best) const
  {
    const Register none{}, one = (Register)(Pack<Integer<T>>{} + Integer<T>(1));
    const auto stays = orderOf<width<T>>(this->C.columnTick + this->Begin + at, 0).before;
    Pack<Integer<T>> last = (Pack<Integer<T>>)chosen<sizeof(T)>(stays, one, none);
    const Pack<T> nearest = this->C.reversed ? path.exit : path.entry;
    Pack<T> corner = path.corner;
    if constexpr (TwoRows)
    {
      // There is a corner where both change, but not at once.
      const Register two = (Register)(Pack<Integer<T>>{} + Integer<T>(2));
      const auto differ = order.before | order.after;
      const auto turned = chosen<sizeof(T)>(differ, one, two);
      last = (Pack<Integer<T>>)chosen<sizeof(T)>(stays, turned, one);
      const Register met = chosen<sizeof(T)>(differ, (Register)nearest, (Register)corner);
      corner = (Pack<T>)chosen<sizeof(T)>(stays, met, (Register)nearest);
    }
    const Pack<Integer<T>> first{};
    const Pack<Integer<T>> second = first + Integer<T>(1);
    Pack<Integer<T>> step = this->C.reversed ? first : last;
    if constexpr (TwoRows)
    {
      step = corner == best ? second : step;
    }
    return nearest == best ? (this->C.reversed ? last : first) : step;
  }

  const Crossing<T>& C;
  std::ptrdiff_t Begin;
  int Count; ///< of registers
  Row Rows[3]; // two neighbours, and one without voxels
};

/// Whole registers of a run, for all rows of pixels. Returns where they end.
template <class T>
inline std::ptrdiff_t crossRegisters(const Crossing<T>& c, const Span& run)
{
  const std::ptrdiff_t end = run.begin + (run.end - run.begin) / width<T> * width<T>;
  for (std::ptrdiff_t begin = run.begin; begin < end; begin += PickedRows<T>::Width)
  {
    const std::ptrdiff_t left = end - begin;
    PickedRows<T> rows(
      c, begin, begin + (left < PickedRows<T>::Width ? left : PickedRows<T>::Width));
    for (int v = 0; v < c.height; ++v)
    {
      rows.cross(v);
    }
  }
  return end;
}
#endif

template <class T>
inline void crossRow(const Crossing<T>& c, const Span& run, int v)
{
  const std::int32_t j[2] = { c.firstRow[v], c.lastRow[v] };
  const bool inside[2] = { j[0] >= 0 && j[0] < c.rows, j[1] >= 0 && j[1] < c.rows };
  const T* const rows[2] = { inside[0] ? c.voxels + j[0] * c.rowStride : c.none,
    inside[1] ? c.voxels + j[1] * c.rowStride : c.none };
  T* const image = c.image + v * c.imageStride;
  std::int16_t* const notes = c.noting.notes ? c.noting.notes + v * c.imageStride : nullptr;
  const unsigned char* const bits = c.bits ? c.bits + v * c.bitsStride : nullptr;
  for (std::ptrdiff_t x = run.begin; x < run.end; ++x)
  {
    notes ? crossPixelNoting(c, image, notes, bits, rows, j[0] != j[1], c.rowTime[v], x)
          : crossPixel(c, image, bits, rows, c.rowTime[v], x);
  }
}

template <class T>
void cross(const Crossing<T>& crossing)
{
  const Crossing<T> c = crossing; // pixels that are bytes might be part of the other one
  for (int n = 0; n < c.runCount; ++n)
  {
    Span rest = c.runs[n];
#if defined(__AVX2__)
    if constexpr (Picker<T>::picks)
    {
      if (c.columns >= Picker<T>::group)
      {
        rest.begin = static_cast<int>(crossRegisters(c, rest));
      }
    }
#endif
    for (int v = 0; v < c.height && rest.begin < rest.end; ++v)
    {
      crossRow(c, rest, v);
    }
  }
}
}
}

#endif
