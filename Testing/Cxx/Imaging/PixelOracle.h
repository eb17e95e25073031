// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Pixels of parallel views by their definition, from the pixels of the shear image: between the
 * four rays beside a pixel's ray or, in overviews, from the samples in the pixel's area.
 */
#ifndef PixelOracle_h
#define PixelOracle_h

#include "ProjectionTesting.h"

#include "Reductions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace projectiontesting
{
/// What pixels of the shear image are, by brute force.
struct Oracle
{
  reference::ShearGrid grid;
  reference::ShearView view;
  std::vector<unsigned char> meets, hit;
  std::vector<double> values;
};

/// A parallel view in index space: a ray through `corner + x across + y up` runs along `direction`.
struct Rays
{
  glm::dvec3 corner, across, up, direction;
};

/// How much of a ray lies in the box of the outermost voxel centres, the picture's outline;
/// negative if it misses it.
inline double lengthInside(
  const std::array<int, 3>& size, const glm::dvec3& at, const glm::dvec3& along)
{
  double begin = -HUGE_VAL, end = HUGE_VAL;
  for (int a = 0; a < 3; ++a)
  {
    const double thin = size[a] == 1 ? 0.5 : 0.0;
    const double low = (-thin - at[a]) / along[a], high = (size[a] - 1 + thin - at[a]) / along[a];
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return end - begin;
}

/// What a pixel must be: nothing if it must have the background. False if that is open.
struct Expected
{
  bool certain = true;
  bool hit = false;
  double value = 0.0;
  double slack = 0.0; ///< what it may differ by, beside rounding
};

inline Expected expectedPixel(
  const Oracle& oracle, const std::array<int, 3>& size, const Rays& rays, const glm::dvec3& point)
{
  Expected expected;
  const double inside = lengthInside(size, point, rays.direction);
  expected.certain = std::abs(inside) > 1e-5;
  if (inside < 0.0)
  {
    return expected;
  }
  const auto& axes = oracle.grid.axes;
  const double depth = point[axes[2]] - oracle.grid.middle;
  const double pu = point[axes[0]] + oracle.grid.margin[0] + oracle.view.shear[0] * depth;
  const double pv = point[axes[1]] + oracle.grid.margin[1] + oracle.view.shear[1] * depth;
  const int u = static_cast<int>(std::floor(pu)), v = static_cast<int>(std::floor(pv));
  double sum = 0.0, weight = 0.0, lost = 0.0;
  for (int n = 0; n < 4; ++n)
  {
    const int i = u + n % 2, j = v + n / 2;
    const double w = std::abs(u + 1 - n % 2 - pu) * std::abs(v + 1 - n / 2 - pv);
    if (i < 0 || j < 0 || i >= oracle.grid.width || j >= oracle.grid.height)
    {
      continue;
    }
    const std::size_t pixel = std::size_t(j) * oracle.grid.width + i;
    if (oracle.meets[pixel])
    {
      (oracle.hit[pixel] ? weight : lost) += w;
      sum += oracle.hit[pixel] ? w * oracle.values[pixel] : 0.0;
    }
  }
  expected.certain = expected.certain && std::abs(lost - 0.5) > 1e-5 && weight > 1e-5;
  expected.hit = weight > 1e-5 && lost <= 0.5;
  expected.value = sum / weight;
  return expected;
}

/// How many voxels a pixel spans across its ray, in the direction of the largest span: the larger
/// singular value of the map from the screen to the plane across the rays of index space.
inline double voxelsPerPixel(const Rays& rays)
{
  const glm::dvec3 ray = glm::normalize(rays.direction);
  const glm::dvec3 across = rays.across - glm::dot(rays.across, ray) * ray;
  const glm::dvec3 up = rays.up - glm::dot(rays.up, ray) * ray;
  const double squares = glm::dot(across, across) + glm::dot(up, up);
  const double area = glm::length(glm::cross(across, up));
  return std::sqrt(
    0.5 * (squares + std::sqrt(std::max(squares * squares - 4.0 * area * area, 0.0))));
}

/// A pixel of an overview: of the samples in its area, row by row, the extremum or the mean. Open
/// if the volume's outline may hide them.
class Area
{
public:
  Area(
    const Oracle& oracle, const std::array<int, 3>& size, const Rays& rays, const glm::dvec3& point)
    : Source(oracle),
      Size(size),
      Direction(rays.direction)
  {
    for (int n = 0; n < 4; ++n)
    {
      const double x = n == 1 || n == 2 ? 0.5 : -0.5, y = n < 2 ? -0.5 : 0.5;
      this->Corners[n] = this->shearPixel(point + x * rays.across + y * rays.up);
    }
  }

  Expected expected(vtkSplattingMIPProjection* filter)
  {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const glm::dvec2& corner : this->Corners)
    {
      low = std::min(low, corner.y);
      high = std::max(high, corner.y);
    }
    for (const double v : this->between(low, high))
    {
      this->readRow(v);
    }
    Expected result;
    result.certain = this->IsCertain && this->IsShown;
    result.hit = true;
    if (result.certain)
    {
      const auto ends = std::minmax_element(this->Values.begin(), this->Values.end());
      const double sum = std::accumulate(this->Values.begin(), this->Values.end(), 0.0);
      const int blend = filter->GetBlendMode();
      result.value = blend == vtkSplattingMIPProjection::MINIMUM_INTENSITY_BLEND ? *ends.first
        : blend == vtkSplattingMIPProjection::AVERAGE_INTENSITY_BLEND
        ? sum / double(this->Values.size())
        : *ends.second;
    }
    return result;
  }

private:
  glm::dvec2 shearPixel(const glm::dvec3& point) const
  {
    const reference::ShearGrid& grid = this->Source.grid;
    const double depth = point[grid.axes[2]] - grid.middle;
    return { point[grid.axes[0]] + grid.margin[0] + this->Source.view.shear[0] * depth,
      point[grid.axes[1]] + grid.margin[1] + this->Source.view.shear[1] * depth };
  }

  /// The whole numbers between two, or the middle if there are none.
  std::vector<double> between(double low, double high)
  {
    std::vector<double> result;
    for (double n = std::ceil(low); n <= high; ++n)
    {
      result.push_back(n);
    }
    for (const double end : { low, high })
    {
      this->IsCertain &= std::abs(end - std::round(end)) > 1e-5;
    }
    return result.empty() ? std::vector<double>{ 0.5 * (low + high) } : result;
  }

  void readRow(double v)
  {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int n = 0; n < 4; ++n)
    {
      const glm::dvec2 a = this->Corners[n], b = this->Corners[(n + 1) % 4];
      const double t = (v - a.y) / (b.y - a.y);
      if (t >= 0.0 && t <= 1.0)
      {
        low = std::min(low, a.x + t * (b.x - a.x));
        high = std::max(high, a.x + t * (b.x - a.x));
      }
    }
    for (const double u : this->between(low, high))
    {
      this->readPoint(u, v);
    }
  }

  void readPoint(double u, double v)
  {
    const reference::ShearGrid& grid = this->Source.grid;
    double sum = 0.0;
    for (int n = 0; n < 4; ++n)
    {
      const int i = int(std::floor(u)) + n % 2, j = int(std::floor(v)) + n / 2;
      const double weight = (1.0 - std::abs(u - i)) * (1.0 - std::abs(v - j));
      const std::size_t pixel = std::size_t(j) * grid.width + i;
      if (weight > 0.0)
      {
        if (i < 0 || j < 0 || i >= grid.width || j >= grid.height || !this->Source.hit[pixel])
        {
          return;
        }
        sum += weight * this->Source.values[pixel];
      }
    }
    this->Values.push_back(sum);
    glm::dvec3 point;
    point[grid.axes[0]] = u - grid.margin[0];
    point[grid.axes[1]] = v - grid.margin[1];
    point[grid.axes[2]] = grid.middle;
    this->IsShown |= u == std::floor(u) && v == std::floor(v) &&
      lengthInside(this->Size, point, this->Direction) > 1e-5;
  }

  const Oracle& Source;
  const std::array<int, 3> Size;
  const glm::dvec3 Direction;
  glm::dvec2 Corners[4];
  std::vector<double> Values;
  bool IsCertain = true, IsShown = false;
};
}

#endif
