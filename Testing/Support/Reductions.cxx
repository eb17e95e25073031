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
} // namespace

//------------------------------------------------------------------------------
bool RayCutter::inHalfSpaces(int u, int v, int slice) const
{
  Stretch<double> ray = this->Rays.beforeEye();
  const glm::dvec3 from = this->Rays.point(u, v, 0.0), direction = this->Rays.direction(u, v);
  for (const std::array<double, 4>& h : this->Cuts.halfSpaces)
  {
    const glm::dvec3 normal(h[0], h[1], h[2]);
    ray.cut(glm::dot(normal, from) + h[3], glm::dot(normal, direction));
  }
  const double low = ray.begin - Rounding * (1.0 + std::abs(ray.begin));
  const double high = ray.end + Rounding * (1.0 + std::abs(ray.end));
  if (ray.length() <= 0.0 || Integers(low, high).any)
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
  const glm::dvec3 point = this->Rays.point(u, v, slice);
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
