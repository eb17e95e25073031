// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which samples count, a sample being a pixel of the shear image and a slice.
 */
#ifndef splattingCuts_h
#define splattingCuts_h

#include "Clipping/Cropping.h"
#include "Clipping/RayIntervals.h"

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
  /// @param geometry  of the whole volume
  /// @param slices    of it, the first of which is slice 0 of the cuts' intervals and of the map
  void reset(const Cuts& cuts, const ShearWarp& geometry, const Span& slices);
  bool none() const { return this->Source->none(); }
  const Cuts& source() const { return *this->Source; }
  bool crops() const { return !this->Regions.empty(); }
  const SliceRegions& regions(int k) const { return this->Regions[k]; }

  /// mask[x] = whether the sample of slice k counts for pixel pixels.begin + x of row v. False if
  /// there is none.
  bool findMask(int k, int v, const Span& pixels, unsigned char* mask) const;

private:
  const Cuts* Source = nullptr;
  std::vector<SliceRegions> Regions; // of all slices, if cropping cuts
};

/// Leaves out of a mask what is not present, if that is known.
inline void narrow(unsigned char* mask, const unsigned char* present, const Span& pixels)
{
  for (int x = 0; present && x < pixels.end - pixels.begin; ++x)
  {
    mask[x] = static_cast<unsigned char>(mask[x] & present[x]);
  }
}

/// How much of a tile's samples counts.
enum TileShare : unsigned char
{
  NoSamples,
  SomeSamples,
  AllSamples
};

/// The cuts of a band of rows, tile by tile, in groups of some rows. A thread's work space.
class TileShares
{
public:
  void reset(const CutMap& map, const CutLoops& loops, int v0, int v1, int width, int height);
  /// For each tile of a group a TileShare of its samples in some slices.
  const unsigned char* find(const Span& slices, int group);

private:
  TileExtremes extremesOf(int group);
  void crop(const Span& slices, int v0, int v1);

  const CutMap* Map = nullptr;
  const CutLoops* Loops = nullptr;
  int V0 = 0, V1 = 0, Width = 0, Height = 0, Tiles = 0;
  std::vector<std::int16_t> Extremes; // four arrays of them for each group
  std::vector<unsigned char> Shares, Any;
};
}

#endif
