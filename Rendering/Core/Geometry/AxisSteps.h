// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The voxels that the rays of a perspective image cross. In a slice the i coordinate of a ray
 * depends only on its column of pixels, and the j coordinate only on its row.
 */
#ifndef splattingAxisSteps_h
#define splattingAxisSteps_h

#include "Geometry/ShearWarp.h"
#include "Kernels/Kernels.h"

#include <cstdint>
#include <vector>

namespace splatting
{
/**
 * The steps of rays from voxel to voxel, along an image's columns or rows, in all visible slices.
 */
class AxisSteps
{
public:
  /// @param a  0 for columns, 1 for rows
  void find(const ShearWarp& geometry, int a, const PerspectiveLoops& loops);

  /// The rays in slice k. Arrays have one element per pixel, and some more that are outside the
  /// volume.
  struct Slice
  {
    /// The voxels in which rays enter and leave the slice, which are neighbours or the same.
    /// Outside the volume -1, or the number of voxels.
    const std::int32_t *first, *last;
    /// The distance from the entry, as a share of a slice, at which rays change to the other voxel.
    const double* time;
    /// The same, rounded down to multiples of 2^-15; -1 for rays that stay in one voxel.
    const std::int16_t* tick;
  };
  Slice slice(int k) const
  {
    const std::size_t at = std::size_t(k - this->Slices.begin) * this->Padded;
    return { &this->First[at], &this->Last[at], &this->Time[at], &this->Tick[at] };
  }

  /// A range of voxels that includes all that some pixels cross in some slices. It has at most one
  /// more voxel at each end. At most two voxels at each end are outside the volume.
  Span voxels(const Span& slices, const Span& pixels) const;

  /// The pixels whose rays enter or leave slice k in the volume, and those whose rays do both.
  struct Covered
  {
    Span some, all;
  };
  const Covered& covered(int k) const { return this->Covers[k - this->Slices.begin]; }

private:
  friend class AxisPicks;
  Span Slices;
  int Count = 0, Size = 0;
  std::ptrdiff_t Padded = 0;
  std::vector<std::int32_t> First, Last;
  std::vector<double> Time;
  std::vector<std::int16_t> Tick;
  std::vector<Covered> Covers;
  std::vector<unsigned char> Ascends; // for each slice, whether voxels ascend with pixels
};

/**
 * The same steps, for loops that select voxels for a register of pixels from a few registers of
 * voxels. Pixels are no wider than voxels, so a group of pixels crosses no more voxels than it has
 * pixels.
 */
class AxisPicks
{
public:
  /// @param group  pixels that select from one register, see VoxelLoops::group
  /// @param bytes  of a voxel
  void find(const AxisSteps& steps, int group, int bytes);

  /// For each group of pixels the first voxel of its register, and for each pixel its voxel in it:
  /// integers as wide as voxels, negative for pixels outside the volume.
  struct Picks
  {
    const std::int32_t* base;
    const void* lanes;
  };
  Picks entering(int k) const { return this->picks(k, 0); }
  Picks leaving(int k) const { return this->picks(k, 1); }

private:
  template <class Lane>
  void fill(const std::int32_t* voxels, std::size_t row, const AxisSteps& steps);
  Picks picks(int k, int end) const
  {
    const std::size_t row = 2 * std::size_t(k - this->First) + end;
    return { &this->Bases[row * this->Groups],
      &this->Lanes[row * this->Groups * this->Group * this->Bytes] };
  }

  int First = 0, Group = 1, Groups = 0, Bytes = 1;
  std::vector<std::int32_t> Bases;
  std::vector<unsigned char> Lanes;
};
}

#endif
