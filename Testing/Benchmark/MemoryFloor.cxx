// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MemoryFloor.h"

#include "vtkSMPTools.h"
#include "vtkType.h"

#include <algorithm>
#include <atomic>

#if defined(__x86_64__) && defined(__GNUC__)
#define HAS_AVX2_LOOP
#endif

namespace
{
#ifdef HAS_AVX2_LOOP
__attribute__((always_inline)) // or the loop would not take its caller's instruction set
#endif
inline unsigned char
Search(const unsigned char* bytes, std::size_t count)
{
  unsigned char largest = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    largest = std::max(largest, bytes[i]);
  }
  return largest;
}

#ifdef HAS_AVX2_LOOP
// The caches, where small volumes stay, outrun plain x86-64 and its 16 bytes per instruction.
__attribute__((target("avx2"))) unsigned char SearchAVX2(
  const unsigned char* bytes, std::size_t count)
{
  return Search(bytes, count);
}
#endif

unsigned char SearchBlock(const unsigned char* bytes, std::size_t count)
{
#ifdef HAS_AVX2_LOOP
  if (__builtin_cpu_supports("avx2"))
  {
    return SearchAVX2(bytes, count);
  }
#endif
  return Search(bytes, count);
}
}

//------------------------------------------------------------------------------
unsigned char LargestByte(const unsigned char* bytes, std::size_t count)
{
  constexpr std::size_t block = std::size_t(1) << 18;
  std::atomic<unsigned char> largest{ 0 };
  const auto search = [&](vtkIdType first, vtkIdType last)
  {
    const std::size_t begin = static_cast<std::size_t>(first) * block;
    const std::size_t end = std::min(count, static_cast<std::size_t>(last) * block);
    const unsigned char found = SearchBlock(bytes + begin, end - begin);
    unsigned char known = largest;
    while (found > known && !largest.compare_exchange_weak(known, found))
    {
    }
  };
  vtkSMPTools::For(0, static_cast<vtkIdType>((count + block - 1) / block), search);
  return largest;
}
