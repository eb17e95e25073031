// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingSurfaceOnScreen_h
#define splattingSurfaceOnScreen_h

#include "Geometry/PixelRays.h"

#include <glm/vec2.hpp>

#include <vector>

namespace splatting
{
class ClosedSurface;

/**
 * The parameters t at which the rays of the screen's pixels enter and leave a closed surface of
 * triangles: the least and the greatest of their crossings. Rays that begin inside enter at their
 * beginning.
 */
class SurfaceOnScreen
{
public:
  /// Computes them for a rectangle of the viewport.
  void find(const ClosedSurface& surface, const PixelRays& rays, const glm::ivec2& origin,
    const glm::ivec2& size);
  bool empty() const { return this->Near.empty(); }

  /// Limits the rays of pixels (x, y), (x + 1, y), ... to the part inside.
  void cut(int x, int y, int count, double* near, double* far) const;

private:
  glm::ivec2 Origin{ 0 }, Size{ 0 };
  std::vector<double> Near, Far;
};
}

#endif
