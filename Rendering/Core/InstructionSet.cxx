// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernels.h"

namespace splatting
{
extern const Kernels kernelsBaseline;
#if defined(SPLATTING_HAS_AVX)
extern const Kernels kernelsAVX2;
extern const Kernels kernelsAVX512;
extern const Kernels kernelsAVX512VBMI;
#endif

InstructionSet bestInstructionSet()
{
#if defined(SPLATTING_HAS_AVX)
  static const InstructionSet best = []
  {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    {
      return __builtin_cpu_supports("avx512vbmi") ? InstructionSet::AVX512VBMI
                                                  : InstructionSet::AVX512;
    }
    return __builtin_cpu_supports("avx2") ? InstructionSet::AVX2 : InstructionSet::Baseline;
  }();
  return best;
#else
  return InstructionSet::Baseline;
#endif
}

const Kernels& kernelsFor(InstructionSet set)
{
#if defined(SPLATTING_HAS_AVX)
  if (set > bestInstructionSet())
  {
    set = bestInstructionSet();
  }
  switch (set)
  {
    case InstructionSet::AVX512VBMI:
      return kernelsAVX512VBMI;
    case InstructionSet::AVX512:
      return kernelsAVX512;
    case InstructionSet::AVX2:
      return kernelsAVX2;
    case InstructionSet::Baseline:
      break;
  }
#else
  (void)set;
#endif
  return kernelsBaseline;
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
