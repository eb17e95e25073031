// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The value of a pixel of the screen that is wider than those of the shear image: the largest value
 * over its area (of minima the least, of averages the average), instead of that at its centre.
 *
 * The shear image is interpolated bilinearly between its samples. Its extremum is that of the
 * samples in the area, of the values where the area's outline crosses the lines between samples,
 * and of the values at its corners. No sample is therefore lost between pixels, and a pixel changes
 * continuously with the view.
 */
#ifndef splattingPixelArea_h
#define splattingPixelArea_h

#include "Projection/ShearImage.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace splatting
{
/// A convex part of a shear image, with its corners in order; may be empty.
struct PixelArea
{
  std::array<glm::dvec2, 8> corners;
  int count = 0;

  const glm::dvec2* begin() const { return this->corners.data(); }
  const glm::dvec2* end() const { return this->corners.data() + this->count; }
};

/// The part of the area of viewport pixel (x, y) that is in the image, or at most a sample beside
/// it. In perspective views the rest may extend behind the eye.
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

/// The interval of u of an area at height v, if it has a length.
inline glm::dvec2 rowOf(const PixelArea& area, double v)
{
  glm::dvec2 row(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (int edge = 0; edge < area.count; ++edge)
  {
    const glm::dvec2 &a = area.corners[edge], &b = area.corners[(edge + 1) % area.count];
    if ((a.y <= v) != (b.y <= v))
    {
      const double u = a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x);
      row = { std::min(row[0], u), std::max(row[1], u) };
    }
  }
  return row;
}

/// The number of parts of a length, none longer than a sample is wide.
inline int partsOf(double length)
{
  // Excludes rounding errors of lengths that are whole numbers of samples.
  constexpr double rounding = 1e-9;
  return std::max(static_cast<int>(std::ceil(length - rounding)), 1);
}

/// A value of an area, and its sample, or the nearest of the two or four that it is interpolated
/// from.
template <class A>
struct AreaValue
{
  A value = std::numeric_limits<A>::quiet_NaN(); ///< none
  int u = 0, v = 0;

  bool found() const { return this->value == this->value; }
  /// Takes another value if it is larger, or less. Returns whether it does.
  bool take(const AreaValue& other, bool least)
  {
    const bool better = (least ? other.value < this->value : other.value > this->value) ||
      (!this->found() && other.found());
    *this = better ? other : *this;
    return better;
  }
};

/// The extremum of an area's samples, and that of its values between samples.
template <class A>
struct AreaExtrema
{
  AreaValue<A> sample, between;
};

/// The weighted mean of values.
struct AreaMean
{
  double sum = 0.0, weights = 0.0;

  void add(double value, double weight)
  {
    this->sum += weight * value;
    this->weights += weight;
  }
};

/**
 * Computes the values of areas in one image, with pixels of type T.
 */
template <class T>
class PixelAreas
{
public:
  using A = Accumulator<T>;

  /// Both must outlive its use.
  PixelAreas(const ShearImage& image, const T* pixels) : Image(image), Pixels(pixels) {}

  AreaExtrema<A> extrema(const PixelArea& area, bool least) const
  {
    AreaExtrema<A> best;
    this->takeLines<0>(area, least, best);
    this->takeLines<1>(area, least, best);
    for (const glm::dvec2& corner : area)
    {
      best.between.take(this->interpolated(corner), least);
    }
    return best;
  }

  AreaValue<A> extremum(const PixelArea& area, bool least) const
  {
    AreaExtrema<A> best = this->extrema(area, least);
    best.sample.take(best.between, least);
    return best.sample;
  }

  /**
   * Adds the image at points spread evenly over an area, no farther apart than samples, each
   * weighted by its part of the screen. Points that are not between samples are skipped. There are
   * at most about as many points as samples in the area, however wide the pixel is.
   */
  void addAverage(const ShearWarp& geometry, const PixelArea& area, AreaMean& mean) const
  {
    const glm::dmat3& toScreen = geometry.shearToScreen();
    const double scale = std::abs(glm::determinant(toScreen));
    const glm::dvec2 heights = this->heightsOf(area);
    const int rows = partsOf(heights[1] - heights[0]);
    const double height = (heights[1] - heights[0]) / rows;
    for (int row = 0; row < rows && height > 0.0; ++row)
    {
      const double v = heights[0] + (row + 0.5) * height;
      const glm::dvec2 cut = rowOf(area, v);
      const double left = std::max(cut[0], 0.0);
      const double right = std::min(cut[1], this->Image.width - 1.0);
      const int points = left < right ? partsOf(right - left) : 0;
      const double width = (right - left) / points;
      for (int n = 0; n < points; ++n)
      {
        const glm::dvec2 p(left + (n + 0.5) * width, v);
        const AreaValue<A> value = this->interpolated(p);
        if (value.found())
        {
          const double z = (toScreen * glm::dvec3(p, 1.0)).z;
          mean.add(value.value, scale * width * height / (z * z * z));
        }
      }
    }
  }

  /// Adds the samples in an area, for areas without a point between samples.
  void addSamples(const PixelArea& area, AreaMean& mean) const
  {
    const glm::dvec2 heights = this->heightsOf(area);
    for (int v = static_cast<int>(std::ceil(heights[0])); v <= heights[1]; ++v)
    {
      const glm::dvec2 cut = rowOf(area, v);
      this->forRow(v, cut[0], cut[1],
        [&](int u)
        {
          if (this->at(u, v) == this->at(u, v)) // not NaN
          {
            mean.add(this->at(u, v), 1.0);
          }
        });
    }
  }

private:
  /// The rows of the image that an area overlaps.
  glm::dvec2 heightsOf(const PixelArea& area) const
  {
    const double last = this->Image.height - 1;
    glm::dvec2 heights(last, 0.0);
    for (const glm::dvec2& corner : area)
    {
      heights[0] = std::min(heights[0], std::max(corner.y, 0.0));
      heights[1] = std::max(heights[1], std::min(corner.y, last));
    }
    return heights;
  }

  A at(int u, int v) const
  {
    return static_cast<A>(this->Pixels[std::ptrdiff_t(v) * this->Image.width + u]);
  }

  /// Interpolates between two neighbouring samples.
  /// @param share  of the way from the first
  AreaValue<A> between(int u0, int v0, int u1, int v1, double share) const
  {
    if (!this->Image.covers(u0, v0) || !this->Image.covers(u1, v1))
    {
      return {};
    }
    const double value = (1.0 - share) * this->at(u0, v0) + share * this->at(u1, v1);
    return { static_cast<A>(value), share < 0.5 ? u0 : u1, share < 0.5 ? v0 : v1 };
  }

  /// Interpolates between four neighbours; none if one of them is not a sample.
  AreaValue<A> interpolated(const glm::dvec2& p) const
  {
    const int u = static_cast<int>(std::floor(p.x)), v = static_cast<int>(std::floor(p.y));
    const AreaValue<A> low = this->between(u, v, u + 1, v, p.x - u);
    const AreaValue<A> high = this->between(u, v + 1, u + 1, v + 1, p.x - u);
    const double share = p.y - v;
    const double value = (1.0 - share) * low.value + share * high.value;
    const AreaValue<A>& nearest = share < 0.5 ? low : high;
    return { static_cast<A>(value), nearest.u, nearest.v };
  }

  /**
   * Takes the samples in the area, and the values at both ends, of each row of the image (for
   * columns only the values at the ends, because the rows have the samples).
   */
  template <int Along>
  void takeLines(const PixelArea& area, bool least, AreaExtrema<A>& best) const
  {
    constexpr int across = 1 - Along;
    const int last = (Along == 0 ? this->Image.height : this->Image.width) - 1;
    double first = last + 1.0, end = -1.0;
    for (const glm::dvec2& corner : area)
    {
      first = std::min(first, std::max(corner[across], 0.0));
      end = std::max(end, std::min<double>(corner[across], last));
    }
    for (int line = static_cast<int>(std::ceil(first)); line <= end; ++line)
    {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int edge = 0; edge < area.count; ++edge)
      {
        const glm::dvec2 &a = area.corners[edge], &b = area.corners[(edge + 1) % area.count];
        if ((a[across] <= line) == (b[across] <= line) && a[across] != line)
        {
          continue;
        }
        const double way = b[across] - a[across];
        const double at =
          way == 0.0 ? a[Along] : a[Along] + (line - a[across]) / way * (b[Along] - a[Along]);
        low = std::min(low, at);
        high = std::max(high, at);
      }
      this->takeEnd<Along>(line, low, least, best);
      this->takeEnd<Along>(line, high, least, best);
      if constexpr (Along == 0)
      {
        this->takeRow(line, low, high, least, best);
      }
    }
  }

  template <int Along>
  void takeEnd(int line, double at, bool least, AreaExtrema<A>& best) const
  {
    const int n = static_cast<int>(std::floor(at));
    best.between.take(Along == 0 ? this->between(n, line, n + 1, line, at - n)
                                 : this->between(line, n, line, n + 1, at - n),
      least);
  }

  void takeRow(int v, double low, double high, bool least, AreaExtrema<A>& best) const
  {
    this->forRow(v, low, high, [&](int u) { best.sample.take({ this->at(u, v), u, v }, least); });
  }

  /// Calls f(u) for the samples of a row in a range.
  template <class F>
  void forRow(int v, double low, double high, F&& f) const
  {
    const Span& span = this->Image.spans[v];
    const int begin = static_cast<int>(std::ceil(std::max<double>(low, span.begin)));
    const int last = static_cast<int>(std::floor(std::min(high, span.end - 1.0)));
    for (int u = begin; u <= last; ++u)
    {
      if (this->Image.covers(u, v))
      {
        f(u);
      }
    }
  }

  const ShearImage& Image;
  const T* Pixels;
};
}

#endif
