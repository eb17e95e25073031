// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where rays enter and leave a closed surface of triangles.
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
 * For each pixel of a shear image the least and the greatest depth, in slices, at which its ray
 * meets a surface: of surfaces that a ray meets more than twice, the hull along the ray. A ray that
 * begins inside the surface, at the eye of a perspective view, meets it there.
 */
class SurfaceDepths
{
public:
  /// For each pixel of a row the two depths; near > far where the ray misses the surface.
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
 * A triangle has its edges, and what lies within 1e-9 pixels (relative to its coordinates) of them,
 * so that no ray slips through between neighbours; in perspective views also what the rounding of
 * rays (see ShearWarp) may take away. No ray beside all columns or all rows of its corners meets
 * it. Triangles that rays see narrower than that are left out: the neighbour at the longest edge
 * has them. The eye is inside where a line from it meets the surface an odd number of times.
 */
class ClosedSurface
{
public:
  bool empty() const { return this->Triangles.empty(); }
  void clear() { this->reset({}, {}); }
  /// Points in index space, with coordinates of at most 1e12, and three of them for each triangle.
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

  /// Whether a line from a point meets the surface an odd number of times.
  bool contains(const glm::dvec3& point) const;

  /// Finds the depths, unless the last call for an image with this direction was for the same rays.
  /// They stay until the next call for one.
  const SurfaceDepths& project(const ShearWarp& geometry);

private:
  void permute(const std::array<int, 3>& axes);
  void findRows(const ShearWarp& geometry);
  void findDepths(SurfaceDepths& depths) const;
  glm::dvec2 beginning(const ShearWarp& geometry) const;

  std::vector<glm::dvec3> Points;
  std::vector<glm::ivec3> Triangles;
  std::vector<glm::dvec3> Positions; // the points in the order of the image's axes
  std::vector<Span> Rows;            // that each triangle may have pixels in
  /// Of perspective images by their direction; of parallel ones the first.
  std::array<SurfaceDepths, 6> Projections;
};
}

#endif
