// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PieceExchange_h
#define PieceExchange_h

#include "Cells/CellScreen.h"
#include "Splat/Projection/Project.h"

#include <glm/vec3.hpp>

#include <cstddef>

namespace splatting
{
/**
 * The interface through which the projector of a piece exchanges data with those of the other
 * pieces.
 */
class PieceExchange
{
public:
  virtual ~PieceExchange() = default;

  /// The first voxel of the piece in the whole.
  virtual const glm::ivec3& First() const = 0;
  virtual VolumeIndex::Range RangeOfWhole(std::size_t component) const = 0;

  /// Collective: all ranks must call it. Whether the argument is true on any rank.
  virtual bool Any(bool here) const = 0;
  /// Collective. Turns the image of a piece into that of the whole, except for its spans and mask.
  /// @param geometry  of the whole
  virtual void Reduce(ShearImage& image, const ShearWarp& geometry, Reduction reduction) = 0;
  /// Collective. Turns the values of a piece into those of the whole, with the least depth of the
  /// pieces that have a pixel's value. Minima of Reduction::Signed are reduced likewise.
  virtual void Reduce(CellScreen& screen) = 0;
};
}

#endif
