// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ClosedSurface.h"

#include <vtkSMPTools.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// The integers in [low, high], cut to [0, size). Both bounds may be infinite.
Span integersIn(double low, double high, int size)
{
  const double limit = size;
  return { static_cast<int>(std::ceil(std::clamp(low, 0.0, limit))),
    static_cast<int>(std::floor(std::clamp(high, -1.0, limit - 1.0))) + 1 };
}

/// A triangle whose corners are pixels and slices, and how it meets rows of pixels.
class Triangle
{
public:
  Triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    : Corners{ a, b, c },
      Normal(glm::cross(b - a, c - a))
  {
    const glm::dvec3 reach = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
    // Larger than what rounding does to the distance between a pixel and an edge.
    this->Margin = 1e-9 * (1.0 + std::max(reach.x, reach.y));
    this->Low = std::min({ a.z, b.z, c.z });
    this->High = std::max({ a.z, b.z, c.z });
  }

  bool isEdgeOn() const
  {
    double longest = 0.0;
    for (int e = 0; e < 3; ++e)
    {
      longest = std::max(longest, glm::length(glm::dvec2(this->edge(e))));
    }
    return !(std::abs(this->Normal.z) > this->Margin * longest);
  }

  Span rows(int height) const
  {
    const glm::dvec3* const p = this->Corners;
    return integersIn(std::min({ p[0].y, p[1].y, p[2].y }) - this->Margin,
      std::max({ p[0].y, p[1].y, p[2].y }) + this->Margin, height);
  }

  /// Widens the depths of the pixels of row v that the triangle covers.
  void cover(int v, int width, double* near, double* far) const
  {
    const Span pixels = this->pixels(v, width);
    const glm::dvec3& a = this->Corners[0];
    const double slope = -this->Normal.x / this->Normal.z;
    const double start = a.z - this->Normal.y / this->Normal.z * (v - a.y);
    for (int u = pixels.begin; u < pixels.end; ++u)
    {
      // Steep triangles would leave their own depths beside their edges.
      const double z = std::clamp(start + slope * (u - a.x), this->Low, this->High);
      near[u] = std::min(near[u], z);
      far[u] = std::max(far[u], z);
    }
  }

private:
  glm::dvec3 edge(int e) const { return this->Corners[(e + 1) % 3] - this->Corners[e]; }

  Span pixels(int v, int width) const
  {
    double low = -Infinity, high = Infinity;
    for (int e = 0; e < 3; ++e)
    {
      // across * (u - corner.x) + along >= 0 inside.
      const double turn = this->Normal.z > 0.0 ? 1.0 : -1.0;
      const glm::dvec3& corner = this->Corners[e];
      const glm::dvec2 side = turn * glm::dvec2(this->edge(e));
      const double across = -side.y;
      const double along =
        side.x * (v - corner.y) + this->Margin * (std::abs(side.x) + std::abs(side.y));
      if (across > 0.0)
      {
        low = std::max(low, corner.x - along / across);
      }
      else if (across < 0.0)
      {
        high = std::min(high, corner.x - along / across);
      }
      else if (along < 0.0)
      {
        return {};
      }
    }
    return integersIn(low, high, width);
  }

  glm::dvec3 Corners[3];
  glm::dvec3 Normal;
  double Margin, Low, High;
};
}

void ClosedSurface::clear()
{
  this->Points.clear();
  this->Triangles.clear();
  this->Projected = false;
}

void ClosedSurface::reset(std::vector<glm::dvec3> points, std::vector<glm::ivec3> triangles)
{
  this->Points = std::move(points);
  this->Triangles = std::move(triangles);
  this->Projected = false;
}

void ClosedSurface::project(const ShearWarp& geometry)
{
  if (this->Projected && geometry.sameShear(this->Geometry))
  {
    return;
  }
  this->Projected = true;
  this->Geometry = geometry;
  this->Width = geometry.width();
  const int height = geometry.height();
  this->Near.resize(std::size_t(this->Width) * height);
  this->Far.resize(this->Near.size());
  this->toPixels(geometry);
  this->findRows(height);
  vtkSMPTools::For(0, height, 32,
    [&](vtkIdType begin, vtkIdType end)
    {
      std::fill(&this->Near[begin * this->Width], &this->Near[0] + end * this->Width, Infinity);
      std::fill(&this->Far[begin * this->Width], &this->Far[0] + end * this->Width, -Infinity);
      for (std::size_t t = 0; t < this->Triangles.size(); ++t)
      {
        const int first = std::max(this->Rows[t].begin, static_cast<int>(begin));
        const int last = std::min(this->Rows[t].end, static_cast<int>(end));
        if (first < last)
        {
          const glm::ivec3& corners = this->Triangles[t];
          const Triangle triangle(
            this->Pixels[corners[0]], this->Pixels[corners[1]], this->Pixels[corners[2]]);
          for (int v = first; v < last; ++v)
          {
            const std::size_t row = std::size_t(v) * this->Width;
            triangle.cover(v, this->Width, &this->Near[row], &this->Far[row]);
          }
        }
      }
    });
}

void ClosedSurface::toPixels(const ShearWarp& geometry)
{
  const std::array<int, 3>& axes = geometry.axes();
  this->Pixels.resize(this->Points.size());
  std::transform(this->Points.begin(), this->Points.end(), this->Pixels.begin(),
    [&](const glm::dvec3& p)
    {
      const double z = p[axes[2]];
      return glm::dvec3(glm::dvec2(p[axes[0]], p[axes[1]]) + geometry.position(z), z);
    });
}

void ClosedSurface::findRows(int height)
{
  this->Rows.resize(this->Triangles.size());
  std::transform(this->Triangles.begin(), this->Triangles.end(), this->Rows.begin(),
    [&](const glm::ivec3& corners)
    {
      const Triangle triangle(
        this->Pixels[corners[0]], this->Pixels[corners[1]], this->Pixels[corners[2]]);
      return triangle.isEdgeOn() ? Span{} : triangle.rows(height);
    });
}
}
