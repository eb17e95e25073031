// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/RayFinder.h"

namespace splatting
{
std::vector<Span> findFieldSpans(const ShearImage& image, const ShearWarp& geometry)
{
  std::vector<Span> spans(geometry.rayCount().y);
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    const auto misses = [&](int u)
    {
      const glm::dvec2 depths = depthsInField(geometry, rayOfPixel(geometry, u, v));
      return depths.y <= depths.x;
    };
    Span& span = spans[v];
    span = common(image.spans[v], { 0, geometry.rayCount().x });
    for (; !span.empty() && misses(span.begin); ++span.begin)
    {
    }
    for (; !span.empty() && misses(span.end - 1); --span.end)
    {
    }
  }
  return spans;
}
}
