// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Runs of pixels from the flags of tiles.
 */
#ifndef splattingTileRuns_h
#define splattingTileRuns_h

#include "Kernels/Kernels.h"

#include <algorithm>
#include <vector>

namespace splatting
{
/// Flags are read in words: their number is a multiple of this, with zeros after the last tile.
constexpr int FlagsPerWord = 64;

/// Allocates the flags of some tiles.
inline void openFlags(int tiles, std::vector<unsigned char>& flags)
{
  flags.resize((tiles + FlagsPerWord - 1) / FlagsPerWord * FlagsPerWord);
  std::fill(flags.begin() + tiles, flags.end(), static_cast<unsigned char>(0));
}

/// @param unit  runs begin and end at multiples of so many pixels, except at the row's end
/// @return the number of tiles in the runs
int findTileRuns(
  const unsigned char* flags, int tiles, int unit, int width, std::vector<Span>& runs);

/// Calls f(run) for the runs of tiles of one kind in a row of pixels.
template <class F>
void forRunsOf(unsigned char kind, const unsigned char* kinds, int tiles, int width, F&& f)
{
  const unsigned char* const last = kinds + tiles;
  const auto isOther = [=](unsigned char other) { return other != kind; };
  for (const unsigned char* begin = kinds; (begin = std::find(begin, last, kind)) != last;)
  {
    const unsigned char* const end = std::find_if(begin, last, isOther);
    f(Span{ static_cast<int>(begin - kinds) * TileWidth,
      std::min(static_cast<int>(end - kinds) * TileWidth, width) });
    begin = end;
  }
}
}

#endif
