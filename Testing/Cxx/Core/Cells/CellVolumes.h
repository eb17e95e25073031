// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Volumes in which thin structures lie before and behind others.
 */
#ifndef CellVolumes_h
#define CellVolumes_h

#include "CellTesting.h"

namespace celltesting
{
/// Voxel values as functions of places, from 0 to 1 of the type's largest value.
template <class T, class F>
reference::Volume<T> volumeOf(const std::array<int, 3>& size, F&& f)
{
  using Limits = std::numeric_limits<T>;
  const double largest = Limits::is_integer ? 0.9 * static_cast<double>(Limits::max()) : 1.0;
  reference::Volume<T> volume(size);
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i)
      {
        volume.at(i, j, k) = static_cast<T>(largest * f(glm::dvec3(i, j, k)));
      }
    }
  }
  return volume;
}

/// A vessel with a Gaussian profile.
struct Vessel
{
  glm::dvec3 point, direction;
  double width = 1.0, peak = 1.0; ///< full width at half maximum

  double at(const glm::dvec3& p) const
  {
    const glm::dvec3 q = p - this->point;
    const glm::dvec3 beside = q - glm::dot(q, this->direction) * this->direction;
    const double r = glm::length(beside) / this->width;
    return this->peak * std::exp(-4.0 * std::log(2.0) * r * r);
  }
};

/// A plate of constant value between two planes.
struct Plate
{
  glm::dvec3 normal;
  double from = 0.0, to = 0.0, value = 0.0;

  double at(const glm::dvec3& p) const
  {
    const double d = glm::dot(p, this->normal);
    return d >= this->from && d <= this->to ? this->value : 0.0;
  }
};

/// Across the view, or oblique to it.
inline glm::dvec3 vesselDirection(const glm::dvec3& view, bool across, Random& random)
{
  const glm::dvec3 side =
    glm::normalize(glm::cross(view, coretesting::anyDirection(random) + 1e-3));
  return across ? side : glm::normalize(side + random.uniform(0.3, 2.0) * view);
}
}

#endif
