// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingPixelRays_h
#define splattingPixelRays_h

#include "Geometry/View.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace splatting
{
/**
 * The rays of a viewport's pixels in index space.
 *
 * The ray of pixel (x, y), whose centre lies at integers, is start(x, y) + t direction(x, y). The
 * parameter t grows away from the viewer; rays of perspective views begin at t = 0. Start
 * (parallel) or direction (perspective) is linear in x and y, the other one is constant.
 */
class PixelRays
{
public:
  /// Sets the rays of a view. Returns false if the view flattens the volume to a line or a point.
  bool find(const View& view);

  bool isPerspective() const { return this->Perspective; }

  glm::dvec3 start(double x, double y) const
  {
    return this->Perspective ? this->Origin : this->Origin + x * this->Across + y * this->Up;
  }
  glm::dvec3 direction(double x, double y) const
  {
    return this->Perspective ? this->Forward + x * this->Across + y * this->Up : this->Forward;
  }
  glm::dvec3 point(double x, double y, double t) const
  {
    return this->start(x, y) + t * this->direction(x, y);
  }

  /// The eye of perspective views, else the start of the ray of pixel (0, 0).
  const glm::dvec3& origin() const { return this->Origin; }
  /// From pixel to pixel along x and along y.
  const glm::dvec3& across() const { return this->Across; }
  const glm::dvec3& up() const { return this->Up; }
  /// The direction of parallel rays, else that of pixel (0, 0).
  const glm::dvec3& forward() const { return this->Forward; }

  /// From p - origin() to (x, y, t), in perspective (x t, y t, t).
  const glm::dmat3& toPixel() const { return this->ToPixel; }

private:
  bool Perspective = false;
  glm::dvec3 Origin{ 0.0 }, Across{ 1.0, 0.0, 0.0 }, Up{ 0.0, 1.0, 0.0 }, Forward{ 0.0, 0.0, 1.0 };
  glm::dmat3 ToPixel{ 1.0 };
};
}

#endif
