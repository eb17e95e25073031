// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Pieces of one volume that are projected apart, each onto the image of the whole. MAX is
 * associative: the image of the whole is the maximum (or minimum) of theirs, bit for bit, if each
 * pixel of each slice's worksheet is computed wholly by a piece that has all the voxels for it, and
 * each by one at least.
 */
#ifndef splattingPiece_h
#define splattingPiece_h

#include "Projection/Project.h"
#include "Projection/ProjectionContext.h"

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
 * How many voxels beyond the one that is nearest to a ray in the middle of a slice the slice's
 * worksheet reads: in the slice, and in other slices. The ghost layers that pieces need.
 *
 * A ray moves by half a voxel at most before and behind the middle, from which it is half a voxel
 * at most to the nearest voxel's side, and a pixel is half a voxel wide on either side. Standard
 * mode's boxes reach half a voxel further, 1.5 to 2 in all, high mode's hats one, and cosine bells
 * one and a half, of which the weights at the very end are 0. A cell of the exact field lies
 * between neighbouring voxels. Previews take each voxel by itself.
 */
struct Reach
{
  int across, along;

  int layers() const { return this->across > this->along ? this->across : this->along; }
};
Reach reachOf(Quality quality);

/// The part of a piece whose voxels have `layers` others of the piece, or none of the whole, on all
/// sides.
Box interiorOf(const Box& piece, const glm::ivec3& whole, const glm::ivec3& layers);

/// Whether each voxel of the whole is in one of the boxes.
bool cover(const std::vector<Box>& boxes, const glm::ivec3& whole);

/**
 * Keeps of the slices only the pixels whose worksheets need no voxels beyond the part: those whose
 * rays, in the middle of the slice, are nearest to a voxel of the part's interior.
 */
void keepInterior(const ShearWarp& whole, const ShearWarp& part, Quality quality,
  std::vector<SliceGeometry>& slices);

/**
 * Turns the pixels of a piece's image into numbers that ranks can reduce by maximum (for
 * Reduction::Minimum by minimum). Pixels without a sample become the least (the greatest) number.
 * Floating-point samples become integers in the same order, none of which is the least or the
 * greatest. In place.
 * @return  the type of these numbers
 */
ScalarType encode(ShearImage& image, Reduction reduction);

/// The image of a piece without samples.
/// @param voxels  the type of the volume
void blank(
  const ShearWarp& whole, ScalarType voxels, const ProjectionSettings& settings, ShearImage& image);

/**
 * Turns reduced numbers into an image again, which has the spans and the mask of the whole.
 * @param type  of the image's pixels
 */
void decode(ShearImage& image, ScalarType type, Reduction reduction);

/// After decode(), the lowest voxel where a depth-shaded image has no sample, as in RayWalk.
void fillEmpty(ShearImage& image, double low);
}

#endif
