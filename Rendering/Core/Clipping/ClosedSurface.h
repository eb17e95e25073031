// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The depths at which rays enter and leave a closed surface of triangles.
 */
#ifndef splattingClosedSurface_h
#define splattingClosedSurface_h

#include "Geometry/ShearWarp.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace splatting
{
/**
 * The least and the greatest depth, in slices, at which the ray of each pixel of a shear image
 * crosses a surface. With more than two crossings this is the hull along the ray. A ray that begins
 * inside the surface, at the eye of a perspective view, crosses it there.
 */
class SurfaceDepths
{
public:
  /// The two depths of each pixel of a row; near > far if the ray misses the surface.
  const double* near(int v) const { return &this->Near[std::size_t(v) * this->Geometry.width()]; }
  const double* far(int v) const { return &this->Far[std::size_t(v) * this->Geometry.width()]; }

private:
  friend class ClosedSurface;

  bool Valid = false;
  ShearWarp Geometry;
  std::vector<double> Near, Far;
};

/**
 * A surface of triangles.
 *
 * A triangle includes its edges, and points within 1e-9 pixels (relative to its coordinates) of
 * them, so that no ray passes between neighbours. In perspective views this distance is enlarged by
 * the rounding errors of rays (see ShearWarp). Only rays in the columns and rows between its
 * corners cross it. Triangles that appear narrower than that are omitted, because the neighbour at
 * the longest edge covers them. The eye is inside if a line from it crosses the surface an odd
 * number of times.
 */
class ClosedSurface
{
public:
  bool empty() const { return this->Triangles.empty(); }
  void clear() { this->reset({}, {}); }
  /// Sets points in index space, with coordinates of at most 1e12, and three of them for each
  /// triangle.
  void reset(std::vector<glm::dvec3> points, std::vector<glm::ivec3> triangles);

  /// Calls f(corners) for each triangle.
  template <class F>
  void forTriangles(F&& f) const
  {
    for (const glm::ivec3& t : this->Triangles)
    {
      f({ this->Points[t[0]], this->Points[t[1]], this->Points[t[2]] });
    }
  }

  /// Whether a line from a point crosses the surface an odd number of times.
  bool contains(const glm::dvec3& point) const;

  /// Computes the depths, unless the last call for an image with this direction had the same rays.
  /// They are valid until the next call for this direction.
  const SurfaceDepths& project(const ShearWarp& geometry);

private:
  void permute(const std::array<int, 3>& axes);
  void findRows(const ShearWarp& geometry);
  void findDepths(SurfaceDepths& depths) const;
  glm::dvec2 beginning(const ShearWarp& geometry) const;

  std::vector<glm::dvec3> Points;
  std::vector<glm::ivec3> Triangles;
  std::vector<glm::dvec3> Positions; // the points in the order of the image's axes
  std::vector<Span> Rows;            // that may have pixels of each triangle
  /// Perspective images use the element of their direction. Parallel images use the first element.
  std::array<SurfaceDepths, 6> Projections;
};
}

#endif
