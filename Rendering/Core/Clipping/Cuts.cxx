// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Clipping/Cuts.h"

#include <cstring>

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

bool SliceRuns::find(
  const CutMap& map, const Span& slices, int v0, int v1, const std::vector<Span>& spans)
{
  this->V0 = v0;
  this->Slices = slices;
  if (slices.empty())
  {
    return true;
  }
  this->Runs.resize(std::size_t(v1 - v0) * this->stride());
  const RayIntervals& intervals = map.source().intervals;
  Span* runs = this->Runs.data();
  for (int v = v0; v < v1; ++v, runs += this->stride())
  {
    std::fill_n(runs, this->stride(), intervals.empty() ? Span{ -Far, Far } : Nothing);
    if (!(intervals.empty() || this->cutByIntervals(intervals, v, spans[v], runs)) ||
      !(map.crops() ? this->crop(map, v, runs) : true))
    {
      return false;
    }
  }
  return true;
}

SliceRuns::Hull SliceRuns::hull(const Span& slices, int v0, int v1) const
{
  Hull hull;
  for (int v = v0; v < v1; ++v)
  {
    for (int k = slices.begin; k < slices.end; ++k)
    {
      const Span& run = this->at(k, v);
      hull.any = { std::min(hull.any.begin, run.begin), std::max(hull.any.end, run.end) };
      hull.all = common(hull.all, run);
    }
  }
  return hull;
}

/// Opens and ends empty runs where slices begin and cease to count from one pixel to the next.
bool SliceRuns::cutByIntervals(
  const RayIntervals& intervals, int v, const Span& pixels, Span* runs) const
{
  const std::int16_t* const first = intervals.first(v);
  const std::int16_t* const last = intervals.last(v);
  const Span all = this->Slices;
  Span* const slice = runs - all.begin;
  bool once = true;
  // How many pixels after u are surely like it: most rays are not cut, or lose all.
  const auto pixelsLike = [=](int u, int end)
  {
    constexpr int some = 8;
    constexpr std::size_t size = some * sizeof(std::int16_t);
    int count = 0;
    while (u + count + some < end &&
      std::memcmp(first + u + count, first + u + count + 1, size) == 0 &&
      std::memcmp(last + u + count, last + u + count + 1, size) == 0)
    {
      count += some;
    }
    return count;
  };
  const auto begin = [&](int from, int to, int u)
  {
    for (int k = from; k < to; ++k)
    {
      once = once && slice[k].empty();
      slice[k] = { u > pixels.begin ? u : -Far, Far };
    }
  };
  const auto end = [&](int from, int to, int u)
  {
    for (int k = from; k < to; ++k)
    {
      slice[k].end = u;
    }
  };
  Span open{ all.begin, all.begin };
  for (int u = pixels.begin; u < pixels.end && once; ++u)
  {
    Span now = common(all, { first[u], last[u] + 1 });
    now = now.empty() ? Span{ open.end, open.end } : now;
    if (now.begin == open.begin && now.end == open.end)
    {
      u += pixelsLike(u, pixels.end);
      continue;
    }
    end(open.begin, std::min(open.end, now.begin), u);
    end(std::max(open.begin, now.end), open.end, u);
    begin(now.begin, std::min(now.end, open.begin), u);
    begin(std::max(now.begin, open.end), now.end, u);
    open = now;
  }
  return once;
}

bool SliceRuns::crop(const CutMap& map, int v, Span* runs) const
{
  for (int k = this->Slices.begin; k < this->Slices.end; ++k, ++runs)
  {
    const SliceRegions& regions = map.regions(k);
    const unsigned shown = regions.regionsOfRow(v);
    if (shown == 5u) // the outer two
    {
      return false;
    }
    const int least = shown & 1u ? 0
      : shown & 2u               ? 1
                                 : 2,
              most = shown & 4u ? 2
      : shown & 2u              ? 1
                                : 0;
    const Span region{ regions.pixels(least).begin, regions.pixels(most).end };
    *runs = common(*runs, region);
    *runs = shown == 0 || runs->empty() ? Nothing : *runs;
  }
  return true;
}

void BandCuts::reset(const CutMap& map, const CutLoops& loops, int v0, int v1, int width)
{
  this->Map = &map;
  this->Loops = &loops;
  this->V0 = v0;
  this->V1 = v1;
  this->Width = width;
  this->Tiles = (width + TileWidth - 1) / TileWidth;
  this->Stride = std::ptrdiff_t(this->Tiles) * TileWidth;
  this->Shares.resize(this->Tiles);
  this->Any.resize(this->Tiles);
  this->Bits.resize(this->Stride * (v1 - v0));
  const RayIntervals& intervals = map.source().intervals;
  const int groups = (v1 - v0 + TileHeight - 1) / TileHeight;
  this->Extremes.resize(intervals.empty() ? 0 : std::size_t(groups) * 4 * this->Tiles);
  for (int g = 0; g < groups && !intervals.empty(); ++g)
  {
    const int v = v0 + g * TileHeight;
    loops.tileExtremes(intervals.first(v), intervals.last(v), width, std::min(TileHeight, v1 - v),
      width, this->extremesOf(g));
  }
}

TileExtremes BandCuts::extremesOf(int group)
{
  std::int16_t* const first = &this->Extremes[std::size_t(group) * 4 * this->Tiles];
  return { first, first + this->Tiles, first + 2 * this->Tiles, first + 3 * this->Tiles };
}

SliceBits BandCuts::findBits(const Span& slices, int group, unsigned char* flags)
{
  this->findShares(slices, group);
  unsigned char* const shares = this->Shares.data();
  unsigned char least = All, greatest = None;
  for (int t = 0; t < this->Tiles; ++t)
  {
    const unsigned char wanted = static_cast<unsigned char>(-flags[t]); // all bits or none
    const unsigned char share = shares[t] & wanted;
    shares[t] = share;
    flags[t] = std::min<unsigned char>(share, 1);
    least = std::min(least, share);
    greatest = std::max(greatest, share);
  }
  if (least == All || greatest == None)
  {
    return {};
  }
  const int v0 = this->V0 + group * TileHeight, v1 = std::min(v0 + TileHeight, this->V1);
  unsigned char* const rows = this->Bits.data() + (v0 - this->V0) * this->Stride;
  for (int t = 0; t < this->Tiles; ++t)
  {
    const std::uint64_t bits = this->Shares[t] == None ? 0 : ~std::uint64_t(0);
    static_assert(sizeof(bits) == TileWidth);
    std::memcpy(rows + t * TileWidth, &bits, sizeof(bits));
  }
  for (int v = v0 + 1; v < v1; ++v)
  {
    std::memcpy(rows + (v - v0) * this->Stride, rows, this->Stride);
  }
  const unsigned char* const last = shares + this->Tiles;
  for (const unsigned char* begin = shares; (begin = std::find(begin, last, Some)) != last;)
  {
    const unsigned char* const end =
      std::find_if(begin, last, [](unsigned char share) { return share != Some; });
    const Span pixels{ static_cast<int>(begin - shares) * TileWidth,
      std::min(static_cast<int>(end - shares) * TileWidth, this->Width) };
    for (int v = v0; v < v1; ++v)
    {
      this->findSome(slices, v, pixels, rows + (v - v0) * this->Stride + pixels.begin);
    }
    begin = end;
  }
  return { this->Bits.data() - this->V0 * this->Stride, this->Stride };
}

Span BandCuts::wholeRun() const
{
  Span longest, run;
  for (int t = 0; t < this->Tiles; ++t)
  {
    run = { this->Shares[t] == All ? run.begin : t + 1, t + 1 };
    longest = run.end - run.begin > longest.end - longest.begin ? run : longest;
  }
  return { longest.begin * TileWidth, std::min(longest.end * TileWidth, this->Width) };
}

void BandCuts::findSome(const Span& slices, int v, const Span& pixels, unsigned char* bits) const
{
  const RayIntervals& intervals = this->Map->source().intervals;
  const std::ptrdiff_t n = pixels.end - pixels.begin;
  if (intervals.empty())
  {
    std::fill_n(bits, n, static_cast<unsigned char>(0xff));
  }
  else
  {
    this->Loops->sliceBits(intervals.first(v) + pixels.begin, intervals.last(v) + pixels.begin,
      slices.begin, slices.end - slices.begin, bits, n);
  }
  for (int k = slices.begin; k < slices.end && this->Map->crops(); ++k)
  {
    const SliceRegions& regions = this->Map->regions(k);
    const unsigned shown = regions.regionsOfRow(v);
    for (int i = 0; i < 3; ++i)
    {
      if (!(shown >> i & 1u))
      {
        const Span region = common(regions.pixels(i), pixels);
        for (int u = region.begin; u < region.end; ++u)
        {
          bits[u - pixels.begin] &= static_cast<unsigned char>(~(1u << (k - slices.begin)));
        }
      }
    }
  }
}

void BandCuts::findShares(const Span& slices, int group)
{
  if (this->Extremes.empty())
  {
    std::fill(this->Shares.begin(), this->Shares.end(), static_cast<unsigned char>(All));
  }
  else
  {
    this->Loops->tileShares(
      this->extremesOf(group), slices.begin, slices.end, this->Shares.data(), this->Tiles);
  }
  if (this->Map->crops())
  {
    const int v0 = this->V0 + group * TileHeight;
    this->cropShares(slices, v0, std::min(v0 + TileHeight, this->V1));
  }
}

void BandCuts::cropShares(const Span& slices, int v0, int v1)
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
        this->Shares[t] = std::min<unsigned char>(this->Shares[t], Some);
      }
    }
  }
  for (int t = 0; t < this->Tiles; ++t)
  {
    this->Shares[t] = this->Any[t] ? this->Shares[t] : static_cast<unsigned char>(None);
  }
}
}
