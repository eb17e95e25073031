// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Tiles of a row of pixels that have a flag, as runs of pixels.
 */
#ifndef splattingTileRuns_h
#define splattingTileRuns_h

#include "Kernels/Kernels.h"

#include <vector>

namespace splatting
{
/// Flags are read in words: room for them is a multiple of this, with zeros behind the last tile.
constexpr int FlagsPerWord = 64;

/// @param unit  pixels whose multiples runs begin and end at, but for the row's end
/// @return how many tiles the runs have
int findTileRuns(
  const unsigned char* flags, int tiles, int unit, int width, std::vector<Span>& runs);
}

#endif
