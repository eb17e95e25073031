// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/TileRuns.h"

#include "Clipping/Cuts.h"

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
    for (int byte = 0; byte < 8; ++byte) // compilers make this one load
    {
      eight |= std::uint64_t(flags[8 * n + byte]) << (8 * byte);
    }
    // The product's highest byte has bit 0 of each byte.
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
    // Small gaps cost less than a second start.
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

void TileBlock::reset(int tiles, int unit, int width)
{
  this->Tiles = tiles;
  this->Unit = unit;
  this->Width = width;
  this->Kinds.resize(std::size_t(MostGroups + 1) * tiles);
}

int TileBlock::sort(int group, const unsigned char* flags, const unsigned char* shares)
{
  unsigned char* const kinds = this->kindsOf(group);
  int count = 0;
  for (int first = 0; first < this->Tiles; first += this->Unit)
  {
    const int end = std::min(first + this->Unit, this->Tiles);
    bool any = false, all = true;
    for (int t = first; t < end; ++t)
    {
      any = any || flags[t];
      all = all && (!shares || shares[t] == AllSamples);
    }
    for (int t = first; t < end; ++t)
    {
      const bool counts = flags[t] && (!shares || shares[t] != NoSamples);
      kinds[t] = any && all ? Whole : counts ? BySample : LeftOut;
      count += kinds[t] != LeftOut;
    }
  }
  return count;
}

void TileBlock::findRuns(const unsigned char* kinds, Kind kind)
{
  this->Runs.clear();
  const unsigned char* const last = kinds + this->Tiles;
  const auto isOther = [=](unsigned char other) { return other != kind; };
  for (const unsigned char* begin = kinds; (begin = std::find(begin, last, kind)) != last;)
  {
    const unsigned char* const end = std::find_if(begin, last, isOther);
    this->Runs.push_back({ static_cast<int>(begin - kinds) * TileWidth,
      std::min(static_cast<int>(end - kinds) * TileWidth, this->Width) });
    begin = end;
  }
}

/// Takes the runs that are whole in all groups from these. Whether there are any.
bool TileBlock::takeCommon(int count)
{
  unsigned char* const common = this->kindsOf(MostGroups);
  std::copy_n(this->kindsOf(0), this->Tiles, common);
  for (int g = 1; g < count; ++g)
  {
    std::transform(common, common + this->Tiles, this->kindsOf(g), common,
      [](unsigned char a, unsigned char b) { return std::min(a, b); });
  }
  this->findRuns(common, Whole);
  for (const Span& run : this->Runs)
  {
    for (int g = 0; g < count; ++g)
    {
      std::fill(this->kindsOf(g) + run.begin / TileWidth,
        this->kindsOf(g) + (run.end + TileWidth - 1) / TileWidth,
        static_cast<unsigned char>(LeftOut));
    }
  }
  return !this->Runs.empty();
}
}
