// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    ScreenPixels.h
 * @brief   the values of the pixels of the screen from those of shear images, by definition
 *
 * Pixels show the shear image where their rays meet it or, in overviews, what it has in their
 * areas.
 */
#ifndef reference_ScreenPixels_h
#define reference_ScreenPixels_h

#include "Projection.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <vector>

namespace reference
{

/**
 * A ray whose samples were reduced to one value.
 */
struct ReducedRay
{
  bool meets = false; ///< whether it crosses the volume
  bool hit = false;   ///< whether it has visible samples
  double value = 0.0;
};

/**
 * The expected value of a pixel, if it shows the volume.
 */
struct ExpectedPixel
{
  bool isCertain = true; ///< whether rounding decides neither the outline nor a cut
  bool isHit = false;
  double value = 0.0;
  double slack = 0.0; ///< the tolerance in addition to rounding errors
};

/**
 * How much of a parallel ray through a point lies in the box of the outermost voxel centres, the
 * picture's outline, in slices; negative if it misses it.
 */
inline double lengthInside(const ImageRays& rays, const glm::dvec3& point)
{
  return inside(boxOfVolume(rays.volumeSize(), false), point, rays.direction(0, 0)).length();
}

/**
 * A pixel of a parallel view, from a point on its ray: between the four rays, rayAt(u, v), beside
 * it.
 */
template <class RayAt>
ExpectedPixel betweenRays(const ImageRays& rays, const glm::dvec3& point, RayAt&& rayAt)
{
  ExpectedPixel expected;
  const double length = lengthInside(rays, point);
  expected.isCertain = std::abs(length) > 1e-5;
  if (length < 0.0)
  {
    return expected;
  }
  const glm::dvec2 p = rays.pixelOf(point);
  const int u = static_cast<int>(std::floor(p.x)), v = static_cast<int>(std::floor(p.y));
  double sum = 0.0, weight = 0.0, lost = 0.0;
  for (int n = 0; n < 4; ++n)
  {
    const int i = u + n % 2, j = v + n / 2;
    if (i < 0 || j < 0 || i >= rays.width() || j >= rays.height())
    {
      continue;
    }
    const double w = (1.0 - std::abs(p.x - i)) * (1.0 - std::abs(p.y - j));
    const ReducedRay& ray = rayAt(i, j);
    if (ray.meets)
    {
      (ray.hit ? weight : lost) += w;
      sum += ray.hit ? w * ray.value : 0.0;
    }
  }
  expected.isCertain = expected.isCertain && std::abs(lost - 0.5) > 1e-5 && weight > 1e-5;
  expected.isHit = weight > 1e-5 && lost <= 0.5;
  expected.value = expected.isHit ? sum / weight : 0.0;
  return expected;
}

/**
 * The values that a pixel of an overview reads.
 */
struct Reading
{
  bool isCertain = true;  ///< whether rounding does not decide what is read
  bool hasSample = false; ///< whether a visible sample is in the area
  std::vector<double> values;
  std::vector<glm::ivec2> nearest; ///< pixel of the shear image to each value
};

/**
 * Reads a shear image in the areas of pixels: in each row at the columns in it or, between two of
 * them, in the middle; likewise between two rows.
 *
 * A source has the image's `width` and `height`, the homographies `toScreen` and `toShear`, and of
 * its pixels covers(u, v), value(u, v), and whether a picture isShown(u, v) there.
 */
template <class Source>
class AreaReader
{
public:
  /// @param rounding  of places, in pixels of the shear image
  AreaReader(const Source& image, double rounding) : Image(image), Rounding(rounding) {}

  /// Adds the values that a pixel reads.
  void read(const glm::dvec2& pixel, Reading& reading) const
  {
    bool meetsRows = false;
    // A row along a side of the area is in it, or not, by rounding.
    for (const glm::dvec2& corner : corners())
    {
      const glm::dvec3 h = this->Image.toShear * glm::dvec3(pixel + corner, 1.0);
      reading.isCertain &= !(h.z > 0.0) || !this->isWhole(h.y / h.z);
    }
    for (int v = -1; v <= this->Image.height; ++v)
    {
      const Stretch<double> row = this->rowIn(pixel, v);
      reading.isCertain &= std::abs(row.length()) > this->Rounding;
      meetsRows |= row.length() > 0.0;
      this->readRow(row, v, reading);
    }
    if (!meetsRows)
    {
      this->readBetweenRows(pixel, reading);
    }
  }

  static std::vector<glm::dvec2> corners()
  {
    return { { -0.5, -0.5 }, { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } };
  }

private:
  bool isWhole(double place) const { return std::abs(place - std::round(place)) <= this->Rounding; }

  /// The part of a row in the area of a pixel. It ends one sample beside the image.
  Stretch<double> rowIn(const glm::dvec2& pixel, double v) const
  {
    Stretch<double> row{ -1.0, double(this->Image.width) };
    const glm::dmat3& m = this->Image.toScreen;
    const glm::dvec3 step = m[0], start = v * m[1] + m[2];
    for (int a = 0; a < 2; ++a)
    {
      for (const double side : { -1.0, 1.0 })
      {
        const double border = pixel[a] + 0.5 * side;
        row.cut(side * (border * start.z - start[a]), side * (border * step.z - step[a]));
      }
    }
    row.cut(start.z, step.z);
    return row;
  }

  /// An area between two rows is read in the middle of its height.
  void readBetweenRows(const glm::dvec2& pixel, Reading& reading) const
  {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const glm::dvec2& corner : corners())
    {
      const glm::dvec3 h = this->Image.toShear * glm::dvec3(pixel + corner, 1.0);
      const glm::dvec2 p = glm::dvec2(h) / h.z;
      reading.isCertain &= h.z > 0.0 && p.x > -1.0 && p.x < this->Image.width;
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
    if (low > -1.0 && high < this->Image.height && reading.isCertain)
    {
      const double v = 0.5 * (low + high);
      this->readRow(this->rowIn(pixel, v), v, reading);
    }
  }

  void readRow(const Stretch<double>& row, double v, Reading& reading) const
  {
    if (!(row.length() >= 0.0))
    {
      return;
    }
    reading.isCertain &= !this->isWhole(row.begin) && !this->isWhole(row.end);
    bool isRead = false;
    for (double u = std::ceil(row.begin); u <= row.end; ++u)
    {
      this->readPoint(u, v, reading);
      isRead = true;
    }
    if (!isRead)
    {
      this->readPoint(0.5 * (row.begin + row.end), v, reading);
    }
  }

  void readPoint(double u, double v, Reading& reading) const
  {
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    double sum = 0.0;
    for (int corner = 0; corner < 4; ++corner)
    {
      const int column = i + corner % 2, row = j + corner / 2;
      const double weight = (1.0 - std::abs(u - column)) * (1.0 - std::abs(v - row));
      if (weight > 0.0 && !this->Image.covers(column, row))
      {
        return;
      }
      sum += weight > 0.0 ? weight * this->Image.value(column, row) : 0.0;
    }
    reading.isCertain &= !this->isWhole(u - 0.5) && !this->isWhole(v - 0.5);
    const glm::ivec2 nearest(std::lround(u), std::lround(v));
    reading.hasSample |=
      nearest.x == u && nearest.y == v && this->Image.isShown(nearest.x, nearest.y);
    reading.values.push_back(sum);
    reading.nearest.push_back(nearest);
  }

  const Source& Image;
  const double Rounding;
};

} // namespace reference

#endif
