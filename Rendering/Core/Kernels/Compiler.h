// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Differences between compilers. In an anonymous namespace because kernels include it, see
 * Kernels.cxx.
 */
#ifndef splattingCompiler_h
#define splattingCompiler_h

#if defined(__AVX2__)
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
// GCC's intrinsics start from registers that are undefined on purpose.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// For functions in loops, where a call is expensive.
#if defined(__GNUC__)
#define SPLATTING_INLINE __attribute__((always_inline)) inline
#else
#define SPLATTING_INLINE inline
#endif

namespace splatting
{
namespace
{
/// Loads memory that will be read soon. The address need not be readable.
inline void prefetch(const void* place)
{
#if defined(__GNUC__)
  __builtin_prefetch(place);
#else
  (void)place;
#endif
}
}
}

#endif
