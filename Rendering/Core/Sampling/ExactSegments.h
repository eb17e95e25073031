// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact mode: the trilinear field along a ray is a cubic polynomial in each cell between eight
 * voxels [Sakas et al. 1995; Bruckner, section 2]. In a parallel view all rays run through the
 * cells of a slice alike, so that the Bernstein coefficients of these cubics are sums of voxels
 * with the same weights for all pixels.
 */
#ifndef splattingExactSegments_h
#define splattingExactSegments_h

#include "Geometry/ShearWarp.h"
#include "Kernels/Kernels.h"

#include <array>
#include <limits>
#include <vector>

namespace splatting
{
/**
 * Where the field is known along an axis of n voxels: between the outermost voxels' centres;
 * where voxels are shown as boxes, and where there is only one, to the ends of the boxes, with the
 * outermost voxels' values.
 */
struct FieldRange
{
  FieldRange(const ShearWarp& geometry, int a)
    : isExtended(geometry.showsBoxes() || geometry.size()[a] == 1),
      begin(isExtended ? -0.5 : 0.0),
      end(geometry.size()[a] - 1 - begin)
  {
  }

  bool isExtended;
  double begin, end;
};

/// The most that a neighbouring slice's voxels weigh in an exact sample: half, where the slice
/// ends.
template <class A>
constexpr A ExactShare = A(0.5);

/**
 * A segment of the rays' path through slice k, half a slice to either side of its middle, in one
 * cell.
 */
template <class A>
struct ExactSegment
{
  int di, dj, dk; ///< the cell's first voxel, relative to pixel and slice
  /// Of Bernstein coefficient b for the cell's voxels, along i first: weights[8 b + n].
  std::array<A, 32> weights;
  bool curved; ///< whether the cubic is more than a line
  /// The pixels for which the segment lies in the field, and those for which it lies in voxels'
  /// boxes.
  std::array<Span, 2> inField, inBoxes; ///< columns and rows
};

template <class A>
using ExactPath = std::vector<ExactSegment<A>>; ///< one after the other, by ascending depth

/// A box around what the path through a slice passes.
template <class A>
struct ExactBox
{
  BoxSide<A> columns, rows;
};

/// How far rounding can lift a sample above, or push a box's largest value below, what they would
/// be exactly, for voxels up to 1. A sample has 9 roundings of eight products and their sum (in
/// perspective 60, see PerspectiveExact::slack()) and 12 of a cubic between its ends, a box 1 of a
/// mean and 7 along each side, and in perspective places have 4, which count twice. Else they are
/// known to 1e-9.
template <class A>
constexpr A ExactBoxSlack = 95 * std::numeric_limits<A>::epsilon() / 2 + A(4e-9);

/// The paths of a parallel view, of all slices of a part of it (or of the whole): the weights do
/// not depend on where the part begins.
template <class A>
void findExactPaths(
  const ShearWarp& whole, const ShearWarp& part, std::vector<ExactPath<A>>& paths);
template <class A>
void findExactBoxes(const ShearWarp& whole, const ShearWarp& part, std::vector<ExactBox<A>>& boxes);

/**
 * For each row of a parallel image the pixels whose rays run through the field. The others, at the
 * image's rim, see voxels' boxes only; they are shown the outermost voxels' values, so that what is
 * interpolated between pixels does not fade there.
 */
void findFieldSpans(const ShearWarp& geometry, std::vector<Span>& spans);
}

#endif
