// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingShearPixels_h
#define splattingShearPixels_h

#include "Projection/Project.h"
#include "Projection/ShearImage.h"

#include <glm/vec2.hpp>

#include <functional>
#include <vector>

namespace splatting
{
/**
 * A pixel of one of a view's shear images; none by default.
 */
struct ShearPixel
{
  int image = -1;
  int u = 0, v = 0;
};

/**
 * For each pixel of a rectangle of the viewport, row by row from the bottom, the shear pixel whose
 * location stands for it: the nearest of those that Warper interpolates its value between, where
 * areas are shown the largest (of minima the least) in the area, or without any the nearest to
 * where the area's value comes from; none where the picture has no sample.
 * @param images     as in Warper::warp()
 * @param hasSample  whether a shear pixel has one; without it, whether it has a winner
 */
void findShearPixels(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& origin,
  const glm::ivec2& size, ShearPixel* out,
  const std::function<bool(const ShearPixel&)>& hasSample = {});
}

#endif
