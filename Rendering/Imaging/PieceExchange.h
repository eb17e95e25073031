// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PieceExchange_h
#define PieceExchange_h

#include "Cells/ScreenScalars.h"
#include "Projection/Project.h"

#include <glm/vec3.hpp>

#include <cstddef>

namespace splatting
{
/**
 * What the projector of a piece of a volume needs of those that have the other pieces.
 */
class PieceExchange
{
public:
  virtual ~PieceExchange() = default;

  /// Where the piece's voxels begin in the whole.
  virtual const glm::ivec3& First() const = 0;
  virtual VolumeIndex::Range RangeOfWhole(std::size_t component) const = 0;

  /// Collective: all must call it. Whether something is so with any of them.
  virtual bool Any(bool here) const = 0;
  /// Collective. From the image of a piece to that of the whole, but for its spans and mask.
  /// @param geometry  of the whole
  virtual void Reduce(ShearImage& image, const ShearWarp& geometry, Reduction reduction) = 0;
  /// Collective. From what a piece shows to what the whole does: values, and of the pieces that
  /// have a pixel's value the least depth.
  virtual void Reduce(ScreenScalars& screen) = 0;
};
}

#endif
