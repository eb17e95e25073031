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
#include "ScreenPixels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace projectiontesting
{
/// The rays of a shear image, each reduced sample by sample.
struct Oracle
{
  reference::ImageRays rays;
  std::vector<reference::ReducedRay> reduced;

  const reference::ReducedRay& at(int u, int v) const
  {
    return this->reduced[std::size_t(v) * this->rays.width() + u];
  }
};

/// A parallel view in index space: a ray through `corner + x across + y up` runs along `direction`.
struct Rays
{
  glm::dvec3 corner, across, up, direction;
};

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

/// A shear image as the source of an AreaReader.
struct OverviewSource
{
  const Oracle& oracle;
  int width, height;
  glm::dmat3 toShear, toScreen;

  OverviewSource(const Oracle& shear, const Rays& rays)
    : oracle(shear),
      width(shear.rays.width()),
      height(shear.rays.height())
  {
    const glm::dvec2 corner = shear.rays.pixelOf(rays.corner);
    this->toShear = { { shear.rays.pixelOf(rays.corner + rays.across) - corner, 0.0 },
      { shear.rays.pixelOf(rays.corner + rays.up) - corner, 0.0 }, { corner, 1.0 } };
    this->toScreen = glm::inverse(this->toShear);
  }
  bool covers(int u, int v) const
  {
    return u >= 0 && v >= 0 && u < this->width && v < this->height && this->oracle.at(u, v).hit;
  }
  double value(int u, int v) const { return this->oracle.at(u, v).value; }
  bool isShown(int u, int v) const
  {
    const reference::ImageRays& rays = this->oracle.rays;
    return reference::lengthInside(rays, rays.point(u, v, rays.start)) > 1e-5;
  }
};

/// A pixel of an overview: the extremum or the mean of the samples in its area. It is uncertain if
/// the outline of the volume may hide the samples.
inline reference::ExpectedPixel ofArea(
  const OverviewSource& source, int x, int y, vtkSplattingMIPProjection* filter)
{
  reference::Reading reading;
  reference::AreaReader<OverviewSource>(source, 1e-5).read({ x, y }, reading);
  reference::ExpectedPixel result;
  result.isCertain = reading.isCertain && reading.hasSample;
  result.isHit = true;
  if (result.isCertain)
  {
    const auto ends = std::minmax_element(reading.values.begin(), reading.values.end());
    const double sum = std::accumulate(reading.values.begin(), reading.values.end(), 0.0);
    const int blend = filter->GetBlendMode();
    result.value = blend == vtkSplattingMIPProjection::MINIMUM_INTENSITY_BLEND ? *ends.first
      : blend == vtkSplattingMIPProjection::AVERAGE_INTENSITY_BLEND
      ? sum / double(reading.values.size())
      : *ends.second;
  }
  return result;
}
}

#endif
