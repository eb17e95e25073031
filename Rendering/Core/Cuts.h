// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which samples count, a sample being a pixel of the shear image and a slice.
 */
#ifndef splattingCuts_h
#define splattingCuts_h

#include "Cropping.h"
#include "RayIntervals.h"

#include <vector>

namespace splatting
{
/// All that leaves samples out.
struct Cuts
{
  RayIntervals intervals;
  Cropping cropping;

  bool none() const { return this->intervals.empty() && !this->cropping.cuts(); }
  bool operator==(const Cuts& other) const
  {
    return this->intervals == other.intervals && this->cropping == other.cropping;
  }
};

/// The cuts of one projection, as its walks ask for them.
class CutMap
{
public:
  /// The cuts must outlive their use.
  void reset(const Cuts& cuts, const ShearWarp& geometry);
  bool none() const { return this->Source->none(); }
  const Cuts& source() const { return *this->Source; }

  /// mask[x] = whether the sample of slice k counts for pixel pixels.begin + x of row v. False if
  /// there is none.
  bool findMask(int k, int v, const Span& pixels, unsigned char* mask) const;

private:
  friend class BandCuts;
  const Cuts* Source = nullptr;
  std::vector<SliceRegions> Regions; // of all slices, if cropping cuts
};

/// How much of a tile and some slices counts.
enum class CutShare : unsigned char
{
  None,
  Some,
  All
};

/// The same for the tiles of a band of rows: groups of TileHeight rows, TileWidth pixels each.
class BandCuts
{
public:
  void reset(const CutMap& map, int v0, int v1, int width);
  /// The shares of all tiles of a group.
  void findShares(const Span& slices, int group, CutShare* shares) const;

private:
  /// The least and greatest first and last slices of a tile's pixels.
  struct Extremes
  {
    std::int16_t leastFirst, greatestFirst, leastLast, greatestLast;
  };
  void cropShares(const Span& slices, int group, CutShare* shares) const;

  const CutMap* Map = nullptr;
  int V0 = 0, V1 = 0, Width = 0, Tiles = 0;
  std::vector<Extremes> Intervals;
};
}

#endif
