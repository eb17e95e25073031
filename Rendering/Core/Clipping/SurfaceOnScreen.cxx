// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Clipping/SurfaceOnScreen.h"

#include "Clipping/ClosedSurface.h"
#include "Common/Parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// The distance beside an edge at which a ray still crosses a triangle, relative to the compared
/// numbers, so that no ray passes between neighbours.
constexpr double Beside = 1e-11;

/// a x + b y + c over the pixels of a viewport.
struct Linear
{
  double a = 0.0, b = 0.0, c = 0.0;

  double at(double x, double y) const { return this->a * x + (this->b * y + this->c); }
};

/// A triangle, and its crossings with the rays of pixels.
class ScreenTriangle
{
public:
  ScreenTriangle(const PixelRays& rays, const glm::dvec3 (&corners)[3])
    : Perspective(rays.isPerspective())
  {
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const glm::dvec3 q = corners[0] - rays.origin();
    // t = Distance / Speed
    this->Speed = { 0.0, 0.0, glm::dot(normal, rays.forward()) };
    this->Distance = { 0.0, 0.0, glm::dot(normal, q) };
    Linear& varying = this->Perspective ? this->Speed : this->Distance;
    const double sense = this->Perspective ? 1.0 : -1.0;
    varying.a = sense * glm::dot(normal, rays.across());
    varying.b = sense * glm::dot(normal, rays.up());
    for (int e = 0; e < 3; ++e)
    {
      const glm::dvec3 a = corners[e] - rays.origin(), b = corners[(e + 1) % 3] - rays.origin();
      // Positive if a ray along the normal passes inside.
      const glm::dvec3 side =
        this->Perspective ? glm::cross(a, b) : glm::cross(rays.forward(), b - a);
      this->Edges[e] = { glm::dot(side, rays.across()), glm::dot(side, rays.up()),
        this->Perspective ? glm::dot(side, rays.forward()) : -glm::dot(side, a) };
    }
    this->findBounds(rays, corners);
  }

  /// Widens the parameters of the pixels in a row.
  void cover(int y, int first, int last, double* near, double* far) const
  {
    first = std::max(first, this->Low.x);
    last = std::min(last, this->High.x);
    for (int x = first; x <= last && y >= this->Low.y && y <= this->High.y; ++x)
    {
      const double speed = this->Speed.at(x, y);
      const double sense = speed > 0.0 ? 1.0 : -1.0;
      bool inside = speed != 0.0;
      for (const Linear& edge : this->Edges)
      {
        const double size = std::abs(edge.a * x) + std::abs(edge.b * y) + std::abs(edge.c);
        inside = inside && sense * edge.at(x, y) >= -Beside * size;
      }
      // Grazing rays would cross the triangle's plane far away from it.
      const double t = std::clamp(this->Distance.at(x, y) / speed, this->First, this->Last);
      if (inside && (!this->Perspective || t > 0.0))
      {
        near[x] = std::min(near[x], t);
        far[x] = std::max(far[x], t);
      }
    }
  }

private:
  void findBounds(const PixelRays& rays, const glm::dvec3 (&corners)[3])
  {
    const double limit = 1e6;
    glm::dvec2 low(limit), high(-limit);
    this->First = Infinity;
    this->Last = -Infinity;
    for (const glm::dvec3& corner : corners)
    {
      const glm::dvec3 q = rays.toPixel() * (corner - rays.origin());
      this->First = std::min(this->First, q.z);
      this->Last = std::max(this->Last, q.z);
      const glm::dvec2 pixel = this->Perspective ? glm::dvec2(q) / q.z : glm::dvec2(q);
      low = glm::min(low, pixel);
      high = glm::max(high, pixel);
    }
    // Edges beside the eye can be visible in any pixel.
    if (this->Perspective && !(this->First > 1e-6 * this->Last))
    {
      low = glm::dvec2(-limit);
      high = this->Last > 0.0 ? glm::dvec2(limit) : glm::dvec2(-2.0 * limit);
    }
    this->Low = glm::ivec2(glm::ceil(glm::clamp(low, -limit, limit) - 1e-3));
    this->High = glm::ivec2(glm::floor(glm::clamp(high, -2.0 * limit, limit) + 1e-3));
  }

  const bool Perspective;
  Linear Speed, Distance, Edges[3];
  glm::ivec2 Low{ 0 }, High{ -1 };
  double First = 0.0, Last = 0.0; // of the corners' parameters
};
}

void SurfaceOnScreen::find(const ClosedSurface& surface, const PixelRays& rays,
  const glm::ivec2& origin, const glm::ivec2& size)
{
  this->Origin = origin;
  this->Size = size;
  const std::size_t pixels = std::size_t(size.x) * size.y;
  const bool inside = rays.isPerspective() && surface.contains(rays.origin());
  this->Near.assign(pixels, inside ? 0.0 : Infinity);
  this->Far.assign(pixels, inside ? 0.0 : -Infinity);
  std::vector<ScreenTriangle> triangles;
  surface.forTriangles(
    [&](const glm::dvec3(&corners)[3]) { triangles.emplace_back(rays, corners); });
  parallelFor(0, size.y, 8,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (const ScreenTriangle& triangle : triangles)
      {
        for (std::ptrdiff_t y = begin; y < end; ++y)
        {
          const std::ptrdiff_t row = y * size.x - origin.x;
          triangle.cover(static_cast<int>(origin.y + y), origin.x, origin.x + size.x - 1,
            this->Near.data() + row, this->Far.data() + row);
        }
      }
    });
}

void SurfaceOnScreen::cut(int x, int y, int count, double* near, double* far) const
{
  const std::size_t first = std::size_t(y - this->Origin.y) * this->Size.x + (x - this->Origin.x);
  for (int n = 0; n < count; ++n)
  {
    near[n] = std::max(near[n], this->Near[first + n]);
    far[n] = std::min(far[n], this->Far[first + n]);
  }
}
}
