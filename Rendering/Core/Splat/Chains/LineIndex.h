// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The line-encoded index [CS98, section 4]: the rows of all slices along one principal axis,
 * divided into chains of voxels with the same value.
 */
#ifndef splattingLineIndex_h
#define splattingLineIndex_h

#include "Common/ScalarType.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace splatting
{
struct Slices;

/// The order of chains.
enum class LineOrder
{
  Lines,       ///< row by row
  SortedLines, ///< slice by slice, descending values
  SortedVolume ///< all of them, descending values
};

/**
 * What chains hold.
 *
 * Delta encoding. A chain's value d differs from each of its voxels x by at most
 *
 *   dv(x) = tolerance / 255 * (high - x),   high the volume's largest voxel:
 *
 * `tolerance` grey levels of 255 at the low end of the range, nothing at its high end. Hence a
 * pixel P of the exact picture becomes one within P - dv(P) and P + dv(P), in all modes: with
 * c = tolerance / 255 <= 1, d lies between x - c (high - x) and x + c (high - x). Both are
 * non-decreasing affine functions of x. Such functions commute with averages whose weights are
 * non-negative and sum to one, and with maxima, so that the same bounds hold for worksheets, with x
 * replaced by the exact worksheet, and then for pixels. (Standard and high mode add the rounding
 * errors of their sums.)
 */
struct LineEncoding
{
  LineOrder order = LineOrder::Lines;
  double tolerance = 0.0; ///< of delta encoding, 0 to 255; 0: chains of equal voxels

  bool operator==(const LineEncoding& other) const
  {
    return this->order == other.order && this->tolerance == other.tolerance;
  }
};

/// Chains of one row of voxels.
template <class T>
struct LineRow
{
  const T* values;
  const std::uint8_t* last; ///< the chain's length minus one
  std::ptrdiff_t count;
};

/// Voxels (i, j) to (i + last, j) of a slice.
struct SliceChain
{
  std::uint16_t i, j, last;
};

/// The same in slice k.
struct VolumeChain
{
  std::uint16_t i, j, last, k;
};

/// Chains with the same value, in the order of k, j and i (no run of pixels).
template <class T, class Chain>
struct ChainRun
{
  T value;
  const Chain* begin;
  const Chain* end;
};

/**
 * The index of a volume without NaN and infinities along one axis. Chains of the lowest value of
 * the type cannot change a picture, and are omitted by sorted orders.
 */
class LineIndex
{
public:
  /// The largest number of voxels along an axis for sorted orders.
  static constexpr int MostSorted = 1 << 16;

  /// Gets the completed share, from 0 to 1, on the building thread. Returns whether to continue. A
  /// stopped index holds no encoding.
  using Progress = std::function<bool(double)>;

  LineIndex() = default;
  LineIndex(ScalarType type, const Slices& slices, const glm::ivec3& size,
    const LineEncoding& encoding, const Progress& progress = {});

  bool holds(const LineEncoding& encoding) const
  {
    return this->Made && this->Encoding == encoding;
  }
  const LineEncoding& encoding() const { return this->Encoding; }
  std::size_t chainCount() const;
  std::size_t memorySize() const;

  /// LineOrder::Lines: a row of a slice.
  template <class T>
  LineRow<T> row(int j, int k) const
  {
    const std::size_t place = std::size_t(k) * (this->Height + 1) + j;
    const std::size_t first = this->SliceStarts[k] + this->RowStarts[place];
    return { this->values<T>() + first, this->Lasts.data() + first,
      std::ptrdiff_t(this->RowStarts[place + 1]) - std::ptrdiff_t(this->RowStarts[place]) };
  }

  /// Sorted orders: the runs [runsOf(k), runsOf(k + 1)) of a slice, or of the volume for k = 0.
  std::size_t runsOf(int k) const { return this->SliceStarts[k]; }
  template <class T, class Chain>
  ChainRun<T, Chain> run(std::size_t r) const
  {
    const Chain* const all = this->chains(static_cast<const Chain*>(nullptr));
    return { this->values<T>()[r], all + this->RunStarts[r], all + this->RunStarts[r + 1] };
  }

private:
  template <class T>
  class Builder;

  template <class T>
  const T* values() const
  {
    return reinterpret_cast<const T*>(this->Values.data());
  }
  const SliceChain* chains(const SliceChain*) const { return this->SliceChains.data(); }
  const VolumeChain* chains(const VolumeChain*) const { return this->VolumeChains.data(); }

  LineEncoding Encoding;
  bool Made = false;
  int Height = 0;
  std::vector<unsigned char> Values;    // of chains or, if sorted, of runs
  std::vector<std::size_t> SliceStarts; // each slice's first chain or run
  std::vector<std::uint32_t> RowStarts; // each row's first chain in its slice
  std::vector<std::uint8_t> Lasts;      // of chains in rows
  std::vector<std::size_t> RunStarts;   // each run's first chain
  std::vector<SliceChain> SliceChains;
  std::vector<VolumeChain> VolumeChains;
};
}

#endif
