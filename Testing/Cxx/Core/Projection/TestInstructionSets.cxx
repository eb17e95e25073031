// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That each instruction set that processor and build have is one of its own: other tests compare
// what they give, and none may be compared with itself unnoticed.
#include "CoreTesting.h"

#include "Kernels/Kernels.h"

#include <cstdint>
#include <string>

namespace
{
using splatting::InstructionSet;

constexpr InstructionSet sets[] = { InstructionSet::Baseline, InstructionSet::AVX2,
  InstructionSet::AVX512, InstructionSet::AVX512VBMI };
constexpr int bytes[] = { 16, 32, 64, 64 }; // of a register

/// Whether the processor has it, and SPLATTINGMIP_SANITIZE, which leaves out AVX-512, the build.
bool has(InstructionSet set)
{
#if defined(__x86_64__) && defined(__GNUC__)
#if defined(SPLATTINGMIP_SANITIZED)
  const bool builds512 = false;
#else
  const bool builds512 = true;
#endif
  const bool has512 = builds512 && __builtin_cpu_supports("avx512f") &&
    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
    __builtin_cpu_supports("avx512vl");
  switch (set)
  {
    case InstructionSet::AVX512VBMI:
      return has512 && __builtin_cpu_supports("avx512vbmi");
    case InstructionSet::AVX512:
      return has512;
    case InstructionSet::AVX2:
      return __builtin_cpu_supports("avx2");
    default:
      return true;
  }
#else
  return set == InstructionSet::Baseline;
#endif
}
}

int TestInstructionSets(int, char*[])
{
  reference::Checks check;
  const splatting::Kernels* last = nullptr; // the best so far that can be used
  InstructionSet best = InstructionSet::Baseline;
  for (int n = 0; n < 4; ++n)
  {
    const splatting::Kernels& kernels = splatting::kernelsFor(sets[n]);
    const std::string name = splatting::nameOf(sets[n]);
    if (!has(sets[n]))
    {
      check(&kernels == last, name, ", which cannot be used, is not the best one below");
      continue;
    }
    check(&kernels != last, name, " is not a set of its own");
    const splatting::VoxelLoops<std::uint8_t>& loops = kernels;
    check(loops.lanes == bytes[n], name, " has registers of ", loops.lanes, " bytes");
    last = &kernels;
    best = sets[n];
  }
  check(splatting::bestInstructionSet() == best, "the best instruction set is ",
    splatting::nameOf(best), ", not ", splatting::nameOf(splatting::bestInstructionSet()));
  return check.exitCode();
}
