// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SliceStack_h
#define SliceStack_h

#include <array>
#include <cstddef>
#include <string>
#include <vector>

using Vector3 = std::array<double, 3>;

/**
 * Where a slice lies in the patient, as DICOM says it, in millimetres.
 */
struct SlicePlane
{
  std::string Name;                // the file's, and the frame's if it has several
  Vector3 Position;                // of the first pixel's middle
  Vector3 Row;                     // unit vector along the rows, ...
  Vector3 Column;                  // ... along the columns
  std::array<double, 2> Spacing;   // from pixel to pixel along rows and columns
  std::array<std::size_t, 2> Size; // pixels along rows and columns
};

/**
 * Vectors from voxel to voxel of a stack whose slices follow in a direction, a unit vector.
 */
std::array<Vector3, 3> MakeSteps(const SlicePlane& plane, const Vector3& direction, double step);

/**
 * The largest number of planes that agree in orientation, pixels and size, numbers of the given
 * ones. A note says which do not.
 */
std::vector<std::size_t> FindLargestStack(const std::vector<SlicePlane>& planes, std::string& note);

/**
 * The planes of a stack at each place, numbers of the given ones, in the order of the places along
 * the normal.
 */
std::vector<std::vector<std::size_t>> FindPlaces(const std::vector<SlicePlane>& planes);

/**
 * A slice of an even grid: First, or between First and Second, Weight being the latter's.
 */
struct SliceBlend
{
  std::size_t First;
  std::size_t Second;
  double Weight;
};

/**
 * An even grid along a stack of slices.
 */
struct SliceGrid
{
  Vector3 Direction; // from slice to slice, a unit vector; not along the normal if a gantry tilts
  double Step;       // from slice to slice, or 0 if there is one
  std::vector<SliceBlend> Slices;
  std::string Note; // what is uneven in the stack, and what was done; or empty
};

/**
 * The grid of one plane from each place. Slices within a tenth of the step from even places are
 * taken as they are. Others are interpolated linearly, with the least step of the stack. Throws
 * std::runtime_error with one sentence if the planes are not above each other, or if there would be
 * more than eight times as many slices.
 */
SliceGrid MakeGrid(const std::vector<SlicePlane>& planes, const std::vector<std::size_t>& order);

#endif
