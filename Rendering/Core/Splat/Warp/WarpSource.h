// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The values of a shear image between its pixels.
 */
#ifndef splattingWarpSource_h
#define splattingWarpSource_h

#include "Splat/Projection/ShearImage.h"
#include "Splat/Warp/Outline.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <limits>

namespace splatting
{
/// Calls f(u, v, weight) for the pixels in the volume that a point is interpolated from.
template <class F>
void forNeighbours(const ShearImage& image, const glm::dvec2& p, F&& f)
{
  // Points on the common border of two images may round to positions outside theirs, where they
  // have no neighbours.
  const int u = static_cast<int>(std::floor(p.x)), v = static_cast<int>(std::floor(p.y));
  const double fu = p.x - u, fv = p.y - v;
  for (int n = 0; n < 4; ++n)
  {
    const int i = n & 1, j = n >> 1;
    if (image.meetsVolume(u + i, v + j))
    {
      f(u + i, v + j, (i ? fu : 1.0 - fu) * (j ? fv : 1.0 - fv));
    }
  }
}

/**
 * One of a view's images, with its pixels in the accumulator's type.
 */
template <class A>
struct WarpSource
{
  const ShearImage& image;
  const A* pixels;
  const ShearWarp& geometry;
  Outline shown, inside;

  /// All must outlive its use.
  WarpSource(const ShearImage& i, const A* p, const ShearWarp& g)
    : image(i),
      pixels(p),
      geometry(g),
      shown(shownBy(g)),
      inside(withinSamples(g))
  {
  }
  bool hasHoles() const { return !this->image.mask.empty() || this->image.nonFinite; }

  /// For points with neighbours that may be missing, NaN or infinite: interpolates between the
  /// others; NaN without a sample.
  A valueAt(const glm::dvec3& homogeneous) const
  {
    const glm::dvec2 p = glm::dvec2(homogeneous) / homogeneous.z;
    double sum = 0.0, weight = 0.0, lost = 0.0, largest = -1.0;
    A nearest = 0;
    forNeighbours(this->image, p,
      [&](int u, int v, double w)
      {
        const A value = this->pixels[std::ptrdiff_t(v) * this->image.width + u];
        if (value != value || !this->image.covers(u, v))
        {
          lost += w;
          return;
        }
        sum += w * value;
        weight += w;
        if (w > largest)
        {
          largest = w;
          nearest = value;
        }
      });
    // Inside the volume the picture ends half-way between a missing sample and the last existing
    // one. At the border of the volume it ends at the silhouette.
    if (weight <= 0.0 || lost > 0.5)
    {
      return std::numeric_limits<A>::quiet_NaN();
    }
    const double average = sum / weight;
    return std::isfinite(average) ? static_cast<A>(average) : nearest;
  }
};
}

#endif
