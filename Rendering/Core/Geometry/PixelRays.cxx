// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/PixelRays.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace splatting
{
namespace
{
/// The matrix with these rows, unless it is singular or not finite.
bool invert(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, glm::dmat3& inverse)
{
  const glm::dmat3 linear = glm::transpose(glm::dmat3(a, b, c));
  // Columns are the images of the volume's axes, which may have very different lengths.
  const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  if (!(std::abs(glm::determinant(linear)) > 1e-12 * lengths) || !std::isfinite(lengths))
  {
    return false;
  }
  inverse = glm::inverse(linear);
  return true;
}
}

bool PixelRays::find(const View& view)
{
  const glm::dmat4& m = view.indexToClip;
  const glm::dvec4 x = glm::row(m, 0), y = glm::row(m, 1), z = glm::row(m, 2), w = glm::row(m, 3);
  const glm::dvec2 step = 2.0 / glm::dvec2(view.viewport);
  const glm::dvec2 first = 0.5 * step - 1.0; // the centre of pixel (0, 0)
  const glm::dvec3 middle = 0.5 * glm::dvec3(view.dimensions - 1);
  this->Perspective = !isParallel(view);
  glm::dmat3 inverse;
  if (this->Perspective)
  {
    // linear (p - eye) = w (x, y, 1), x and y in [-1, 1] over the viewport.
    if (!invert(glm::dvec3(x), glm::dvec3(y), glm::dvec3(w), inverse))
    {
      return false;
    }
    this->Origin = -(inverse * glm::dvec3(x.w, y.w, w.w));
    this->Across = step.x * inverse[0];
    this->Up = step.y * inverse[1];
    this->Forward = first.x * inverse[0] + first.y * inverse[1] + inverse[2];
    // A step of t is about a voxel in the middle of the view.
    const double scale = 1.0 / glm::length(inverse[2]);
    this->Across *= scale;
    this->Up *= scale;
    this->Forward *= scale;
  }
  else
  {
    const double depth = glm::dot(glm::dvec3(w), middle) + w.w;
    const glm::dvec3 a = glm::dvec3(x) / depth, b = glm::dvec3(y) / depth;
    const glm::dvec3 along = glm::cross(a, b);
    if (!(glm::length(along) > 0.0))
    {
      return false;
    }
    const double sense = glm::dot(glm::dvec3(z) / depth, along) < 0.0 ? -1.0 : 1.0;
    this->Forward = sense * glm::normalize(along);
    if (!invert(a, b, this->Forward, inverse))
    {
      return false;
    }
    // t = 0 in the plane through the volume's middle, so that parameters are small.
    this->Origin = inverse *
      glm::dvec3(first.x - x.w / depth, first.y - y.w / depth, glm::dot(this->Forward, middle));
    this->Across = step.x * inverse[0];
    this->Up = step.y * inverse[1];
  }
  this->ToPixel = glm::inverse(glm::dmat3(this->Across, this->Up, this->Forward));
  return std::isfinite(glm::length(this->Origin)) && std::isfinite(glm::determinant(this->ToPixel));
}
}
