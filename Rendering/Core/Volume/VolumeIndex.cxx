// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Volume/VolumeIndex.h"

#include "Common/Parallel.h"
#include "Kernels/Kernels.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace splatting
{
namespace
{
/// Adds its lifetime to a number of seconds.
class Stopwatch
{
public:
  explicit Stopwatch(double& seconds) : Seconds(seconds), Start(std::chrono::steady_clock::now()) {}
  ~Stopwatch()
  {
    this->Seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  void operator=(const Stopwatch&) = delete;

private:
  double& Seconds;
  std::chrono::steady_clock::time_point Start;
};

/// out[x - begin][z][y] = in[z][y][x] for x in [begin, end), in blocks that fit the first-level
/// cache on both sides.
template <class T>
void transpose(const T* in, T* out, const glm::ivec3& size, int begin, int end)
{
  constexpr int block = 64;
  const std::ptrdiff_t nx = size.x, ny = size.y, nz = size.z;
  parallelFor(0, nz, 0,
    [=](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t z = first; z < last; ++z)
      {
        for (std::ptrdiff_t y0 = 0; y0 < ny; y0 += block)
        {
          const std::ptrdiff_t y1 = std::min(y0 + block, ny);
          for (std::ptrdiff_t x0 = begin; x0 < end; x0 += block)
          {
            const std::ptrdiff_t x1 = std::min<std::ptrdiff_t>(x0 + block, end);
            for (std::ptrdiff_t x = x0; x < x1; ++x)
            {
              const T* from = in + (z * ny + y0) * nx + x;
              T* to = out + ((x - begin) * nz + z) * ny;
              for (std::ptrdiff_t y = y0; y < y1; ++y, from += nx)
              {
                to[y] = *from;
              }
            }
          }
        }
      }
    });
}

template <class T>
struct Extremes
{
  T low = greatestValue<T>(), high = leastValue<T>();
  bool nonFinite = false;
};

/// Finds the range of all voxels and, on request, the bricks along all axes, in one pass. Bricks
/// consist of cubes of four voxels, two rows of cubes along x at a time.
template <class T>
class Survey
{
public:
  /// @param bricks  of the three axes, or nullptr
  Survey(const VoxelArray& volume, BrickMaxima* bricks)
    : Volume(volume),
      Bricks(bricks),
      Count((volume.dimensions + (Edge - 1)) / Edge)
  {
    for (int axis = 0; axis < 3 && bricks; ++axis)
    {
      this->open(axis);
    }
  }

  Extremes<T> operator()()
  {
    const int pairs = (this->Count.y + 1) / 2;
    parallelFor(0, std::ptrdiff_t(pairs) * this->Count.z, 0,
      [&](std::ptrdiff_t first, std::ptrdiff_t last)
      {
        Scratch& scratch = this->Scratches.Local();
        for (std::ptrdiff_t n = first; n < last; ++n)
        {
          this->lookAt(static_cast<int>(n % pairs), static_cast<int>(n / pairs), scratch);
        }
      });
    Extremes<T> all;
    this->Scratches.forAll(
      [&](const Scratch& scratch)
      {
        const Extremes<T>& part = scratch.extremes;
        all.low = std::min(all.low, part.low);
        all.high = std::max(all.high, part.high);
        all.nonFinite = all.nonFinite || part.nonFinite;
      });
    return all;
  }

private:
  static constexpr int Edge = 4;
  static_assert(BrickWidth == 2 * Edge && BrickHeight == Edge && BrickDepth == Edge);

  struct Scratch
  {
    std::vector<T> columns, cubes[2];
    Extremes<T> extremes;
  };

  void open(int axis)
  {
    const glm::ivec3& n = this->Count;
    this->Bricks[axis].template open<T>(
      { ((axis == 0 ? n.y : n.x) + 1) / 2, axis == 2 ? n.y : n.z, n[axis] });
  }

  T* row(int axis, int j, int k) const
  {
    return const_cast<T*>(this->Bricks[axis].template row<T>(j, k));
  }

  /// Rows 2 pair and, if it exists, 2 pair + 1 of the cubes at z.
  void lookAt(int pair, int z, Scratch& scratch) const
  {
    const int y = 2 * pair;
    const bool isPair = y + 1 < this->Count.y;
    for (int n = 0; n < (isPair ? 2 : 1); ++n)
    {
      std::vector<T>& cubes = scratch.cubes[n];
      this->findCubes(y + n, z, scratch, cubes);
      if (this->Bricks)
      {
        // Along axes 1 and 2 a brick consists of two cubes along x,
        T* const bricks = this->row(2, y + n, z);
        join(cubes.data(), this->Count.x, bricks);
        std::copy(bricks, bricks + this->Bricks[2].count.x, this->row(1, z, y + n));
      }
    }
    if (this->Bricks)
    {
      // along axis 0 of two along y.
      const T *const a = scratch.cubes[0].data(), *const b = scratch.cubes[isPair ? 1 : 0].data();
      const std::ptrdiff_t slice =
        std::ptrdiff_t(this->Bricks[0].count.x) * this->Bricks[0].count.y;
      T* const bricks = this->row(0, z, 0) + pair;
      for (int x = 0; x < this->Count.x; ++x)
      {
        bricks[x * slice] = std::max(a[x], b[x]);
      }
    }
  }

  /// The larger of each two cubes; a single last cube is copied.
  static void join(const T* cubes, int count, T* bricks)
  {
    for (int i = 0; i < count / 2; ++i)
    {
      bricks[i] = std::max(cubes[2 * i], cubes[2 * i + 1]);
    }
    if (count % 2)
    {
      bricks[count / 2] = cubes[count - 1];
    }
  }

  void findCubes(int y, int z, Scratch& scratch, std::vector<T>& cubes) const
  {
    const glm::ivec3& size = this->Volume.dimensions;
    const T* const voxels = static_cast<const T*>(this->Volume.voxels);
    const VoxelLoops<T>& loops = kernelsFor(bestInstructionSet());
    scratch.columns.assign(std::size_t(this->Count.x) * Edge, leastValue<T>());
    for (int j = y * Edge; j < std::min((y + 1) * Edge, size.y); ++j)
    {
      const T* rows[Edge]; // several memory streams keep the processor busy
      int count = 0;
      for (int k = z * Edge; k < std::min((z + 1) * Edge, size.z); ++k)
      {
        rows[count++] = voxels + (std::ptrdiff_t(k) * size.y + j) * size.x;
      }
      loops.survey(rows, count, size.x, scratch.columns.data(), scratch.extremes.low,
        scratch.extremes.nonFinite);
    }
    cubes.resize(this->Count.x);
    loops.largestOfFour(scratch.columns.data(), cubes.data(), this->Count.x);
    T high = scratch.extremes.high;
    for (const T& cube : cubes)
    {
      high = std::max(high, cube);
    }
    scratch.extremes.high = high;
  }

  const VoxelArray& Volume;
  BrickMaxima* Bricks;
  glm::ivec3 Count; ///< of cubes
  PerThread<Scratch> Scratches;
};

template <class T>
double largestMagnitudeOf(const VoxelArray& volume, const Extremes<T>& extremes)
{
  const double low = static_cast<double>(extremes.low);
  const double high = static_cast<double>(extremes.high);
  if (std::isfinite(low) && std::isfinite(high))
  {
    return std::max(std::abs(low), std::abs(high));
  }
  // The magnitudes of the other voxels are unknown beside infinities.
  const T* const voxels = static_cast<const T*>(volume.voxels);
  const glm::ivec3& size = volume.dimensions;
  return std::accumulate(voxels, voxels + std::ptrdiff_t(size.x) * size.y * size.z, 0.0,
    [](double largest, T voxel)
    {
      const double magnitude = std::abs(static_cast<double>(voxel));
      return std::isfinite(magnitude) ? std::max(largest, magnitude) : largest;
    });
}
}

template <class T>
void VolumeIndex::survey()
{
  const bool fits = this->brickSize() <= this->Budget;
  const Extremes<T> extremes = Survey<T>(this->Volume, fits ? this->Bricks.data() : nullptr)();
  this->ValueRange = { static_cast<double>(extremes.low), static_cast<double>(extremes.high),
    extremes.nonFinite, largestMagnitudeOf(this->Volume, extremes) };
  // Walks of volumes with infinities skip nothing.
  this->BricksMade = fits && !this->ValueRange.hasInfinities();
  if (!this->BricksMade)
  {
    this->Bricks = {};
  }
}

void VolumeIndex::reset(const VoxelArray& volume)
{
  VolumeIndex fresh;
  fresh.Volume = volume;
  fresh.Budget = this->Budget;
  *this = std::move(fresh);
}

bool VolumeIndex::setBudget(std::size_t bytes)
{
  if (bytes == this->Budget)
  {
    return false;
  }
  this->Budget = bytes;
  this->reset(this->Volume);
  return true;
}

std::size_t VolumeIndex::volumeSize() const
{
  const glm::ivec3& n = this->Volume.dimensions;
  return std::size_t(n.x) * n.y * n.z * sizeOf(this->Volume.type);
}

std::size_t VolumeIndex::brickSize() const
{
  std::size_t bricks = 0;
  for (int k = 0; k < 3; ++k)
  {
    const glm::ivec3& n = this->Volume.dimensions;
    const int i = n[k == 0 ? 1 : 0], j = n[k == 2 ? 1 : 2];
    bricks += std::size_t((i + BrickWidth - 1) / BrickWidth) *
      ((j + BrickHeight - 1) / BrickHeight) * ((n[k] + BrickDepth - 1) / BrickDepth);
  }
  return bricks * sizeOf(this->Volume.type) + 3 * 2 * BrickMaxima::Padding;
}

bool VolumeIndex::hasBricks()
{
  this->Exceeded = this->Exceeded || (!this->range().hasInfinities() && !this->BricksMade);
  return this->BricksMade;
}

bool VolumeIndex::hasSlices(int principalAxis)
{
  if (principalAxis != 0 || this->Copy)
  {
    return true;
  }
  const bool fits = this->volumeSize() + this->memorySize() <= this->Budget;
  this->Exceeded = this->Exceeded || !fits;
  return fits;
}

Slices VolumeIndex::slices(int principalAxis)
{
  const std::ptrdiff_t nx = this->Volume.dimensions.x, ny = this->Volume.dimensions.y,
                       nz = this->Volume.dimensions.z;
  if (principalAxis == 2)
  {
    return { this->Volume.voxels, nx, nx * ny };
  }
  if (principalAxis == 1)
  {
    return { this->Volume.voxels, nx * ny, nx };
  }
  if (!this->Copy)
  {
    const Stopwatch stopwatch(this->Seconds);
    this->CopySize = this->volumeSize();
    this->Copy.reset(new unsigned char[this->CopySize]);
    dispatch(this->Volume.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        transpose(static_cast<const T*>(this->Volume.voxels),
          reinterpret_cast<T*>(this->Copy.get()), this->Volume.dimensions, 0,
          this->Volume.dimensions.x);
      });
  }
  return { this->Copy.get(), ny, ny * nz };
}

Slices VolumeIndex::someSlices(int begin, int end, std::vector<unsigned char>& buffer) const
{
  const std::ptrdiff_t slice =
    std::ptrdiff_t(this->Volume.dimensions.y) * this->Volume.dimensions.z;
  buffer.resize(std::size_t(end - begin) * slice * sizeOf(this->Volume.type));
  const void* first = nullptr; // of slice 0, which need not exist
  dispatch(this->Volume.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      T* const copy = reinterpret_cast<T*>(buffer.data());
      transpose(
        static_cast<const T*>(this->Volume.voxels), copy, this->Volume.dimensions, begin, end);
      first = copy - begin * slice;
    });
  return { first, this->Volume.dimensions.y, slice };
}

const VolumeIndex::Range& VolumeIndex::range()
{
  if (!this->Surveyed)
  {
    const Stopwatch stopwatch(this->Seconds);
    dispatch(this->Volume.type,
      [this](auto* null) { this->survey<std::remove_pointer_t<decltype(null)>>(); });
    this->Surveyed = true;
  }
  return this->ValueRange;
}

void VolumeIndex::setRangeOfWhole(const Range& range)
{
  if (this->Volume.voxels)
  {
    this->range(); // the pass makes the bricks
  }
  this->Surveyed = true;
  this->ValueRange = range;
  this->BricksMade = this->BricksMade && !range.hasInfinities();
}

const BrickMaxima& VolumeIndex::bricks(int principalAxis)
{
  this->range();
  return this->Bricks[principalAxis];
}

const LineIndex* VolumeIndex::lines(
  int principalAxis, const LineEncoding& encoding, const LineIndex::Progress& progress)
{
  const bool plain = encoding.order == LineOrder::Lines;
  LineIndex& lines = this->Lines[principalAxis][plain ? 0 : 1];
  std::optional<LineEncoding>& tooLarge = this->Unmade[principalAxis][plain ? 0 : 1];
  if (lines.holds(encoding))
  {
    return &lines;
  }
  lines = {};
  if (tooLarge == encoding || !this->hasSlices(principalAxis))
  {
    return nullptr;
  }
  const bool copied = this->Copy != nullptr;
  const glm::ivec3& d = this->Volume.dimensions;
  const glm::ivec3 size(
    principalAxis == 0 ? d.y : d.x, principalAxis == 2 ? d.y : d.z, d[principalAxis]);
  const Slices slices = this->slices(principalAxis);
  {
    const Stopwatch stopwatch(this->Seconds);
    lines = LineIndex(this->Volume.type, slices, size, encoding, progress);
  }
  if (!copied)
  {
    this->Copy.reset();
    this->CopySize = 0;
  }
  if (!lines.holds(encoding))
  {
    lines = {};
    return nullptr;
  }
  if (this->memorySize() > this->Budget)
  {
    lines = {};
    tooLarge = encoding;
    this->Exceeded = true;
    return nullptr;
  }
  return &lines;
}

std::size_t VolumeIndex::memorySize() const
{
  std::size_t size = this->CopySize;
  for (const BrickMaxima& bricks : this->Bricks)
  {
    size += bricks.size;
  }
  for (const auto& lines : this->Lines)
  {
    size += lines[0].memorySize() + lines[1].memorySize();
  }
  return size;
}
}
