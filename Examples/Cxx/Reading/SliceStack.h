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
 * Where a slice lies in the patient according to DICOM, in millimetres.
 */
struct SlicePlane
{
  std::string Name;                // of the file, and of the frame if there are several
  Vector3 Position;                // of the centre of the first pixel
  Vector3 Row;                     // unit vector along the rows, ...
  Vector3 Column;                  // ... along the columns
  std::array<double, 2> Spacing;   // from pixel to pixel along rows and columns
  std::array<std::size_t, 2> Size; // pixels along rows and columns
};

/**
 * Make vectors from voxel to voxel of a stack whose slices follow in a direction, a unit vector.
 */
std::array<Vector3, 3> MakeSteps(const SlicePlane& plane, const Vector3& direction, double step);

/**
 * Describe a plane by its name and position.
 */
std::string Describe(const SlicePlane& plane);

/**
 * Find the largest number of planes that agree in orientation, pixels and size. Returns the numbers
 * of the given ones. A note says which do not.
 */
std::vector<std::size_t> FindLargestStack(const std::vector<SlicePlane>& planes, std::string& note);

/**
 * Find the planes of a stack at each place, numbers of the given ones, in the order of the places
 * along the normal.
 */
std::vector<std::vector<std::size_t>> FindPlaces(const std::vector<SlicePlane>& planes);

/**
 * The line along which slices follow each other. Its direction, a unit vector, is that from the
 * first slice to the last: not along the normal if a gantry tilts.
 */
struct SliceLine
{
  Vector3 Direction;
  std::vector<double> Places; // of the slices, from 0
};

/**
 * Find the line of planes in an order of rising places. Throws std::runtime_error with one sentence
 * if they are not above each other.
 */
SliceLine FindLine(const std::vector<SlicePlane>& planes, const std::vector<std::size_t>& order);

#endif
