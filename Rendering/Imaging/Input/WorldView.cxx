// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/WorldView.h"

#include "vtkMatrix4x4.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace splatting
{
namespace
{
glm::dvec4 row(const glm::dmat4& m, int r)
{
  return { m[0][r], m[1][r], m[2][r], m[3][r] };
}

/// Exchanges the flags of the lowest and the highest cropping regions along an axis.
unsigned mirrored(unsigned flags, int stride)
{
  unsigned result = 0;
  for (int bit = 0; bit < 27; ++bit)
  {
    const int region = bit / stride % 3;
    result |= (flags >> bit & 1u) << (bit + (2 - 2 * region) * stride);
  }
  return result;
}

/// The direction of projection in the world, and the largest step of rays along it from slice to
/// slice.
struct Projection
{
  glm::dvec3 normal;
  double slice;
};

Projection projectionOf(const View& view, const glm::dmat4& world)
{
  const glm::dmat3 linear(world);
  if (isParallel(view))
  {
    // Rays are the lines of constant screen coordinates.
    const glm::dvec3 ray =
      glm::cross(glm::dvec3(row(view.indexToClip, 0)), glm::dvec3(row(view.indexToClip, 1)));
    const glm::dvec3 across = linear * ray, steps = glm::abs(ray);
    return { glm::normalize(across),
      glm::length(across) / std::max({ steps.x, steps.y, steps.z }) };
  }
  // The direction in which w grows; a plane is a row vector. From slice to slice rays advance by
  // one step along one axis, and by at most one along the others.
  const glm::dvec3 w(row(view.indexToClip, 3));
  const glm::dvec3 normal = glm::normalize(w * glm::inverse(linear));
  const glm::dvec3 steps = glm::abs(normal * linear);
  return { normal, steps.x + steps.y + steps.z };
}

/// Adds a half-space of index space, if it cuts the volume's voxels.
void addHalfSpace(View& view, const glm::dvec4& h)
{
  double least = h.w;
  for (int a = 0; a < 3; ++a)
  {
    least += std::min(-0.5 * h[a], (view.dimensions[a] - 0.5) * h[a]);
  }
  if (least < 0.0)
  {
    view.halfSpaces.push_back(h);
  }
}
}

glm::dmat4 toGlm(const vtkMatrix4x4* matrix)
{
  glm::dmat4 m;
  for (int r = 0; r < 4; ++r)
  {
    for (int c = 0; c < 4; ++c)
    {
      m[c][r] = matrix->GetData()[4 * r + c];
    }
  }
  return m;
}

bool isSingular(const glm::dmat4& indexToWorld)
{
  const glm::dmat3 linear(indexToWorld);
  const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return !(std::abs(glm::determinant(linear)) > 1e-10 * lengths) || !std::isfinite(lengths) ||
    !std::isfinite(glm::length(indexToWorld[3]));
}

View viewOf(const VolumeGrid& grid, const glm::dmat4& indexToWorld, const glm::dmat4& worldToClip,
  const glm::ivec2& viewport)
{
  View view;
  view.dimensions = grid.dimensions;
  view.showsBoxes = grid.cells;
  view.viewport = viewport;
  view.indexToClip = worldToClip * indexToWorld;
  // Near and far plane: -w <= z <= w.
  const glm::dvec4 z = row(view.indexToClip, 2), w = row(view.indexToClip, 3);
  addHalfSpace(view, w + z);
  addHalfSpace(view, w - z);
  return view;
}

void addPlanes(View& view, const glm::dmat4& indexToWorld, vtkPlaneCollection* planes)
{
  vtkCollectionSimpleIterator it;
  planes->InitTraversal(it);
  while (vtkPlane* plane = planes->GetNextPlane(it))
  {
    const glm::dvec3 normal(plane->GetNormal()[0], plane->GetNormal()[1], plane->GetNormal()[2]);
    const glm::dvec3 origin(plane->GetOrigin()[0], plane->GetOrigin()[1], plane->GetOrigin()[2]);
    // A plane is a row vector, transformed from the right.
    addHalfSpace(view, glm::dvec4(normal, -glm::dot(normal, origin)) * indexToWorld);
  }
}

Cropping croppingOf(const VolumeGrid& grid, const double planes[6], int flags)
{
  Cropping cropping;
  unsigned shown = static_cast<unsigned>(flags);
  for (int a = 0, stride = 1; a < 3; ++a, stride *= 3)
  {
    const double spacing = grid.spacing[a], first = grid.first[a];
    cropping.planes[a] = { (planes[2 * a] - first) / spacing,
      (planes[2 * a + 1] - first) / spacing };
    if (spacing < 0.0)
    {
      std::swap(cropping.planes[a][0], cropping.planes[a][1]);
      shown = mirrored(shown, stride);
    }
  }
  cropping.flags = shown & Cropping::All;
  return cropping;
}

void addSlab(View& view, const glm::dmat4& indexToWorld, const double centre[3], double thickness)
{
  const Projection projection = projectionOf(view, indexToWorld);
  const double place = glm::dot(projection.normal, glm::dvec3(centre[0], centre[1], centre[2]));
  // A slab thinner than a slice shows the nearest slice. It must not be lost by rounding.
  const double half = 0.5 * std::max(thickness, 1e-3 * projection.slice);
  addHalfSpace(view, glm::dvec4(projection.normal, half - place) * indexToWorld);
  addHalfSpace(view, glm::dvec4(-projection.normal, half + place) * indexToWorld);
}
}
