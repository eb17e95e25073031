// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Instructions that select elements for each pixel of a register: voxels of a row, and the voxel of
 * a ray from two registers. For Kernels.cxx only, which explains the anonymous namespace.
 */
#ifndef splattingPickKernels_h
#define splattingPickKernels_h

#include "Kernels/Registers.h"

namespace splatting
{
namespace
{
/// Selects voxels for a register of pixels. The general case selects nothing: `picks` is false, and
/// `group` is not used.
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

#if defined(__AVX2__)
/// `before` has the pixels of a register whose rays change columns before they change rows. `after`
/// has those whose rays change columns later. `ties` is whether there are other pixels, which may
/// be undecided by their ticks.
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

/// The same from the times themselves, which decide all cases except ties.
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

/// The same from the times themselves, which decide all cases except ties.
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
#endif
}
}

#endif
