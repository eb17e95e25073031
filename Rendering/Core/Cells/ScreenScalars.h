// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingScreenScalars_h
#define splattingScreenScalars_h

#include "Cells/PixelRays.h"
#include "Common/ScalarType.h"

#include <glm/vec2.hpp>

#include <cstddef>
#include <vector>

namespace splatting
{
/**
 * What the pixels of a viewport show: scalars, and on request where on their rays these lie.
 */
struct ScreenScalars
{
  /// The rectangle of the viewport that the volume may be seen in. Rows from bottom to top.
  glm::ivec2 origin{ 0 }, size{ 0 };
  /// The type of the values, Float32 or Float64: the accumulator's type for the type of the voxels.
  ScalarType type = ScalarType::Float32;
  /// size.x * size.y values; NaN where there is no sample.
  std::vector<unsigned char> bytes;
  /// If asked for, the parameters t of the samples on the pixels' rays; else empty.
  std::vector<float> depths;
  /// In Reduction::Signed the minima, which CellProjector::finish() combines with the maxima. Else
  /// empty.
  std::vector<ScreenScalars> minima;
  PixelRays rays;

  template <class A>
  A* row(int y)
  {
    return reinterpret_cast<A*>(this->bytes.data()) + std::ptrdiff_t(y) * this->size.x;
  }
  template <class A>
  const A* row(int y) const
  {
    return const_cast<ScreenScalars*>(this)->row<A>(y);
  }
};
}

#endif
