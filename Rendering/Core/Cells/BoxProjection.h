// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Projects boxes of index space to the screen.
 */
#ifndef splattingBoxProjection_h
#define splattingBoxProjection_h

#include "Geometry/PixelRays.h"
#include "Geometry/View.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace splatting
{
/// Middle and half the sides of a box.
struct CellBox
{
  glm::dvec3 middle, half;

  CellBox(const glm::dvec3& low, const glm::dvec3& high)
    : middle(0.5 * (low + high)),
      half(0.5 * (high - low))
  {
  }
  glm::dvec3 low() const { return this->middle - this->half; }
  glm::dvec3 high() const { return this->middle + this->half; }
};

/// The least and the greatest value of h in a box.
inline glm::dvec2 rangeOf(const glm::dvec4& h, const CellBox& box)
{
  const double middle = glm::dot(glm::dvec3(h), box.middle) + h.w;
  const double reach = glm::dot(glm::abs(glm::dvec3(h)), box.half);
  return { middle - reach, middle + reach };
}

inline bool overlap(const CellBox& a, const CellBox& b)
{
  return glm::all(glm::lessThanEqual(glm::abs(a.middle - b.middle), a.half + b.half));
}

/// Pixels, both ends included.
struct PixelRectangle
{
  glm::ivec2 low{ 0 }, high{ -1 };

  bool empty() const { return this->low.x > this->high.x || this->low.y > this->high.y; }
};

/// The pixels of the viewport whose rays may cross a box, and between which parameters.
class ProjectedBox
{
public:
  ProjectedBox(const PixelRays& rays, const CellBox& box) : Rays(rays), Box(box)
  {
    const glm::dmat3& m = rays.toPixel();
    const glm::dvec3 q = m * (box.middle - rays.origin());
    this->T = q.z;
    this->Reach = this->reachOf(2, 0.0);
    if (!rays.isPerspective())
    {
      this->Pixel = glm::dvec2(q);
      this->Spread = { this->reachOf(0, 0.0), this->reachOf(1, 0.0) };
      return;
    }
    // If the box may contain the eye or points beside the eye, its projection has no bounds.
    this->Near = !(this->T - this->Reach > 1e-3 * this->T);
    if (!this->Near)
    {
      this->Pixel = glm::dvec2(q) / q.z;
      this->Spread = glm::dvec2(this->reachOf(0, this->Pixel.x), this->reachOf(1, this->Pixel.y)) /
        (this->T - this->Reach);
    }
  }

  /// Whether the box is so near to the eye that pixel() and spread() are invalid.
  bool isNear() const { return this->Near; }
  const glm::dvec2& pixel() const { return this->Pixel; }
  const glm::dvec2& spread() const { return this->Spread; }
  /// t() is the parameter t at the middle of the box. reach() is the largest difference from it in
  /// the box.
  double t() const { return this->T; }
  double reach() const { return this->Reach; }

  /// Returns those of the pixels that are in a rectangle.
  PixelRectangle within(const PixelRectangle& pixels) const
  {
    constexpr double margin = 0.01;
    if (this->Near)
    {
      return this->isBeside(pixels) ? PixelRectangle() : pixels;
    }
    const auto limited = [](double x) { return static_cast<int>(std::clamp(x, -1e6, 1e6)); };
    const glm::dvec2 low = glm::ceil(this->Pixel - this->Spread - margin);
    const glm::dvec2 high = glm::floor(this->Pixel + this->Spread + margin);
    return { glm::max(pixels.low, glm::ivec2(limited(low.x), limited(low.y))),
      glm::min(pixels.high, glm::ivec2(limited(high.x), limited(high.y))) };
  }

private:
  /// The largest change, from the box's middle, of row r of toPixel() minus `share` times its last
  /// row.
  double reachOf(int r, double share) const
  {
    const glm::dmat3& m = this->Rays.toPixel();
    double reach = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      reach += std::abs(m[a][r] - share * m[a][2]) * this->Box.half[a];
    }
    return reach;
  }

  /// Whether the box lies wholly behind the eye or on the outer side of a plane through the eye and
  /// a side of the rectangle.
  bool isBeside(const PixelRectangle& pixels) const
  {
    const glm::dvec3 q = this->Rays.toPixel() * (this->Box.middle - this->Rays.origin());
    if (q.z + this->Reach < 0.0)
    {
      return true;
    }
    for (int a = 0; a < 2; ++a)
    {
      const double low = pixels.low[a] - 0.01, high = pixels.high[a] + 0.01;
      if (q[a] - low * q.z + this->reachOf(a, low) < 0.0 ||
        high * q.z - q[a] + this->reachOf(a, high) < 0.0)
      {
        return true;
      }
    }
    return false;
  }

  const PixelRays& Rays;
  const CellBox& Box;
  bool Near = false;
  double T, Reach;
  glm::dvec2 Pixel{ 0.0 }, Spread{ 0.0 };
};

/// The parts of the field that cropping shows, as boxes.
struct ShownRegions
{
  std::vector<CellBox> boxes;

  /// Neighbouring regions along x become one box.
  ShownRegions(const Cropping& cropping, const glm::dvec3& low, const glm::dvec3& high)
  {
    if (!cropping.cuts())
    {
      this->boxes.emplace_back(low, high);
      return;
    }
    for (int n = 0; n < 9; ++n)
    {
      const int y = n % 3, z = n / 3;
      for (int x = 0; x < 3; ++x)
      {
        int last = x;
        if (!(cropping.flags >> (x + 3 * y + 9 * z) & 1))
        {
          continue;
        }
        while (last < 2 && cropping.flags >> (last + 1 + 3 * y + 9 * z) & 1)
        {
          ++last;
        }
        this->add(cropping, glm::ivec3(x, y, z), glm::ivec3(last, y, z), low, high);
        x = last;
      }
    }
  }

private:
  void add(const Cropping& cropping, const glm::ivec3& first, const glm::ivec3& last,
    const glm::dvec3& low, const glm::dvec3& high)
  {
    glm::dvec3 from, to;
    for (int a = 0; a < 3; ++a)
    {
      const glm::dvec2& planes = cropping.planes[a];
      from[a] = first[a] == 0 ? low[a] : std::max(low[a], planes[first[a] - 1]);
      to[a] = last[a] == 2 ? high[a] : std::min(high[a], planes[last[a]]);
    }
    if (from.x < to.x && from.y < to.y && from.z < to.z)
    {
      this->boxes.emplace_back(from, to);
    }
  }
};
}

#endif
