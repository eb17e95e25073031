// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Clipping/ClosedSurface.h"

#include "Common/Parallel.h"

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

/// The integers in [low, high], limited to [0, size). Bounds may be infinite.
Span integersIn(double low, double high, int size)
{
  const double limit = size;
  return { static_cast<int>(std::ceil(std::clamp(low, 0.0, limit))),
    static_cast<int>(std::floor(std::clamp(high, -1.0, limit - 1.0))) + 1 };
}

/// The largest rounding errors of rays' positions at the reference, and of their slopes: of a ray
/// and of the two that it is interpolated between.
constexpr double PlaceRounding = 0x1p-20, SlopeRounding = 0x1p-24;

double largest(const glm::dvec3& p)
{
  return std::max({ std::abs(p.x), std::abs(p.y), std::abs(p.z) });
}

/// Depths of all pixels.
struct SurfaceRows
{
  double *near, *far;
};

/// A point (i, j, k), sheared so that parallel rays run along k.
glm::dvec3 asSeen(const ShearWarp& geometry, const glm::dvec3& p)
{
  if (geometry.isPerspective())
  {
    return p;
  }
  const double depth = p.z - geometry.reference();
  return { p.x - geometry.columns().slope[0] * depth, p.y - geometry.rows().slope[0] * depth, p.z };
}

/// A triangle of (i, j, k), and its crossings with the rays of an image.
class Triangle
{
public:
  Triangle(const ShearWarp& geometry, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    : Geometry(geometry),
      Corners{ asSeen(geometry, a), asSeen(geometry, b), asSeen(geometry, c) },
      Normal(glm::cross(this->Corners[1] - this->Corners[0], this->Corners[2] - this->Corners[0]))
  {
    this->Low = std::min({ a.z, b.z, c.z });
    this->High = std::max({ a.z, b.z, c.z });
    double reach = std::max({ largest(a), largest(b), largest(c) });
    if (geometry.isPerspective())
    {
      const glm::dvec3& eye = geometry.eye();
      this->Facing = glm::dot(this->Normal, geometry.reversed() ? eye - a : a - eye);
      this->Nearest = std::min({ this->ahead(0), this->ahead(1), this->ahead(2) });
      reach = std::max(reach, largest(eye));
      const double z = geometry.reference();
      this->Margin = PlaceRounding +
        SlopeRounding * std::max({ std::abs(a.z - z), std::abs(b.z - z), std::abs(c.z - z) });
      double& end = geometry.reversed() ? this->High : this->Low;
      end = geometry.reversed() ? std::min(end, eye.z) : std::max(end, eye.z);
    }
    else
    {
      this->Facing = this->Normal.z;
    }
    // Larger than the rounding error of the distance between a ray and an edge.
    this->Margin += 1e-9 * (1.0 + reach);
  }

  /// Whether no ray crosses the triangle, or the neighbour at its longest edge covers all that do.
  bool isUnseen() const
  {
    const double longest = std::max({ this->length(0), this->length(1), this->length(2) });
    return !(std::abs(this->Facing) > std::max(this->Nearest, 0.0) * this->Margin * longest) ||
      this->Low > this->High;
  }

  /// The rows of pixels that may cross the triangle.
  Span rows() const { return this->extent(1, this->Geometry.height()); }

  /// Widens the depths of the pixels that the triangle covers in some rows.
  void cover(const Span& rows, SurfaceRows depths) const
  {
    // Grazing rays are near the lines of its edges also far beyond its corners.
    const Span columns = this->extent(0, this->Geometry.width());
    if (columns.empty())
    {
      return;
    }
    const Side sides[] = { this->side(0), this->side(1), this->side(2) };
    for (int v = rows.begin; v < rows.end; ++v)
    {
      const std::size_t row = std::size_t(v) * this->Geometry.width();
      this->cover(v, this->pixels(sides, v, columns), depths.near + row, depths.far + row);
    }
  }

private:
  /// Of parallel views the sheared edge, so that margins are distances in the image.
  glm::dvec3 edge(int e) const
  {
    const glm::dvec3 edge = this->Corners[(e + 1) % 3] - this->Corners[e];
    return this->Geometry.isPerspective() ? edge : glm::dvec3(edge.x, edge.y, 0.0);
  }

  /// The distance of a corner before the eye, in perspective views.
  double ahead(int c) const
  {
    const double depth = this->Corners[c].z - this->Geometry.eye().z;
    return this->Geometry.reversed() ? -depth : depth;
  }

  /// An upper bound of the length of an edge across rays. Multiplied by the distance from a ray it
  /// is the volume between them.
  double length(int e) const
  {
    const glm::dvec3 edge = this->edge(e);
    if (!this->Geometry.isPerspective())
    {
      return glm::length(edge);
    }
    const double nearest = std::min(this->ahead(e), this->ahead((e + 1) % 3));
    const glm::dvec3 area = glm::cross(edge, this->Corners[e] - this->Geometry.eye());
    // Slopes of rays are not much above 1.
    const double most = 4.0 * glm::dot(edge, edge), seen = glm::dot(area, area);
    return std::sqrt(nearest > 0.0 ? std::min(most, seen / (nearest * nearest)) : most);
  }

  double slope(const AxisRays& rays, int n) const
  {
    return this->Geometry.isPerspective() ? rays.slope[n] : 0.0;
  }

  /// The columns (a = 0) or rows (1) of pixels from corner to corner.
  Span extent(int a, int size) const
  {
    double low = Infinity, high = -Infinity;
    for (const glm::dvec3& corner : this->Corners)
    {
      const glm::dvec2 range = this->rangeOf(corner, a);
      low = std::min(low, range.x);
      high = std::max(high, range.y);
    }
    return integersIn(low, high, size);
  }

  /// The columns or rows between which a corner is visible: all unless it is well before the eye.
  glm::dvec2 rangeOf(const glm::dvec3& corner, int a) const
  {
    const double first = (a == 0 ? this->Geometry.columns() : this->Geometry.rows()).at[0];
    if (!this->Geometry.isPerspective())
    {
      return { corner[a] - first - this->Margin, corner[a] - first + this->Margin };
    }
    const glm::dvec3& eye = this->Geometry.eye();
    const glm::dvec3 way = corner - eye;
    const double far = this->Geometry.reference() - eye.z;
    const double ratio = far / way.z;
    if (!(ratio > 0.0 && ratio < 1e12))
    {
      return { -Infinity, Infinity };
    }
    const double pitch = this->Geometry.pitch();
    const double place = (eye[a] + way[a] * ratio - first) / pitch;
    // Rounding errors are largest near the eye, where rays are close together.
    const double rounding =
      (this->Margin + SlopeRounding * std::abs(far)) * std::max(ratio, 1.0) / pitch;
    return { place - rounding, place + rounding };
  }

  /// Coefficients that compare rays with an edge.
  struct Side
  {
    glm::dvec3 corner, edge; // in the direction of rotation that rays see
    double depth, tolerance;
  };

  Side side(int e) const
  {
    // Twice the margin, to include that of an omitted neighbour.
    const glm::dvec3 edge = this->Facing > 0.0 ? this->edge(e) : -this->edge(e);
    return { this->Corners[e], edge, this->Corners[e].z - this->Geometry.reference(),
      2.0 * this->Margin * this->length(e) };
  }

  /// The pixels of row v, out of some columns, that the triangle covers.
  Span pixels(const Side (&sides)[3], int v, const Span& some) const
  {
    const AxisRays &columns = this->Geometry.columns(), &rows = this->Geometry.rows();
    const int last = this->Geometry.rayCount().x - 1;
    double low = some.begin, high = some.end - 1.0;
    for (const Side& s : sides)
    {
      // The volume between a ray and an edge is not negative if the ray passes inside. Along the
      // row it is linear, except for rounding errors of rays.
      const double q = rows.at[v] + this->slope(rows, v) * s.depth - s.corner.y;
      const double across = s.edge.z * this->slope(rows, v) - s.edge.y;
      const double turned = across * s.depth - s.edge.z * q;
      const double rest = s.edge.x * q - across * s.corner.x;
      const auto inside = [&](int u)
      { return across * columns.at[u] + turned * this->slope(columns, u) + rest; };
      const double begin = inside(0), rise = inside(last) - begin;
      const double start = begin + s.tolerance;
      if (rise > 0.0)
      {
        low = std::max(low, -start * last / rise);
      }
      else if (rise < 0.0)
      {
        high = std::min(high, -start * last / rise);
      }
      else if (start < 0.0)
      {
        return {};
      }
    }
    return integersIn(low, high, last + 1);
  }

  void cover(int v, const Span& pixels, double* near, double* far) const
  {
    const AxisRays &columns = this->Geometry.columns(), &rows = this->Geometry.rows();
    const glm::dvec3 &a = this->Corners[0], &n = this->Normal;
    const double depth = a.z - this->Geometry.reference();
    const double rest = n.y * (rows.at[v] + this->slope(rows, v) * depth - a.y);
    const double speed = n.y * this->slope(rows, v) + n.z;
    for (int u = pixels.begin; u < pixels.end; ++u)
    {
      const double distance = n.x * (columns.at[u] + this->slope(columns, u) * depth - a.x) + rest;
      // Limits depths of steep triangles, whose planes are far away beside their edges.
      const double z =
        std::clamp(a.z - distance / (n.x * this->slope(columns, u) + speed), this->Low, this->High);
      near[u] = std::min(near[u], z);
      far[u] = std::max(far[u], z);
    }
  }

  const ShearWarp& Geometry;
  glm::dvec3 Corners[3];
  glm::dvec3 Normal;
  double Facing;        // positive if rays see the corners in the direction of rotation from i to j
  double Nearest = 1.0; // in perspective views, the distance of the nearest corner before the eye
  double Margin = 0.0, Low, High;
};

/// Whether a half-line from the origin along +z, or -z, crosses a triangle. All triangles at an
/// edge decide in the same way on which side of it the line passes, regardless of rounding.
bool isMet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool reversed)
{
  const glm::dvec3* const corners[] = { &a, &b, &c };
  bool isInside = false;
  for (int e = 0; e < 3; ++e)
  {
    const glm::dvec3* low = corners[e];
    const glm::dvec3* high = corners[(e + 1) % 3];
    if (low->y > high->y)
    {
      std::swap(low, high);
    }
    isInside ^= low->y <= 0.0 && high->y > 0.0 && low->x * high->y - high->x * low->y > 0.0;
  }
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double z = std::clamp(
    glm::dot(normal, a) / normal.z, std::min({ a.z, b.z, c.z }), std::max({ a.z, b.z, c.z }));
  return isInside && (reversed ? z < 0.0 : z > 0.0);
}
}

void ClosedSurface::reset(std::vector<glm::dvec3> points, std::vector<glm::ivec3> triangles)
{
  this->Points = std::move(points);
  this->Triangles = std::move(triangles);
  for (SurfaceDepths& depths : this->Projections)
  {
    depths.Valid = false;
  }
}

bool ClosedSurface::contains(const glm::dvec3& point) const
{
  bool isInside = false;
  for (const glm::ivec3& t : this->Triangles)
  {
    isInside ^= isMet(
      this->Points[t[0]] - point, this->Points[t[1]] - point, this->Points[t[2]] - point, false);
  }
  return isInside;
}

const SurfaceDepths& ClosedSurface::project(const ShearWarp& geometry)
{
  const int direction =
    geometry.isPerspective() ? 2 * geometry.principalAxis() + geometry.reversed() : 0;
  SurfaceDepths& depths = this->Projections[direction];
  if (!depths.Valid || !geometry.sameShear(depths.Geometry) ||
    geometry.eye() != depths.Geometry.eye())
  {
    depths.Valid = true;
    depths.Geometry = geometry;
    this->permute(geometry.axes());
    this->findRows(geometry);
    this->findDepths(depths);
  }
  return depths;
}

void ClosedSurface::permute(const std::array<int, 3>& axes)
{
  this->Positions.resize(this->Points.size());
  std::transform(this->Points.begin(), this->Points.end(), this->Positions.begin(),
    [&](const glm::dvec3& p) { return glm::dvec3(p[axes[0]], p[axes[1]], p[axes[2]]); });
}

void ClosedSurface::findRows(const ShearWarp& geometry)
{
  this->Rows.resize(this->Triangles.size());
  std::transform(this->Triangles.begin(), this->Triangles.end(), this->Rows.begin(),
    [&](const glm::ivec3& t)
    {
      const Triangle triangle(
        geometry, this->Positions[t[0]], this->Positions[t[1]], this->Positions[t[2]]);
      const Span rows = triangle.rows();
      return rows.empty() || triangle.isUnseen() ? Span{} : rows;
    });
}

void ClosedSurface::findDepths(SurfaceDepths& depths) const
{
  const ShearWarp& geometry = depths.Geometry;
  const std::size_t width = geometry.width();
  const glm::dvec2 beginning = this->beginning(geometry);
  depths.Near.resize(width * geometry.height());
  depths.Far.resize(depths.Near.size());
  parallelFor(0, geometry.height(), 32,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      std::fill_n(&depths.Near[begin * width], (end - begin) * width, beginning.x);
      std::fill_n(&depths.Far[begin * width], (end - begin) * width, beginning.y);
      for (std::size_t t = 0; t < this->Triangles.size(); ++t)
      {
        const int first = std::max(this->Rows[t].begin, static_cast<int>(begin));
        const int last = std::min(this->Rows[t].end, static_cast<int>(end));
        if (first < last)
        {
          const glm::ivec3& corners = this->Triangles[t];
          const Triangle triangle(geometry, this->Positions[corners[0]],
            this->Positions[corners[1]], this->Positions[corners[2]]);
          triangle.cover({ first, last }, { depths.Near.data(), depths.Far.data() });
        }
      }
    });
}

/// Initial near and far depths of all rays.
glm::dvec2 ClosedSurface::beginning(const ShearWarp& geometry) const
{
  glm::dvec2 result(Infinity, -Infinity);
  const glm::dvec3& eye = geometry.eye();
  bool isInside = false;
  for (std::size_t t = 0; geometry.isPerspective() && t < this->Triangles.size(); ++t)
  {
    const glm::ivec3& corners = this->Triangles[t];
    isInside ^= isMet(this->Positions[corners[0]] - eye, this->Positions[corners[1]] - eye,
      this->Positions[corners[2]] - eye, geometry.reversed());
  }
  if (isInside)
  {
    (geometry.reversed() ? result.y : result.x) = eye.z;
  }
  return result;
}
}
