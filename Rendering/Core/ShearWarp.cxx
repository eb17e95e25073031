// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShearWarp.h"

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
/// Row r of a matrix (GLM's are columns).
glm::dvec4 row(const glm::dmat4& m, int r)
{
  return { m[0][r], m[1][r], m[2][r], m[3][r] };
}

double quantised(double shear)
{
  constexpr double steps = 1 << 24;
  return std::round(shear * steps) / steps;
}

/// One coordinate of a ray while it crosses a slice, relative to its pixel.
struct Crossing
{
  int first, last;     // offsets of the voxels where it enters and leaves the slice
  double faceDistance; // from the entry to the face between the two
};

Crossing cross(double entry, double exit)
{
  // The ray enters and leaves voxels through faces at half-integers. A point on a face belongs to
  // the voxel that the ray runs in next to it: after the entry, before the exit.
  const bool forward = exit >= entry;
  const int first = static_cast<int>(forward ? std::floor(entry + 0.5) : std::ceil(entry - 0.5));
  const int last = static_cast<int>(forward ? std::ceil(exit - 0.5) : std::floor(exit + 0.5));
  return { first, last, std::abs(first + (forward ? 0.5 : -0.5) - entry) };
}
}

ShearWarp::ShearWarp(const View& view)
{
  const glm::dmat4& m = view.indexToClip;
  const double w = m[3][3];
  // Rows of the affine map from index space to pixels, whose centres lie at integers.
  const glm::dvec4 half(0.0, 0.0, 0.0, 1.0);
  const glm::dvec4 rowX = 0.5 * view.viewport.x * (row(m, 0) / w + half) - 0.5 * half;
  const glm::dvec4 rowY = 0.5 * view.viewport.y * (row(m, 1) / w + half) - 0.5 * half;
  // Rays run where neither pixel coordinate changes.
  const glm::dvec3 x(rowX), y(rowY);
  const glm::dvec3 direction = glm::cross(x, y);
  const double area = glm::length(direction);
  // The comparison also fails for matrices with NaN or infinity.
  if (!(area > 1e-12 * glm::length(x) * glm::length(y)) || !std::isfinite(area))
  {
    return;
  }
  this->Size = view.dimensions;
  this->ShowsBoxes = view.showsBoxes;
  this->chooseAxes(direction);
  // Clip space is deeper away from the viewer; along the ray, with the principal axis growing:
  const double deeper = glm::dot(glm::dvec3(row(m, 2)) / w, direction);
  this->Reversed = deeper * direction[this->Axes[2]] < 0.0;
  this->computeWarp(rowX, rowY);
  this->Valid = true;
}

void ShearWarp::chooseAxes(const glm::dvec3& direction)
{
  // On ties (to rounding errors) the slowest axis wins: its slices are contiguous.
  int k = 2;
  for (int a = 1; a >= 0; --a)
  {
    if (std::abs(direction[a]) > std::abs(direction[k]) * (1.0 + 1e-12))
    {
      k = a;
    }
  }
  this->Axes = { k == 0 ? 1 : 0, k == 2 ? 1 : 2, k };
  const glm::ivec3 dimensions = this->Size;
  for (int a = 0; a < 3; ++a)
  {
    this->Size[a] = dimensions[this->Axes[a]];
  }
  this->Middle = 0.5 * (this->Size.z - 1);
  for (int a = 0; a < 2; ++a)
  {
    const double shear = -direction[this->Axes[a]] / direction[k];
    this->Shear[a] = quantised(std::clamp(shear, -1.0, 1.0));
    // Half the stack on either side of the middle, and a pixel for footprints at the rim.
    this->Margin[a] = static_cast<int>(std::ceil(std::abs(this->Shear[a]) * this->Size.z / 2)) + 1;
  }
}

void ShearWarp::computeWarp(const glm::dvec4& rowX, const glm::dvec4& rowY)
{
  // A shear pixel shows the voxel of the middle slice that lies there.
  const int i = this->Axes[0], j = this->Axes[1], k = this->Axes[2];
  const glm::dmat2 linear(rowX[i], rowY[i], rowX[j], rowY[j]);
  const glm::dvec2 middle =
    glm::dvec2(rowX.w, rowY.w) + this->Middle * glm::dvec2(rowX[k], rowY[k]);
  const glm::dvec2 offset = middle - linear * glm::dvec2(this->Margin);
  this->ShearToScreen = glm::dmat3x2(linear[0], linear[1], offset);
  const glm::dmat2 inverse = glm::inverse(linear);
  this->ScreenToShear = glm::dmat3x2(inverse[0], inverse[1], -(inverse * offset));
}

RayPath ShearWarp::rayPath(int k) const
{
  const glm::dvec2 entry = -this->position(k - 0.5);
  const glm::dvec2 exit = -this->position(k + 0.5);
  const Crossing x = cross(entry.x, exit.x);
  const Crossing y = cross(entry.y, exit.y);
  RayPath path;
  const auto add = [&path](int di, int dj)
  {
    path.di[path.count] = di;
    path.dj[path.count] = dj;
    ++path.count;
  };
  add(x.first, y.first);
  if (x.first != x.last && y.first != y.last)
  {
    // Which face comes first? distance / speed, multiplied out: products of 25 and 24 bits, exact.
    const double timeX = x.faceDistance * std::abs(this->Shear.y);
    const double timeY = y.faceDistance * std::abs(this->Shear.x);
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
  return path;
}

Span ShearWarp::coverage(const RayPath& path, int v) const
{
  // The voxels of a path are neighbours, so the ranges of pixels that see them join.
  Span all{ this->width(), 0 };
  for (int t = 0; t < path.count; ++t)
  {
    const int j = v + path.dj[t];
    if (j >= 0 && j < this->Size.y)
    {
      all.begin = std::min(all.begin, -path.di[t]);
      all.end = std::max(all.end, this->Size.x - path.di[t]);
    }
  }
  return all;
}

glm::dvec4 ShearWarp::inPixels(const glm::dvec4& halfSpace) const
{
  const double a = halfSpace[this->Axes[0]];
  const double b = halfSpace[this->Axes[1]];
  const double c = halfSpace[this->Axes[2]];
  const glm::dvec2 origin = this->position(0.0);
  return { a, b, c - a * this->Shear.x - b * this->Shear.y,
    halfSpace.w - a * origin.x - b * origin.y };
}

bool ShearWarp::sameShear(const ShearWarp& other) const
{
  return this->Valid == other.Valid && this->Axes == other.Axes && this->Size == other.Size &&
    this->Shear == other.Shear;
}
}
