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

/// For each pixel of some rows, which of a few slices count: bit s of a byte is the s-th slice.
struct SliceBits
{
  const unsigned char* origin = nullptr; ///< of pixel (0, 0), which need not exist
  std::ptrdiff_t stride = 0;

  const unsigned char* at(int u, int v) const { return this->origin + v * this->stride + u; }
};

/// For each row of a band and each slice the run of pixels for which the slice counts, where that
/// is one run, as with planes and boxes. A thread's work space.
class SliceRuns
{
  static constexpr int Far = 1 << 29;
  static constexpr Span Nothing{ Far, -Far };

public:
  /// False if a slice counts for two runs of a row.
  /// @param spans  the pixels of each row of the image that matter
  bool find(const CutMap& map, const Span& slices, int v0, int v1, const std::vector<Span>& spans);

  /// Those that reach the ends of what matters go on beyond, empty ones begin behind the others and
  /// end before them.
  const Span& at(int k, int v) const
  {
    return this->Runs[std::ptrdiff_t(v - this->V0) * this->stride() + k - this->Slices.begin];
  }
  /// From one row to the next.
  std::ptrdiff_t stride() const { return this->Slices.end - this->Slices.begin; }

  /// The pixels of some rows for which any of some slices counts, and those for which all do in all
  /// rows.
  struct Hull
  {
    Span any = Nothing, all{ -Far, Far };
  };
  Hull hull(const Span& slices, int v0, int v1) const;

private:
  bool cutByIntervals(const RayIntervals& intervals, int v, const Span& pixels, Span* runs) const;
  bool crop(const CutMap& map, int v, Span* runs) const;

  int V0 = 0;
  Span Slices;
  std::vector<Span> Runs;
};

/// Some rows of pixels, the runs of pixels in them, and, if not all samples count, their bits and
/// the longest run of pixels of which all do.
struct RowRuns
{
  int v0 = 0, v1 = 0;
  std::vector<Span> runs;
  SliceBits bits;
  Span whole;
};

/// The cuts of a band of rows, tile by tile, in groups of TileHeight rows. A thread's work space.
class BandCuts
{
public:
  void reset(const CutMap& map, const CutLoops& loops, int v0, int v1, int width);

  /**
   * Finds the bits of a group's rows for the slices of a layer. Tiles without a flag, and those of
   * which nothing counts, which lose theirs, get no bits. If everything counts there are none.
   */
  SliceBits findBits(const Span& slices, int group, unsigned char* flags);
  /// The longest run of pixels of tiles of which everything counts, where bits were found last.
  Span wholeRun() const;

private:
  /// How much of a tile's samples counts.
  enum Share : unsigned char
  {
    None,
    Some,
    All
  };
  TileExtremes extremesOf(int group);
  void findShares(const Span& slices, int group);
  void cropShares(const Span& slices, int v0, int v1);
  void findSome(const Span& slices, int v, const Span& pixels, unsigned char* bits) const;

  const CutMap* Map = nullptr;
  const CutLoops* Loops = nullptr;
  int V0 = 0, V1 = 0, Width = 0, Tiles = 0;
  std::ptrdiff_t Stride = 0;
  std::vector<std::int16_t> Extremes; // four arrays of them for each group
  std::vector<unsigned char> Shares, Any, Bits;
};
}

#endif
