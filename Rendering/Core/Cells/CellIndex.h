// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingCellIndex_h
#define splattingCellIndex_h

#include "Cells/Kernels/CellLoops.h"
#include "Common/ProjectionSettings.h"
#include "Volume/VolumeIndex.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace splatting
{
/// Cells along a brick's side, twice as many as along a block's.
constexpr int BrickCells = 2 * BlockCells;

/**
 * A volume, or a piece of one, as cells.
 *
 * Along an axis, cell c lies between voxels c - shift and c - shift + 1, which are clamped to the
 * volume. For cell scalars, and along axes with one voxel, the field ends at the sides of the
 * outermost voxels. Such an axis has one more cell at each end. The inner half of this cell is in
 * the field. Cells and bricks are numbered in the whole volume, so a piece has the same cells and
 * bricks as the whole.
 */
struct CellGrid
{
  VoxelArray voxels;     ///< of the piece
  glm::ivec3 first{ 0 }; ///< where it begins in the whole
  glm::ivec3 whole{ 0 }; ///< voxels of the whole
  glm::ivec3 shift{ 0 };
  glm::ivec3 begin{ 0 }, end{ 0 };    ///< the cells of the piece
  glm::dvec3 low{ 0.0 }, high{ 0.0 }; ///< where the field of the whole ends
  glm::ivec3 firstBrick{ 0 }, bricks{ 0 };

  CellGrid() = default;
  CellGrid(const VoxelArray& piece, const glm::ivec3& firstVoxel, const glm::ivec3& wholeSize,
    bool showsBoxes);

  bool operator==(const CellGrid& other) const
  {
    return this->voxels.voxels == other.voxels.voxels && this->voxels.type == other.voxels.type &&
      this->voxels.dimensions == other.voxels.dimensions && this->first == other.first &&
      this->whole == other.whole && this->shift == other.shift;
  }
  std::size_t brickCount() const
  {
    return std::size_t(this->bricks.x) * this->bricks.y * this->bricks.z;
  }
  /// The first cell of a brick.
  glm::ivec3 brickCell(std::uint32_t brick) const;
  /// The first and the last voxel of the piece, along an axis, that are corners of cells [from,
  /// to).
  glm::ivec2 voxelsOf(int axis, int from, int to) const;
};

/**
 * The largest voxel of each brick of 8^3 cells, and of each of its eight blocks of 4^3 cells. The
 * voxels of their far faces count, too. For minima it is the least voxel. It is NaN where all
 * voxels are hidden. It has the volume's type.
 */
struct CellBounds
{
  std::vector<unsigned char> bricks, blocks;
  /// Bricks with the largest values first. Those without a voxel are left out.
  std::vector<std::uint32_t> order;

  template <class T>
  const T* brick() const
  {
    return reinterpret_cast<const T*>(this->bricks.data());
  }
  template <class T>
  const T* block() const
  {
    return reinterpret_cast<const T*>(this->blocks.data());
  }
};

/**
 * Bounds of a volume's cells, made on first need and kept until the data change. They take about
 * 1/57 of the volume's memory for maxima, and as much for minima.
 */
class CellIndex
{
public:
  /// Forgets everything if anything has changed.
  /// @param range  of the whole
  void update(const CellGrid& grid, const VolumeIndex::Range& range);
  /// The voxels have changed.
  void clear();

  const CellGrid& grid() const { return this->Grid; }
  const VolumeIndex::Range& range() const { return this->Range; }
  const CellBounds& bounds(bool minima);

  std::size_t memorySize() const;
  /// Seconds that making the bounds took.
  double time() const { return this->Seconds; }

private:
  template <class T>
  void make(bool minima, CellBounds& bounds) const;

  CellGrid Grid;
  VolumeIndex::Range Range;
  CellBounds Bounds[2];
  bool Made[2] = { false, false };
  double Seconds = 0.0;
};

/// The largest magnitude of finite voxels. Cells scale voxels by their range, which is unknown
/// beside infinities, and multiply them.
double mostMagnitude(ScalarType type, const VolumeIndex::Range& range);

/// From the values of the kernels to voxels.
template <class A>
struct ValueScale
{
  CellScale<A> scale; ///< from voxels to values; for minima these are negative
  A highest;          ///< the largest voxel, of minima the least
  bool minima;
  bool shades; ///< whether voxels may be above the largest

  ValueScale(const VolumeIndex::Range& range, Reduction reduction);

  /// NaN if there is no sample.
  A voxelOf(A value) const
  {
    constexpr A infinite = std::numeric_limits<A>::infinity();
    if (value == CellValue<A>::Outside || value == CellValue<A>::None)
    {
      return std::numeric_limits<A>::quiet_NaN();
    }
    if (value >= CellValue<A>::Highest || value <= CellValue<A>::Lowest)
    {
      return (value > 0) != this->minima ? infinite : -infinite;
    }
    // The products of sums, not the sums of products, are finite.
    const A voxel = (value - this->scale.offset) * (A(1) / this->scale.factor);
    // Rounding must not lift it above the largest voxel.
    return this->shades ? voxel
      : this->minima    ? std::max(voxel, this->highest)
                        : std::min(voxel, this->highest);
  }
};

/// Converts a voxel of bounds() to a value.
template <class T>
Accumulator<T> boundOf(T voxel, const CellScale<Accumulator<T>>& scale)
{
  using A = Accumulator<T>;
  const A value = std::fma(scale.factor, static_cast<A>(voxel), scale.offset);
  return value != value ? CellValue<A>::None
                        : std::clamp(value, CellValue<A>::Lowest, CellValue<A>::Highest);
}
}

#endif
