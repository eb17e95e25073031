// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Visible samples; a sample is a pixel of the shear image and a slice.
 */
#ifndef splattingCuts_h
#define splattingCuts_h

#include "Clipping/Cropping.h"
#include "Splat/Projection/RayIntervals.h"

#include <vector>

namespace splatting
{
/// All cuts of a volume.
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

/// The cuts of one projection, in the form that walks need.
class CutMap
{
public:
  /// Sets the cuts, which must outlive their use.
  /// @param geometry  of the whole volume
  /// @param slices    the slices of the volume to use; slices.begin is slice 0 of the cuts'
  ///   intervals and of this map
  void reset(const Cuts& cuts, const ShearWarp& geometry, const Span& slices);
  bool none() const { return this->Source->none(); }
  const Cuts& source() const { return *this->Source; }
  bool crops() const { return !this->Regions.empty(); }
  const SliceRegions& regions(int k) const { return this->Regions[k]; }

  /// Sets mask[x] to whether the sample of slice k is visible at pixel pixels.begin + x of row v.
  /// Returns false if none is.
  bool findMask(int k, int v, const Span& pixels, unsigned char* mask) const;

private:
  const Cuts* Source = nullptr;
  std::vector<SliceRegions> Regions; // of all slices, if cropping cuts
};

/// Clears the mask of samples that are not present; `present` may be nullptr.
inline void narrow(unsigned char* mask, const unsigned char* present, const Span& pixels)
{
  for (int x = 0; present && x < pixels.end - pixels.begin; ++x)
  {
    mask[x] = static_cast<unsigned char>(mask[x] & present[x]);
  }
}

/// The visible share of a tile's samples.
enum TileShare : unsigned char
{
  NoSamples,
  SomeSamples,
  AllSamples
};

/// The cuts of a band of rows, tile by tile, in groups of rows. Work space of a thread.
class TileShares
{
public:
  void reset(const CutMap& map, const CutLoops& loops, int v0, int v1, int width, int height);
  /// The TileShare of the samples of some slices, for each tile of a group.
  const unsigned char* find(const Span& slices, int group);

private:
  TileExtremes extremesOf(int group);
  void crop(const Span& slices, int v0, int v1);

  const CutMap* Map = nullptr;
  const CutLoops* Loops = nullptr;
  int V0 = 0, V1 = 0, Width = 0, Height = 0, Tiles = 0;
  std::vector<std::int16_t> Extremes; // four arrays for each group
  std::vector<unsigned char> Shares, Any;
};
}

#endif
