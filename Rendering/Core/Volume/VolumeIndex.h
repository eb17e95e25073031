// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Data derived from a volume, made on demand and kept until the volume changes.
 */
#ifndef splattingVolumeIndex_h
#define splattingVolumeIndex_h

#include "Common/ScalarType.h"
#include "Splat/Chains/LineIndex.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace splatting
{
/**
 * The address of a volume's voxels, first axis fastest, without gaps.
 */
struct VoxelArray
{
  const void* voxels = nullptr;
  ScalarType type = ScalarType::UInt8;
  glm::ivec3 dimensions{ 0 };
};

/**
 * Slices along one axis: voxel (i, j, k) at voxels[i + j * rowStride + k * sliceStride].
 */
struct Slices
{
  const void* voxels = nullptr;
  std::ptrdiff_t rowStride = 0;
  std::ptrdiff_t sliceStride = 0;
};

/// Voxels of a brick along i, j and k.
constexpr int BrickWidth = 8;
constexpr int BrickHeight = 4;
constexpr int BrickDepth = 4;

/**
 * The largest voxel of each brick, without NaN, with bricks along one principal axis.
 */
struct BrickMaxima
{
  /// Bytes that may be read before the first and after the last brick, so that loops can read whole
  /// registers.
  static constexpr std::size_t Padding = 128;

  glm::ivec3 count{ 0 }; ///< bricks along i, j and k
  std::unique_ptr<unsigned char[]> bytes;
  std::size_t size = 0; ///< with padding

  /// Allocates bricks without setting them, so that each thread touches its pages first.
  template <class T>
  void open(const glm::ivec3& bricks)
  {
    this->count = bricks;
    this->size = std::size_t(bricks.x) * bricks.y * bricks.z * sizeof(T) + 2 * Padding;
    this->bytes.reset(new unsigned char[this->size]);
    std::fill_n(this->bytes.get(), Padding, static_cast<unsigned char>(0));
    std::fill_n(this->bytes.get() + this->size - Padding, Padding, static_cast<unsigned char>(0));
  }

  template <class T>
  const T* row(int j, int k) const
  {
    return reinterpret_cast<const T*>(this->bytes.get() + Padding) +
      (std::ptrdiff_t(k) * this->count.y + j) * this->count.x;
  }
};

/// Statistics of bricks, for Acceleration::Auto.
struct SkipStatistics
{
  double share = 0.0;  ///< of the tiles that bricks did not skip, in their last frame
  int framesSince = 0; ///< frames without bricks since then
};

class VolumeIndex
{
public:
  /// Discards all data, and sets other (or changed) voxels.
  void reset(const VoxelArray& volume);

  const VoxelArray& volume() const { return this->Volume; }

  /// Sets the bytes that may be held besides the volume. What would exceed them is not made. A
  /// change discards all data. Returns whether the budget has changed.
  bool setBudget(std::size_t bytes);
  /// Whether something was not made because of the budget.
  bool exceedsBudget() const { return this->Exceeded; }

  /// Whether slices() can be called for an axis: without a copy, or because the budget has room for
  /// one.
  bool hasSlices(int principalAxis);
  /**
   * The volume as slices along an axis, rows without gaps, (i, j) as in ShearWarp::axes(). Along
   * the first axis it is a copy with axes (1, 2, 0), because voxels of a row would be a whole row
   * apart in memory. The copy is made on demand in one pass.
   */
  Slices slices(int principalAxis);
  /**
   * The same for slices [begin, end) along the first axis, copied into `buffer`.
   */
  Slices someSlices(int begin, int end, std::vector<unsigned char>& buffer) const;

  struct Range
  {
    double low = 0.0, high = 0.0; ///< of all voxels except NaN; low > high if there are none
    bool nonFinite = false;       ///< whether there are NaN or infinities
    double magnitude = 0.0;       ///< the largest one of finite voxels

    bool hasInfinities() const
    {
      return this->low <= this->high && (std::isinf(this->low) || std::isinf(this->high));
    }
  };
  /// Computed on demand in one pass over the voxels, which also makes the bricks.
  const Range& range();
  /// Sets the range that range() returns for a piece to that of the whole volume. It must include
  /// that of the piece.
  void setRangeOfWhole(const Range& range);

  /// Whether there are bricks: the budget has room for them, and there are no infinities.
  bool hasBricks();
  /// The bricks along an axis; 3/128 of the volume for all axes together.
  const BrickMaxima& bricks(int principalAxis);

  /**
   * The chains along an axis, or nullptr if the budget has no room or `progress` stopped them. Made
   * on demand, and again when the encoding changes. Unsorted chains are kept in addition to the
   * last sorted ones. Not for volumes with NaN or infinities.
   */
  const LineIndex* lines(
    int principalAxis, const LineEncoding& encoding, const LineIndex::Progress& progress = {});

  /// Cut volumes have their own statistics, because much of them may be skipped.
  SkipStatistics& statistics(int principalAxis, int quality, bool isCut)
  {
    return this->Statistics[isCut][principalAxis][quality];
  }

  /// Bytes held besides the volume.
  std::size_t memorySize() const;
  /// Seconds that all data took.
  double time() const { return this->Seconds; }

private:
  template <class T>
  void survey();
  std::size_t volumeSize() const;
  std::size_t brickSize() const;

  VoxelArray Volume;
  std::size_t Budget = std::numeric_limits<std::size_t>::max();
  std::unique_ptr<unsigned char[]> Copy;
  std::size_t CopySize = 0;
  Range ValueRange;
  std::array<BrickMaxima, 3> Bricks;
  std::array<std::array<LineIndex, 2>, 3> Lines;
  std::array<std::array<std::optional<LineEncoding>, 2>, 3>
    Unmade; // encodings that exceeded the budget
  bool Surveyed = false;
  bool BricksMade = false;
  bool Exceeded = false;
  double Seconds = 0.0;
  // Of the whole and of the cut volume, axes and qualities.
  std::array<std::array<std::array<SkipStatistics, 4>, 3>, 2> Statistics;
};
}

#endif
