// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The trilinear field of volumes with NaN and hidden voxels, of which cells with such a voxel are
 * left out: what a ray meets that is known but for a small displacement.
 */
#ifndef FieldWithNaN_h
#define FieldWithNaN_h

#include "CoreTesting.h"
#include "FieldMaximum.h"
#include "Volume/VoxelCopies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace coretesting
{
/// A ray beside another one.
inline reference::FieldRay displaced(reference::FieldRay ray, double x, double y)
{
  ray.at[0] += x;
  ray.at[1] += y;
  return ray;
}

/// Whether all voxels about a point of a ray are numbers.
inline bool isInNumbers(
  const reference::Volume<double>& field, const reference::FieldRay& ray, double z)
{
  double sum = 0.0;
  for (int n = 0; n < 8; ++n)
  {
    std::array<int, 3> voxel;
    for (int a = 0; a < 3; ++a)
    {
      const double at = a == 2 ? z : ray.at[a] + ray.slope[a] * (z - ray.start);
      const int axis = ray.axes[a];
      voxel[axis] =
        std::clamp(static_cast<int>(std::floor(at)) + (n >> a & 1), 0, field.size[axis] - 1);
    }
    sum += field.at(voxel);
  }
  return std::isfinite(sum);
}

/// Calls take(from, to) for the parts of rays between which none of them enters another cell.
template <class Take>
void forCells(const std::vector<reference::FieldRay>& rays, double from, double to, Take&& take)
{
  std::vector<double> depths{ from, to };
  for (const reference::FieldRay& ray : rays)
  {
    for (int a = 0; a < 3; ++a)
    {
      const double start = a < 2 ? ray.at[a] - ray.slope[a] * ray.start : 0.0;
      const double slope = a < 2 ? ray.slope[a] : 1.0;
      const double p = start + slope * from, q = start + slope * to;
      for (int n = static_cast<int>(std::ceil(std::min(p, q))); n < std::max(p, q); ++n)
      {
        depths.push_back(std::clamp((n - start) / slope, from, to));
      }
    }
  }
  std::sort(depths.begin(), depths.end());
  for (std::size_t n = 0; n + 1 < depths.size(); ++n)
  {
    take(depths[n], depths[n + 1]);
  }
}

/// Depths next to where cells meet are left out: which cell they are in is a matter of rounding.
constexpr double NextToFaces = 1e-9;

/// The largest value of the field in cells of numbers on a ray.
inline double mostInNumbers(
  const reference::Volume<double>& field, const reference::FieldRay& ray, double from, double to)
{
  return to - from > 2.0 * NextToFaces
    ? reference::fieldMaximum(field, ray, from + NextToFaces, to - NextToFaces)
    : -std::numeric_limits<double>::infinity();
}

/**
 * No less, but for changeNearby(), than what a ray meets that is displaced by no more than a way
 * across the principal axis. What it meets in a cell, one of nine rays that are displaced twice as
 * far, or not at all, along each axis meets nearby in the same cell.
 */
inline double mostNearby(const reference::Volume<double>& field, const reference::FieldRay& ray,
  double from, double to, double way)
{
  double most = -std::numeric_limits<double>::infinity();
  for (int n = 0; n < 9; ++n)
  {
    const auto beside = displaced(ray, 2.0 * (n % 3 - 1) * way, 2.0 * (n / 3 - 1) * way);
    forCells({ beside }, from, to,
      [&](double begin, double end)
      {
        if (isInNumbers(field, beside, 0.5 * (begin + end)))
        {
          most = std::max(most, mostInNumbers(field, beside, begin, end));
        }
      });
  }
  return most;
}

/**
 * No more, but for changeNearby(): what the ray meets in cells of numbers that it leaves under no
 * such displacement. -infinity if there is nothing.
 */
inline double leastNearby(const reference::Volume<double>& field, const reference::FieldRay& ray,
  double from, double to, double way)
{
  double most = -std::numeric_limits<double>::infinity();
  std::vector<reference::FieldRay> corners;
  for (int n = 0; n < 4; ++n)
  {
    corners.push_back(displaced(ray, n % 2 ? way : -way, n / 2 ? way : -way));
  }
  std::vector<reference::FieldRay> all = corners;
  all.push_back(ray);
  forCells(all, from, to,
    [&](double begin, double end)
    {
      if (std::all_of(corners.begin(), corners.end(),
            [&](const reference::FieldRay& corner)
            { return isInNumbers(field, corner, 0.5 * (begin + end)); }))
      {
        most = std::max(most, mostInNumbers(field, ray, begin, end));
      }
    });
  return most;
}

/// How much the field changes over these ways.
inline double changeNearby(const glm::dvec3& steps, const reference::FieldRay& ray, double way)
{
  const double across = steps[ray.axes[0]] + steps[ray.axes[1]];
  return 3.0 * way * across + NextToFaces * (across + steps[ray.axes[2]]);
}

/// The most that neighbours along each axis differ by, NaN aside.
inline glm::dvec3 stepsOf(const reference::Volume<double>& volume)
{
  glm::dvec3 steps(0.0);
  std::array<int, 3> p;
  for (p[2] = 0; p[2] < volume.size[2]; ++p[2])
  {
    for (p[1] = 0; p[1] < volume.size[1]; ++p[1])
    {
      for (p[0] = 0; p[0] < volume.size[0]; ++p[0])
      {
        for (int a = 0; a < 3; ++a)
        {
          std::array<int, 3> next = p;
          if (++next[a] < volume.size[a])
          {
            steps[a] = std::max(steps[a], std::abs(volume.at(next) - volume.at(p)));
          }
        }
      }
    }
  }
  return steps;
}

/// Flags for a few voxels, or for a box of them.
inline std::vector<unsigned char> anyHidden(
  const std::array<int, 3>& size, reference::Random& random)
{
  const bool isBox = random.uniform(0, 1), isMany = random.uniform(0, 1);
  std::array<int, 3> first, last, p;
  for (int a = 0; a < 3; ++a)
  {
    first[a] = random.uniform(0, size[a] - 1);
    last[a] = random.uniform(first[a], size[a] - 1);
  }
  std::vector<unsigned char> hidden;
  for (p[2] = 0; p[2] < size[2]; ++p[2])
  {
    for (p[1] = 0; p[1] < size[1]; ++p[1])
    {
      for (p[0] = 0; p[0] < size[0]; ++p[0])
      {
        const bool isInBox = p[0] >= first[0] && p[1] >= first[1] && p[2] >= first[2] &&
          p[0] <= last[0] && p[1] <= last[1] && p[2] <= last[2];
        const bool isOneOf = random.uniform(0, isMany ? 15 : 99) == 0;
        hidden.push_back(isBox ? isInBox : isOneOf);
      }
    }
  }
  return hidden;
}

/// The volume with some voxels hidden, which makes them NaN, in the type of averages.
template <class T>
reference::Volume<splatting::Accumulator<T>> withHidden(
  const reference::Volume<T>& from, reference::Random& random)
{
  reference::Volume<splatting::Accumulator<T>> volume;
  volume.size = from.size;
  volume.voxels.resize(from.voxels.size());
  const auto hidden = anyHidden(from.size, random);
  splatting::hide({ from.voxels.data(), splatting::scalarTypeOf<T>(), 1 }, hidden.data(),
    static_cast<std::ptrdiff_t>(hidden.size()), volume.voxels.data());
  return volume;
}

/// The least and the largest voxel, NaN aside.
inline glm::dvec2 rangeOfNumbers(const reference::Volume<double>& volume)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  glm::dvec2 range(infinite, -infinite);
  for (const double voxel : volume.voxels)
  {
    range[0] = std::min(range[0], std::isnan(voxel) ? range[0] : voxel);
    range[1] = std::max(range[1], std::isnan(voxel) ? range[1] : voxel);
  }
  return range;
}
}

#endif
