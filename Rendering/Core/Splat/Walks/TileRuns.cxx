// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Walks/TileRuns.h"

#include <algorithm>
#include <cstdint>

namespace splatting
{
namespace
{
/// Bit n is byte n, which is 0 or 1.
std::uint64_t packed(const unsigned char* flags)
{
  std::uint64_t bits = 0;
  for (int n = 0; n < 8; ++n)
  {
    std::uint64_t eight = 0;
    for (int byte = 0; byte < 8; ++byte) // compiled to one load
    {
      eight |= std::uint64_t(flags[8 * n + byte]) << (8 * byte);
    }
    // Bit n of the product's highest byte is byte n.
    bits |= (eight * 0x0102040810204080u) >> 56 << (8 * n);
  }
  return bits;
}

int trailingZeros(std::uint64_t word)
{
#if defined(__GNUC__)
  return __builtin_ctzll(word);
#else
  int n = 0;
  for (; !(word & 1); word >>= 1)
  {
    ++n;
  }
  return n;
#endif
}
}

int findTileRuns(
  const unsigned char* flags, int tiles, int unit, int width, std::vector<Span>& runs)
{
  int count = 0;
  runs.clear();
  for (int first = 0; first < tiles; first += FlagsPerWord)
  {
    std::uint64_t word = packed(flags + first);
    // Small gaps cost less than another run.
    word |= ((word << 1) & (word >> 1)) | ((word << 1) & (word >> 2)) | ((word << 2) & (word >> 1));
    while (word)
    {
      const int begin = trailingZeros(word);
      const std::uint64_t rest = ~(word >> begin);
      const int length = rest ? trailingZeros(rest) : FlagsPerWord;
      word = begin + length < FlagsPerWord ? word >> (begin + length) << (begin + length) : 0;
      count += length;
      const int u = (first + begin) * TileWidth;
      runs.push_back(
        { u / unit * unit, std::min((u + length * TileWidth + unit - 1) / unit * unit, width) });
    }
  }
  return count;
}
}
