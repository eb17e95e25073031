// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the samples lie that a projection shows: from winners to voxels, depths and points.
 *
 * In exact projections a sample lies where the pixel's ray has its extremum, and its voxel is the
 * one nearest to that point. Else a sample is the slice (in preview the voxel) that a pixel's value
 * comes from. Its point lies on the ray of the screen pixel (in overviews of the shear pixel), in
 * the middle of that slice. Its voxel is, in preview, the one that wins; in standard and high the
 * one of the slice that adds most to the average: the largest weight times its distance from the
 * volume's lowest value (of minima, from the highest). If only a piece of the volume is here, it is
 * the voxel nearest to the point.
 */
#ifndef splattingLocations_h
#define splattingLocations_h

#include "Display/ShearPixels.h"
#include "Projection/Project.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace splatting
{
struct ScreenScalars;

/// A view's projection with winners. What is pointed at must outlive its use.
struct Located
{
  const std::vector<ShearImage>* images = nullptr;
  const std::vector<ShearWarp>* geometries = nullptr; ///< as many as the view has
  VoxelArray volume; ///< what was projected; without voxels if only a piece of it is here
  double low = 0.0, high = 0.0; ///< its range, infinities and NaN aside
  /// Of an exact projection, with depths: there are no images then.
  const ScreenScalars* screen = nullptr;
  ProjectionSettings settings; ///< of the projection
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

  /// A sample, if there is one.
  struct Sample
  {
    bool exists = false;
    glm::dvec3 point{ 0.0 }; ///< in index space
    glm::ivec3 voxel{ -1 };
  };
  /// What a pixel of the viewport shows in an exact projection.
  Sample onScreen(const glm::ivec2& pixel) const;
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
  glm::dvec3 pointAt(const glm::dvec2& pixel, const ShearPixel& shown, double z) const;
  template <class F>
  void fillFrom(
    const glm::ivec2& origin, const glm::ivec2& size, const Arrays& arrays, F&& sampleOf) const;
  void put(std::size_t at, const Sample& sample, const Arrays& arrays) const;

  Located Source;
};

/// The voxel of a shear pixel with a winner.
glm::ivec3 findVoxel(const Located& located, const ShearPixel& pixel);

/// The voxel of each pixel of a shear image with winners, -1 for none.
void findVoxels(const Located& located, std::size_t image, std::vector<glm::ivec3>& voxels);
}

#endif
