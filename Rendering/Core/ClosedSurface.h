// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where rays enter and leave a closed surface of triangles.
 */
#ifndef splattingClosedSurface_h
#define splattingClosedSurface_h

#include "ShearWarp.h"

#include <glm/vec3.hpp>

#include <vector>

namespace splatting
{
/**
 * A surface and, for each pixel of the last shear image, the least and the greatest depth at which
 * the pixel's ray meets it: of surfaces that a ray meets more than twice, the hull along the ray.
 *
 * A triangle has its edges, and what lies within 1e-9 pixels (relative to its coordinates) of them,
 * so that no ray slips through between neighbours. Triangles that rays see edge-on are left out:
 * the neighbours have their edges.
 */
class ClosedSurface
{
public:
  bool empty() const { return this->Triangles.empty(); }
  void clear();
  /// Points in index space, with coordinates of at most 1e12, and three of them for each triangle.
  void reset(std::vector<glm::dvec3> points, std::vector<glm::ivec3> triangles);

  /// Finds the depths, in slices, unless the last call was for the same rays.
  void project(const ShearWarp& geometry);

  /// For each pixel of a row the two depths; near > far where the ray misses the surface.
  const double* near(int v) const { return &this->Near[std::size_t(v) * this->Width]; }
  const double* far(int v) const { return &this->Far[std::size_t(v) * this->Width]; }

private:
  void toPixels(const ShearWarp& geometry);
  void findRows(int height);

  std::vector<glm::dvec3> Points;
  std::vector<glm::ivec3> Triangles;
  bool Projected = false;
  ShearWarp Geometry;
  std::vector<glm::dvec3> Pixels; // the points' places in the image, and slices
  std::vector<Span> Rows;         // that each triangle may have pixels in
  int Width = 0;
  std::vector<double> Near, Far;
};
}

#endif
