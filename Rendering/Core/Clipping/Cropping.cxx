// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Clipping/Cropping.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
/// Moves a plane within rounding of a voxel's centre outwards, so that the voxel is inside.
glm::dvec2 widened(const glm::dvec2& planes)
{
  constexpr double rounding = 1e-9;
  return { planes[0] - rounding * (1.0 + std::abs(planes[0])),
    planes[1] + rounding * (1.0 + std::abs(planes[1])) };
}

/// The first integers inside the middle region and beyond it.
std::array<int, 2> boundaries(const glm::dvec2& planes, double shift)
{
  constexpr double limit = 1e6; // beyond any image
  const glm::dvec2 p = widened(planes) + shift;
  const int begin = static_cast<int>(std::ceil(std::clamp(p[0], -limit, limit)));
  const int end = static_cast<int>(std::floor(std::clamp(p[1], -limit, limit))) + 1;
  return { begin, std::max(begin, end) };
}

/// The same for the rays of a perspective image at `depth` from the reference: the first rays.
std::array<int, 2> boundaries(const glm::dvec2& planes, const AxisRays& rays, double depth)
{
  const auto countBefore = [&](auto isBefore)
  {
    const auto end = std::partition_point(rays.at.begin(), rays.at.end(),
      [&](const double& at) { return isBefore(at + rays.slope[&at - rays.at.data()] * depth); });
    return static_cast<int>(end - rays.at.begin());
  };
  const glm::dvec2 p = widened(planes);
  const int begin = countBefore([&](double x) { return x < p[0]; });
  const int end = countBefore([&](double x) { return x <= p[1]; });
  return { begin, std::max(begin, end) };
}

int regionOfSlice(const glm::dvec2& planes, int k)
{
  std::array<int, 2> middle = boundaries(planes, 0.0);
  if (middle[0] == middle[1] && planes[0] <= planes[1])
  {
    middle[0] =
      static_cast<int>(std::floor(std::clamp(0.5 * (planes[0] + planes[1]), -1e6, 1e6) + 0.5));
    middle[1] = middle[0] + 1;
  }
  return k < middle[0] ? 0 : k < middle[1] ? 1 : 2;
}
}

SliceRegions regionsOf(const Cropping& cropping, const ShearWarp& geometry, int k)
{
  const std::array<int, 3>& axes = geometry.axes();
  SliceRegions regions{};
  if (geometry.isPerspective())
  {
    const double depth = k - geometry.reference();
    regions.u = boundaries(cropping.planes[axes[0]], geometry.columns(), depth);
    regions.v = boundaries(cropping.planes[axes[1]], geometry.rows(), depth);
  }
  else
  {
    const glm::dvec2 shift = geometry.position(k);
    regions.u = boundaries(cropping.planes[axes[0]], shift.x);
    regions.v = boundaries(cropping.planes[axes[1]], shift.y);
  }
  const int strides[3] = { 1, 3, 9 };
  const int slice = strides[axes[2]] * regionOfSlice(cropping.planes[axes[2]], k);
  const bool exists = k >= geometry.slices().begin && k < geometry.slices().end;
  for (int j = 0; j < 3 && exists; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int bit = slice + strides[axes[1]] * j + strides[axes[0]] * i;
      regions.rows[j] |= (cropping.flags >> bit & 1u) << i;
    }
  }
  return regions;
}

bool isShown(const Cropping& cropping, const ShearWarp& geometry, const glm::dvec2& at, int k)
{
  const std::array<int, 3>& axes = geometry.axes();
  const int strides[3] = { 1, 3, 9 };
  int bit = strides[axes[2]] * regionOfSlice(cropping.planes[axes[2]], k);
  for (int a = 0; a < 2; ++a)
  {
    const glm::dvec2 planes = widened(cropping.planes[axes[a]]);
    bit += strides[axes[a]] * (at[a] < planes[0] ? 0 : at[a] <= planes[1] ? 1 : 2);
  }
  return cropping.flags >> bit & 1u;
}
}
