// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * A register of elements. For Kernels.cxx only, which explains the anonymous namespace.
 */
#ifndef splattingRegisters_h
#define splattingRegisters_h

#include "Common/ScalarType.h"
#include "Kernels/Compiler.h"

namespace splatting
{
namespace
{
#if defined(__GNUC__)
/// A register full of T. Vector extensions of GCC and Clang; elsewhere one element.
template <class T>
struct PackOf
{
  typedef T type __attribute__((vector_size(SPLATTING_VECTOR_BYTES)));
  typedef T loose
    __attribute__((vector_size(SPLATTING_VECTOR_BYTES), aligned(sizeof(T)), may_alias));
};
template <class T>
using Pack = typename PackOf<T>::type;
template <class T>
inline Pack<T> load(const T* p)
{
  return *reinterpret_cast<const typename PackOf<T>::loose*>(p);
}
template <class T>
inline void store(T* p, Pack<T> value)
{
  *reinterpret_cast<typename PackOf<T>::loose*>(p) = value;
}
#else
template <class T>
using Pack = T;
template <class T>
inline Pack<T> load(const T* p)
{
  return *p;
}
template <class T>
inline void store(T* p, Pack<T> value)
{
  *p = value;
}
#endif

template <class T>
constexpr std::ptrdiff_t width = sizeof(Pack<T>) / sizeof(T);

/// Integers as wide as elements of type T.
template <int Size>
struct IntegerOf;
template <>
struct IntegerOf<1>
{
  using type = std::int8_t;
};
template <>
struct IntegerOf<2>
{
  using type = std::int16_t;
};
template <>
struct IntegerOf<4>
{
  using type = std::int32_t;
};
template <>
struct IntegerOf<8>
{
  using type = std::int64_t;
};
template <class T>
using Integer = typename IntegerOf<sizeof(T)>::type;

/// A register of elements, converted to the accumulator's type. For float, compilers need the
/// explicit instruction that converts small integers.
template <class T>
inline Pack<Accumulator<T>> loadWidened(const T* p)
{
  using A = Accumulator<T>;
  if constexpr (std::is_same_v<T, A>)
  {
    return load(p);
  }
  else
  {
    A out[width<A>];
    for (std::ptrdiff_t x = 0; x < width<A>; ++x)
    {
      out[x] = static_cast<A>(p[x]);
    }
    return load(out);
  }
}

#if defined(__AVX512F__)
inline __m512 toFloat(__m512i integers)
{
  return _mm512_cvtepi32_ps(integers);
}
inline Pack<float> loadWidened(const std::uint8_t* p)
{
  return toFloat(_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
}
inline Pack<float> loadWidened(const std::int8_t* p)
{
  return toFloat(_mm512_cvtepi8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
}
inline Pack<float> loadWidened(const std::uint16_t* p)
{
  return toFloat(_mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))));
}
inline Pack<float> loadWidened(const std::int16_t* p)
{
  return toFloat(_mm512_cvtepi16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))));
}
#elif defined(__AVX2__)
inline __m256 toFloat(__m256i integers)
{
  return _mm256_cvtepi32_ps(integers);
}
inline Pack<float> loadWidened(const std::uint8_t* p)
{
  return toFloat(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))));
}
inline Pack<float> loadWidened(const std::int8_t* p)
{
  return toFloat(_mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))));
}
inline Pack<float> loadWidened(const std::uint16_t* p)
{
  return toFloat(_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
}
inline Pack<float> loadWidened(const std::int16_t* p)
{
  return toFloat(_mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
}
#endif

/// Whether advanced() is an instruction.
#if defined(__AVX512F__)
constexpr bool AdvancesRegisters = true;
#else
constexpr bool AdvancesRegisters = false;
#endif

/// All elements of one register except the first, then the first of another one.
template <class P>
inline P advanced(P front, P back)
{
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<P, Pack<float>>)
  {
    return reinterpret_cast<P>(
      _mm512_alignr_epi32(reinterpret_cast<__m512i>(back), reinterpret_cast<__m512i>(front), 1));
  }
#endif
  (void)back;
  return front;
}

/// Whether any element of a comparison's result is true.
template <class M>
inline bool anyOf(const M& mask)
{
  if constexpr (std::is_arithmetic_v<M>)
  {
    return mask != 0;
  }
  else
  {
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask(
             reinterpret_cast<const __m512i&>(mask), reinterpret_cast<const __m512i&>(mask)) != 0;
#elif defined(__AVX2__)
    return _mm256_movemask_epi8(reinterpret_cast<const __m256i&>(mask)) != 0;
#elif defined(__SSE2__)
    return _mm_movemask_epi8(reinterpret_cast<const __m128i&>(mask)) != 0;
#else
    bool any = false;
    for (std::size_t n = 0; n < sizeof(M) / sizeof(mask[0]); ++n)
    {
      any = any || mask[n] != 0;
    }
    return any;
#endif
  }
}

/// The larger; the second if either is NaN.
template <class P>
inline P larger(P a, P b)
{
  return a > b ? a : b;
}

template <class P>
inline P smaller(P a, P b)
{
  return a < b ? a : b;
}

/// Calls block.run<V>(x) for groups of V registers that cover [0, n). The last group overlaps the
/// one before, so elements may be processed twice. If n is too short for a register, calls
/// single(x) for each x.
template <class T, class Block, class Single>
inline void blocks(std::ptrdiff_t n, Block&& block, Single&& single)
{
  constexpr std::ptrdiff_t w = width<T>;
  std::ptrdiff_t x = 0;
  for (; n - x >= 4 * w; x += 4 * w)
  {
    block.template run<4>(x);
  }
  if (n - x >= 2 * w)
  {
    block.template run<2>(x);
    x += 2 * w;
  }
  if (n - x >= w)
  {
    block.template run<1>(x);
    x += w;
  }
  if (x < n && n >= w)
  {
    block.template run<1>(n - w);
    x = n;
  }
  for (; x < n; ++x)
  {
    single(x);
  }
}
}
}

#endif
