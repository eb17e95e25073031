// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What compilers spell differently. In an anonymous namespace because kernels include it, see
 * Kernels.cxx.
 */
#ifndef splattingCompiler_h
#define splattingCompiler_h

#if defined(__AVX2__)
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
// GCC's own intrinsics start from registers that they leave undefined on purpose.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// For functions of loops in which a call costs more than compilers expect.
#if defined(__GNUC__)
#define SPLATTING_INLINE __attribute__((always_inline)) inline
#else
#define SPLATTING_INLINE inline
#endif

namespace splatting
{
namespace
{
/// Asks memory for what will be read soon. The place need not be readable.
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
