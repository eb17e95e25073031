// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Walks/Cuts.h"

#include <algorithm>

namespace splatting
{
void CutMap::reset(const Cuts& cuts, const ShearWarp& geometry, const Span& slices)
{
  this->Source = &cuts;
  this->Regions.clear();
  for (int k = slices.begin; cuts.cropping.cuts() && k < slices.end; ++k)
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

void TileShares::reset(
  const CutMap& map, const CutLoops& loops, int v0, int v1, int width, int height)
{
  this->Map = &map;
  this->Loops = &loops;
  this->V0 = v0;
  this->V1 = v1;
  this->Width = width;
  this->Height = height;
  this->Tiles = (width + TileWidth - 1) / TileWidth;
  this->Shares.resize(this->Tiles);
  this->Any.resize(this->Tiles);
  const RayIntervals& intervals = map.source().intervals;
  const int groups = (v1 - v0 + height - 1) / height;
  this->Extremes.resize(intervals.empty() ? 0 : std::size_t(groups) * 4 * this->Tiles);
  for (int g = 0; g < groups && !intervals.empty(); ++g)
  {
    const int v = v0 + g * height;
    loops.tileExtremes(intervals.first(v), intervals.last(v), width, std::min(height, v1 - v),
      width, this->extremesOf(g));
  }
}

TileExtremes TileShares::extremesOf(int group)
{
  std::int16_t* const first = &this->Extremes[std::size_t(group) * 4 * this->Tiles];
  return { first, first + this->Tiles, first + 2 * this->Tiles, first + 3 * this->Tiles };
}

const unsigned char* TileShares::find(const Span& slices, int group)
{
  if (this->Extremes.empty())
  {
    std::fill(this->Shares.begin(), this->Shares.end(), static_cast<unsigned char>(AllSamples));
  }
  else
  {
    this->Loops->tileShares(
      this->extremesOf(group), slices.begin, slices.end, this->Shares.data(), this->Tiles);
  }
  if (this->Map->crops())
  {
    const int v0 = this->V0 + group * this->Height;
    this->crop(slices, v0, std::min(v0 + this->Height, this->V1));
  }
  return this->Shares.data();
}

void TileShares::crop(const Span& slices, int v0, int v1)
{
  std::fill(this->Any.begin(), this->Any.end(), static_cast<unsigned char>(0));
  for (int k = slices.begin; k < slices.end; ++k)
  {
    const SliceRegions& regions = this->Map->regions(k);
    unsigned any = 0, all = 7;
    for (int v = v0; v < v1; ++v)
    {
      any |= regions.regionsOfRow(v);
      all &= regions.regionsOfRow(v);
    }
    for (int i = 0; i < 3; ++i)
    {
      const Span pixels = common(regions.pixels(i), { 0, this->Width });
      if (pixels.empty())
      {
        continue;
      }
      const int begin = pixels.begin / TileWidth, end = (pixels.end - 1) / TileWidth + 1;
      if (any >> i & 1u)
      {
        std::fill(
          this->Any.begin() + begin, this->Any.begin() + end, static_cast<unsigned char>(1));
      }
      for (int t = begin; t < end && !(all >> i & 1u); ++t)
      {
        this->Shares[t] = std::min<unsigned char>(this->Shares[t], SomeSamples);
      }
    }
  }
  for (int t = 0; t < this->Tiles; ++t)
  {
    this->Shares[t] = this->Any[t] ? this->Shares[t] : static_cast<unsigned char>(NoSamples);
  }
}
}
