// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellIndex.h"

#include "Common/Parallel.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <type_traits>

namespace splatting
{
CellGrid::CellGrid(const VoxelArray& piece, const glm::ivec3& firstVoxel,
  const glm::ivec3& wholeSize, bool showsBoxes)
  : voxels(piece),
    first(firstVoxel),
    whole(wholeSize)
{
  for (int a = 0; a < 3; ++a)
  {
    const int size = wholeSize[a];
    const bool extended = showsBoxes || size == 1;
    this->shift[a] = extended;
    this->low[a] = extended ? -0.5 : 0.0;
    this->high[a] = size - (extended ? 0.5 : 1.0);
    const int last = firstVoxel[a] + piece.dimensions[a] - 1;
    // Beyond the whole's ends the outermost voxels are repeated.
    this->begin[a] = firstVoxel[a] == 0 ? 0 : firstVoxel[a] + this->shift[a];
    this->end[a] = last + this->shift[a] + (extended && last == size - 1);
    this->firstBrick[a] = this->begin[a] / BrickCells;
    this->bricks[a] = (this->end[a] + BrickCells - 1) / BrickCells - this->firstBrick[a];
  }
  if (glm::any(glm::lessThan(piece.dimensions, glm::ivec3(1))) ||
    glm::any(glm::lessThanEqual(this->end, this->begin)))
  {
    this->end = this->begin;
    this->bricks = glm::ivec3(0);
  }
}

glm::ivec3 CellGrid::brickCell(std::uint32_t brick) const
{
  const int x = static_cast<int>(brick % this->bricks.x);
  const int y = static_cast<int>(brick / this->bricks.x % this->bricks.y);
  const int z = static_cast<int>(brick / this->bricks.x / this->bricks.y);
  return BrickCells * (this->firstBrick + glm::ivec3(x, y, z));
}

glm::ivec2 CellGrid::voxelsOf(int axis, int from, int to) const
{
  const int origin = this->shift[axis] + this->first[axis];
  const int last = this->voxels.dimensions[axis] - 1;
  return { std::clamp(from - origin, 0, last), std::clamp(to - origin, 0, last) };
}

namespace
{
template <class T>
bool isNaN(T value)
{
  return value != value;
}

/// Keeps the larger (of minima the smaller) of the two that is a number.
template <class T, bool Minima>
inline void keep(T& best, T value)
{
  const bool better = Minima ? value < best : value > best;
  if constexpr (std::numeric_limits<T>::is_integer)
  {
    best = better ? value : best;
  }
  else
  {
    best = better || best != best ? value : best;
  }
}

/// The bounds of one brick's blocks, row of bricks by row of bricks.
template <class T, bool Minima>
class Survey
{
public:
  Survey(const CellGrid& grid, T* blocks) : Grid(grid), Blocks(blocks) {}

  void survey(int brickZ)
  {
    for (int y = 0; y < this->Grid.bricks.y; ++y)
    {
      for (int half = 0; half < 4; ++half)
      {
        this->surveyBlocks(y, brickZ, half & 1, half >> 1);
      }
    }
  }

private:
  /// The voxels that an axis' block covers; first > last if it has no cells.
  glm::ivec2 voxelsOf(int axis, int brick, int half) const
  {
    const int cell = BrickCells * (this->Grid.firstBrick[axis] + brick) + BlockCells * half;
    const int from = std::max(cell, this->Grid.begin[axis]);
    const int to = std::min(cell + BlockCells, this->Grid.end[axis]);
    return from < to ? this->Grid.voxelsOf(axis, from, to) : glm::ivec2(0, -1);
  }

  void surveyBlocks(int brickY, int brickZ, int halfY, int halfZ)
  {
    const glm::ivec3& size = this->Grid.voxels.dimensions;
    const glm::ivec2 rows = this->voxelsOf(1, brickY, halfY);
    const glm::ivec2 slices = this->voxelsOf(2, brickZ, halfZ);
    if (rows.x > rows.y || slices.x > slices.y)
    {
      return;
    }
    const T* const voxels = static_cast<const T*>(this->Grid.voxels.voxels);
    this->Best.clear();
    for (int z = slices.x; z <= slices.y; ++z)
    {
      for (int y = rows.x; y <= rows.y; ++y)
      {
        const T* const row = voxels + (std::ptrdiff_t(z) * size.y + y) * size.x;
        if (this->Best.empty())
        {
          this->Best.assign(row, row + size.x);
          continue;
        }
        T* const best = this->Best.data();
        for (int x = 0; x < size.x; ++x)
        {
          keep<T, Minima>(best[x], row[x]);
        }
      }
    }
    T* const blocks =
      this->Blocks + (std::size_t(brickZ) * this->Grid.bricks.y + brickY) * this->Grid.bricks.x * 8;
    for (int x = 0; x < 2 * this->Grid.bricks.x; ++x)
    {
      const glm::ivec2 columns = this->voxelsOf(0, x / 2, x % 2);
      if (columns.x <= columns.y)
      {
        T best = this->Best[columns.x];
        for (int n = columns.x + 1; n <= columns.y; ++n)
        {
          keep<T, Minima>(best, this->Best[n]);
        }
        blocks[8 * (x / 2) + 4 * halfZ + 2 * halfY + x % 2] = best;
      }
    }
  }

  const CellGrid& Grid;
  T* Blocks;
  std::vector<T> Best; // of each column
};

template <class T, bool Minima>
void survey(const CellGrid& grid, T* blocks, T* bricks)
{
  parallelFor(0, grid.bricks.z, 1,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      Survey<T, Minima> survey(grid, blocks);
      for (int z = static_cast<int>(begin); z < end; ++z)
      {
        survey.survey(z);
      }
      const std::size_t layer = std::size_t(grid.bricks.x) * grid.bricks.y;
      for (std::size_t n = begin * layer; n < end * layer; ++n)
      {
        bricks[n] = blocks[8 * n];
        for (int b = 1; b < 8; ++b)
        {
          keep<T, Minima>(bricks[n], blocks[8 * n + b]);
        }
      }
    });
}

/// Descending order of values, to within a thousandth of their range.
template <class T>
void sortBricks(const T* bricks, std::size_t count, bool minima, std::vector<std::uint32_t>& order)
{
  constexpr int levels = 1024;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t n = 0; n < count; ++n)
  {
    const double value = static_cast<double>(bricks[n]);
    if (std::isfinite(value))
    {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  // Half of both, because their difference may not be finite.
  const double range = 0.5 * high - 0.5 * low;
  const auto level = [&](T brick)
  {
    const double share = range > 0.0
      ? std::clamp((0.5 * static_cast<double>(brick) - 0.5 * low) / range, 0.0, 1.0)
      : 0.0;
    const int n = static_cast<int>(share * (levels - 1));
    return minima ? n : levels - 1 - n;
  };
  std::array<std::uint32_t, levels + 1> starts{};
  for (std::size_t n = 0; n < count; ++n)
  {
    starts[isNaN(bricks[n]) ? 0 : level(bricks[n]) + 1] += !isNaN(bricks[n]);
  }
  for (int n = 0; n < levels; ++n)
  {
    starts[n + 1] += starts[n];
  }
  order.resize(starts[levels]);
  for (std::size_t n = 0; n < count; ++n)
  {
    if (!isNaN(bricks[n]))
    {
      order[starts[level(bricks[n])]++] = static_cast<std::uint32_t>(n);
    }
  }
}
}

void CellIndex::update(const CellGrid& grid, const VolumeIndex::Range& range)
{
  if (!(this->Grid == grid))
  {
    this->clear();
  }
  this->Grid = grid; // its field may end elsewhere
  this->Range = range;
}

void CellIndex::clear()
{
  this->Grid = CellGrid();
  for (int m = 0; m < 2; ++m)
  {
    this->Bounds[m] = CellBounds();
    this->Made[m] = false;
  }
  this->Seconds = 0.0;
}

const CellBounds& CellIndex::bounds(bool minima)
{
  if (!this->Made[minima])
  {
    const auto start = std::chrono::steady_clock::now();
    dispatch(this->Grid.voxels.type,
      [&](auto* null)
      { this->make<std::remove_pointer_t<decltype(null)>>(minima, this->Bounds[minima]); });
    this->Made[minima] = true;
    this->Seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return this->Bounds[minima];
}

template <class T>
void CellIndex::make(bool minima, CellBounds& bounds) const
{
  const std::size_t count = this->Grid.brickCount();
  bounds.bricks.resize(count * sizeof(T));
  bounds.blocks.resize(8 * count * sizeof(T));
  T* const bricks = reinterpret_cast<T*>(bounds.bricks.data());
  T* const blocks = reinterpret_cast<T*>(bounds.blocks.data());
  // Of blocks without cells.
  const T none = !std::numeric_limits<T>::is_integer ? std::numeric_limits<T>::quiet_NaN()
    : minima                                         ? std::numeric_limits<T>::max()
                                                     : std::numeric_limits<T>::lowest();
  std::fill_n(blocks, 8 * count, none);
  minima ? survey<T, true>(this->Grid, blocks, bricks)
         : survey<T, false>(this->Grid, blocks, bricks);
  sortBricks(bricks, count, minima, bounds.order);
}

std::size_t CellIndex::memorySize() const
{
  std::size_t size = 0;
  for (const CellBounds& bounds : this->Bounds)
  {
    size +=
      bounds.bricks.size() + bounds.blocks.size() + bounds.order.size() * sizeof(std::uint32_t);
  }
  return size;
}

double mostMagnitude(ScalarType type, const VolumeIndex::Range& range)
{
  const bool isDouble = averageType(type) == ScalarType::Float64;
  return range.hasInfinities() ? (isDouble ? 1e150 : 1e18) : (isDouble ? 1e303 : 1e37);
}

namespace
{
/// See CellLoops.h.
template <class A>
CellScale<A> scaleOf(const VolumeIndex::Range& range, bool minima)
{
  // Squares of values must be finite, and above 0. Of volumes with infinities no more is known than
  // that sums of a few values must be finite.
  const bool finite = !range.hasInfinities() && range.low <= range.high;
  const double half = finite ? 0.5 * range.high - 0.5 * range.low : 0.0;
  constexpr int most = sizeof(A) == sizeof(float) ? 120 : 1000;
  int exponent = half > 0.0 ? std::ilogb(half) + 1 : 0;
  exponent = std::abs(exponent) > 40 ? std::clamp(exponent, -most, most) : 0;
  const double size = range.hasInfinities() ? 0x1p-8 : std::ldexp(1.0, -exponent);
  const double factor = minima ? -size : size;
  CellScale<A> scale;
  scale.factor = static_cast<A>(factor);
  scale.offset = finite ? static_cast<A>(-factor * (minima ? range.high : range.low)) : A(0);
  scale.holes = range.nonFinite;
  return scale;
}
}

template <class A>
ValueScale<A>::ValueScale(const VolumeIndex::Range& range, Reduction reduction)
  : scale(scaleOf<A>(range, reduction == Reduction::Minimum)),
    highest(static_cast<A>(reduction == Reduction::Minimum ? range.low : range.high)),
    minima(reduction == Reduction::Minimum),
    shades(reduction == Reduction::DepthShaded)
{
}

template struct ValueScale<float>;
template struct ValueScale<double>;
}
