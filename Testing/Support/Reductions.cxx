// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reductions.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace reference
{

namespace
{
constexpr double Rounding = 1e-9;

/**
 * Whether there is an integer in [low, high], and otherwise the integer nearest to its middle.
 */
struct Integers
{
  bool any;
  double nearest;

  Integers(double low, double high)
    : any(std::ceil(low) <= high),
      nearest(std::floor(0.5 * (low + high) + 0.5))
  {
  }
};

/**
 * The rays of a parallel view as if they came from an eye.
 */
PerspectiveRays raysOf(const ShearGrid& grid, const ShearView& view)
{
  PerspectiveRays rays;
  rays.axes = grid.axes;
  rays.size = grid.size;
  rays.start = grid.middle;
  rays.eye = -std::numeric_limits<double>::infinity();
  const int pixels[2] = { grid.width, grid.height };
  for (int a = 0; a < 2; ++a)
  {
    for (int pixel = 0; pixel < pixels[a]; ++pixel)
    {
      rays.at[a].push_back(static_cast<double>(pixel) - grid.margin[a]);
      rays.slope[a].push_back(-view.shear[a]);
    }
  }
  return rays;
}
} // namespace

//------------------------------------------------------------------------------
RayCutter::RayCutter(const ShearGrid& grid, const ShearView& view, const RayCuts& cuts)
  : RayCutter(raysOf(grid, view), cuts)
{
}

//------------------------------------------------------------------------------
RayCutter::RayCutter(const PerspectiveRays& rays, const RayCuts& cuts) : Rays(rays), Cuts(cuts) {}

//------------------------------------------------------------------------------
std::array<double, 3> RayCutter::pointOfRay(int u, int v, double z) const
{
  std::array<double, 3> point;
  point[this->Rays.axes[0]] = this->Rays.position(0, u, z);
  point[this->Rays.axes[1]] = this->Rays.position(1, v, z);
  point[this->Rays.axes[2]] = z;
  return point;
}

//------------------------------------------------------------------------------
RayCutter::Line RayCutter::alongRay(const std::array<double, 4>& halfSpace, int u, int v) const
{
  const auto at = [&](double z)
  {
    const std::array<double, 3> p = this->pointOfRay(u, v, z);
    return halfSpace[0] * p[0] + halfSpace[1] * p[1] + halfSpace[2] * p[2] + halfSpace[3];
  };
  const double slope = halfSpace[this->Rays.axes[2]] +
    halfSpace[this->Rays.axes[0]] * this->Rays.slope[0][u] +
    halfSpace[this->Rays.axes[1]] * this->Rays.slope[1][v];
  return { at(0.0), slope };
}

//------------------------------------------------------------------------------
bool RayCutter::inHalfSpaces(int u, int v, int slice) const
{
  const double infinity = std::numeric_limits<double>::infinity();
  double near = this->Rays.reversed ? -infinity : this->Rays.eye;
  double far = this->Rays.reversed ? this->Rays.eye : infinity;
  for (const std::array<double, 4>& halfSpace : this->Cuts.halfSpaces)
  {
    const Line line = this->alongRay(halfSpace, u, v);
    const double z = -line.offset / line.slope;
    if (line.slope == 0.0 && line.offset < 0.0)
    {
      return false;
    }
    near = line.slope > 0.0 ? std::max(near, z) : near;
    far = line.slope < 0.0 ? std::min(far, z) : far;
  }
  const double low = near - Rounding * (1.0 + std::abs(near));
  const double high = far + Rounding * (1.0 + std::abs(far));
  if (near >= far || Integers(low, high).any)
  {
    return slice >= low && slice <= high;
  }
  return slice == Integers(low, high).nearest;
}

//------------------------------------------------------------------------------
int RayCutter::region(int axis, double position) const
{
  double low = this->Cuts.planes[axis][0], high = this->Cuts.planes[axis][1];
  low -= Rounding * (1.0 + std::abs(low));
  high += Rounding * (1.0 + std::abs(high));
  if (axis == this->Rays.axes[2] && low <= high && !Integers(low, high).any)
  {
    low = high = Integers(low, high).nearest;
  }
  return position < low ? 0 : position <= high ? 1 : 2;
}

//------------------------------------------------------------------------------
bool RayCutter::inRegions(int u, int v, int slice) const
{
  const std::array<double, 3> point = this->pointOfRay(u, v, slice);
  const int number =
    this->region(0, point[0]) + 3 * this->region(1, point[1]) + 9 * this->region(2, point[2]);
  return (this->Cuts.regions >> number & 1u) != 0;
}

//------------------------------------------------------------------------------
Outcomes<double> mean(const CutRay<double>& ray, double low, double high, double error)
{
  long double sum = 0.0;
  int count = 0;
  std::vector<double> open;
  for (const auto& sample : ray.samples)
  {
    const double x = sample.value;
    if (x >= low + error && x <= high - error)
    {
      sum += x;
      ++count;
    }
    else if (x >= low - error && x <= high + error)
    {
      open.push_back(x);
    }
  }
  // Every subset of the samples that are within the range or not.
  Outcomes<double> outcomes;
  if (open.size() > 16)
  {
    throw std::length_error("Too many samples are too close to the ends of the range.");
  }
  for (unsigned subset = 0; subset < 1u << open.size(); ++subset)
  {
    long double subsetSum = sum;
    int subsetCount = count;
    for (std::size_t n = 0; n < open.size(); ++n)
    {
      subsetSum += (subset >> n & 1u) ? open[n] : 0.0;
      subsetCount += (subset >> n & 1u);
    }
    outcomes.push_back(
      { subsetCount > 0, subsetCount > 0 ? static_cast<double>(subsetSum / subsetCount) : 0.0 });
  }
  return outcomes;
}

//------------------------------------------------------------------------------
Outcomes<double> depthShaded(
  const CutRay<double>& ray, double base, double ambient, double changeRate)
{
  Outcome<double> result = { false, 0.0 };
  for (const auto& sample : ray.samples)
  {
    const double depth = static_cast<double>(sample.number) / ray.slices;
    const double factor = ambient + (1.0 - depth) * changeRate;
    const double shaded = base + (sample.value - base) * factor;
    result.value = !result.hit || shaded > result.value ? shaded : result.value;
    result.hit = true;
  }
  return { result };
}

} // namespace reference
