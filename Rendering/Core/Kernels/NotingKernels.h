// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How loops note which sample a pixel's value is. For Kernels.cxx only, which says why all of this
 * is in an anonymous namespace.
 */
#ifndef splattingNotingKernels_h
#define splattingNotingKernels_h

#include "Kernels/Kernels.h"
#include "Kernels/Registers.h"

#include <limits>

namespace splatting
{
namespace
{
/// No element is less.
template <class T>
constexpr T Least = std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity()
                                                         : std::numeric_limits<T>::lowest();

/// Where the V registers of a block are: side by side, but for the last one, which may overlap.
template <class T, int V>
struct Registers
{
  std::ptrdiff_t x, last;
  inline std::ptrdiff_t operator[](int v) const
  {
    return v + 1 < V ? this->x + v * width<T> : this->last;
  }
};

#if defined(__GNUC__)
/// As many notes as a register of T has elements, or as fit into one.
template <class T>
struct NotesOf
{
  static constexpr std::ptrdiff_t count =
    width<T> < width<std::int16_t> ? width<T> : width<std::int16_t>;
  typedef std::int16_t type __attribute__((vector_size(2 * count)));
  typedef std::int16_t loose
    __attribute__((vector_size(2 * count), aligned(sizeof(std::int16_t)), may_alias));
  typedef Integer<T> wide __attribute__((vector_size(sizeof(T) * count), may_alias));

  /// Part n of a register, narrowed or widened.
  static inline type part(const Pack<Integer<T>>& pack, std::ptrdiff_t n)
  {
    // Compilers need to be told the instruction that widens bytes.
#if defined(__AVX512F__)
    if constexpr (sizeof(T) == 1)
    {
      return reinterpret_cast<type>(
        _mm512_cvtepi8_epi16(reinterpret_cast<const __m256i*>(&pack)[n]));
    }
#elif defined(__AVX2__)
    if constexpr (sizeof(T) == 1)
    {
      return reinterpret_cast<type>(
        _mm256_cvtepi8_epi16(reinterpret_cast<const __m128i*>(&pack)[n]));
    }
#endif
    return __builtin_convertvector(reinterpret_cast<const wide*>(&pack)[n], type);
  }
};
#else
template <class T>
struct NotesOf
{
  static constexpr std::ptrdiff_t count = 1;
  using type = std::int16_t;
  using loose = std::int16_t;
  static inline type part(Integer<T> element, std::ptrdiff_t) { return static_cast<type>(element); }
};
#endif

/// Notes `own` where pixels win, or tie with what is farther.
template <class T, class N>
inline void keepNearest(
  std::int16_t* notes, std::ptrdiff_t part, N own, Pack<Integer<T>> raised, Pack<Integer<T>> tied)
{
  using Notes = NotesOf<T>;
  typename Notes::loose* const place = reinterpret_cast<typename Notes::loose*>(notes) + part;
  const N old = *place;
  const N wins = Notes::part(raised, part) | (Notes::part(tied, part) & (own < old));
  *place = wins != 0 ? own : old;
}

/// Whether V registers raise any pixel. One question for all of them: in noise most registers do,
/// elsewhere few, so that the answer is easily foretold.
template <int V, class T>
inline bool anyLarger(const T* image, const Registers<T, V>& at, const Pack<T> (&best)[V])
{
  Pack<Integer<T>> raised{};
#pragma GCC unroll 4
  for (int v = 0; v < V; ++v)
  {
    raised |= best[v] > load<T>(image + at[v]);
  }
  return anyOf(raised);
}

/// Notes a slice where its sums are larger than what was before, or as large and nearer, and count.
template <class A>
inline void noteSums(
  const Noting& noting, std::ptrdiff_t at, Pack<A> sum, Pack<A> before, Pack<Integer<A>> counts)
{
  // Without a question, whose answer nobody could foretell.
  const Pack<Integer<A>> tied = (sum == before) & counts;
  keepNearest<A>(noting.notes + at, 0, typename NotesOf<A>::type{} + noting.order, sum > before,
    noting.nearestFirst ? Pack<Integer<A>>{} : tied);
}

/// The same for one sum, if there are notes.
template <class A>
inline void noteSum(const Noting& noting, std::ptrdiff_t at, A sum, A before)
{
  if (noting.notes && (sum > before || (sum == before && noting.order < noting.notes[at])))
  {
    noting.notes[at] = noting.order;
  }
}

#if defined(__AVX512F__)
inline __mmask64 maskOfLarger(Pack<std::uint8_t> a, Pack<std::uint8_t> b)
{
  return _mm512_cmpgt_epu8_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
}
inline __mmask64 maskOfLarger(Pack<std::int8_t> a, Pack<std::int8_t> b)
{
  return _mm512_cmpgt_epi8_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
}
inline __mmask32 maskOfLarger(Pack<std::uint16_t> a, Pack<std::uint16_t> b)
{
  return _mm512_cmpgt_epu16_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
}
inline __mmask32 maskOfLarger(Pack<std::int16_t> a, Pack<std::int16_t> b)
{
  return _mm512_cmpgt_epi16_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
}

/// A register of notes.
inline void keepNearestNotes(
  const Noting& noting, std::int16_t* notes, __m512i offset, __mmask32 raised, __mmask32 tied)
{
  const __m512i own = _mm512_add_epi16(_mm512_set1_epi16(noting.order), offset);
  const __m512i old = _mm512_loadu_si512(notes);
  const __mmask32 nearer = noting.nearestFirst ? 0 : tied & _mm512_cmplt_epi16_mask(own, old);
  _mm512_storeu_si512(notes, _mm512_mask_mov_epi16(old, raised | nearer, own));
}

/// keepNearest() for a register of bytes or shorts: half of the instructions that compilers find,
/// which do not see that masks need no widening.
template <class T>
inline void keepNearestMasked(
  const Noting& noting, std::int16_t* notes, Pack<T> best, Pack<T> before, __m512i offset)
{
  const auto raised = maskOfLarger(best, before);
  const __m512i a = reinterpret_cast<__m512i>(best), b = reinterpret_cast<__m512i>(before);
  if constexpr (sizeof(T) == 2)
  {
    keepNearestNotes(noting, notes, offset, raised, _mm512_cmpeq_epi16_mask(a, b));
  }
  else
  {
    const __mmask64 tied = _mm512_cmpeq_epi8_mask(a, b);
    keepNearestNotes(noting, notes, _mm512_cvtepi8_epi16(_mm512_castsi512_si256(offset)),
      static_cast<__mmask32>(raised), static_cast<__mmask32>(tied));
    keepNearestNotes(noting, notes + 32, _mm512_cvtepi8_epi16(_mm512_extracti64x4_epi64(offset, 1)),
      static_cast<__mmask32>(raised >> 32), static_cast<__mmask32>(tied >> 32));
  }
}
#endif

/// Raises a register of pixels, and notes which row that is.
template <class T>
inline void raiseRegister(
  const Noting& noting, T* image, std::int16_t* notes, Pack<T> best, Pack<Integer<T>> offset)
{
  const Pack<T> before = load<T>(image);
  store<T>(image, larger(best, before));
#if defined(__AVX512F__)
  if constexpr (sizeof(T) <= 2)
  {
    keepNearestMasked<T>(noting, notes, best, before, reinterpret_cast<__m512i>(offset));
    return;
  }
#endif
  const Pack<Integer<T>> raised = best > before;
  Pack<Integer<T>> tied{};
  if (!noting.nearestFirst)
  {
    tied = best == before;
  }
#pragma GCC unroll 2
  for (std::ptrdiff_t n = 0; n < width<T> / NotesOf<T>::count; ++n)
  {
    keepNearest<T>(notes, n, NotesOf<T>::part(offset, n) + noting.order, raised, tied);
  }
}
}
}

#endif
