// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a screen pixel shows that is wider than the shear image's: not the value at its centre, but
 * the largest one (of minima the least, of averages the average) over its area.
 *
 * The shear image is interpolated bilinearly between its samples. Its extremum is sought among the
 * samples in the area and where the area's outline meets the lines between samples, and its
 * corners. So no sample is lost between pixels, and what the pixel shows changes steadily with the
 * view: a sample that comes in is seen coming.
 */
#ifndef splattingPixelArea_h
#define splattingPixelArea_h

#include "Projection/ShearImage.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splatting
{
/// A convex quadrangle of a shear image, its corners in order.
using PixelArea = std::array<glm::dvec2, 4>;

/// The area of the viewport pixel (x, y).
inline PixelArea areaOf(const ShearWarp& geometry, double x, double y)
{
  const glm::dmat3& m = geometry.screenToShear();
  const auto corner = [&](double dx, double dy)
  {
    const glm::dvec3 p = m * glm::dvec3(x + dx, y + dy, 1.0);
    return glm::dvec2(p) / p.z;
  };
  return { corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5) };
}

/// A value of an area, and the sample that it comes from, or of two or four the nearest.
template <class A>
struct AreaValue
{
  A value = std::numeric_limits<A>::quiet_NaN(); ///< none
  int u = 0, v = 0;

  bool found() const { return this->value == this->value; }
  /// Takes another one if it is larger, or less.
  void take(const AreaValue& other, bool least)
  {
    const bool better = least ? other.value < this->value : other.value > this->value;
    if (better || (!this->found() && other.found()))
    {
      *this = other;
    }
  }
};

/**
 * Finds what areas of one image show, whose pixels are of type T.
 */
template <class T>
class PixelAreas
{
public:
  using A = Accumulator<T>;

  /// Both must outlive its use.
  PixelAreas(const ShearImage& image, const T* pixels) : Image(image), Pixels(pixels) {}

  AreaValue<A> extremum(const PixelArea& area, bool least) const
  {
    AreaValue<A> best;
    this->takeLines<0>(area, least, best);
    this->takeLines<1>(area, least, best);
    for (const glm::dvec2& corner : area)
    {
      best.take(this->interpolated(corner), least);
    }
    return best;
  }

  /**
   * Adds up the image at points that are spread evenly over a pixel's area, no farther apart than
   * samples, and counts those that are between samples.
   */
  void addAverage(const ShearWarp& geometry, double x, double y, double& sum, int& count) const
  {
    const PixelArea area = areaOf(geometry, x, y);
    const auto steps = [](const glm::dvec2& a, const glm::dvec2& b)
    { return std::max(static_cast<int>(std::ceil(std::max(glm::length(a), glm::length(b)))), 1); };
    const int columns = steps(area[1] - area[0], area[2] - area[3]);
    const int rows = steps(area[3] - area[0], area[2] - area[1]);
    for (int n = 0; n < columns * rows; ++n)
    {
      const glm::dvec2 at(x - 0.5 + (n % columns + 0.5) / columns,
        y - 0.5 + (static_cast<double>(n / columns) + 0.5) / rows);
      const glm::dvec3 p = geometry.screenToShear() * glm::dvec3(at, 1.0);
      const AreaValue<A> value = this->interpolated(glm::dvec2(p) / p.z);
      if (value.found())
      {
        sum += value.value;
        ++count;
      }
    }
  }

private:
  A at(int u, int v) const
  {
    return static_cast<A>(this->Pixels[std::ptrdiff_t(v) * this->Image.width + u]);
  }

  /// Between two neighbours, where both are samples: a share of the way from the first.
  AreaValue<A> between(int u0, int v0, int u1, int v1, double share) const
  {
    if (!this->Image.covers(u0, v0) || !this->Image.covers(u1, v1))
    {
      return {};
    }
    const double value = (1.0 - share) * this->at(u0, v0) + share * this->at(u1, v1);
    return { static_cast<A>(value), share < 0.5 ? u0 : u1, share < 0.5 ? v0 : v1 };
  }

  /// Between four; none where one of them is not a sample.
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
   * Takes the samples in the area, and the values at both ends, of each row of the image (of each
   * column the ends alone: the samples are the rows').
   */
  template <int Along>
  void takeLines(const PixelArea& area, bool least, AreaValue<A>& best) const
  {
    constexpr int across = 1 - Along;
    const auto range =
      std::minmax({ area[0][across], area[1][across], area[2][across], area[3][across] });
    const double last = (Along == 0 ? this->Image.height : this->Image.width) - 1.0;
    const int end = static_cast<int>(std::floor(std::min(range.second, last)));
    for (int line = static_cast<int>(std::ceil(std::max(range.first, 0.0))); line <= end; ++line)
    {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int edge = 0; edge < 4; ++edge)
      {
        const glm::dvec2 &a = area[edge], &b = area[(edge + 1) % 4];
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
  void takeEnd(int line, double at, bool least, AreaValue<A>& best) const
  {
    const int n = static_cast<int>(std::floor(at));
    best.take(Along == 0 ? this->between(n, line, n + 1, line, at - n)
                         : this->between(line, n, line, n + 1, at - n),
      least);
  }

  void takeRow(int v, double low, double high, bool least, AreaValue<A>& best) const
  {
    const Span& span = this->Image.spans[v];
    const int begin = static_cast<int>(std::ceil(std::max<double>(low, span.begin)));
    const int last = static_cast<int>(std::floor(std::min(high, span.end - 1.0)));
    for (int u = begin; u <= last; ++u)
    {
      if (this->Image.covers(u, v))
      {
        best.take({ this->at(u, v), u, v }, least);
      }
    }
  }

  const ShearImage& Image;
  const T* Pixels;
};
}

#endif
