// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Depths of the scene that hide a volume.
 */
#ifndef splattingSceneDepth_h
#define splattingSceneDepth_h

#include "Display/Picture.h"
#include "Geometry/ShearWarp.h"
#include "Geometry/View.h"

#include <vector>

namespace splatting
{
class PixelRays;

/**
 * Depths of the scene, one per screen pixel, and the position of the volume relative to them.
 *
 * The volume is the box that its picture shows (see WarpedScalars), in the view's half-spaces.
 * Depths before it hide it, pixel by pixel of the screen (hide()). Depths inside end the rays of
 * the shear image (endRays()), each at the depth of the nearest screen pixel. A hidden pixel does
 * not end its ray, because its neighbours on the screen interpolate with the uncut ray.
 *
 * A depth within 2^-21 of the front of the box counts as before it. A depth within 2^-21 of the
 * back counts as behind it. Depth buffers have 24 bits, and vertices are transformed in single
 * precision.
 */
class SceneDepth
{
public:
  /// Whether the depths are equal.
  bool operator==(const SceneDepth& other) const
  {
    return this->Origin == other.Origin && this->Size == other.Size &&
      this->Samples == other.Samples;
  }

  /// Removes all depths.
  void clear()
  {
    this->Size = {};
    this->Samples.clear();
  }
  bool empty() const { return this->Size.x < 1 || this->Size.y < 1; }

  /// Whether there are depths of this rectangle.
  bool isOf(const glm::ivec2& origin, const glm::ivec2& size) const
  {
    return !this->empty() && this->Origin == origin && this->Size == size;
  }

  /// Allocates the depths of a rectangle of viewport pixels, 0 at the near and 1 at the far plane,
  /// row by row from the bottom. The caller sets them.
  float* allocate(const glm::ivec2& origin, const glm::ivec2& size);

  /// Sets the view that the depths were rendered with.
  void place(const View& view);

  /// Limits the near and far depths, in slices, of the rays of `count` pixels from (u, v) on of a
  /// shear image of this view.
  void endRays(const ShearWarp& geometry, int u, int v, int count, double* near, double* far) const;

  /// The same by the depth of one pixel of the viewport, for a ray at position at + slope (z -
  /// reference) at depth z.
  void endRay(const ShearWarp& geometry, const glm::ivec2& pixel, const glm::dvec2& at,
    const glm::dvec2& slope, double& near, double& far) const;

  /// Ends the rays of the pixels (x, y), (x + 1, y), ... of this view at their depths.
  void endRays(const PixelRays& rays, int x, int y, int count, double* far) const;

  /// Clears the hidden pixels of a picture.
  void hide(Picture& picture) const;

private:
  /// The depths at which rays enter and leave a convex body, as affine functions of screen pixels;
  /// in perspective, depths behind the eye are larger than all others.
  struct Body
  {
    std::vector<glm::dvec3> fronts, backs;

    double entry(const glm::dvec3& pixel) const;
    double exit(const glm::dvec3& pixel) const;
  };

  void addBox(const glm::dvec3& low, const glm::dvec3& high, Body& body) const;
  void addHalfSpace(const glm::dvec4& h, Body& body) const;
  float at(const glm::ivec2& pixel) const;
  bool endsRay(const glm::ivec2& pixel, double depth) const;

  glm::ivec2 Origin{ 0 }, Size{ 0 }, Viewport{ 0 };
  std::vector<float> Samples;
  glm::dmat4 ClipToIndex{ 1.0 };
  glm::dvec4 ClipZ{ 0.0 }, ClipW{ 0.0 }; // of (x, y, z, 1)
  Body Shown, Voxels;                    // the latter with the outer halves of the voxels
};
}

#endif
