// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact mode in perspective views: which cells between voxels the rays of an image's columns (or
 * rows) are in, slice by slice.
 */
#ifndef splattingAxisCells_h
#define splattingAxisCells_h

#include "Geometry/ShearWarp.h"
#include "Kernels/Kernels.h"

#include <array>
#include <cstdint>
#include <vector>

namespace splatting
{
template <class A>
class AxisCells
{
public:
  /// @param whole  the image's geometry: where rays are in their cells does not depend on parts
  /// @param part   the part that is projected, from which voxels are counted; or the same
  /// @param a      0 for columns, 1 for rows
  void find(const ShearWarp& whole, const ShearWarp& part, int a);

  AxisCellArrays<A> slice(int k) const;

  /// The voxels of the cells that some pixels are in, in some slices, from first to last; they may
  /// lie outside the volume.
  Span voxels(const Span& slices, const Span& pixels) const;

private:
  enum Arrays
  {
    At,
    Crossing,
    FieldBegin,
    FieldEnd,
    BoxesBegin,
    BoxesEnd,
    ArrayCount
  };
  /// The depths at which the rays of a column are somewhere.
  using Depths = std::array<double, 2>;
  static Depths depthsIn(double begin, double end, double at, double slope, double reference);
  void findSlice(const ShearWarp& whole, const ShearWarp& part, int a, int k);
  A* array(int k, int which)
  {
    return &this->Values[(std::size_t(k - this->Slices.begin) * ArrayCount + which) * this->Padded];
  }

  Span Slices;
  int Count = 0, Size = 0;
  std::size_t Padded = 0;
  std::vector<std::int32_t> Cells;
  std::vector<A> Values, Slopes, FieldNear, FieldFar;
  std::vector<Depths> Field, Boxes;
};
}

#endif
