// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * VTK's cropping: two planes across each axis cut the volume into 27 regions.
 */
#ifndef splattingCropping_h
#define splattingCropping_h

#include "Geometry/ShearWarp.h"
#include "Kernels/Kernels.h"

#include <array>

namespace splatting
{
/// The regions of one slice, in pixels of the shear image.
struct SliceRegions
{
  std::array<int, 2> u, v;      ///< where the middle region begins, and the highest one
  std::array<unsigned, 3> rows; ///< for each region along v: bit i is region i along u

  /// Those of region i along u.
  Span pixels(int i) const
  {
    constexpr int far = 1 << 30;
    return { i == 0 ? -far : this->u[i - 1], i == 2 ? far : this->u[i] };
  }
  unsigned regionsOfRow(int row) const
  {
    return this->rows[row < this->v[0] ? 0 : row < this->v[1] ? 1 : 2];
  }
};

/**
 * A sample of slice k counts if the point where the ray crosses the middle of the slice lies in a
 * region that is shown. Where the middle region is thinner than a slice and has the middle of none,
 * the nearest slice is in it. Of slices that do not lie before the eye no region is shown.
 */
SliceRegions regionsOf(const Cropping& cropping, const ShearWarp& geometry, int k);

/// The same of one ray, `at` being (i, j) where it crosses the middle of slice k.
bool isShown(const Cropping& cropping, const ShearWarp& geometry, const glm::dvec2& at, int k);
}

#endif
