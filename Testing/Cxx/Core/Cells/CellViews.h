// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Views of small volumes: parallel and perspective, from anywhere, along axes and diagonals, nearly
 * along these, from inside the volume.
 */
#ifndef CellViews_h
#define CellViews_h

#include "CellTesting.h"

namespace celltesting
{
/// Turned and scaled as by a direction matrix and a prop matrix with any spacing.
inline glm::dmat3 randomPlacement(Random& random)
{
  glm::dmat4 m(1.0);
  const bool turns = !random.oneIn(3);
  if (turns)
  {
    const glm::dvec3 axis = coretesting::anyVector(random, -1.0, 1.0) + glm::dvec3(0.0, 0.0, 1.1);
    m = glm::rotate(m, random.uniform(0.0, 6.3), glm::normalize(axis));
  }
  if (random.oneIn(3))
  {
    m = glm::scale(m, coretesting::anyVector(random, 0.6, 1.5)); // of the prop
  }
  if (turns)
  {
    const glm::dvec3 axis = coretesting::anyVector(random, -1.0, 1.0) + glm::dvec3(1.1, 0.0, 0.0);
    m = glm::rotate(m, random.uniform(0.0, 6.3), glm::normalize(axis));
  }
  if (!random.oneIn(4))
  {
    m = glm::scale(m, coretesting::anyVector(random, 0.5, 2.0)); // spacing
  }
  return glm::dmat3(m);
}

/// A direction of view in index space.
inline glm::dvec3 randomDirection(Random& random)
{
  glm::dvec3 d(0.0);
  switch (random.uniform(0, 4))
  {
    case 0: // an axis
      d[random.uniform(0, 2)] = random.sign();
      return d;
    case 1: // a diagonal
      while (d == glm::dvec3(0.0))
      {
        for (int a = 0; a < 3; ++a)
        {
          d[a] = random.uniform(-2, 2);
        }
      }
      return d;
    case 2: // nearly one of these
    {
      d = coretesting::anyVector(random, -1.0, 1.0) * std::pow(10.0, random.uniform(-14.0, -1.0));
      d[random.uniform(0, 2)] += 1.0;
      return d;
    }
    default:
      return coretesting::anyDirection(random);
  }
}

/// What looks along a direction: right, up and forward in the world, for index space.
struct Camera
{
  glm::dmat3 placement{ 1.0 };
  glm::dvec3 right, up, forward;

  Camera(const glm::dmat3& place, const glm::dvec3& direction, Random& random) : placement(place)
  {
    this->forward = glm::normalize(place * direction);
    glm::dvec3 side(0.0);
    if (random.oneIn(2))
    {
      side = coretesting::anyVector(random, -1.0, 1.0);
    }
    if (glm::length(glm::cross(side, this->forward)) < 0.1)
    {
      // An axis of the volume is upright on the screen.
      const glm::dvec3 size = glm::abs(this->forward);
      side = glm::dvec3(0.0);
      side[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1.0;
    }
    this->right = glm::normalize(glm::cross(this->forward, side));
    this->up = glm::cross(this->right, this->forward);
  }
  /// A row of a matrix: direction . placement (p - middle).
  glm::dvec4 row(const glm::dvec3& direction, const glm::dvec3& middle) const
  {
    const glm::dvec3 r = glm::transpose(this->placement) * direction;
    return { r, -glm::dot(r, middle) };
  }
};

inline void setRows(
  View& view, const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z, const glm::dvec4& w)
{
  view.indexToClip = glm::transpose(glm::dmat4(x, y, z, w));
}

/// @param pixels  on the screen per voxel, about
inline View parallelView(const std::array<int, 3>& size, double pixels, int largestWindow,
  const glm::dvec3& direction, const glm::dmat3& placement, Random& random)
{
  View view;
  view.dimensions = coretesting::toGlm(size);
  const double span =
    pixels * (glm::length(placement * glm::dvec3(view.dimensions)) * random.uniform(0.6, 1.2) + 1);
  const int window = std::min(largestWindow, static_cast<int>(span) + 2);
  view.viewport = { std::max(random.uniform(window / 2, window), 1),
    std::max(random.uniform(window / 2, window), 1) };
  const Camera camera(placement, direction, random);
  const glm::dvec3 middle = 0.5 * glm::dvec3(view.dimensions - 1);
  glm::dvec4 x = camera.row(camera.right, middle), y = camera.row(camera.up, middle);
  glm::dvec4 z = camera.row(camera.forward, middle);
  // From voxels to pixels, then to the clip cube. Some pixels' centres lie in faces of cells.
  glm::dvec2 centre(0.0);
  if (random.oneIn(2))
  {
    centre = { random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0) };
  }
  x = pixels * x + glm::dvec4(0.0, 0.0, 0.0, centre.x);
  y = pixels * y + glm::dvec4(0.0, 0.0, 0.0, centre.y);
  const double w = !random.oneIn(4) ? 1.0 : random.oneIn(2) ? 2.5 : -0.5;
  const double depth = 1.0 / (2.0 * glm::length(placement * glm::dvec3(view.dimensions)));
  setRows(view, 2.0 * w / view.viewport.x * x, 2.0 * w / view.viewport.y * y, depth * w * z,
    { 0.0, 0.0, 0.0, w });
  return view;
}

/// @param pixels    on the screen per voxel, about, at the volume's middle
/// @param distance  of the eye from the middle, as a multiple of the volume's size
inline View perspectiveView(const std::array<int, 3>& size, double pixels, int largestWindow,
  double distance, const glm::dvec3& direction, const glm::dmat3& placement, Random& random)
{
  View view;
  view.dimensions = coretesting::toGlm(size);
  const double extent = glm::length(placement * glm::dvec3(view.dimensions));
  const int window = std::min(largestWindow, static_cast<int>(pixels * extent) + 2);
  view.viewport = { std::max(random.uniform(window / 2, window), 1),
    std::max(random.uniform(window / 2, window), 1) };
  const Camera camera(placement, direction, random);
  const glm::dvec3 middle = 0.5 * glm::dvec3(view.dimensions - 1);
  // A point in the middle of the screen, and the eye before it.
  glm::dvec3 focus = middle;
  for (int a = 0; a < 3; ++a)
  {
    focus[a] += random.uniform(-0.3, 0.3) * size[a];
  }
  glm::dvec3 eye = focus - glm::inverse(placement) * (camera.forward * distance * extent);
  if (random.oneIn(3))
  {
    eye = glm::round(2.0 * eye) / 2.0; // rays meet edges
  }
  const double w = !random.oneIn(3) ? 1.0 : 3.0;
  const double reach = std::max(distance * extent, 1.0);
  // `pixels` per voxel at the distance of the middle.
  const glm::dvec4 x = camera.row(camera.right, eye) * (pixels * reach);
  const glm::dvec4 y = camera.row(camera.up, eye) * (pixels * reach);
  const glm::dvec4 z = camera.row(camera.forward, eye);
  const double near = 0.05 * reach, far = reach + 3.0 * extent;
  glm::dvec4 depth = z * ((far + near) / (far - near));
  depth.w -= 2.0 * far * near / (far - near);
  setRows(view, 2.0 * w / view.viewport.x * x, 2.0 * w / view.viewport.y * y, w * depth, w * z);
  return view;
}

/// Any of these. Half are perspective, a third of those with the eye in the volume or nearby.
inline View randomCellView(const std::array<int, 3>& size, int largestWindow, Random& random)
{
  const double pixels = random.uniform(1.0, random.oneIn(2) ? 3.0 : 8.0);
  const glm::dmat3 placement = randomPlacement(random);
  const glm::dvec3 direction = randomDirection(random);
  if (random.oneIn(2))
  {
    return parallelView(size, pixels, largestWindow, direction, placement, random);
  }
  const double distance = !random.oneIn(3) ? random.uniform(0.6, 6.0) : random.uniform(0.05, 0.6);
  return perspectiveView(size, pixels, largestWindow, distance, direction, placement, random);
}
}

#endif
