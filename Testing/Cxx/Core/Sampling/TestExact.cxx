// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Exact mode shows the maximum of the trilinear field along each ray, as brute force finds it.
#include "AverageTesting.h"
#include "Display/Warp.h"
#include "ExactTesting.h"
#include "FieldWithNaN.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace coretesting;
using splatting::Acceleration;
using splatting::Quality;

namespace
{
splatting::ProjectionSettings exactSettings()
{
  splatting::ProjectionSettings settings;
  settings.quality = Quality::Exact;
  return settings;
}

struct Worst
{
  double error = 0.0;
  int compared = 0;
};

/// All pixels that see the field over some way, in the slices [begin, end).
template <class T>
void comparePixels(Checks& check, const reference::Volume<T>& volume,
  const splatting::ShearWarp& geometry, const splatting::ShearImage& image, Worst& worst)
{
  using A = splatting::Accumulator<T>;
  const auto exact = reference::toDouble(volume);
  const double low = *std::min_element(exact.voxels.begin(), exact.voxels.end());
  const double high = *std::max_element(exact.voxels.begin(), exact.voxels.end());
  // The reference refines to some roundings of double.
  const double bound =
    (geometry.isPerspective() ? perspectiveExactBound<T>(low, high) : exactBound<T>(low, high)) +
    1e-12 * std::max({ high - low, std::abs(low), std::abs(high) }) + 1e-300;
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    for (int u = 0; u < geometry.rayCount().x; ++u)
    {
      if (!seesField(geometry, u, v))
      {
        continue;
      }
      const auto ray = rayOf(geometry, u, v);
      const auto depths = depthsOf(geometry, ray);
      const double expected = reference::fieldMaximum(exact, ray, depths[0], depths[1]);
      const double found = double(image.row<A>(v)[u]);
      const double error = std::abs(found - expected) / bound;
      check(image.covers(u, v), "pixel ", u, " ", v, " is not covered");
      check(error <= 1.0, "pixel ", u, " ", v, " is ", found, ", not ", expected, ": ", error,
        " bounds, axis ", geometry.principalAxis(), ", shear ", geometry.shear().x, " ",
        geometry.shear().y);
      worst.error = std::max(worst.error, error);
      ++worst.compared;
    }
  }
}

/// The same of a volume with NaN. Rounding moves rays by less than a millionth of a voxel.
template <class T>
void compareWithNaN(Checks& check, const reference::Volume<T>& volume,
  const splatting::ShearWarp& geometry, const splatting::ShearImage& image, Worst& worst)
{
  constexpr double way = 1e-6;
  const auto field = reference::toDouble(volume);
  const glm::dvec2 range = rangeOfNumbers(field);
  const glm::dvec3 steps = stepsOf(field);
  const double bound = perspectiveExactBound<T>(range[0], range[1]) +
    1e-12 * std::max({ range[1] - range[0], std::abs(range[0]), std::abs(range[1]) });
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    for (int u = 0; u < geometry.rayCount().x; ++u)
    {
      if (!seesField(geometry, u, v))
      {
        continue;
      }
      const auto ray = rayOf(geometry, u, v);
      const auto depths = depthsOf(geometry, ray);
      const double change = changeNearby(steps, ray, way) + bound;
      const double least = leastNearby(field, ray, depths[0] + way, depths[1] - way, way);
      const double most = mostNearby(field, ray, depths[0] - way, depths[1] + way, way);
      const double found = double(image.row<splatting::Accumulator<T>>(v)[u]);
      const bool hasNone = !image.covers(u, v) || found != found;
      check(hasNone ? !std::isfinite(least) : found >= least - change && found <= most + change,
        "beside NaN pixel ", u, " ", v, " is ", found, ", not from ", least, " to ", most,
        ", axis ", geometry.principalAxis(), ", slope ", ray.slope[0], " ", ray.slope[1]);
      worst.compared += !hasNone;
    }
  }
}

/// A view with voxels as boxes or as points.
splatting::View anyDomain(splatting::View view, reference::Random& random)
{
  view.showsBoxes = random.uniform(0, 2) == 0;
  return view;
}

/// Depth-shaded maxima in the picture: no pixel shows what none of its samples can be, whatever the
/// factors, at the field's rim and beside cuts and hidden voxels, too. Pixels without a sample show
/// the lowest voxel.
template <class T>
void testShaded(Checks& check, const reference::Volume<T>& volume, const splatting::View& view,
  reference::Random& random)
{
  using A = splatting::Accumulator<T>;
  splatting::ProjectionSettings settings = exactSettings();
  settings.reduction = splatting::Reduction::DepthShaded;
  settings.ambient = random.uniform(-2.0, 1.0);
  settings.changeRate = random.uniform(-2.0, 2.0);
  const auto field = reference::toDouble(volume);
  const glm::dvec2 range = rangeOfNumbers(field);
  const double width = range[1] - range[0];
  const double factors[2] = { settings.ambient, settings.ambient + settings.changeRate };
  const double low = range[0] + width * std::min({ 0.0, factors[0], factors[1] });
  const double high = range[0] + width * std::max({ 0.0, factors[0], factors[1] });
  // Of the sample, and 20 roundings of what it is multiplied by and added to.
  const double bound = 4.0 * perspectiveExactBound<T>(range[0], range[1]) +
    100.0 * std::numeric_limits<A>::epsilon() * std::max(std::abs(range[0]), std::abs(range[1]));
  std::vector<glm::dvec4> halfSpaces;
  if (random.uniform(0, 1))
  {
    const glm::dvec3 normal = anyVector(random, -1.0, 1.0);
    const glm::dvec3 point = anyVector(random, 0.0, 1.0) * glm::dvec3(toGlm(volume.size) - 1);
    halfSpaces.push_back({ normal, -glm::dot(normal, point) });
  }
  std::vector<splatting::ShearWarp> geometries;
  splatting::ShearWarp::factorise(view, geometries, anySampling(random));
  std::vector<splatting::ShearImage> images;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    images.push_back(project(volume, geometry, settings, halfSpaces));
  }
  constexpr A none = std::numeric_limits<A>::quiet_NaN();
  std::vector<A> pixels(std::size_t(view.viewport.x) * view.viewport.y, none);
  splatting::Warper().warpScalars(images, geometries, settings.reduction, view.viewport,
    settings.instructionSet, none, pixels.data());
  for (const A pixel : pixels)
  {
    check(pixel != pixel || (pixel >= low - bound && pixel <= high + bound), "shaded by ",
      factors[0], " to ", factors[1], " a pixel is ", pixel, ", not from ", low, " to ", high);
  }
}

/// Of all types, so that enough pixels are compared whatever the share of scenes.
struct Seen
{
  Sightings parallel, perspective, withNaN;
};

template <class T>
void testType(Checks& check, Seen& seen)
{
  Worst worst;
  reference::forScenes(seriesOf<T>("parallel views"), 25,
    [&](int, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<T>(randomSize(random, 7), random);
      const splatting::View view = anyDomain(anyView(volume.size, random), random);
      const splatting::ShearWarp geometry(view, anySampling(random));
      const int before = worst.compared;
      comparePixels(check, volume, geometry, project(volume, geometry, exactSettings()), worst);
      seen.parallel.add(worst.compared > before);
    });
  Worst perspective;
  reference::forScenes(seriesOf<T>("perspective views"), 60,
    [&](int, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<T>(randomSize(random, 7), random);
      const splatting::View view = anyDomain(randomPerspective(volume.size, random), random);
      std::vector<splatting::ShearWarp> images;
      splatting::ShearWarp::factorise(view, images, anySampling(random));
      const int before = perspective.compared;
      for (const splatting::ShearWarp& geometry : images)
      {
        comparePixels(
          check, volume, geometry, project(volume, geometry, exactSettings()), perspective);
      }
      seen.perspective.add(perspective.compared > before);
    });
  Worst withNaN;
  reference::forScenes(seriesOf<T>("hidden voxels"), 30,
    [&](int n, reference::Random& random)
    {
      const auto volume = withHidden(wholeRangeNoise<T>(randomSize(random, 7), random), random);
      const splatting::View view = anyDomain(
        n % 2 ? randomPerspective(volume.size, random) : anyView(volume.size, random), random);
      std::vector<splatting::ShearWarp> images;
      splatting::ShearWarp::factorise(view, images, anySampling(random));
      const int before = withNaN.compared;
      for (const splatting::ShearWarp& geometry : images)
      {
        compareWithNaN(
          check, volume, geometry, project(volume, geometry, exactSettings()), withNaN);
      }
      seen.withNaN.add(withNaN.compared > before);
    });
  reference::forScenes(seriesOf<T>("shaded"), 40,
    [&](int n, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<T>(randomSize(random, 7), random);
      const splatting::View view = anyDomain(
        n % 2 ? randomPerspective(volume.size, random) : anyView(volume.size, random), random);
      n % 4 < 2 ? testShaded(check, volume, view, random)
                : testShaded(check, withHidden(volume, random), view, random);
    });
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ": largest error " << worst.error
            << " of the bound, " << worst.compared << " pixels; in perspective "
            << perspective.error << ", " << perspective.compared << " pixels; with hidden voxels "
            << withNaN.compared << " pixels" << std::endl;
}

/// Large enough for whole registers, tiles and bands; the accelerations and instruction sets agree.
template <class T>
void testAccelerations(Checks& check)
{
  reference::forScenes(seriesOf<T>("accelerations"), 6,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int& s : size)
      {
        s = random.uniform(20, 70);
      }
      auto volume = wholeRangeNoise<T>(size, random);
      for (T& voxel : volume.voxels)
      {
        voxel = random.uniform(0, 99) ? static_cast<T>(voxel / 8) : voxel;
      }
      splatting::ShearWarp geometry;
      if (n % 2)
      {
        geometry = randomPerspectiveImage(size, random);
      }
      else
      {
        const splatting::View view = anyDomain(randomView(size, random), random);
        geometry = splatting::ShearWarp(view, anySampling(random));
      }
      const std::vector<glm::dvec4> halfSpaces = n % 3 == 0
        ? std::vector<glm::dvec4>{ { 0.7, 0.5, -0.4, -0.1 * size[0] } }
        : std::vector<glm::dvec4>{};
      splatting::ProjectionSettings settings = exactSettings();
      settings.acceleration = Acceleration::Dense;
      settings.instructionSet = splatting::InstructionSet::Baseline;
      const auto expected = project(volume, geometry, settings, halfSpaces);
      for (splatting::InstructionSet set : instructionSets)
      {
        settings.instructionSet = set;
        for (const Acceleration acceleration :
          { Acceleration::Dense, Acceleration::Bricks, Acceleration::Lines })
        {
          settings.acceleration = acceleration;
          check(sameImages(project(volume, geometry, settings, halfSpaces), expected),
            "other bits with acceleration ", int(acceleration), ", ", splatting::nameOf(set));
        }
      }
    });
}
}

int TestExact(int, char*[])
{
  Checks check;
  Seen seen;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testType<T>(check, seen);
      testAccelerations<T>(check);
    });
  check(seen.parallel.areEnough(0.5), "pixels are compared in only ", seen.parallel);
  check(seen.perspective.areEnough(0.3), "pixels in perspective are compared in only ",
    seen.perspective);
  check(seen.withNaN.areEnough(0.2), "pixels beside NaN are compared in only ", seen.withNaN);
  return check.result();
}
