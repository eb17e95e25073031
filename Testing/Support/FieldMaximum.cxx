// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FieldMaximum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference
{
namespace
{
std::array<double, 3> pointOnRay(const FieldRay& ray, double z)
{
  std::array<double, 3> point;
  point[ray.axes[2]] = z;
  for (int a = 0; a < 2; ++a)
  {
    point[ray.axes[a]] = ray.at[a] + ray.slope[a] * (z - ray.start);
  }
  return point;
}

double fieldOnRay(const Volume<double>& volume, const FieldRay& ray, double z)
{
  return fieldAt(volume, pointOnRay(ray, z));
}
}

std::array<double, 2> depthsInField(const std::array<int, 3>& volumeSize, const FieldRay& ray,
  FieldDomain domain, double near, double far)
{
  for (int a = 0; a < 3; ++a)
  {
    const int n = volumeSize[ray.axes[a]];
    const double low = domain == FieldDomain::Boxes || n == 1 ? -0.5 : 0.0, high = n - 1 - low;
    if (a == 2)
    {
      near = std::max(near, low);
      far = std::min(far, high);
    }
    else if (ray.slope[a] == 0.0)
    {
      far = ray.at[a] >= low && ray.at[a] <= high ? far : near - 1.0;
    }
    else
    {
      const double p = ray.start + (low - ray.at[a]) / ray.slope[a];
      const double q = ray.start + (high - ray.at[a]) / ray.slope[a];
      near = std::max(near, std::min(p, q));
      far = std::min(far, std::max(p, q));
    }
  }
  return { near, far };
}

double fieldAt(const Volume<double>& volume, const std::array<double, 3>& point)
{
  double sum = 0.0;
  for (int n = 0; n < 8; ++n)
  {
    double weight = 1.0;
    std::array<int, 3> voxel;
    for (int a = 0; a < 3; ++a)
    {
      const double below = std::floor(point[a]), fraction = point[a] - below;
      const int next = n >> a & 1;
      weight *= next ? fraction : 1.0 - fraction;
      voxel[a] = std::clamp(static_cast<int>(below) + next, 0, volume.size[a] - 1);
    }
    sum += weight > 0.0 ? weight * volume.at(voxel) : 0.0;
  }
  return sum;
}

namespace
{
/// The same where no coordinate of the ray passes a whole number on its way.
double maximumInCell(const Volume<double>& volume, const FieldRay& ray, double near, double far)
{
  constexpr int steps = 64;
  const auto depth = [&](double n) { return near + (far - near) * n / steps; };
  std::array<double, steps + 1> values;
  for (int n = 0; n <= steps; ++n)
  {
    values[n] = fieldOnRay(volume, ray, depth(n));
  }
  double largest = values.front();
  for (int n = 0; n <= steps; ++n)
  {
    const int before = std::max(n - 1, 0), after = std::min(n + 1, steps);
    if (values[n] < values[before] || values[n] < values[after])
    {
      continue;
    }
    // Thirds that cannot hold the maximum are given up.
    double low = depth(before), high = depth(after);
    for (int turn = 0; turn < 60; ++turn)
    {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      const bool rises = fieldOnRay(volume, ray, a) < fieldOnRay(volume, ray, b);
      (rises ? low : high) = rises ? a : b;
    }
    largest = std::max({ largest, values[n], fieldOnRay(volume, ray, 0.5 * (low + high)) });
  }
  return largest;
}
}

namespace
{
/// Whether one of the voxels about a point of the ray is larger, or no number: no mean of them is
/// larger than they are.
bool mayExceed(const Volume<double>& volume, const FieldRay& ray, double z, double value)
{
  const std::array<double, 3> point = pointOnRay(ray, z);
  for (int n = 0; n < 8; ++n)
  {
    std::array<int, 3> voxel;
    for (int a = 0; a < 3; ++a)
    {
      voxel[a] =
        std::clamp(static_cast<int>(std::floor(point[a])) + (n >> a & 1), 0, volume.size[a] - 1);
    }
    if (!(volume.at(voxel) <= value))
    {
      return true;
    }
  }
  return false;
}
}

double fieldMaximum(const Volume<double>& volume, const FieldRay& ray, double near, double far)
{
  std::vector<double> depths{ near, far };
  for (int k = static_cast<int>(std::ceil(near)); k < far; ++k)
  {
    depths.push_back(k);
  }
  for (int a = 0; a < 2; ++a)
  {
    const double p = ray.at[a] + ray.slope[a] * (near - ray.start);
    const double q = ray.at[a] + ray.slope[a] * (far - ray.start);
    for (int n = static_cast<int>(std::ceil(std::min(p, q))); n < std::max(p, q); ++n)
    {
      depths.push_back(std::clamp(ray.start + (n - ray.at[a]) / ray.slope[a], near, far));
    }
  }
  std::sort(depths.begin(), depths.end());
  double largest = fieldOnRay(volume, ray, near);
  for (std::size_t n = 0; n + 1 < depths.size(); ++n)
  {
    if (mayExceed(volume, ray, 0.5 * (depths[n] + depths[n + 1]), largest))
    {
      largest = std::max(largest, maximumInCell(volume, ray, depths[n], depths[n + 1]));
    }
  }
  return largest;
}

namespace
{
/// Where a ray is along an axis of the volume: place + slope z.
struct AxisOfRay
{
  double place, slope;
};

std::array<AxisOfRay, 3> axesOf(const FieldRay& ray)
{
  std::array<AxisOfRay, 3> axes;
  for (int a = 0; a < 2; ++a)
  {
    axes[ray.axes[a]] = { ray.at[a] - ray.slope[a] * ray.start, ray.slope[a] };
  }
  axes[ray.axes[2]] = { 0.0, 1.0 };
  return axes;
}

/// Cuts a range of depths to where offset + slope z >= 0.
void cutRange(std::array<double, 2>& range, double offset, double slope)
{
  if (slope > 0.0)
  {
    range[0] = std::max(range[0], -offset / slope);
  }
  else if (slope < 0.0)
  {
    range[1] = std::min(range[1], -offset / slope);
  }
  else if (offset < 0.0)
  {
    range[1] = -HUGE_VAL;
  }
}

bool isShown(const std::array<AxisOfRay, 3>& axes, const RayCuts& cuts, double z)
{
  int region = 0;
  for (int a = 0, factor = 1; a < 3; ++a, factor *= 3)
  {
    const double at = axes[a].place + axes[a].slope * z;
    region += factor * (at < cuts.planes[a][0] ? 0 : at <= cuts.planes[a][1] ? 1 : 2);
  }
  return (cuts.regions >> region & 1u) != 0;
}
}

CutMaximum cutMaximum(const Volume<double>& volume, const FieldRay& ray, FieldDomain domain,
  double near, double far, const RayCuts& cuts)
{
  constexpr double margin = 1e-5;
  const std::array<AxisOfRay, 3> axes = axesOf(ray);
  std::array<double, 2> range = depthsInField(volume.size, ray, domain, near, far);
  for (const std::array<double, 4>& h : cuts.halfSpaces)
  {
    double offset = h[3], slope = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      offset += h[a] * axes[a].place;
      slope += h[a] * axes[a].slope;
    }
    cutRange(range, offset, slope);
  }
  std::vector<double> depths{ range[0], range[1] };
  for (int a = 0; a < 3; ++a)
  {
    for (const double plane : cuts.planes[a])
    {
      const double z = (plane - axes[a].place) / axes[a].slope;
      if (z > range[0] && z < range[1])
      {
        depths.push_back(z);
      }
    }
  }
  std::sort(depths.begin(), depths.end());
  CutMaximum maximum;
  bool isNear = false; // whether there may be something
  maximum.low = maximum.high = -HUGE_VAL;
  for (std::size_t n = 0; n + 1 < depths.size(); ++n)
  {
    const double from = depths[n], to = depths[n + 1];
    if (range[1] - range[0] <= -2.0 * margin || !isShown(axes, cuts, 0.5 * (from + to)))
    {
      continue;
    }
    isNear = true;
    maximum.high = std::max(maximum.high, fieldMaximum(volume, ray, from - margin, to + margin));
    if (to - from > 2.0 * margin)
    {
      maximum.isHit = true;
      maximum.low = std::max(maximum.low, fieldMaximum(volume, ray, from + margin, to - margin));
    }
  }
  maximum.isCertain = maximum.isHit == isNear;
  return maximum;
}

FieldRay fieldRay(const std::array<int, 3>& volumeSize, const ShearView& view, int u, int v)
{
  const ShearGrid grid = makeShearGrid(volumeSize, view);
  return { grid.axes, { double(u) - grid.margin[0], double(v) - grid.margin[1] },
    { -view.shear[0], -view.shear[1] }, grid.middle };
}

FieldRay fieldRay(const PerspectiveRays& rays, int u, int v)
{
  return { rays.axes, { rays.at[0][u], rays.at[1][v] }, { rays.slope[0][u], rays.slope[1][v] },
    rays.start };
}
}
