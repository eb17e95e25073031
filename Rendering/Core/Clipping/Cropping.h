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
  std::array<int, 2> u, v;      ///< first pixels of the middle and of the highest region
  std::array<unsigned, 3> rows; ///< for each region along v: bit i is region i along u

  /// The pixels of region i along u.
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
 * The sample of slice k is visible if the ray crosses the middle of the slice in a region that is
 * shown. If a middle region is thinner than a slice and contains no slice's middle, it contains the
 * nearest slice. Slices behind the eye have no visible region.
 */
SliceRegions regionsOf(const Cropping& cropping, const ShearWarp& geometry, int k);

/// The same for one ray, which crosses the middle of slice k at `at` = (i, j).
bool isShown(const Cropping& cropping, const ShearWarp& geometry, const glm::dvec2& at, int k);
}

#endif
