// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares standard and high mode with the average over pixel area and slice thickness (in
// perspective with the average of parts), which is integrated numerically. The tolerance is the
// documented error bound.
#include "AverageTesting.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace coretesting;
using splatting::Quality;

namespace
{
template <class T>
void testAverages(Checks& check, bool perspective)
{
  using A = splatting::Accumulator<T>;
  double worst = 0.0;
  reference::forScenes(seriesOf<T>(nameOf("averages", perspective)), perspective ? 60 : 20,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const int largest = perspective && n % 3 == 0 ? 20 : 7;
      const auto volume = reference::uniformNoise<T>(randomSize(random, largest), random);
      const splatting::ShearWarp image = anyGeometry(volume.size, perspective, random);
      const reference::ImageRays rays = referenceRays(image);
      splatting::ProjectionSettings settings = settingsOf(mode);
      settings.instructionSet = anyInstructionSet(random);
      settings.acceleration = anyAcceleration(random);
      const auto expected = reference::maximumOf(
        reference::slabSamples(reference::toDouble(volume), rays, mode.reference), rays);
      auto found = reference::toDouble(toReference<A>(project(volume, image, settings)));
      forgetGrazes(
        image, [&](int u, int v) { return expected.isHit(u, v); }, found);
      const double bound = averageBound(volume, image, mode);
      const double error = largestDifference(expected, found) / bound;
      worst = std::max(worst, error);
      check.same(expected, found, bound, "type ", int(splatting::scalarTypeOf<T>()), ", mode ",
        int(mode.quality), ", kernel ", int(mode.kernel.shape), " ", mode.kernel.radius,
        ": error of ", error, " bounds; ", describe(image));
    });
  std::cout << nameOf("type", perspective) << " " << int(splatting::scalarTypeOf<T>())
            << ": largest error " << worst << " of the bound" << std::endl;
}

/// NaN voxels are left out.
void testNaN(Checks& check, bool perspective)
{
  reference::forScenes(nameOf("NaN", perspective), 45,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const int share = 1 + n % 9; // out of ten
      auto volume = reference::uniformNoise<double>(randomSize(random, 6), random);
      reference::Random many = random.fork();
      for (double& voxel : volume.voxels)
      {
        voxel = many.chance(share / 10.0) ? std::numeric_limits<double>::quiet_NaN() : voxel;
      }
      const splatting::ShearWarp image = anyGeometry(volume.size, perspective, random);
      const reference::ImageRays rays = referenceRays(image);
      const auto samples = reference::slabSamples(volume, rays, mode.reference);
      auto found = toReference<double>(project(volume, image, settingsOf(mode)));
      forgetGrazes(
        image, [&](int u, int v) { return !samples[std::size_t(v) * rays.width() + u].empty(); },
        found);
      compareWithNaN(check, samples, found, averageBound<double>(image, mode, -1.0, 1.0),
        "NaN volume, mode " + std::to_string(int(mode.quality)) + ", " + describe(image));
    });
}

/// Volumes with infinities.
void testInfinities(Checks& check)
{
  reference::Volume<float> volume({ 7, 7, 3 }, 1.0f);
  volume.at(3, 3, 1) = std::numeric_limits<float>::infinity();
  volume.at(1, 1, 1) = std::numeric_limits<float>::quiet_NaN();
  const splatting::ShearWarp geometry(viewWithShear(volume.size, 2, 0.0, 0.0));
  for (const Mode& mode : modes())
  {
    const auto image = toReference<float>(project(volume, geometry, settingsOf(mode)));
    const int m = geometry.margin().x;
    check(std::isinf(image.at(3 + m, 3 + m)), "an infinite voxel is not seen");
    check(image.at(1 + m, 1 + m) == 1.0f, "a NaN voxel spreads");
    check(image.at(5 + m, 5 + m) == 1.0f, "an infinite voxel spreads");
  }
}

/// Footprints from tables.
template <class T>
void testConstant(Checks& check, bool perspective)
{
  using A = splatting::Accumulator<T>;
  using Limits = std::numeric_limits<T>;
  reference::forScenes(seriesOf<T>(nameOf("constant volumes", perspective)), 20,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const T value = random.uniform<T>(Limits::lowest() / 2, Limits::max() / 2);
      const reference::Volume<T> volume(randomSize(random, 30), value);
      const splatting::ShearWarp image = anyGeometry(volume.size, perspective, random);
      splatting::ProjectionSettings settings = settingsOf(mode);
      settings.footprintSampling = std::max(random.uniform(-3, 3), 0);
      settings.kernel.radius = random.oneIn(4) ? 0.5 : settings.kernel.radius;
      settings.acceleration = anyAcceleration(random);
      const auto found = toReference<A>(project(volume, image, settings));
      for (std::size_t p = 0; p < found.value.size(); ++p)
      {
        check(!found.hit[p] || found.value[p] == static_cast<A>(value), "a constant volume of ",
          double(value), " is ", double(found.value[p]), ", mode ", int(mode.quality));
      }
    });
}

/// Weights that add up to more than one would show in plateaus.
template <class T>
void testNeverAbove(Checks& check, bool perspective)
{
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>(nameOf("plateaus", perspective)), 5,
    [&](int, reference::Random& random)
    {
      const Mode mode = modes()[random.uniform(0, 4)];
      reference::Volume<T> volume(randomSize(random, 30), T(101));
      reference::Random many = random.fork();
      for (T& voxel : volume.voxels)
      {
        voxel = !many.oneIn(100) ? voxel : T(many.uniform(0, 100));
      }
      const splatting::ShearWarp image = anyGeometry(volume.size, perspective, random);
      const auto found = toReference<A>(project(volume, image, settingsOf(mode)));
      const A largest = *std::max_element(found.value.begin(), found.value.end());
      check(largest <= A(101), "a pixel is above all voxels by ", double(largest) - 101.0,
        ", mode ", int(mode.quality));
    });
}

/// [CS98], Fig. 1: a pixel half-way between two voxels sees their average, not half of either.
void testFigure1(Checks& check)
{
  // With shear 1 and two slices, pixels lie between voxels in the middle of slice 0. Slice 1, where
  // the same rays look elsewhere, is cut away.
  const std::vector<glm::dvec4> slice0{ { 0.0, 0.0, -1.0, 0.5 } };
  for (const Mode& mode : modes())
  {
    for (int right : { 250, 150 })
    {
      reference::Volume<std::uint8_t> volume({ 8, 5, 2 }, 250);
      for (int n = 0; n < 8 * 5 * 2; ++n)
      {
        volume.voxels[n] = static_cast<std::uint8_t>(n % 8 < 4 ? 250 : right);
      }
      const splatting::ShearWarp geometry(viewWithShear(volume.size, 2, 1.0, 0.0));
      const auto image =
        toReference<float>(project(volume, geometry, settingsOf(mode), cutsBy(geometry, slice0)));
      const float found = image.at(3 + geometry.margin().x, 2 + geometry.margin().y);
      const float expected = (250 + right) / 2.0f;
      // Standard weighs both voxels by exactly 1/2; the other kernels' weights are rounded.
      const double bound = mode.quality == Quality::Standard
        ? 0.0
        : errorBound<std::uint8_t>(mode.quality, right, 250);
      check(std::abs(found - expected) <= bound, "Fig. 1: 250 beside ", right, " gives ", found,
        ", not ", expected);
    }
  }
}
}

int TestWorksheets(int, char*[])
{
  Checks check;
  for (bool perspective : { false, true })
  {
    forEachType(
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        testAverages<T>(check, perspective);
        testConstant<T>(check, perspective);
        testNeverAbove<T>(check, perspective);
      });
    testNaN(check, perspective);
  }
  testInfinities(check);
  testFigure1(check);
  return check.exitCode();
}
