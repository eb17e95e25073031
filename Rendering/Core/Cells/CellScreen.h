// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingCellScreen_h
#define splattingCellScreen_h

#include "Display/ScreenScalars.h"
#include "Geometry/PixelRays.h"

#include <cstddef>
#include <vector>

namespace splatting
{
/**
 * The result of a projection by cells: values, and on request where on their rays the samples lie.
 */
class CellScreen : public ScreenScalars
{
public:
  /// size.x * size.y values; NaN where there is no sample.
  std::vector<unsigned char> bytes;
  /// If asked for, the parameters t of the samples on the pixels' rays; else empty.
  std::vector<float> depths;
  /// In Reduction::Signed the minima, which CellProjector::finish() combines with the maxima. Else
  /// empty.
  std::vector<CellScreen> minima;
  PixelRays rays;

  const void* valuesOfRow(int y, void*) const override
  {
    return this->bytes.data() + std::size_t(y) * this->size.x * sizeOf(this->type);
  }
  template <class A>
  A* row(int y)
  {
    return reinterpret_cast<A*>(this->bytes.data()) + std::ptrdiff_t(y) * this->size.x;
  }
  template <class A>
  const A* row(int y) const
  {
    return const_cast<CellScreen*>(this)->row<A>(y);
  }
};
}

#endif
