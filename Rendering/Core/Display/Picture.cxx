// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/Picture.h"

#include "Common/Parallel.h"
#include "Splat/Warp/Outline.h"

#include <glm/common.hpp>

#include <algorithm>

namespace splatting
{
namespace
{
/// Corners of a rectangle of viewport pixels.
struct Rectangle
{
  glm::dvec2 low, high;
};

/// Contains all pixels that show an image, and perhaps some beside them.
Rectangle boundsOf(const ShearWarp& geometry, const glm::dvec2& viewport)
{
  if (!geometry.isPerspective() && !geometry.minifiesAnyAxis())
  {
    // The box is symmetric about the centre of the volume.
    const Cuboid box = shownBox(geometry);
    const glm::dvec3 size = box.high - box.low;
    const glm::dvec2 s = glm::abs(geometry.shear());
    const glm::dvec2 half = 0.5 * (glm::dvec2(size) + s * size.z) / geometry.pitch();
    const glm::dvec3 centre = 0.5 * glm::dvec3(geometry.size() - 1);
    const glm::dmat3& m = geometry.shearToScreen();
    const glm::dvec2 middle(m * geometry.pixelOf(centre));
    const glm::dvec2 reach = glm::dvec2(glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y);
    return { middle - reach, middle + reach };
  }
  const glm::dvec2 last = viewport - 1.0;
  Rectangle bounds{ viewport, glm::dvec2(-2.0) };
  const Outline shown = geometry.minifiesAnyAxis() ? metByAreas(geometry) : shownBy(geometry);
  for (const glm::dvec3& corner :
    shown.cut({ { 0.0, 0.0, 1.0 }, { last.x, 0.0, 1.0 }, { last, 1.0 }, { 0.0, last.y, 1.0 } }))
  {
    bounds.low = glm::min(bounds.low, glm::dvec2(corner));
    bounds.high = glm::max(bounds.high, glm::dvec2(corner));
  }
  return bounds;
}
}

void placePicture(
  const std::vector<ShearWarp>& images, const glm::ivec2& viewport, Picture& picture)
{
  const glm::dvec2 limit(viewport);
  glm::dvec2 low = limit, high(0.0);
  for (const ShearWarp& image : images)
  {
    const Rectangle bounds = boundsOf(image, limit);
    low = glm::min(low, glm::clamp(glm::floor(bounds.low), glm::dvec2(0.0), limit));
    high = glm::max(high, glm::clamp(glm::ceil(bounds.high) + 1.0, glm::dvec2(0.0), limit));
  }
  picture.origin = glm::ivec2(low);
  picture.size = glm::max(glm::ivec2(high) - picture.origin, glm::ivec2(0));
}

void addSaturated(const Picture& layer, Picture& sum)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(layer.pixels.data());
  auto* const to = reinterpret_cast<unsigned char*>(sum.pixels.data());
  parallelFor(0, static_cast<std::ptrdiff_t>(4 * sum.pixels.size()), 1 << 16,
    [=](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t n = first; n < last; ++n)
      {
        to[n] = static_cast<unsigned char>(std::min(to[n] + from[n], 255));
      }
    });
}

void multiplyByOpacity(const Picture& opacity, Picture& picture)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(opacity.pixels.data());
  auto* const to = reinterpret_cast<unsigned char*>(picture.pixels.data());
  parallelFor(0, static_cast<std::ptrdiff_t>(picture.pixels.size()), 1 << 14,
    [=](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t n = 4 * first; n < 4 * last; ++n)
      {
        to[n] = static_cast<unsigned char>((to[n] * from[n | 3] + 127) / 255);
      }
    });
}
}
