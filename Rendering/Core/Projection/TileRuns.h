// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Tiles of a row of pixels that have a flag, as runs of pixels.
 */
#ifndef splattingTileRuns_h
#define splattingTileRuns_h

#include "Kernels/Kernels.h"

#include <algorithm>
#include <vector>

namespace splatting
{
/// Flags are read in words: room for them is a multiple of this, with zeros behind the last tile.
constexpr int FlagsPerWord = 64;

/// Room for the flags of some tiles.
inline void openFlags(int tiles, std::vector<unsigned char>& flags)
{
  flags.resize((tiles + FlagsPerWord - 1) / FlagsPerWord * FlagsPerWord);
  std::fill(flags.begin() + tiles, flags.end(), static_cast<unsigned char>(0));
}

/// @param unit  pixels whose multiples runs begin and end at, but for the row's end
/// @return how many tiles the runs have
int findTileRuns(
  const unsigned char* flags, int tiles, int unit, int width, std::vector<Span>& runs);

/// Some rows of tiles, which share what they read, sorted by what becomes of each tile. A thread's
/// work space.
class TileBlock
{
public:
  /// Rows of tiles at a time.
  static constexpr int MostGroups = 4;

  /// @param unit  tiles that had best go together
  void reset(int tiles, int unit, int width);

  /// Sorts the tiles of one of its groups: those without a flag are left out, those with one are
  /// whole or, where `shares` say so (see TileShares), to be looked at sample by sample. Units are
  /// whole if all of their tiles may be. How many are not left out.
  int sort(int group, const unsigned char* flags, const unsigned char* shares);

  /// Calls f(first, end, runs) for the whole tiles of groups [0, count): those of all groups
  /// together, then what is left of each.
  template <class F>
  void forWhole(int count, F&& f);
  /// Calls f(run) for the tiles of a group that are looked at sample by sample.
  template <class F>
  void forPartly(int group, F&& f)
  {
    this->findRuns(this->kindsOf(group), BySample);
    for (const Span& run : this->Runs)
    {
      f(run);
    }
  }

private:
  enum Kind : unsigned char
  {
    LeftOut,
    BySample,
    Whole
  };
  unsigned char* kindsOf(int group) { return &this->Kinds[std::size_t(group) * this->Tiles]; }
  void findRuns(const unsigned char* kinds, Kind kind);
  bool takeCommon(int count);

  int Tiles = 0, Unit = 1, Width = 0;
  std::vector<unsigned char> Kinds; // of all groups, and of what they have in common
  std::vector<Span> Runs;
};

template <class F>
void TileBlock::forWhole(int count, F&& f)
{
  if (count > 1 && this->takeCommon(count))
  {
    f(0, count, this->Runs);
  }
  for (int g = 0; g < count; ++g)
  {
    this->findRuns(this->kindsOf(g), Whole);
    if (!this->Runs.empty())
    {
      f(g, g + 1, this->Runs);
    }
  }
}
}

#endif
