// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Exact mode shows the maximum of the trilinear field along each ray, as brute force finds it.
#include "CoreTesting.h"
#include "FieldMaximum.h"

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

/**
 * How far the maximum may be from the field's, of voxels that are no larger than `largest` without
 * the base that is subtracted.
 *
 * A Bernstein coefficient is a sum of eight products with weights that were rounded, 9 roundings of
 * what adds up to no more than the largest voxel; a peak is found by six interpolations of two
 * products and a sum each, in three layers of 4 roundings. Where the peak is looked for matters to
 * second order only. Last, the base is added.
 */
template <class T>
double exactBound(double low, double high)
{
  using A = splatting::Accumulator<T>;
  const double rounding = std::numeric_limits<A>::epsilon() / 2;
  const double largest = std::max(std::abs(low), std::abs(high));
  const bool hasBase = std::numeric_limits<T>::is_integer && sizeof(T) < 8;
  return rounding * ((9.0 + 3.0 * 4.0 + 3.0) * (hasBase ? high - low : largest) + largest);
}

/**
 * In perspective views a coefficient is interpolated three times, with five roundings each, and a
 * mean of three, with four; where the ray is in its cell, and where pieces begin and end, is a sum
 * and a product of numbers up to 3, 12 roundings for each of three coordinates.
 */
template <class T>
double perspectiveExactBound(double low, double high)
{
  using A = splatting::Accumulator<T>;
  const double rounding = std::numeric_limits<A>::epsilon() / 2;
  return exactBound<T>(low, high) +
    rounding * (3.0 * 5.0 + 4.0) * std::max(std::abs(low), std::abs(high)) +
    rounding * 3.0 * 12.0 * (high - low);
}

reference::FieldRay rayOf(const splatting::ShearWarp& geometry, int u, int v)
{
  const auto& size = geometry.size();
  std::array<int, 3> volumeSize;
  for (int a = 0; a < 3; ++a)
  {
    volumeSize[geometry.axes()[a]] = size[a];
  }
  return geometry.isPerspective() ? reference::fieldRay(referenceRays(geometry), u, v)
                                  : reference::fieldRay(volumeSize, referenceView(geometry), u, v);
}

/// Within a face that a ray runs in it belongs to the higher voxels, of which there are none behind
/// the last one.
bool runsAlongLastFace(const splatting::ShearWarp& geometry, const reference::FieldRay& ray)
{
  const auto runs = [&](int a)
  { return ray.slope[a] == 0.0 && ray.at[a] == geometry.size()[a] - 0.5; };
  return runs(0) || runs(1);
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
  const auto domain =
    geometry.showsBoxes() ? reference::FieldDomain::Boxes : reference::FieldDomain::Centres;
  // The reference refines to some roundings of double.
  const double bound =
    (geometry.isPerspective() ? perspectiveExactBound<T>(low, high) : exactBound<T>(low, high)) +
    1e-12 * std::max({ high - low, std::abs(low), std::abs(high) }) + 1e-300;
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    for (int u = 0; u < geometry.rayCount().x; ++u)
    {
      const auto ray = rayOf(geometry, u, v);
      // Slices behind the eye are not seen at all.
      const splatting::Span& slices = geometry.slices();
      const glm::dvec2 faces(geometry.faces(slices.begin).x, geometry.faces(slices.end - 1).y);
      const auto depths = reference::depthsInField(volume.size, ray, domain, faces.x, faces.y);
      if (depths[1] - depths[0] < (geometry.isPerspective() ? 2e-3 : 1e-6) ||
        runsAlongLastFace(geometry, ray))
      {
        continue;
      }
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

/// A view with voxels as boxes or as points.
splatting::View anyDomain(splatting::View view, reference::Random& random)
{
  view.showsBoxes = random.uniform(0, 2) == 0;
  return view;
}

template <class T>
void testType(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  Worst worst;
  for (int n = 0; n < 25; ++n)
  {
    const auto volume = wholeRangeNoise<T>(randomSize(random, 7), random.bits());
    const splatting::ShearWarp geometry(
      anyDomain(anyView(volume.size, random), random), anySampling(random));
    comparePixels(check, volume, geometry, project(volume, geometry, exactSettings()), worst);
  }
  Worst perspective;
  std::vector<splatting::ShearWarp> images;
  for (int n = 0; n < 60; ++n)
  {
    const auto volume = wholeRangeNoise<T>(randomSize(random, 7), random.bits());
    splatting::ShearWarp::factorise(
      anyDomain(randomPerspective(volume.size, random), random), images, anySampling(random));
    for (const splatting::ShearWarp& geometry : images)
    {
      comparePixels(
        check, volume, geometry, project(volume, geometry, exactSettings()), perspective);
    }
  }
  check(perspective.compared > 300, "only ", perspective.compared, " pixels in perspective");
  check(worst.compared > 300, "only ", worst.compared, " pixels");
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ": largest error " << worst.error
            << " of the bound, " << worst.compared << " pixels; in perspective "
            << perspective.error << ", " << perspective.compared << " pixels" << std::endl;
}

/// Large enough for whole registers, tiles and bands; the accelerations and instruction sets agree.
template <class T>
void testAccelerations(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  for (int n = 0; n < 6; ++n)
  {
    std::array<int, 3> size;
    for (int& s : size)
    {
      s = random.uniform(20, 70);
    }
    auto volume = wholeRangeNoise<T>(size, random.bits());
    for (T& voxel : volume.voxels)
    {
      voxel = random.uniform(0, 99) ? static_cast<T>(voxel / 8) : voxel;
    }
    const splatting::ShearWarp geometry = n % 2
      ? randomPerspectiveImage(size, random)
      : splatting::ShearWarp(anyDomain(randomView(size, random), random), anySampling(random));
    const std::vector<glm::dvec4> halfSpaces = n % 3 == 0
      ? std::vector<glm::dvec4>{ { 0.7, 0.5, -0.4, -0.1 * size[0] } }
      : std::vector<glm::dvec4>{};
    splatting::ProjectionSettings settings = exactSettings();
    settings.acceleration = Acceleration::Dense;
    settings.instructionSet = splatting::InstructionSet::Baseline;
    const auto expected = project(volume, geometry, settings, halfSpaces);
    for (int set = 0; set <= static_cast<int>(splatting::bestInstructionSet()); ++set)
    {
      settings.instructionSet = static_cast<splatting::InstructionSet>(set);
      for (const Acceleration acceleration :
        { Acceleration::Dense, Acceleration::Bricks, Acceleration::Lines })
      {
        settings.acceleration = acceleration;
        check(sameImages(project(volume, geometry, settings, halfSpaces), expected),
          "other bits with acceleration ", int(acceleration), ", instruction set ", set);
      }
    }
  }
}
}

int TestExact(int, char*[])
{
  Checks check;
  std::uint64_t seed = 300;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testType<T>(check, ++seed);
      testAccelerations<T>(check, ++seed);
    });
  return check.result();
}
