// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/Kernels/CellLoops.h"
#include "Kernels/Kernels.h"

#include <algorithm>

namespace splatting
{
extern const Kernels kernelsBaseline;
extern const CellKernels cellKernelsBaseline;
#if defined(SPLATTING_HAS_AVX2)
extern const Kernels kernelsAVX2;
extern const CellKernels cellKernelsAVX2;
#endif
#if defined(SPLATTING_HAS_AVX512)
extern const Kernels kernelsAVX512;
extern const CellKernels cellKernelsAVX512;
extern const Kernels kernelsAVX512VBMI;
#endif

InstructionSet bestInstructionSet()
{
  static const InstructionSet best = []
  {
#if defined(SPLATTING_HAS_AVX512)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    {
      return __builtin_cpu_supports("avx512vbmi") ? InstructionSet::AVX512VBMI
                                                  : InstructionSet::AVX512;
    }
#endif
#if defined(SPLATTING_HAS_AVX2)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    {
      return InstructionSet::AVX2;
    }
#endif
    return InstructionSet::Baseline;
  }();
  return best;
}

const Kernels& kernelsFor(InstructionSet set)
{
  switch (std::min(set, bestInstructionSet()))
  {
#if defined(SPLATTING_HAS_AVX512)
    case InstructionSet::AVX512VBMI:
      return kernelsAVX512VBMI;
    case InstructionSet::AVX512:
      return kernelsAVX512;
#endif
#if defined(SPLATTING_HAS_AVX2)
    case InstructionSet::AVX2:
      return kernelsAVX2;
#endif
    default:
      return kernelsBaseline;
  }
}

const CellKernels& cellKernelsFor(InstructionSet set)
{
  switch (std::min(set, bestInstructionSet()))
  {
#if defined(SPLATTING_HAS_AVX512)
    case InstructionSet::AVX512VBMI:
    case InstructionSet::AVX512:
      return cellKernelsAVX512;
#endif
#if defined(SPLATTING_HAS_AVX2)
    case InstructionSet::AVX2:
      return cellKernelsAVX2;
#endif
    default:
      return cellKernelsBaseline;
  }
}

const char* nameOf(InstructionSet set)
{
  switch (set)
  {
    case InstructionSet::AVX512VBMI:
      return "AVX-512 VBMI";
    case InstructionSet::AVX512:
      return "AVX-512";
    case InstructionSet::AVX2:
      return "AVX2";
    case InstructionSet::Baseline:
      break;
  }
  return "baseline";
}
}
