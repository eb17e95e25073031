// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/RayPath.h"

#include <glm/common.hpp>

#include <cmath>

namespace splatting
{
namespace
{
/// One coordinate of a ray in a slice, relative to its pixel.
struct Crossing
{
  int first, last;     // offsets of the voxels in which it enters and leaves the slice
  double faceDistance; // from the entry to the face between them
};

Crossing cross(double entry, double exit)
{
  // The ray enters and leaves voxels through faces at half-integers. A point on a face belongs to
  // the voxel that the ray crosses: after the entry, before the exit.
  const bool forward = exit >= entry;
  const int first = static_cast<int>(forward ? std::floor(entry + 0.5) : std::ceil(entry - 0.5));
  if (exit == entry)
  {
    return { first, first, 0.0 };
  }
  const int last = static_cast<int>(forward ? std::ceil(exit - 0.5) : std::floor(exit + 0.5));
  return { first, last, std::abs(first + (forward ? 0.5 : -0.5) - entry) };
}
}

RayPath pathBetween(const glm::dvec2& enter, const glm::dvec2& leave, const glm::dvec2& slope)
{
  const Crossing x = cross(enter.x, leave.x);
  const Crossing y = cross(enter.y, leave.y);
  const glm::dvec2 speed = glm::abs(slope);
  RayPath found;
  const auto add = [&found](int di, int dj)
  {
    found.di[found.count] = di;
    found.dj[found.count] = dj;
    ++found.count;
  };
  add(x.first, y.first);
  if (x.first != x.last && y.first != y.last)
  {
    // Compares the times of the two faces, distance / speed, multiplied out: products of 25 and 24
    // bits are exact; those of 34 and 24 bits, in the slice with the eye, are rounded.
    const double timeX = x.faceDistance * speed.y;
    const double timeY = y.faceDistance * speed.x;
    if (timeX < timeY)
    {
      add(x.last, y.first);
    }
    else if (timeY < timeX)
    {
      add(x.first, y.last);
    }
  }
  if (x.first != x.last || y.first != y.last)
  {
    add(x.last, y.last);
  }
  return found;
}
}
