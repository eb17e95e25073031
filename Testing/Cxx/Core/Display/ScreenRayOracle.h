// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    ScreenRayOracle.h
 * @brief   the rays of an exact picture's pixels, from the view's matrix alone, and what they find
 */
#ifndef ScreenRayOracle_h
#define ScreenRayOracle_h

#include "Display/ScreenRays.h"
#include "Display/ShearPixels.h"
#include "Display/Warp.h"
#include "ExactTesting.h"
#include "FieldWithNaN.h"
#include "Projection/Locations.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace screenrays
{
using namespace coretesting;
using splatting::Quality;

constexpr double Infinite = std::numeric_limits<double>::infinity();

/// What is projected, and how.
template <class T>
struct Scene
{
  reference::Volume<T> volume;
  splatting::View view;
  std::vector<splatting::ShearWarp> images;
  std::vector<glm::dvec4> halfSpaces;
  splatting::Cropping cropping;
};

/// The whole picture as scalars, NaN where there is nothing, and what it was made from.
template <class T>
struct Shown
{
  std::vector<splatting::Accumulator<T>> pixels;
  std::vector<splatting::ShearImage> images;
  std::vector<splatting::Cuts> cuts;
  splatting::ProjectionSettings settings;
  bool isSameWithoutBricks = true;
};

template <class T>
Shown<T> pictureOf(const Scene<T>& scene, reference::Random& random)
{
  using A = splatting::Accumulator<T>;
  Shown<T> shown;
  splatting::ProjectionSettings& settings = shown.settings;
  settings.quality = Quality::Exact;
  settings.instructionSet = anyInstructionSet(random);
  splatting::VolumeIndex index;
  index.reset(
    { scene.volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(scene.volume.size) });
  std::vector<splatting::ShearImage>& images = shown.images;
  std::vector<splatting::Cuts>& cuts = shown.cuts;
  for (const splatting::ShearWarp& geometry : scene.images)
  {
    cuts.push_back(cutsBy(geometry, scene.halfSpaces, scene.cropping));
    images.push_back(project(index, geometry, settings, cuts.back()));
  }
  const glm::ivec2& viewport = scene.view.viewport;
  const A none = std::numeric_limits<A>::quiet_NaN();
  shown.pixels.assign(std::size_t(viewport.x) * viewport.y, none);
  splatting::RaySource source{ index.volume(), glm::ivec3(0), &cuts };
  splatting::ScreenRays plain, rays;
  plain.find(images, scene.images, source, viewport, settings.instructionSet);
  source.index = index.hasBricks() ? &index : nullptr;
  rays.find(images, scene.images, source, viewport, settings.instructionSet);
  shown.isSameWithoutBricks = plain.values().bytes == rays.values().bytes;
  splatting::Warper().warpScalars(images, scene.images, settings.reduction, viewport,
    settings.instructionSet, none, shown.pixels.data(), rays);
  return shown;
}

/// The ray of a screen pixel, from the view's matrix alone.
struct ScreenRay
{
  reference::FieldRay line;
  bool reversed;
  double eye;      ///< its depth; without limit in parallel views
  double steepest; ///< the larger of its slopes
};

inline ScreenRay screenRay(const splatting::View& view, double x, double y)
{
  const glm::dmat4 inverse = glm::inverse(view.indexToClip);
  const glm::dvec2 clip = (2.0 * glm::dvec2(x, y) + 1.0) / glm::dvec2(view.viewport) - 1.0;
  const glm::dvec4 a = inverse * glm::dvec4(clip, -1.0, 1.0);
  const glm::dvec4 b = inverse * glm::dvec4(clip, 1.0, 1.0);
  const glm::dvec3 begin = glm::dvec3(a) / a.w, way = glm::dvec3(b) / b.w - begin;
  int k = 2;
  for (int n = 1; n >= 0; --n)
  {
    k = std::abs(way[n]) > std::abs(way[k]) * (1.0 + 1e-12) ? n : k;
  }
  ScreenRay ray;
  ray.line.axes = { k == 0 ? 1 : 0, k == 2 ? 1 : 2, k };
  ray.line.start = begin[k];
  ray.steepest = 0.0;
  for (int n = 0; n < 2; ++n)
  {
    ray.line.at[n] = begin[ray.line.axes[n]];
    ray.line.slope[n] = way[ray.line.axes[n]] / way[k];
    ray.steepest = std::max(ray.steepest, std::abs(ray.line.slope[n]));
  }
  ray.reversed = way[k] < 0.0;
  ray.eye = ray.reversed ? Infinite : -Infinite;
  if (!splatting::isParallel(view))
  {
    const glm::dvec4 eye = inverse * glm::dvec4(0.0, 0.0, 1.0, 0.0);
    ray.eye = eye[k] / eye.w;
  }
  return ray;
}

/// Which samples count in a slice, of rays that are displaced by no more than a given way.
enum Counts
{
  None,
  Some,
  All
};

template <class T>
Counts countsIn(const Scene<T>& scene, const reference::FieldRay& ray, int k, double way)
{
  glm::dvec4 point(0.0, 0.0, 0.0, 1.0);
  point[ray.axes[2]] = k;
  for (int a = 0; a < 2; ++a)
  {
    point[ray.axes[a]] = ray.at[a] + ray.slope[a] * (k - ray.start);
  }
  Counts counts = All;
  for (const glm::dvec4& h : scene.halfSpaces)
  {
    const double inside = glm::dot(h, point);
    const double error = way * (std::abs(h[ray.axes[0]]) + std::abs(h[ray.axes[1]])) + 1e-6;
    counts = std::min(counts, inside > error ? All : inside > -error ? Some : None);
  }
  if (scene.cropping.cuts())
  {
    // Middle regions are wider than a way, see anyCropping(): one of three points is in each.
    bool any = false, all = true;
    for (int n = 0; n < 9; ++n)
    {
      int bit = 0;
      const int strides[3] = { 1, 3, 9 };
      for (int a = 0; a < 3; ++a)
      {
        const double error = a == ray.axes[0] ? (n % 3 - 1) * way
          : a == ray.axes[1]                  ? (n / 3 - 1) * way
                                              : 0.0;
        const glm::dvec2& planes = scene.cropping.planes[a];
        const double at = point[a] + error;
        bit += strides[a] * (at < planes[0] ? 0 : at <= planes[1] ? 1 : 2);
      }
      const bool shown = scene.cropping.flags >> bit & 1u;
      any = any || shown;
      all = all && shown;
    }
    counts = std::min(counts, all ? All : any ? Some : None);
  }
  return counts;
}

/// The depths at which a ray is in the field if ray and eye are displaced by a way across the
/// principal axis, to see more of it or, below 0, less.
template <class T>
std::array<double, 2> seenDepths(const Scene<T>& scene, const ScreenRay& screen, double more)
{
  const reference::FieldRay& ray = screen.line;
  const glm::ivec3 size = toGlm(scene.volume.size);
  // Slices whose middle is behind the eye are not seen.
  double near = -0.5, far = size[ray.axes[2]] - 0.5;
  (screen.reversed ? far : near) = screen.reversed
    ? std::min({ far, screen.eye + more, std::ceil(screen.eye + more) - 0.5 })
    : std::max({ near, screen.eye - more, std::floor(screen.eye - more) + 0.5 });
  for (int a = 0; a < 3; ++a)
  {
    const int n = size[ray.axes[a]];
    const bool isThick = scene.view.showsBoxes || n == 1;
    const double side = (isThick ? 0.5 : 0.0) + (a < 2 ? more : 0.0);
    const double begin = -side, end = n - 1 + side;
    if (begin > end) // nothing is sure to be in what is thinner than twice the way
    {
      return { near, near - 1.0 };
    }
    if (a == 2)
    {
      near = std::max(near, begin);
      far = std::min(far, end);
    }
    else if (ray.slope[a] == 0.0)
    {
      far = ray.at[a] >= begin && ray.at[a] <= end ? far : near - 1.0;
    }
    else
    {
      const double p = ray.start + (begin - ray.at[a]) / ray.slope[a];
      const double q = ray.start + (end - ray.at[a]) / ray.slope[a];
      near = std::max(near, std::min(p, q));
      far = std::min(far, std::max(p, q));
    }
  }
  return { near, far };
}

/// How far rays, and what cuts them, may be displaced across the principal axis, in voxels.
struct Ways
{
  double ray, cut;
};

/// Between what the extremum must lie if rays, and where the field ends, are displaced by no more
/// than that.
struct Limits
{
  double low = -Infinite, high = -Infinite;
};

/// Whether some of slice k may count (grown), or all of it surely does. Planes may cut within it.
template <class T>
bool countsBeside(
  const Scene<T>& scene, const reference::FieldRay& ray, int k, double way, bool grown)
{
  const int beside = scene.halfSpaces.empty() ? 0 : 1;
  bool any = false, all = true;
  for (int n = k - beside; n <= k + beside; ++n)
  {
    const Counts counts = countsIn(scene, ray, n, way);
    any = any || counts >= Some;
    all = all && counts == All;
  }
  return grown ? any : all;
}

/// Calls take(grown, from, to) for what may count in each slice (grown), and for what surely does.
template <class T, class Take>
void forSeenSlices(const Scene<T>& scene, const ScreenRay& screen, const Ways& ways, Take&& take)
{
  const int slices = scene.volume.size[screen.line.axes[2]];
  for (const bool grown : { false, true })
  {
    const auto seen = seenDepths(scene, screen, grown ? ways.ray : -ways.ray);
    for (int k = 0; k < slices; ++k)
    {
      const double from = std::max(seen[0], k - 0.5), to = std::min(seen[1], k + 0.5);
      if (from < to && countsBeside(scene, screen.line, k, ways.cut, grown))
      {
        take(grown, from, to);
      }
    }
  }
}

template <class T>
Limits limitsOf(const Scene<T>& scene, const reference::Volume<double>& field,
  const glm::dvec3& steps, const ScreenRay& screen, const Ways& ways)
{
  const reference::FieldRay& ray = screen.line;
  Limits limits;
  forSeenSlices(scene, screen, ways,
    [&](bool grown, double from, double to)
    {
      double& limit = grown ? limits.high : limits.low;
      limit = std::max(limit, reference::fieldMaximum(field, ray, from, to));
    });
  const double change = ways.ray * (steps[ray.axes[0]] + steps[ray.axes[1]]);
  return { limits.low - change, limits.high + change };
}

/// The same of a field of which cells with NaN are left out.
template <class T>
Limits limitsWithNaN(const Scene<T>& scene, const reference::Volume<double>& field,
  const glm::dvec3& steps, const ScreenRay& screen, const Ways& ways)
{
  Limits limits;
  forSeenSlices(scene, screen, ways,
    [&](bool grown, double from, double to)
    {
      double& limit = grown ? limits.high : limits.low;
      limit = std::max(limit,
        grown ? mostNearby(field, screen.line, from, to, ways.ray)
              : leastNearby(field, screen.line, from, to, ways.ray));
    });
  const double change = changeNearby(steps, screen.line, ways.ray);
  return { limits.low - change, limits.high + change };
}

/// How a pixel lies to the rays that it may be interpolated between.
enum Place
{
  Unclear,
  Inside,
  AtRim
};

/// The number of the image whose axis a ray follows, or how many there are.
inline std::size_t imageOf(const std::vector<splatting::ShearWarp>& images, const ScreenRay& ray)
{
  return static_cast<std::size_t>(
    std::find_if(images.begin(), images.end(),
      [&](const splatting::ShearWarp& image)
      {
        return image.principalAxis() == ray.line.axes[2] &&
          (!image.isPerspective() || image.reversed() == ray.reversed);
      }) -
    images.begin());
}

inline Place placeOf(
  const std::vector<splatting::ShearWarp>& images, const ScreenRay& ray, int x, int y)
{
  const std::size_t number = imageOf(images, ray);
  const splatting::ShearWarp* const geometry = number < images.size() ? &images[number] : nullptr;
  // Where two axes are as near to the ray either image may be shown.
  if (!geometry || ray.steepest > 0.999)
  {
    return Unclear;
  }
  const glm::dvec3 point = geometry->screenToShear() * glm::dvec3(x, y, 1.0);
  const glm::dvec2 p = glm::dvec2(point) / point.z;
  const glm::dvec2 low = glm::floor(p), away = p - low;
  double shortest = Infinite, longest = 0.0;
  for (int n = 0; n < 4; ++n)
  {
    const int u = static_cast<int>(low.x) + n % 2, v = static_cast<int>(low.y) + n / 2;
    const double weight = (n % 2 ? away.x : 1.0 - away.x) * (n / 2 ? away.y : 1.0 - away.y);
    if (weight < 1e-9)
    {
      if (weight > 0.0)
      {
        return Unclear;
      }
      continue;
    }
    double length = 0.0;
    if (u >= 0 && v >= 0 && u < geometry->rayCount().x && v < geometry->rayCount().y)
    {
      const auto depths = depthsOf(*geometry, rayOf(*geometry, u, v));
      // Rays that touch the field, as all that run along a face with the eye in it, may or may not
      // see it.
      if (std::abs(depths[1] - depths[0]) < 3e-3)
      {
        return Unclear;
      }
      length = std::max(depths[1] - depths[0], 0.0);
    }
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  const double share = shortest / longest;
  if (shortest > 0.0 && share > 0.501)
  {
    return Inside;
  }
  return shortest <= 0.0 || share < 0.499 ? AtRim : Unclear;
}

/// How much of a pixel inside lies in pixels of the shear image that have no sample.
template <class T>
double lostOf(const Scene<T>& scene, const Shown<T>& shown, const ScreenRay& ray, int x, int y)
{
  const std::size_t number = imageOf(scene.images, ray);
  const splatting::ShearImage& image = shown.images[number];
  const glm::dvec3 point = scene.images[number].screenToShear() * glm::dvec3(x, y, 1.0);
  const glm::dvec2 p = glm::dvec2(point) / point.z;
  double lost = 0.0;
  for (int n = 0; n < 4; ++n)
  {
    const int u = static_cast<int>(std::floor(p.x)) + n % 2;
    const int v = static_cast<int>(std::floor(p.y)) + n / 2;
    const double weight = (1.0 - std::abs(p.x - u)) * (1.0 - std::abs(p.y - v));
    const bool has =
      weight <= 0.0 || (image.covers(u, v) && image.row<T>(v)[u] == image.row<T>(v)[u]);
    lost += has ? 0.0 : weight;
  }
  return lost;
}

/// What a ray has from the slice before to the slice behind each of the winners that it lies
/// between, if the field begins and ends so much further out.
template <class T>
double besideWinners(const Scene<T>& scene, const Shown<T>& shown,
  const reference::Volume<double>& field, const ScreenRay& ray, int x, int y, double more)
{
  const std::size_t number = imageOf(scene.images, ray);
  const splatting::ShearWarp& geometry = scene.images[number];
  const splatting::ShearImage& image = shown.images[number];
  const glm::dvec3 point = geometry.screenToShear() * glm::dvec3(x, y, 1.0);
  const glm::dvec2 p = glm::dvec2(point) / point.z;
  auto seen = seenDepths(scene, ray, more);
  for (const glm::dvec4& h : scene.halfSpaces)
  {
    // h . (the ray at depth z) >= 0
    double speed = h[ray.line.axes[2]], value = h.w - more * glm::length(glm::dvec3(h));
    for (int a = 0; a < 2; ++a)
    {
      speed += h[ray.line.axes[a]] * ray.line.slope[a];
      value += h[ray.line.axes[a]] * (ray.line.at[a] - ray.line.slope[a] * ray.line.start);
    }
    (speed > 0.0 ? seen[0] : seen[1]) =
      speed > 0.0 ? std::max(seen[0], -value / speed) : std::min(seen[1], -value / speed);
  }
  double largest = -Infinite;
  for (int n = 0; n < 4; ++n)
  {
    const int u = static_cast<int>(std::floor(p.x)) + n % 2;
    const int v = static_cast<int>(std::floor(p.y)) + n / 2;
    const double weight = (1.0 - std::abs(p.x - u)) * (1.0 - std::abs(p.y - v));
    const int winner =
      weight > 0.0 ? image.winners[std::size_t(v) * image.width + u] / splatting::StepsPerSlice : 0;
    const double from = std::max(seen[0], winner - 1.0), to = std::min(seen[1], winner + 1.0);
    if (weight > 0.0 && (winner < seen[0] || winner > seen[1]))
    {
      // The ray does not meet the middle of a winner's slice, or not any more: all is looked at.
      return reference::fieldMaximum(field, ray.line, seen[0], seen[1]);
    }
    if (weight > 0.0 && from < to)
    {
      largest = std::max(largest, reference::fieldMaximum(field, ray.line, from, to));
    }
  }
  return largest;
}

/// Whether nothing or a plane cuts a pixel's ray and the four rays around it, which then are cut at
/// depths that the pixel's is the mean of.
template <class T>
bool isCutClearly(const Scene<T>& scene, const Shown<T>& shown, const ScreenRay& ray, int x, int y)
{
  if (scene.halfSpaces.empty() || scene.cropping.cuts())
  {
    return !scene.cropping.cuts();
  }
  const std::size_t number = imageOf(scene.images, ray);
  const splatting::ShearWarp& geometry = scene.images[number];
  const splatting::ShearImage& image = shown.images[number];
  const splatting::RayIntervals& intervals = shown.cuts[number].intervals;
  const glm::dvec3 point = geometry.screenToShear() * glm::dvec3(x, y, 1.0);
  bool clear = !geometry.isPerspective();
  for (int n = 0; n < 4 && !intervals.empty(); ++n)
  {
    const int u = static_cast<int>(std::floor(point.x)) + n % 2;
    const int v = static_cast<int>(std::floor(point.y)) + n / 2;
    const glm::dvec2 depths =
      clear && image.covers(u, v) ? intervals.depths(u, v) : glm::dvec2(0.0);
    const glm::dvec2 others = clear && image.covers(u, v)
      ? intervals.depths(static_cast<int>(point.x), static_cast<int>(point.y))
      : glm::dvec2(9.0);
    clear = clear && image.covers(u, v) && depths.x < depths.y &&
      std::abs(depths.x - others.x) < 1.4 && std::abs(depths.y - others.y) < 1.4;
  }
  return clear;
}

/// What the field has at the point that is told of a pixel.
template <class T>
double atLocation(const Scene<T>& scene, const Shown<T>& shown,
  const reference::Volume<double>& field, int x, int y)
{
  splatting::Located located;
  located.images = &shown.images;
  located.geometries = &scene.images;
  located.cuts = &shown.cuts;
  located.volume = { scene.volume.voxels.data(), splatting::scalarTypeOf<T>(),
    toGlm(scene.volume.size) };
  located.settings = shown.settings;
  located.view = scene.view;
  splatting::ShearPixel pixel;
  splatting::findShearPixels(
    shown.images, scene.images, shown.settings.reduction, { x, y }, glm::ivec2(1), &pixel);
  const glm::dvec3 point = splatting::Locator(located).point(glm::dvec2(x, y), pixel);
  return reference::fieldAt(field, { point.x, point.y, point.z });
}
}

#endif
