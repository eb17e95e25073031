// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The points at which a pixel of the screen reads a shear image whose pixels are narrower: the
 * samples in its area, row by row. If the area is between two rows, the row halfway between its
 * lowest and its highest corner is interpolated instead. If a row has no sample in the area, it is
 * interpolated at the middle of the part that lies in the area. Every sample is therefore in the
 * area of some pixel.
 */
#ifndef splattingPixelArea_h
#define splattingPixelArea_h

#include "Splat/Projection/ShearImage.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace splatting
{
/// Points along a row or a column of an image, a sample apart.
struct AreaPoints
{
  double first;
  int count;
};

/// The samples from `low` to `high`, or the middle if there are none.
inline AreaPoints pointsBetween(double low, double high)
{
  // Samples on the line between two areas are in both, whatever the rounding.
  constexpr double rounding = 1e-9;
  const double first = std::ceil(low - rounding), last = std::floor(high + rounding);
  return first <= last ? AreaPoints{ first, static_cast<int>(last - first) + 1 }
                       : AreaPoints{ 0.5 * (low + high), low <= high };
}

/// A convex part of a shear image, its corners in order; none if it is empty.
struct PixelArea
{
  std::array<glm::dvec2, 8> corners;
  int count = 0;

  /// Calls f(u, v) for the points that are read.
  template <class F>
  void forPoints(F&& f) const
  {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int n = 0; n < this->count; ++n)
    {
      low = std::min(low, this->corners[n].y);
      high = std::max(high, this->corners[n].y);
    }
    const AreaPoints rows = pointsBetween(low, high);
    for (int row = 0; row < rows.count; ++row)
    {
      const double v = rows.first + row;
      const AreaPoints columns = this->columnsAt(std::clamp(v, low, high));
      for (int n = 0; n < columns.count; ++n)
      {
        f(columns.first + n, v);
      }
    }
  }

private:
  /// At a height between the lowest and the highest corner.
  AreaPoints columnsAt(double v) const
  {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int edge = 0; edge < this->count; ++edge)
    {
      const glm::dvec2 &a = this->corners[edge], &b = this->corners[(edge + 1) % this->count];
      if (std::min(a.y, b.y) <= v && v <= std::max(a.y, b.y))
      {
        const double u = a.y == b.y ? a.x : a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x);
        low = std::min(low, u);
        high = std::max(high, u);
      }
    }
    return pointsBetween(low, high);
  }
};

/// The part of the area of viewport pixel (x, y) that is in the image, enlarged by one sample on
/// each side. The rest is omitted: in perspective views it may extend behind the eye.
inline PixelArea areaOf(const ShearWarp& geometry, double x, double y)
{
  const glm::dmat3& m = geometry.screenToShear();
  std::array<glm::dvec3, 4> quadrangle{ glm::dvec3(x - 0.5, y - 0.5, 1.0),
    { x + 0.5, y - 0.5, 1.0 }, { x + 0.5, y + 0.5, 1.0 }, { x - 0.5, y + 0.5, 1.0 } };
  const std::array<glm::dvec3, 4> sides{ glm::dvec3(1.0, 0.0, 1.0), { 0.0, 1.0, 1.0 },
    { -1.0, 0.0, geometry.width() }, { 0.0, -1.0, geometry.height() } };
  bool isInside = true;
  for (glm::dvec3& corner : quadrangle)
  {
    corner = m * corner;
    for (const glm::dvec3& side : sides)
    {
      isInside = isInside && glm::dot(side, corner) > 0.0;
    }
  }
  PixelArea area;
  const auto add = [&](const glm::dvec3& corner)
  { area.corners[area.count++] = glm::dvec2(corner) / corner.z; };
  if (isInside)
  {
    std::for_each(quadrangle.begin(), quadrangle.end(), add);
    return area;
  }
  std::vector<glm::dvec3> rest(quadrangle.begin(), quadrangle.end());
  for (const glm::dvec3& side : sides)
  {
    rest = clipped(rest, side);
  }
  // Rounding may duplicate corners on sides.
  rest.resize(std::min(rest.size(), area.corners.size()));
  std::for_each(rest.begin(), rest.end(), add);
  return area;
}

/// An image interpolated bilinearly at a point. NaN if one of the samples does not exist.
template <class T>
Accumulator<T> interpolatedAt(const ShearImage& image, const T* pixels, double u, double v)
{
  using A = Accumulator<T>;
  const auto sample = [&](int i, int j)
  {
    return image.covers(i, j) ? static_cast<A>(pixels[std::ptrdiff_t(j) * image.width + i])
                              : std::numeric_limits<A>::quiet_NaN();
  };
  const auto between = [](A a, double share, auto&& b)
  { return share == 0.0 ? a : static_cast<A>((1.0 - share) * a + share * b()); };
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const auto inRow = [&](int row)
  { return between(sample(i, row), u - i, [&] { return sample(i + 1, row); }); };
  return between(inRow(j), v - j, [&] { return inRow(j + 1); });
}
}

#endif
