// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingRayEnds_h
#define splattingRayEnds_h

#include <cstdint>

namespace splatting
{
class ClosedSurface;
class SceneDepth;

/// What ends rays besides the half-spaces and the cropping of a view.
struct RayEnds
{
  ClosedSurface* surface = nullptr;  ///< rays are cut to the hull of their part inside
  const SceneDepth* depth = nullptr; ///< placed in the view
  std::int64_t surfaceVersion = 0;   ///< differs after a change of the surface
};
}

#endif
