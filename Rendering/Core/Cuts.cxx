// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cuts.h"

namespace splatting
{
namespace
{
/// The regions along u that pixels [begin, end) meet, as bits.
unsigned regionsMet(const SliceRegions& regions, int begin, int end)
{
  return (begin < regions.u[0] ? 1u : 0u) |
    (begin < regions.u[1] && end > regions.u[0] && regions.u[0] < regions.u[1] ? 2u : 0u) |
    (end > regions.u[1] ? 4u : 0u);
}
}

void CutMap::reset(const Cuts& cuts, const ShearWarp& geometry)
{
  this->Source = &cuts;
  this->Regions.clear();
  for (int k = 0; cuts.cropping.cuts() && k < geometry.size().z; ++k)
  {
    this->Regions.push_back(regionsOf(cuts.cropping, geometry, k));
  }
}

bool CutMap::findMask(int k, int v, const Span& pixels, unsigned char* mask) const
{
  const int count = pixels.end - pixels.begin;
  unsigned any = 0;
  if (this->Source->intervals.empty())
  {
    std::fill_n(mask, std::max(count, 0), static_cast<unsigned char>(1));
    any = count > 0;
  }
  else
  {
    const std::int16_t* const first = this->Source->intervals.first(v) + pixels.begin;
    const std::int16_t* const last = this->Source->intervals.last(v) + pixels.begin;
    const std::int16_t slice = static_cast<std::int16_t>(k);
    for (int x = 0; x < count; ++x)
    {
      mask[x] = static_cast<unsigned char>((first[x] <= slice) & (slice <= last[x]));
      any |= mask[x];
    }
  }
  if (this->Regions.empty())
  {
    return any != 0;
  }
  const SliceRegions& regions = this->Regions[k];
  const unsigned shown = regions.regionsOfRow(v);
  const int ends[4] = { pixels.begin, std::clamp(regions.u[0], pixels.begin, pixels.end),
    std::clamp(regions.u[1], pixels.begin, pixels.end), pixels.end };
  for (int i = 0; i < 3; ++i)
  {
    if (!(shown >> i & 1u))
    {
      std::fill(mask + (ends[i] - pixels.begin), mask + (ends[i + 1] - pixels.begin),
        static_cast<unsigned char>(0));
    }
  }
  return any != 0 && shown != 0;
}

void BandCuts::reset(const CutMap& map, int v0, int v1, int width)
{
  this->Map = &map;
  this->V0 = v0;
  this->V1 = v1;
  this->Width = width;
  this->Tiles = (width + TileWidth - 1) / TileWidth;
  this->Intervals.clear();
  const RayIntervals& intervals = map.Source->intervals;
  if (intervals.empty())
  {
    return;
  }
  const int groups = (v1 - v0 + TileHeight - 1) / TileHeight;
  constexpr std::int16_t low = std::numeric_limits<std::int16_t>::lowest();
  constexpr std::int16_t high = std::numeric_limits<std::int16_t>::max();
  this->Intervals.assign(std::size_t(groups) * this->Tiles, Extremes{ high, low, high, low });
  for (int v = v0; v < v1; ++v)
  {
    const std::int16_t* const first = intervals.first(v);
    const std::int16_t* const last = intervals.last(v);
    Extremes* const row = &this->Intervals[std::size_t((v - v0) / TileHeight) * this->Tiles];
    for (int u = 0; u < width; ++u)
    {
      Extremes& tile = row[u / TileWidth];
      tile.leastFirst = std::min(tile.leastFirst, first[u]);
      tile.greatestFirst = std::max(tile.greatestFirst, first[u]);
      tile.leastLast = std::min(tile.leastLast, last[u]);
      tile.greatestLast = std::max(tile.greatestLast, last[u]);
    }
  }
}

void BandCuts::findShares(const Span& slices, int group, CutShare* shares) const
{
  if (this->Intervals.empty())
  {
    std::fill_n(shares, this->Tiles, CutShare::All);
  }
  else
  {
    const Extremes* const tiles = &this->Intervals[std::size_t(group) * this->Tiles];
    for (int t = 0; t < this->Tiles; ++t)
    {
      const Extremes& e = tiles[t];
      shares[t] = slices.end <= e.leastFirst || slices.begin > e.greatestLast ? CutShare::None
        : slices.begin >= e.greatestFirst && slices.end - 1 <= e.leastLast    ? CutShare::All
                                                                              : CutShare::Some;
    }
  }
  if (!this->Map->Regions.empty())
  {
    this->cropShares(slices, group, shares);
  }
}

void BandCuts::cropShares(const Span& slices, int group, CutShare* shares) const
{
  const int v0 = this->V0 + group * TileHeight, v1 = std::min(v0 + TileHeight, this->V1);
  for (int t = 0; t < this->Tiles; ++t)
  {
    const int u0 = t * TileWidth, u1 = std::min(u0 + TileWidth, this->Width);
    bool any = false, all = true;
    for (int k = slices.begin; k < slices.end; ++k)
    {
      const SliceRegions& regions = this->Map->Regions[k];
      const unsigned met = regionsMet(regions, u0, u1);
      for (int v = v0; v < v1; ++v)
      {
        const unsigned shown = regions.regionsOfRow(v) & met;
        any = any || shown != 0;
        all = all && shown == met;
      }
    }
    shares[t] = !any ? CutShare::None : all ? shares[t] : std::min(shares[t], CutShare::Some);
  }
}
}
