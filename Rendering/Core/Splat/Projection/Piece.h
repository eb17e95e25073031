// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Pieces of one volume that are projected separately, each onto the image of the whole. MAX is
 * associative, so the image of the whole is the maximum (or minimum) of their images, bit for bit.
 * This has two conditions for each pixel of each slice's worksheet: at least one piece computes it,
 * and only pieces that have all of its voxels compute it.
 */
#ifndef splattingPiece_h
#define splattingPiece_h

#include "Splat/Projection/Project.h"
#include "Splat/Projection/ProjectionContext.h"

#include <glm/vec3.hpp>

#include <vector>

namespace splatting
{
/// Voxels [begin, end) along each axis.
struct Box
{
  glm::ivec3 begin{ 0 }, end{ 0 };

  bool empty() const
  {
    return this->begin.x >= this->end.x || this->begin.y >= this->end.y ||
      this->begin.z >= this->end.z;
  }
  bool operator==(const Box& other) const
  {
    return this->begin == other.begin && this->end == other.end;
  }
};

/**
 * The number of voxels that a slice's worksheet reads beyond the nearest voxel: `across` in the
 * slice, `along` in other slices. The nearest voxel is the one nearest to the point where the ray
 * crosses the middle of the slice. They determine the ghost layers of pieces.
 *
 * A ray moves by at most half a voxel before and behind the middle. The nearest voxel's side is at
 * most half a voxel away, and half of a pixel is half a voxel wide. Boxes of standard mode extend
 * by half a voxel. With the other distances this is 1.5 to 2 voxels. Hats of high mode extend by
 * one voxel, cosine bells by one and a half. The weights at the end are 0. A cell of the exact
 * field lies between neighbouring voxels. Preview reads single voxels.
 */
struct Reach
{
  int across, along;

  int layers() const { return this->across > this->along ? this->across : this->along; }
};
Reach reachOf(Quality quality);

/// The part of a piece whose voxels have `layers` other voxels of the piece on each side. A side
/// where the whole volume ends needs none.
Box interiorOf(const Box& piece, const glm::ivec3& whole, const glm::ivec3& layers);

/// Whether each voxel of the whole is in one of the boxes.
bool cover(const std::vector<Box>& boxes, const glm::ivec3& whole);

/**
 * Limits the slices to the pixels whose worksheets need no voxels outside the part: those whose
 * rays, in the middle of the slice, are nearest to a voxel of the part's interior.
 */
void keepInterior(const ShearWarp& whole, const ShearWarp& part, Quality quality,
  std::vector<SliceGeometry>& slices);

/**
 * Converts the pixels of a piece's image in place to numbers that ranks can reduce by maximum (by
 * minimum for Reduction::Minimum). Pixels without a sample become the least (greatest) number.
 * Floating-point samples become integers in the same order, excluding the least and the greatest.
 * @return  the type of these numbers
 */
ScalarType encode(ShearImage& image, Reduction reduction);

/// Makes the image of a piece without samples. Its member nonFinite must be set before.
/// @param voxels  the type of the volume
void blank(
  const ShearWarp& whole, ScalarType voxels, const ProjectionSettings& settings, ShearImage& image);

/**
 * Converts reduced numbers back to an image, with the spans and the mask of the whole.
 * @param type  of the image's pixels
 */
void decode(ShearImage& image, ScalarType type, Reduction reduction);

/// After decode(), sets depth-shaded pixels without a sample to the lowest voxel, as RayWalk does.
void fillEmpty(ShearImage& image, double low);
}

#endif
