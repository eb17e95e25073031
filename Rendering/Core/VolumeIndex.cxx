// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeIndex.h"

#include "Kernels.h"

#include <vtkSMPThreadLocal.h>
#include <vtkSMPTools.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>
#include <vector>

namespace splatting
{
namespace
{
template <class T>
constexpr T lowest()
{
  return std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity()
                                              : std::numeric_limits<T>::lowest();
}
template <class T>
constexpr T highest()
{
  return std::numeric_limits<T>::has_infinity ? std::numeric_limits<T>::infinity()
                                              : std::numeric_limits<T>::max();
}

/// Adds the seconds that it lives.
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
  vtkSMPTools::For(0, nz,
    [=](vtkIdType first, vtkIdType last)
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

/// Cubes of 4 voxels, of which the bricks along every axis are made: [z][y][x].
template <class T>
struct Cubes
{
  static constexpr int Edge = 4;
  glm::ivec3 count;
  std::vector<T> maxima;

  explicit Cubes(const glm::ivec3& dimensions)
    : count((dimensions + (Edge - 1)) / Edge),
      maxima(std::size_t(this->count.x) * this->count.y * this->count.z)
  {
  }
  T* row(int y, int z)
  {
    return this->maxima.data() + (std::ptrdiff_t(z) * this->count.y + y) * this->count.x;
  }
  const T* row(int y, int z) const { return const_cast<Cubes*>(this)->row(y, z); }
};

template <class T>
struct Extremes
{
  T low = highest<T>(), high = lowest<T>();
  bool special = false;
};

/// Reads the voxels of one row of cubes.
template <class T>
void surveyRow(const VoxelArray& volume, int y, int z, std::vector<T>& columns, Cubes<T>& cubes,
  Extremes<T>& extremes)
{
  constexpr int edge = Cubes<T>::Edge;
  const glm::ivec3& size = volume.dimensions;
  const T* const voxels = static_cast<const T*>(volume.voxels);
  const VoxelLoops<T>& loops = kernelsFor(bestInstructionSet());
  columns.assign(std::size_t(cubes.count.x) * edge, lowest<T>());
  for (int j = y * edge; j < std::min((y + 1) * edge, size.y); ++j)
  {
    const T* rows[edge]; // several streams through memory keep the processor busy
    int count = 0;
    for (int k = z * edge; k < std::min((z + 1) * edge, size.z); ++k)
    {
      rows[count++] = voxels + (std::ptrdiff_t(k) * size.y + j) * size.x;
    }
    loops.survey(rows, count, size.x, columns.data(), extremes.low, extremes.special);
  }
  T* const out = cubes.row(y, z);
  loops.largestOfFour(columns.data(), out, cubes.count.x);
  for (int x = 0; x < cubes.count.x; ++x)
  {
    extremes.high = std::max(extremes.high, out[x]);
  }
}

/// Two cubes along i make a brick.
template <class T>
void bricksFromCubes(const Cubes<T>& cubes, const std::array<int, 3>& axes, BrickMaxima& bricks)
{
  static_assert(BrickWidth == 2 * Cubes<T>::Edge && BrickHeight == Cubes<T>::Edge &&
    BrickDepth == Cubes<T>::Edge);
  const glm::ivec3 n(cubes.count[axes[0]], cubes.count[axes[1]], cubes.count[axes[2]]);
  const std::ptrdiff_t strides[3] = { 1, cubes.count.x,
    std::ptrdiff_t(cubes.count.x) * cubes.count.y };
  const std::ptrdiff_t si = strides[axes[0]], sj = strides[axes[1]], sk = strides[axes[2]];
  bricks.count = { (n.x + 1) / 2, n.y, n.z };
  bricks.bytes.resize(
    std::size_t(bricks.count.x) * n.y * n.z * sizeof(T) + 2 * BrickMaxima::Padding);
  vtkSMPTools::For(0, n.y,
    [&](vtkIdType first, vtkIdType last)
    {
      for (int j = static_cast<int>(first); j < last; ++j)
      {
        for (int k = 0; k < n.z; ++k)
        {
          const T* const from = cubes.maxima.data() + j * sj + k * sk;
          T* const to = const_cast<T*>(bricks.row<T>(j, k));
          for (int i = 0; i < n.x / 2; ++i)
          {
            to[i] = std::max(from[2 * i * si], from[(2 * i + 1) * si]);
          }
          if (n.x % 2)
          {
            to[n.x / 2] = from[(n.x - 1) * si];
          }
        }
      }
    });
}
}

template <class T>
void VolumeIndex::survey()
{
  Cubes<T> cubes(this->Volume.dimensions);
  vtkSMPThreadLocal<Extremes<T>> extremes;
  vtkSMPThreadLocal<std::vector<T>> columns;
  vtkSMPTools::For(0, std::ptrdiff_t(cubes.count.y) * cubes.count.z,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType row = first; row < last; ++row)
      {
        surveyRow(this->Volume, static_cast<int>(row % cubes.count.y),
          static_cast<int>(row / cubes.count.y), columns.Local(), cubes, extremes.Local());
      }
    });
  Extremes<T> all;
  for (const Extremes<T>& part : extremes)
  {
    all.low = std::min(all.low, part.low);
    all.high = std::max(all.high, part.high);
    all.special = all.special || part.special;
  }
  this->ValueRange = { static_cast<double>(all.low), static_cast<double>(all.high), all.special };
  // Walks of volumes with NaN or infinities leave nothing out.
  this->BricksMade = !all.special && this->brickSize() <= this->Budget;
  for (int k = 0; k < 3 && this->BricksMade; ++k)
  {
    bricksFromCubes(cubes, { k == 0 ? 1 : 0, k == 2 ? 1 : 2, k }, this->Bricks[k]);
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
  this->Exceeded = this->Exceeded || (!this->range().special && !this->BricksMade);
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
  const void* first = nullptr; // where slice 0 would be
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
  this->BricksMade = this->BricksMade && !range.special;
}

const BrickMaxima& VolumeIndex::bricks(int principalAxis)
{
  this->range();
  return this->Bricks[principalAxis];
}

const LineIndex* VolumeIndex::lines(
  int principalAxis, const LineEncoding& encoding, const LineIndex::Progress& progress)
{
  const bool plain = encoding.order == LineOrder::Lines && !encoding.eliminate;
  LineIndex& lines = this->Lines[principalAxis][plain ? 0 : 1];
  std::optional<LineEncoding>& tooLarge = this->TooLarge[principalAxis][plain ? 0 : 1];
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
    size += bricks.bytes.size();
  }
  for (const auto& lines : this->Lines)
  {
    size += lines[0].memorySize() + lines[1].memorySize();
  }
  return size;
}
}
