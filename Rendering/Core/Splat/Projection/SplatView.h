// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingSplatView_h
#define splattingSplatView_h

#include "Clipping/RayEnds.h"
#include "Geometry/ShearWarp.h"
#include "Splat/Walks/Cuts.h"

#include <vector>

namespace splatting
{
/**
 * A view as shear images, with the cuts of each as slices.
 */
struct SplatView
{
  std::vector<ShearWarp> geometries; ///< of no image, if the volume is not in the view
  std::vector<Cuts> cuts;

  /// Factorises a view. Returns false if it is invalid.
  bool set(const View& view, const RayEnds& ends);

  /// Whether both views have the same rays, cuts, and equally sharp images, and, if `ordered`, the
  /// same side of the viewer.
  bool projectsAs(const SplatView& other, bool ordered) const;

  /// The geometry of the largest image; nullptr without images.
  const ShearWarp* main() const;
};
}

#endif
