// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Positions of the samples that a projection shows: voxels, depths and points.
 *
 * In exact projections a sample lies where the pixel's ray has its extremum, and its voxel is the
 * nearest one. In other projections a sample is a slice, in preview a voxel. Its point is where the
 * ray of the screen pixel (in overviews of the shear pixel) crosses the middle of the slice. In
 * preview its voxel is the sample itself. In standard and high mode it is the voxel that
 * contributes most to the slice's sample. The contribution is its weight times its height above the
 * volume's lowest value (for minima, its depth below the highest value). If only a piece of the
 * volume is available, it is the voxel nearest to the point.
 *
 * In Reduction::Signed a pixel has the location of its maximum or of its minimum, whichever its
 * picture shows.
 */
#ifndef splattingLocations_h
#define splattingLocations_h

#include "Clipping/RayEnds.h"
#include "Splat/Projection/Project.h"
#include "Splat/Warp/ShearPixels.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace splatting
{
class CellScreen;

/// A projection of a view. The objects that its pointers refer to must exist while it is used.
struct Located
{
  const std::vector<ShearImage>* images = nullptr;
  const std::vector<ShearWarp>* geometries = nullptr; ///< as many as the view has
  const std::vector<Cuts>* cuts = nullptr;            ///< of each image
  VoxelArray volume; ///< the projected volume; without voxels if only a piece is available
  double low = 0.0, high = 0.0; ///< the range of its finite voxels
  /// The result of an exact projection with recorded locations. There are no images then.
  const CellScreen* screen = nullptr;
  RayEnds ends;                ///< of the view; of images without the surface
  ProjectionSettings settings; ///< of the projection
  View view;
  glm::dmat4 indexToWorld{ 1.0 };
  /// Depths are distances from this point, in parallel views along the direction, which has length
  /// 1.
  glm::dvec3 camera{ 0.0 };
  glm::dvec3 direction{ 0.0, 0.0, -1.0 };
};

/// The samples of a projection with recorded locations.
class Locator
{
public:
  explicit Locator(const Located& located);

  /// A sample, if there is one.
  struct Sample
  {
    bool exists = false;
    glm::dvec3 point{ 0.0 }; ///< in index space
    glm::ivec3 voxel{ -1 };
    /// In units of the scalars; the extremum, voxel or average that the location belongs to.
    double value = std::numeric_limits<double>::quiet_NaN();
  };
  /// The sample that a pixel of the viewport shows.
  Sample at(const glm::ivec2& pixel) const;
  /// The sample that a pixel of the viewport shows, if its shear pixel is known.
  /// @param shown  may be none
  Sample at(const glm::ivec2& pixel, const ShearPixel& shown) const;
  glm::dvec3 inWorld(const glm::dvec3& point) const;
  /// @param world  a point in world space
  double depth(const glm::dvec3& world) const;
  /// The depths of the nearest and the farthest corner of the box of voxel centres, not below 0.
  glm::dvec2 depthRange() const;

  /// Destinations of arrays, nullptr if not wanted. Pixels without a sample get -1, NaN, NaN.
  struct Arrays
  {
    int* voxels = nullptr; ///< three for each pixel: i, j, k
    float* depths = nullptr;
    double* positions = nullptr; ///< three for each pixel
    float* clipDepths = nullptr; ///< as in depth buffers, 0 to 1
  };
  /// Fills the arrays for a rectangle of the viewport, row by row from the bottom.
  void fill(const glm::ivec2& origin, const glm::ivec2& size, const Arrays& arrays) const;

private:
  Sample onScreen(const glm::ivec2& pixel) const;
  glm::dvec3 point(const glm::dvec2& pixel, const ShearPixel& shown) const;
  glm::dvec3 pointAt(const glm::dvec2& pixel, const ShearPixel& shown, double z) const;
  template <class F>
  void fillFrom(
    const glm::ivec2& origin, const glm::ivec2& size, const Arrays& arrays, F&& sampleOf) const;
  void put(std::size_t at, const Sample& sample, const Arrays& arrays) const;

  Located Source;
};

/// As findShearPixels(), for a rectangle of the projection's viewport. In Reduction::Signed the
/// shear pixels have the extremum that WarpedScalars shows.
void findShown(const Located& located, const glm::ivec2& origin, const glm::ivec2& size,
  ShearPixel* out, const std::function<bool(const ShearPixel&)>& hasSample = {});

/// The value of a shear pixel.
double valueOf(const std::vector<ShearImage>& images, const ShearPixel& pixel);

/// The voxel of each pixel of a shear image with winners, -1 for none.
/// @param minima  in Reduction::Signed whether to find those of minima
void findVoxels(
  const Located& located, std::size_t image, std::vector<glm::ivec3>& voxels, bool minima = false);
}

#endif
