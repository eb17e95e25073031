// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Registers for CellKernels.cxx: values, masks with a bit for each lane, and 32-bit integers. All
 * operations are IEEE operations on single lanes, so that the width does not matter. Multiply-add
 * is fused everywhere, by a function of C's library where the processor cannot.
 */
#ifndef splattingCellRegisters_h
#define splattingCellRegisters_h

#include "Kernels/Compiler.h"

#include <cstdint>
#include <cstring>

namespace splatting
{
namespace
{
/// The number of lanes of a register of type A for which no class is specialised below.
template <class A>
constexpr int lanesOf = SPLATTING_VECTOR_BYTES / static_cast<int>(sizeof(A));

template <class A>
SPLATTING_INLINE A fused(A a, A b, A c)
{
  if constexpr (sizeof(A) == sizeof(float))
  {
    return __builtin_fmaf(a, b, c);
  }
  else
  {
    return __builtin_fma(a, b, c);
  }
}

/// Stores from + n step, for the lanes n of a mask only, one after the other. Returns how many
/// there are.
inline int storeLanes(std::int32_t* p, std::int32_t from, std::int32_t step, unsigned lanes)
{
  int count = 0;
  for (; lanes; lanes &= lanes - 1)
  {
    p[count++] = from + step * __builtin_ctz(lanes);
  }
  return count;
}

/// Any type and any width, lane by lane.
template <class A>
struct PlainRegisters
{
  static constexpr int N = lanesOf<A>;
  using Mask = std::uint32_t;
  struct Value
  {
    A lane[N];
  };
  struct Index
  {
    std::int32_t lane[N];
  };

  template <class F>
  static SPLATTING_INLINE Value each(F&& f)
  {
    Value r;
    for (int n = 0; n < N; ++n)
    {
      r.lane[n] = f(n);
    }
    return r;
  }
  template <class F>
  static SPLATTING_INLINE Mask eachBit(F&& f)
  {
    Mask m = 0;
    for (int n = 0; n < N; ++n)
    {
      m |= f(n) ? 1u << n : 0u;
    }
    return m;
  }
  static SPLATTING_INLINE Value set(A a)
  {
    return each([&](int) { return a; });
  }
  static SPLATTING_INLINE Value load(const A* p)
  {
    return each([&](int n) { return p[n]; });
  }
  static SPLATTING_INLINE void store(A* p, Value a) { std::memcpy(p, a.lane, sizeof a.lane); }
  static SPLATTING_INLINE Value add(Value a, Value b)
  {
    return each([&](int n) { return a.lane[n] + b.lane[n]; });
  }
  static SPLATTING_INLINE Value sub(Value a, Value b)
  {
    return each([&](int n) { return a.lane[n] - b.lane[n]; });
  }
  static SPLATTING_INLINE Value mul(Value a, Value b)
  {
    return each([&](int n) { return a.lane[n] * b.lane[n]; });
  }
  static SPLATTING_INLINE Value div(Value a, Value b)
  {
    return each([&](int n) { return a.lane[n] / b.lane[n]; });
  }
  static SPLATTING_INLINE Value fma(Value a, Value b, Value c)
  {
    return each([&](int n) { return fused(a.lane[n], b.lane[n], c.lane[n]); });
  }
  static SPLATTING_INLINE Value root(Value a)
  {
    return each(
      [&](int n)
      {
        if constexpr (sizeof(A) == sizeof(float))
        {
          return __builtin_sqrtf(a.lane[n]);
        }
        else
        {
          return __builtin_sqrt(a.lane[n]);
        }
      });
  }
  static SPLATTING_INLINE Value floor(Value a)
  {
    return each([&](int n) { return static_cast<A>(__builtin_floor(a.lane[n])); });
  }
  static SPLATTING_INLINE Value ceil(Value a)
  {
    return each([&](int n) { return static_cast<A>(__builtin_ceil(a.lane[n])); });
  }
  static SPLATTING_INLINE Value larger(Value a, Value b)
  {
    return each([&](int n) { return a.lane[n] > b.lane[n] ? a.lane[n] : b.lane[n]; });
  }
  static SPLATTING_INLINE Value smaller(Value a, Value b)
  {
    return each([&](int n) { return a.lane[n] < b.lane[n] ? a.lane[n] : b.lane[n]; });
  }
  static SPLATTING_INLINE Mask above(Value a, Value b)
  {
    return eachBit([&](int n) { return a.lane[n] > b.lane[n]; });
  }
  static SPLATTING_INLINE Mask atLeast(Value a, Value b)
  {
    return eachBit([&](int n) { return a.lane[n] >= b.lane[n]; });
  }
  static SPLATTING_INLINE Value choose(Mask m, Value a, Value b)
  {
    return each([&](int n) { return m >> n & 1 ? a.lane[n] : b.lane[n]; });
  }
  static SPLATTING_INLINE Index loadIndex(const std::int32_t* p)
  {
    Index r;
    std::memcpy(r.lane, p, sizeof r.lane);
    return r;
  }
  /// (i >> shift) & mask as values.
  static SPLATTING_INLINE Value part(Index i, int shift, int mask)
  {
    return each([&](int n) { return static_cast<A>(i.lane[n] >> shift & mask); });
  }
  /// table[i & 15]
  static SPLATTING_INLINE Value pick(const A* table, Index i)
  {
    return each([&](int n) { return table[i.lane[n] & 15]; });
  }
  /// p[at] where the mask is set, else `other`; `at` are integers.
  static SPLATTING_INLINE Value gather(const A* p, Value at, Mask m, Value other)
  {
    return each(
      [&](int n) { return m >> n & 1 ? p[static_cast<std::int32_t>(at.lane[n])] : other.lane[n]; });
  }
  /// storeLanes(), which may write up to N numbers.
  static SPLATTING_INLINE int compress(
    std::int32_t* p, std::int32_t from, std::int32_t step, Mask m)
  {
    return storeLanes(p, from, step, m);
  }
  /// The same of values.
  static SPLATTING_INLINE int compress(std::int32_t* p, Value a, Mask m)
  {
    int count = 0;
    for (; m; m &= m - 1)
    {
      p[count++] = static_cast<std::int32_t>(a.lane[__builtin_ctz(m)]);
    }
    return count;
  }
};

template <class A>
struct RegistersOf
{
  using type = PlainRegisters<A>;
};

#if defined(__AVX512F__)
struct FloatRegisters
{
  static constexpr int N = 16;
  using Mask = __mmask16;
  using Value = __m512;
  using Index = __m512i;

  static SPLATTING_INLINE Value set(float a) { return _mm512_set1_ps(a); }
  static SPLATTING_INLINE Value load(const float* p) { return _mm512_loadu_ps(p); }
  static SPLATTING_INLINE void store(float* p, Value a) { _mm512_storeu_ps(p, a); }
  static SPLATTING_INLINE Value add(Value a, Value b) { return _mm512_add_ps(a, b); }
  static SPLATTING_INLINE Value sub(Value a, Value b) { return _mm512_sub_ps(a, b); }
  static SPLATTING_INLINE Value mul(Value a, Value b) { return _mm512_mul_ps(a, b); }
  static SPLATTING_INLINE Value div(Value a, Value b) { return _mm512_div_ps(a, b); }
  static SPLATTING_INLINE Value fma(Value a, Value b, Value c) { return _mm512_fmadd_ps(a, b, c); }
  static SPLATTING_INLINE Value root(Value a) { return _mm512_sqrt_ps(a); }
  static SPLATTING_INLINE Value floor(Value a) { return _mm512_roundscale_ps(a, 1); }
  static SPLATTING_INLINE Value ceil(Value a) { return _mm512_roundscale_ps(a, 2); }
  static SPLATTING_INLINE Value larger(Value a, Value b) { return _mm512_max_ps(a, b); }
  static SPLATTING_INLINE Value smaller(Value a, Value b) { return _mm512_min_ps(a, b); }
  static SPLATTING_INLINE Mask above(Value a, Value b)
  {
    return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ);
  }
  static SPLATTING_INLINE Mask atLeast(Value a, Value b)
  {
    return _mm512_cmp_ps_mask(a, b, _CMP_GE_OQ);
  }
  static SPLATTING_INLINE Value choose(Mask m, Value a, Value b)
  {
    return _mm512_mask_blend_ps(m, b, a);
  }
  static SPLATTING_INLINE Index loadIndex(const std::int32_t* p) { return _mm512_loadu_si512(p); }
  static SPLATTING_INLINE Value part(Index i, int shift, int mask)
  {
    return _mm512_cvtepi32_ps(
      _mm512_and_si512(_mm512_srli_epi32(i, shift), _mm512_set1_epi32(mask)));
  }
  static SPLATTING_INLINE Value pick(const float* table, Index i)
  {
    return _mm512_permutexvar_ps(i, _mm512_loadu_ps(table));
  }
  static SPLATTING_INLINE Value gather(const float* p, Value at, Mask m, Value other)
  {
    return _mm512_mask_i32gather_ps(other, m, _mm512_cvtps_epi32(at), p, 4);
  }
  static SPLATTING_INLINE int compress(
    std::int32_t* p, std::int32_t from, std::int32_t step, Mask m)
  {
    const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i all =
      _mm512_add_epi32(_mm512_set1_epi32(from), _mm512_mullo_epi32(_mm512_set1_epi32(step), lanes));
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(m, all));
    return __builtin_popcount(m);
  }
  static SPLATTING_INLINE int compress(std::int32_t* p, Value a, Mask m)
  {
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(m, _mm512_cvtps_epi32(a)));
    return __builtin_popcount(m);
  }
};
template <>
struct RegistersOf<float>
{
  using type = FloatRegisters;
};
#elif defined(__AVX2__)
struct FloatRegisters
{
  static constexpr int N = 8;
  using Mask = std::uint32_t;
  using Value = __m256;
  using Index = __m256i;

  static SPLATTING_INLINE Mask bits(__m256 m) { return _mm256_movemask_ps(m); }
  static SPLATTING_INLINE __m256 lanes(Mask m)
  {
    const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_castsi256_ps(
      _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(m)), bit), bit));
  }
  static SPLATTING_INLINE Value set(float a) { return _mm256_set1_ps(a); }
  static SPLATTING_INLINE Value load(const float* p) { return _mm256_loadu_ps(p); }
  static SPLATTING_INLINE void store(float* p, Value a) { _mm256_storeu_ps(p, a); }
  static SPLATTING_INLINE Value add(Value a, Value b) { return _mm256_add_ps(a, b); }
  static SPLATTING_INLINE Value sub(Value a, Value b) { return _mm256_sub_ps(a, b); }
  static SPLATTING_INLINE Value mul(Value a, Value b) { return _mm256_mul_ps(a, b); }
  static SPLATTING_INLINE Value div(Value a, Value b) { return _mm256_div_ps(a, b); }
  static SPLATTING_INLINE Value fma(Value a, Value b, Value c) { return _mm256_fmadd_ps(a, b, c); }
  static SPLATTING_INLINE Value root(Value a) { return _mm256_sqrt_ps(a); }
  static SPLATTING_INLINE Value floor(Value a) { return _mm256_floor_ps(a); }
  static SPLATTING_INLINE Value ceil(Value a) { return _mm256_ceil_ps(a); }
  static SPLATTING_INLINE Value larger(Value a, Value b) { return _mm256_max_ps(a, b); }
  static SPLATTING_INLINE Value smaller(Value a, Value b) { return _mm256_min_ps(a, b); }
  static SPLATTING_INLINE Mask above(Value a, Value b)
  {
    return bits(_mm256_cmp_ps(a, b, _CMP_GT_OQ));
  }
  static SPLATTING_INLINE Mask atLeast(Value a, Value b)
  {
    return bits(_mm256_cmp_ps(a, b, _CMP_GE_OQ));
  }
  static SPLATTING_INLINE Value choose(Mask m, Value a, Value b)
  {
    return _mm256_blendv_ps(b, a, lanes(m));
  }
  static SPLATTING_INLINE Index loadIndex(const std::int32_t* p)
  {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
  }
  static SPLATTING_INLINE Value part(Index i, int shift, int mask)
  {
    return _mm256_cvtepi32_ps(
      _mm256_and_si256(_mm256_srli_epi32(i, shift), _mm256_set1_epi32(mask)));
  }
  static SPLATTING_INLINE Value pick(const float* table, Index i)
  {
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), i);
    const __m256 high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table + 8), i);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(i, 28)));
  }
  static SPLATTING_INLINE Value gather(const float* p, Value at, Mask m, Value other)
  {
    return _mm256_mask_i32gather_ps(other, p, _mm256_cvtps_epi32(at), lanes(m), 4);
  }
  static SPLATTING_INLINE void storeIntegers(std::int32_t* p, Value a)
  {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_cvtps_epi32(a));
  }
  static SPLATTING_INLINE int compress(
    std::int32_t* p, std::int32_t from, std::int32_t step, Mask m)
  {
    return storeLanes(p, from, step, m);
  }
  static SPLATTING_INLINE int compress(std::int32_t* p, Value a, Mask m)
  {
    std::int32_t all[N];
    storeIntegers(all, a);
    int count = 0;
    for (; m; m &= m - 1)
    {
      p[count++] = all[__builtin_ctz(m)];
    }
    return count;
  }
};
template <>
struct RegistersOf<float>
{
  using type = FloatRegisters;
};
#endif

#if defined(__AVX512F__)
struct DoubleRegisters
{
  static constexpr int N = 8;
  using Mask = __mmask8;
  using Value = __m512d;
  using Index = __m256i;

  static SPLATTING_INLINE Value set(double a) { return _mm512_set1_pd(a); }
  static SPLATTING_INLINE Value load(const double* p) { return _mm512_loadu_pd(p); }
  static SPLATTING_INLINE void store(double* p, Value a) { _mm512_storeu_pd(p, a); }
  static SPLATTING_INLINE Value add(Value a, Value b) { return _mm512_add_pd(a, b); }
  static SPLATTING_INLINE Value sub(Value a, Value b) { return _mm512_sub_pd(a, b); }
  static SPLATTING_INLINE Value mul(Value a, Value b) { return _mm512_mul_pd(a, b); }
  static SPLATTING_INLINE Value div(Value a, Value b) { return _mm512_div_pd(a, b); }
  static SPLATTING_INLINE Value fma(Value a, Value b, Value c) { return _mm512_fmadd_pd(a, b, c); }
  static SPLATTING_INLINE Value root(Value a) { return _mm512_sqrt_pd(a); }
  static SPLATTING_INLINE Value floor(Value a) { return _mm512_roundscale_pd(a, 1); }
  static SPLATTING_INLINE Value ceil(Value a) { return _mm512_roundscale_pd(a, 2); }
  static SPLATTING_INLINE Value larger(Value a, Value b) { return _mm512_max_pd(a, b); }
  static SPLATTING_INLINE Value smaller(Value a, Value b) { return _mm512_min_pd(a, b); }
  static SPLATTING_INLINE Mask above(Value a, Value b)
  {
    return _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ);
  }
  static SPLATTING_INLINE Mask atLeast(Value a, Value b)
  {
    return _mm512_cmp_pd_mask(a, b, _CMP_GE_OQ);
  }
  static SPLATTING_INLINE Value choose(Mask m, Value a, Value b)
  {
    return _mm512_mask_blend_pd(m, b, a);
  }
  static SPLATTING_INLINE Index loadIndex(const std::int32_t* p)
  {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
  }
  static SPLATTING_INLINE Value part(Index i, int shift, int mask)
  {
    return _mm512_cvtepi32_pd(
      _mm256_and_si256(_mm256_srli_epi32(i, shift), _mm256_set1_epi32(mask)));
  }
  static SPLATTING_INLINE Value pick(const double* table, Index i)
  {
    return _mm512_permutex2var_pd(
      _mm512_loadu_pd(table), _mm512_cvtepi32_epi64(i), _mm512_loadu_pd(table + 8));
  }
  static SPLATTING_INLINE Value gather(const double* p, Value at, Mask m, Value other)
  {
    return _mm512_mask_i32gather_pd(other, m, _mm512_cvtpd_epi32(at), p, 8);
  }
  static SPLATTING_INLINE int compress(
    std::int32_t* p, std::int32_t from, std::int32_t step, Mask m)
  {
    const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i all =
      _mm256_add_epi32(_mm256_set1_epi32(from), _mm256_mullo_epi32(_mm256_set1_epi32(step), lanes));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_maskz_compress_epi32(m, all));
    return __builtin_popcount(m);
  }
  static SPLATTING_INLINE int compress(std::int32_t* p, Value a, Mask m)
  {
    _mm256_storeu_si256(
      reinterpret_cast<__m256i*>(p), _mm256_maskz_compress_epi32(m, _mm512_cvtpd_epi32(a)));
    return __builtin_popcount(m);
  }
};
template <>
struct RegistersOf<double>
{
  using type = DoubleRegisters;
};
#endif

template <class A>
using Registers = typename RegistersOf<A>::type;

template <class A>
SPLATTING_INLINE typename Registers<A>::Mask firstLanes(int count)
{
  return static_cast<typename Registers<A>::Mask>(
    count >= Registers<A>::N ? (1u << Registers<A>::N) - 1 : (1u << count) - 1);
}
}
}

#endif
