// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Views whose pixels show points, and overviews, whose pixels show areas.
 */
#ifndef WideViews_h
#define WideViews_h

#include "Geometry/Magnification.h"
#include "Geometry/ShearWarp.h"

#include "Random.h"

#include <glm/gtc/matrix_transform.hpp>

namespace coretesting
{
/// The same view of a volume whose slices are displaced along its first two axes.
inline splatting::View skewed(splatting::View view, reference::Random& random)
{
  glm::dmat4 shear(1.0);
  shear[2] = glm::dvec4(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), 1.0, 0.0);
  const glm::dvec3 centre = 0.5 * glm::dvec3(view.dimensions - 1);
  const glm::dmat4 toCentre = glm::translate(glm::dmat4(1.0), centre);
  view.indexToClip = view.indexToClip * toCentre * shear * glm::inverse(toCentre);
  return view;
}

/// In which a voxel is twelve pixels wide.
inline splatting::View magnifiedView()
{
  splatting::View view;
  view.dimensions = glm::ivec3(8);
  view.viewport = glm::ivec2(96);
  view.indexToClip = glm::dmat4(0.25);
  view.indexToClip[3] = glm::dvec4(-1.0, -1.0, 0.0, 1.0);
  return view;
}

/// The same view with so many pixels, or so near to the window's middle, that it is no overview.
/// Large windows would be looked at for seconds.
inline splatting::View magnified(splatting::View view)
{
  while (splatting::minifiesAnyAxis(view))
  {
    if (view.viewport.x < 300 && view.viewport.y < 300)
    {
      view.viewport *= 2;
    }
    else
    {
      const glm::dvec3 twiceAsLarge(2.0, 2.0, 1.0);
      view.indexToClip = glm::scale(glm::dmat4(1.0), twiceAsLarge) * view.indexToClip;
    }
  }
  return view;
}

/// The same view with so few pixels that it is an overview, if that is possible.
inline splatting::View reduced(splatting::View view)
{
  while (!splatting::minifiesAnyAxis(view) && view.viewport.x > 1 && view.viewport.y > 1)
  {
    view.viewport = (view.viewport + 1) / 2;
  }
  return view;
}
}

#endif
