// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a viewport's depth buffer hides of a volume.
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
 * Depths of other things in the scene, one per screen pixel, and where the volume lies among them.
 *
 * A volume is the box that its picture shows (see Warper), in the view's half-spaces. What lies
 * before it hides it, pixel by pixel of the screen (hide()); what lies inside ends the rays of the
 * shear image (endRays()), each at the depth of the screen pixel nearest to it. A pixel that is
 * hidden does not end its ray: its neighbours on the screen interpolate with the whole one.
 *
 * Depths within 2^-21 of the depth range count as equal to that of the box, to be before it at the
 * front and behind it at the back: depth buffers have 24 bits, and vertices are transformed in
 * single precision.
 */
class SceneDepth
{
public:
  /// Whether the same depths are known.
  bool operator==(const SceneDepth& other) const
  {
    return this->Origin == other.Origin && this->Size == other.Size &&
      this->Samples == other.Samples;
  }

  /// Nothing is known.
  void clear()
  {
    this->Size = {};
    this->Samples.clear();
  }
  bool empty() const { return this->Size.x < 1 || this->Size.y < 1; }

  /// Whether depths of this rectangle are known.
  bool isOf(const glm::ivec2& origin, const glm::ivec2& size) const
  {
    return !this->empty() && this->Origin == origin && this->Size == size;
  }

  /// The depths of a rectangle of viewport pixels, 0 at the near and 1 at the far plane, row by row
  /// from the bottom, to be filled by the caller.
  float* allocate(const glm::ivec2& origin, const glm::ivec2& size);

  /// Says how the volume lies in the view that the depths were drawn with.
  void place(const View& view);

  /// Cuts the near and far depths, in slices, of the rays of `count` pixels from (u, v) on of a
  /// shear image of this view.
  void endRays(const ShearWarp& geometry, int u, int v, int count, double* near, double* far) const;

  /// The same for a ray that passes at + slope (z - the geometry's reference) at depth z, by the
  /// depth of one pixel of the viewport.
  void endRay(const ShearWarp& geometry, const glm::ivec2& pixel, const glm::dvec2& at,
    const glm::dvec2& slope, double& near, double& far) const;

  /// Ends the rays of the pixels (x, y), (x + 1, y), ... of this view where other things lie.
  void endRays(const PixelRays& rays, int x, int y, int count, double* far) const;

  /// Clears the pixels of a picture that are hidden.
  void hide(Picture& picture) const;

private:
  /// Depths where rays enter and leave a convex body, each an affine function of screen pixels: in
  /// perspective, too, where that of what lies behind the eye is deeper than anything before it.
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
  Body Shown, Voxels;                    // the latter with the voxels' outer halves
};
}

#endif
