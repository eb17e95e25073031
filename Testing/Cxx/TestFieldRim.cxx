// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What exact mode shows on the screen is the largest value that the field has on the
// pixel's own ray: to rounding at the rim of the field, and elsewhere as well as the four rays of
// the shear image tell that a pixel is interpolated between.
#include "Display/FieldRim.h"
#include "Display/Warp.h"
#include "ExactTesting.h"
#include "FieldWithNaN.h"
#include "WideViews.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

using namespace coretesting;
using splatting::Quality;

namespace
{
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

/// The whole picture as scalars; NaN where there is nothing.
template <class T>
std::vector<splatting::Accumulator<T>> pictureOf(const Scene<T>& scene, reference::Random& random)
{
  using A = splatting::Accumulator<T>;
  splatting::ProjectionSettings settings;
  settings.quality = Quality::Exact;
  settings.instructionSet = anyInstructionSet(random);
  splatting::VolumeIndex index;
  index.reset(
    { scene.volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(scene.volume.size) });
  std::vector<splatting::ShearImage> images;
  std::vector<splatting::Cuts> cuts;
  for (const splatting::ShearWarp& geometry : scene.images)
  {
    cuts.push_back(cutsBy(geometry, scene.halfSpaces, scene.cropping));
    images.push_back(project(index, geometry, settings, cuts.back()));
  }
  const glm::ivec2& viewport = scene.view.viewport;
  const A none = std::numeric_limits<A>::quiet_NaN();
  std::vector<A> pixels(std::size_t(viewport.x) * viewport.y, none);
  splatting::FieldRim rim;
  if (splatting::hasFieldRim(settings))
  {
    rim.find(images, scene.images, { index.volume(), glm::ivec3(0), &cuts }, viewport);
  }
  splatting::Warper().warpScalars(images, scene.images, settings.reduction, viewport,
    settings.instructionSet, none, pixels.data(), rim);
  return pixels;
}

/// The ray of a screen pixel, from the view's matrix alone.
struct ScreenRay
{
  reference::FieldRay line;
  bool reversed;
  double eye;      ///< its depth; without limit in parallel views
  double steepest; ///< the larger of its slopes
};

ScreenRay screenRay(const splatting::View& view, double x, double y)
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
      if (from < to && countsIn(scene, screen.line, k, ways.cut) >= (grown ? Some : All))
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

/// How much of the ray of a point between pixels is in the field.
double lengthAt(const splatting::ShearWarp& geometry, const glm::dvec2& p)
{
  reference::FieldRay ray = rayOf(geometry, 0, 0);
  const glm::ivec2 last = geometry.rayCount() - 1;
  const reference::FieldRay other = rayOf(geometry, last.x, last.y);
  for (int a = 0; a < 2; ++a)
  {
    const double share = p[a] / std::max(last[a], 1);
    ray.at[a] += share * (other.at[a] - ray.at[a]);
    ray.slope[a] += share * (other.slope[a] - ray.slope[a]);
  }
  const auto depths = depthsOf(geometry, ray);
  return depths[1] - depths[0];
}

/// Whether a square of pixels, or more if it is to be sure, reaches beyond the field. Its outline
/// is convex.
bool reachesOut(const splatting::ShearWarp& geometry, const glm::dvec2& p, double width)
{
  bool out = false;
  for (int n = 0; n < 4; ++n)
  {
    const glm::dvec2 corner(n & 1 ? width : -width, n & 2 ? width : -width);
    out = out || lengthAt(geometry, p + corner) < 0.0;
  }
  return out;
}

/// How a pixel lies to the rays that it may be interpolated between.
enum Place
{
  Unclear,
  Inside,
  AtRim
};

Place placeOf(const std::vector<splatting::ShearWarp>& images, const ScreenRay& ray, int x, int y)
{
  const splatting::ShearWarp* geometry = nullptr;
  for (const splatting::ShearWarp& image : images)
  {
    if (image.principalAxis() == ray.line.axes[2] &&
      (!image.isPerspective() || image.reversed() == ray.reversed))
    {
      geometry = &image;
    }
  }
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
  const double share = shortest / longest, own = lengthAt(*geometry, p);
  if (shortest > 0.0 && (share > 0.501 || own > 3.001 || !reachesOut(*geometry, p, 2.01)))
  {
    return Inside;
  }
  return shortest <= 0.0 || (share < 0.499 && own < 2.999 && reachesOut(*geometry, p, 1.99))
    ? AtRim
    : Unclear;
}

struct Worst
{
  double rim = 0.0, inside = 0.0; ///< beyond what is surely there, of the range
  long atRim = 0, within = 0;
};

/// Compares pixels of a picture; of fields with NaN those at the rim.
template <class T>
void comparePixels(Checks& check, const Scene<T>& scene, reference::Random& random, Worst& worst)
{
  const auto field = reference::toDouble(scene.volume);
  const glm::dvec2 range = rangeOfNumbers(field);
  const double low = range[0], high = range[1];
  const bool hasNaN = std::any_of(
    field.voxels.begin(), field.voxels.end(), [](double voxel) { return std::isnan(voxel); });
  const glm::dvec3 steps = stepsOf(field);
  const auto pixels = pictureOf(scene, random);
  const bool perspective = !splatting::isParallel(scene.view);
  const double rounding = 4.0 * perspectiveExactBound<T>(low, high) + 1e-9 * (high - low);
  // The eye is rounded to 2^-10 voxels along each axis, slopes to 2^-24.
  const double turn =
    0x1p-24 * *std::max_element(scene.volume.size.begin(), scene.volume.size.end());
  const double exactly = (perspective ? 0x1p-10 : 0.0) + 2.0 * turn + 1e-8;
  for (int y = 0; y < scene.view.viewport.y; ++y)
  {
    for (int x = 0; x < scene.view.viewport.x; ++x)
    {
      const double shown = double(pixels[std::size_t(y) * scene.view.viewport.x + x]);
      const ScreenRay ray = screenRay(scene.view, x, y);
      const Place place = shown == shown ? placeOf(scene.images, ray, x, y) : Unclear;
      // Brute force takes its time: some of them.
      if (place == Unclear || (hasNaN && place == Inside) ||
        random.uniform(0, place == AtRim ? 3 : 31))
      {
        continue;
      }
      double pitch = 0.0;
      for (const splatting::ShearWarp& image : scene.images)
      {
        pitch = std::max(pitch, image.pitch() * (1.0 + 1e-9));
      }
      const double way = place == AtRim ? exactly : pitch;
      // The intervals are those of a ray beside the pixel's.
      const Ways ways{ way, scene.halfSpaces.empty() ? way : pitch };
      const Limits limits = hasNaN ? limitsWithNaN(scene, field, steps, ray, ways)
                                   : limitsOf(scene, field, steps, ray, ways);
      if (limits.low == -Infinite)
      {
        continue; // what is shown where a ray may have no sample is the warp's affair
      }
      const double above = shown - limits.high, below = limits.low - shown;
      check(above <= rounding && below <= rounding, "pixel ", x, " ", y,
        place == AtRim ? " at the rim" : " inside", " is ", shown, ", not from ", limits.low,
        " to ", limits.high, ", axis ", ray.line.axes[2], ", slope ", ray.line.slope[0], " ",
        ray.line.slope[1]);
      (place == AtRim ? worst.rim : worst.inside) =
        std::max(place == AtRim ? worst.rim : worst.inside, std::max(above, below) / (high - low));
      ++(place == AtRim ? worst.atRim : worst.within);
    }
  }
}

/// Planes that the middle of some slice lies between.
splatting::Cropping anyCropping(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::Cropping cropping;
  for (int a = 0; a < 3; ++a)
  {
    cropping.planes[a][0] = random.uniform(0.0, 0.4 * size[a]);
    cropping.planes[a][1] = cropping.planes[a][0] + 1.01 + random.uniform(0.0, 0.5 * size[a]);
  }
  cropping.flags = static_cast<std::uint32_t>(random.bits()) & splatting::Cropping::All;
  return cropping;
}

/// A view and cuts of a volume of noise.
template <class T>
Scene<T> anyScene(const std::array<int, 3>& size, bool perspective, reference::Random& random)
{
  Scene<T> scene;
  scene.volume = wholeRangeNoise<T>(size, random);
  scene.view = magnified(perspective ? randomPerspective(size, random) : randomView(size, random));
  scene.view.showsBoxes = random.uniform(0, 2) == 0;
  if (random.uniform(0, 3) == 0)
  {
    scene.cropping = anyCropping(size, random);
  }
  if (random.uniform(0, 3) == 0)
  {
    const glm::dvec3 normal = anyVector(random, -1.0, 1.0);
    const glm::dvec3 point = anyVector(random, 0.0, 1.0) * glm::dvec3(toGlm(size) - 1);
    scene.halfSpaces.push_back({ normal, -glm::dot(normal, point) });
  }
  splatting::ShearWarp::factorise(scene.view, scene.images, anySampling(random));
  return scene;
}

/// The scene with some voxels hidden, which makes them NaN, in the type of averages.
template <class T>
Scene<splatting::Accumulator<T>> withHidden(const Scene<T>& from, reference::Random& random)
{
  return { coretesting::withHidden(from.volume, random), from.view, from.images, from.halfSpaces,
    from.cropping };
}

template <class T>
void testType(Checks& check, Sightings& seen, Sightings& seenWithNaN)
{
  Worst worst, worstWithNaN;
  reference::forScenes(seriesOf<T>("noise"), 40,
    [&](int n, reference::Random& random)
    {
      const auto size = randomSize(random, 12);
      const long before = worst.atRim;
      comparePixels(check, anyScene<T>(size, n % 2 == 1, random), random, worst);
      seen.add(worst.atRim > before);
    });
  reference::forScenes(seriesOf<T>("hidden voxels"), 40,
    [&](int n, reference::Random& random)
    {
      const auto size = randomSize(random, 12);
      const auto scene = withHidden(anyScene<T>(size, n % 2 == 1, random), random);
      const long before = worstWithNaN.atRim;
      comparePixels(check, scene, random, worstWithNaN);
      seenWithNaN.add(worstWithNaN.atRim > before);
    });
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ": " << worst.atRim
            << " pixels at the rim, " << worst.rim << " beyond; " << worst.within
            << " pixels inside, " << worst.inside << " beyond; with hidden voxels "
            << worstWithNaN.atRim << " pixels at the rim, " << worstWithNaN.rim << " beyond"
            << std::endl;
}
}

int TestFieldRim(int, char*[])
{
  Checks check;
  Sightings seen, seenWithNaN;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testType<T>(check, seen, seenWithNaN);
    });
  check(seen.areEnough(0.4), "a rim is compared in only ", seen);
  check(seenWithNaN.areEnough(0.3), "a rim beside hidden voxels is compared in only ", seenWithNaN);
  std::cout << seenWithNaN << " with hidden voxels" << std::endl;
  return check.result();
}
