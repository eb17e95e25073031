// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of views share whose pixels are wider than voxels.
 */
#ifndef PixelAreaTesting_h
#define PixelAreaTesting_h

#include "CoreTesting.h"
#include "WideViews.h"

#include "Display/PixelArea.h"
#include "Display/Warp.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coretesting
{
using Images = std::vector<splatting::ShearImage>;
using Geometries = std::vector<splatting::ShearWarp>;

constexpr float Background = -100.0f; // below all values

/// A float image of a function of the pixel, as wide as a preview's; some have holes.
template <class F>
splatting::ShearImage imageOf(
  const splatting::ShearWarp& geometry, bool hasHoles, reference::Random& random, F&& f)
{
  const auto size = geometry.size();
  std::array<int, 3> dimensions;
  for (int a = 0; a < 3; ++a)
  {
    dimensions[geometry.axes()[a]] = size[a];
  }
  splatting::ProjectionSettings settings;
  settings.quality = splatting::Quality::Preview;
  splatting::ShearImage image =
    project(reference::constant<float>(dimensions, 0.0f), geometry, settings);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      image.row<float>(v)[u] = static_cast<float>(f(u, v));
    }
  }
  if (hasHoles)
  {
    image.mask.resize(std::size_t(image.width) * image.height);
    for (unsigned char& sample : image.mask)
    {
      sample = random.uniform(0, 9) > 0;
    }
  }
  return image;
}

inline Images noise(const Geometries& geometries, bool hasHoles, reference::Random& random)
{
  Images images;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    images.push_back(
      imageOf(geometry, hasHoles, random, [&](int, int) { return random.uniform(0.0, 1.0); }));
    splatting::ShearImage& image = images.back();
    image.winners.assign(std::size_t(image.width) * image.height, 0);
    for (std::size_t n = 0; n < image.mask.size(); ++n)
    {
      image.winners[n] = image.mask[n] ? 0 : -1;
    }
  }
  return images;
}

inline std::vector<float> picture(const Images& images, const Geometries& geometries,
  splatting::Reduction reduction, const glm::ivec2& viewport, reference::Random& random)
{
  std::vector<float> pixels(std::size_t(viewport.x) * viewport.y, Background);
  splatting::Warper().warpScalars(
    images, geometries, reduction, viewport, anyInstructionSet(random), Background, pixels.data());
  return pixels;
}

/// Whether a ray passes between the outermost voxels' centres, where the picture does not end:
/// the outermost half slices are beyond.
inline bool isShown(const splatting::ShearWarp& geometry, int u, int v)
{
  if (u >= geometry.rayCount().x || !meets(geometry, u, v, -0.5 - 1e-6))
  {
    return false;
  }
  const glm::dvec3 last = glm::dvec3(geometry.size()) - 1.0;
  double near = last.z > 0.0 ? 0.0 : -0.5, far = last.z > 0.0 ? last.z : 0.5;
  for (int a = 0; a < 2; ++a)
  {
    const splatting::AxisRays& rays = a == 0 ? geometry.columns() : geometry.rows();
    const int n = a == 0 ? u : v;
    const double first = (1e-6 - rays.at[n]) / rays.slope[n];
    const double second = (last[a] - 1e-6 - rays.at[n]) / rays.slope[n];
    near = std::max(near, geometry.reference() + std::min(first, second));
    far = std::min(far, geometry.reference() + std::max(first, second));
  }
  return near <= far;
}

inline splatting::View someView(int n, reference::Random& random)
{
  const auto size = randomSize(random, 24);
  return reduced(n % 2 ? randomPerspective(size, random) : anyView(size, random));
}

/// Calls f(n, view, geometries, random) for those of some views that are overviews, and counts
/// them.
template <class F>
Sightings forOverviews(const char* series, int count, F&& f)
{
  Sightings overviews;
  reference::forScenes(series, count,
    [&](int n, reference::Random& random)
    {
      const splatting::View view = someView(n, random);
      Geometries geometries;
      splatting::ShearWarp::factorise(view, geometries);
      const bool isOverview = !geometries.empty() && geometries.front().isOverview();
      overviews.add(isOverview);
      if (isOverview)
      {
        f(n, view, geometries, random);
      }
    });
  return overviews;
}

/// Whether all four pixels are samples between which an image is interpolated at a place.
inline bool isBetweenSamples(const splatting::ShearImage& image, const glm::dvec2& p)
{
  const glm::dvec2 low = glm::floor(p), limit(image.width, image.height);
  bool all = low.x >= 0.0 && low.y >= 0.0 && low.x < limit.x && low.y < limit.y;
  for (int corner = 0; corner < 4 && all; ++corner)
  {
    all = image.covers(static_cast<int>(low.x) + corner % 2, static_cast<int>(low.y) + corner / 2);
  }
  return all;
}
}

#endif
