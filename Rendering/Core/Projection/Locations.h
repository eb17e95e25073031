// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the samples lie that a projection shows: from winners to voxels, depths and points.
 *
 * A sample is the slice (in preview the voxel) that a pixel's value comes from. Its point lies on
 * the ray of the screen pixel (in overviews of the shear pixel), in the middle of that slice. In
 * exact mode it lies where that ray has its largest value, as RayFinder finds it. If RayFinder
 * finds none, and for other reductions, it lies at the depth of the field's extremum in the slice,
 * on the ray of the nearest shear pixel.
 *
 * Its voxel is, in preview, the one that wins; in standard and high the one of the slice that adds
 * most to the average: the largest weight times its distance from the volume's lowest value (of
 * minima, from the highest); in exact mode the one nearest to the point. If only a piece of the
 * volume is here, all modes but preview take the middle of the slice, and the voxel nearest to it.
 */
#ifndef splattingLocations_h
#define splattingLocations_h

#include "Display/ShearPixels.h"
#include "Projection/Project.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace splatting
{
/// A view's projection with winners. What is pointed at must outlive its use.
struct Located
{
  const std::vector<ShearImage>* images = nullptr;
  const std::vector<ShearWarp>* geometries = nullptr; ///< as many as the view has
  VoxelArray volume; ///< what was projected; without voxels if only a piece of it is here
  double low = 0.0, high = 0.0; ///< its range, infinities and NaN aside
  /// Of each image; without them nothing is looked for on the screen's own rays.
  const std::vector<Cuts>* cuts = nullptr;
  const SceneDepth* depth = nullptr; ///< of what else is in the scene, if there is anything
  ProjectionSettings settings;       ///< of the projection
  View view;
  glm::dmat4 indexToWorld{ 1.0 };
  /// Depths are distances from here: in parallel views along the direction, of length 1.
  glm::dvec3 camera{ 0.0 };
  glm::dvec3 direction{ 0.0, 0.0, -1.0 };
};

class Locator
{
public:
  explicit Locator(const Located& located);

  /// Where, along the principal axis, the sample of a shear pixel lies that has one, on its ray.
  double depthOf(const ShearPixel& shown) const;

  /// The point of index space that a viewport pixel (centre at integers) shows by way of its shear
  /// pixel, which must not be none.
  glm::dvec3 point(const glm::dvec2& pixel, const ShearPixel& shown) const;
  /// The voxel that it shows.
  glm::ivec3 voxel(const glm::dvec2& pixel, const ShearPixel& shown) const;
  glm::dvec3 inWorld(const glm::dvec3& point) const;
  /// Of a point of the world.
  double depth(const glm::dvec3& world) const;
  /// The depths of the nearest and the farthest corner of the box of voxel centres, no less than 0.
  glm::dvec2 depthRange() const;

  /// Where arrays go, or nullptr for what is not wanted; of pixels without a sample -1, NaN, NaN.
  struct Arrays
  {
    int* voxels = nullptr; ///< three of each pixel: i, j, k
    float* depths = nullptr;
    double* positions = nullptr; ///< three of each pixel
    float* clipDepths = nullptr; ///< as in depth buffers: 0 to 1
  };
  /// Fills what is given, all for a rectangle of the viewport, row by row from the bottom.
  void fill(const glm::ivec2& origin, const glm::ivec2& size, const Arrays& arrays) const;

private:
  /// The depth of the largest value on the ray of a pixel of the viewport; NaN if there is none.
  using DepthOnRay = std::function<double(const glm::ivec2&)>;

  /// Where a pixel's sample lies, and its voxel where its own ray tells that.
  struct Sample
  {
    glm::dvec3 point;
    glm::ivec3 voxel;
    bool hasVoxel;
  };
  Sample sample(const glm::dvec2& pixel, const ShearPixel& shown) const;
  glm::dvec3 pointAt(const glm::dvec2& pixel, const ShearPixel& shown, double z) const;
  double depthOnOwnRay(const glm::dvec2& pixel, const ShearPixel& shown) const;
  void fillRow(int y, const glm::ivec2& origin, int width, const ShearPixel* shown,
    const std::vector<std::vector<glm::ivec3>>& voxels, const Arrays& arrays) const;

  Located Source;
  std::vector<DepthOnRay> OwnRays; // of each image, where the screen's rays are looked along
};

/// The voxel of a shear pixel with a winner.
glm::ivec3 findVoxel(const Located& located, const ShearPixel& pixel);

/// The voxel of each pixel of a shear image with winners, -1 for none.
void findVoxels(const Located& located, std::size_t image, std::vector<glm::ivec3>& voxels);
}

#endif
