// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/AxisSteps.h"

#include "Common/Parallel.h"

#include <algorithm>

namespace splatting
{
namespace
{
/// The pixels from the first to the last for which f is true.
template <class F>
Span pixelsThat(int count, F&& f)
{
  int begin = 0, end = count;
  for (; begin < end && !f(begin); ++begin)
  {
  }
  for (; end > begin && !f(end - 1); --end)
  {
  }
  return { begin, end };
}
}

void AxisSteps::find(const ShearWarp& geometry, int a, const PerspectiveLoops& loops)
{
  const AxisRays& rays = a == 0 ? geometry.columns() : geometry.rows();
  const int size = geometry.size()[a];
  // Whole registers of any voxel type.
  constexpr int unit = 64;
  this->Slices = geometry.slices();
  this->Count = geometry.rayCount()[a];
  this->Size = size;
  this->Padded = (this->Count + unit - 1) / unit * unit;
  const int slices = this->Slices.end - this->Slices.begin;
  const std::size_t steps = std::size_t(slices) * this->Padded;
  this->First.resize(steps);
  this->Last.resize(steps);
  this->Time.resize(steps);
  this->Tick.resize(steps);
  this->Covers.resize(slices);
  this->Ascends.resize(slices);
  parallelFor(0, slices, 8,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (std::ptrdiff_t n = begin; n < end; ++n)
      {
        const glm::dvec2 faces =
          geometry.faces(this->Slices.begin + static_cast<int>(n)) - geometry.reference();
        const std::size_t at = n * this->Padded;
        std::int32_t* const first = &this->First[at];
        std::int32_t* const last = &this->Last[at];
        loops.steps(rays.at.data(), rays.slope.data(), faces.x, faces.y, size, first, last,
          &this->Time[at], &this->Tick[at], this->Count);
        std::fill(first + this->Count, first + this->Padded, size);
        std::fill(last + this->Count, last + this->Padded, size);
        std::fill_n(&this->Tick[at + this->Count], this->Padded - this->Count, std::int16_t(0));
        std::fill_n(&this->Time[at + this->Count], this->Padded - this->Count, 0.0);
        this->Ascends[n] =
          std::is_sorted(first, first + this->Count) && std::is_sorted(last, last + this->Count);
        const auto inside = [size](int voxel) { return voxel >= 0 && voxel < size; };
        this->Covers[n].some =
          pixelsThat(this->Count, [&](int p) { return inside(first[p]) || inside(last[p]); });
        this->Covers[n].all =
          pixelsThat(this->Count, [&](int p) { return inside(first[p]) && inside(last[p]); });
      }
    });
}

Span AxisSteps::voxels(const Span& slices, const Span& pixels) const
{
  Span all{ this->Size, 0 };
  const int p = pixels.begin, q = std::min(pixels.end, this->Count) - 1;
  for (int k = slices.begin; k < slices.end && p <= q; ++k)
  {
    const Slice slice = this->slice(k);
    // If rays meet in the eye, on a face, rounding moves some of them into the neighbouring voxel.
    const int beside = this->Ascends[k - this->Slices.begin] ? 0 : 1;
    all.begin = std::min({ all.begin, slice.first[p] - beside, slice.last[p] - beside });
    all.end = std::max({ all.end, slice.first[q] + 1 + beside, slice.last[q] + 1 + beside });
  }
  return all;
}

void AxisPicks::find(const AxisSteps& steps, int group, int bytes)
{
  this->First = steps.Slices.begin;
  this->Group = group;
  this->Groups = static_cast<int>(steps.Padded) / group;
  this->Bytes = bytes;
  const int slices = steps.Slices.end - steps.Slices.begin;
  this->Bases.resize(2 * std::size_t(slices) * this->Groups);
  this->Lanes.resize(2 * std::size_t(slices) * steps.Padded * bytes);
  parallelFor(0, 2 * slices, 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (std::ptrdiff_t row = begin; row < end; ++row)
      {
        const std::int32_t* const voxels =
          (row % 2 ? steps.Last : steps.First).data() + row / 2 * steps.Padded;
        switch (bytes)
        {
          case 1:
            this->fill<std::int8_t>(voxels, row, steps);
            break;
          case 2:
            this->fill<std::int16_t>(voxels, row, steps);
            break;
          case 4:
            this->fill<std::int32_t>(voxels, row, steps);
            break;
          default:
            this->fill<std::int64_t>(voxels, row, steps);
        }
      }
    });
}

template <class Lane>
void AxisPicks::fill(const std::int32_t* voxels, std::size_t row, const AxisSteps& steps)
{
  Lane* const lanes = reinterpret_cast<Lane*>(this->Lanes.data()) + row * steps.Padded;
  const std::int32_t size = steps.Size;
  for (int g = 0; g < this->Groups; ++g)
  {
    const std::int32_t* const own = voxels + std::ptrdiff_t(g) * this->Group;
    std::int32_t least = size;
    for (int p = 0; p < this->Group; ++p)
    {
      const std::int32_t voxel = own[p] < 0 ? size : own[p];
      least = voxel < least ? voxel : least;
    }
    // Registers of voxels must stay in their row.
    const std::int32_t base = std::max(std::min(least, size - this->Group), 0);
    this->Bases[row * this->Groups + g] = base;
    Lane* const out = lanes + std::ptrdiff_t(g) * this->Group;
    for (int p = 0; p < this->Group; ++p)
    {
      const bool outside = (own[p] < 0) | (own[p] >= size);
      out[p] = static_cast<Lane>(outside ? -1 : own[p] - base);
    }
  }
}
}
