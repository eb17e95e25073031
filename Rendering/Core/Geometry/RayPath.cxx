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

/// All crossed voxels.
RayPath crossed(const glm::dvec2& entry, const glm::dvec2& exit, const glm::dvec2& speed)
{
  const Crossing x = cross(entry.x, exit.x);
  const Crossing y = cross(entry.y, exit.y);
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

RayPath pathBetween(
  const glm::dvec2& enter, const glm::dvec2& leave, const glm::dvec2& slope, Meets meets)
{
  if (meets == Meets::All)
  {
    return crossed(enter, leave, glm::abs(slope));
  }
  const auto nearest = [&](int a)
  {
    return static_cast<int>(
      slope[a] < 0.0 ? std::ceil(enter[a] - 0.5) : std::floor(enter[a] + 0.5));
  };
  RayPath found;
  found.count = 1;
  found.di[0] = nearest(0);
  found.dj[0] = nearest(1);
  return found;
}
}
