// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Standard and high mode equal the average over pixel area and slice thickness, integrated
// numerically, within the documented error bound.
#include "AverageTesting.h"
#include "CoreTesting.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace coretesting;
using splatting::Quality;

namespace
{
/// The largest error, relative to the bound; infinity where one image has a sample and one not.
template <class T>
double largestError(const reference::Volume<T>& volume, const splatting::ShearWarp& geometry,
  const Mode& mode, double bound, splatting::InstructionSet set = splatting::bestInstructionSet())
{
  using A = splatting::Accumulator<T>;
  const auto expected =
    reference::slabAverage(reference::toDouble(volume), referenceView(geometry), mode.reference);
  splatting::ProjectionSettings settings = settingsOf(mode);
  settings.instructionSet = set;
  const auto found = toReference<A>(project(volume, geometry, settings));
  if (found.hit != expected.hit)
  {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0.0;
  for (std::size_t p = 0; p < expected.value.size(); ++p)
  {
    if (expected.hit[p] && expected.value[p] != double(found.value[p]))
    {
      largest = std::max(largest, std::abs(expected.value[p] - double(found.value[p])));
    }
  }
  return largest / bound;
}

/// Rows that fill several registers, with every instruction set.
template <class T>
void testLongRows(Checks& check)
{
  reference::forScenes(seriesOf<T>("long rows"), 8,
    [&](int way, reference::Random& random)
    {
      const std::array<int, 3> size{ random.uniform(70, 150), random.uniform(3, 9),
        random.uniform(2, 4) };
      const auto volume = reference::uniformNoise<T>(size, random);
      const double shearX = 0.01 * random.uniform(-99, 99), shearY = 0.01 * random.uniform(-99, 99);
      const splatting::ShearWarp geometry(viewWithShear(size, 2, shearX, shearY));
      const double low = double(*std::min_element(volume.voxels.begin(), volume.voxels.end()));
      const double high = double(*std::max_element(volume.voxels.begin(), volume.voxels.end()));
      Mode mode = modes()[way % 2];
      const double bound = errorBound<T>(mode.quality, low, high) +
        2e-13 * std::max(std::abs(low), std::abs(high)) + 1e-300;
      const splatting::InstructionSet set = instructionSets[way / 2];
      const double error = largestError(volume, geometry, mode, bound, set);
      check(error <= 1.0, "long rows of type ", int(splatting::scalarTypeOf<T>()), ", mode ",
        int(mode.quality), ", ", splatting::nameOf(set), ": error of ", error, " bounds");
    });
}

template <class T>
void testType(Checks& check)
{
  double worst = 0.0;
  reference::forScenes(seriesOf<T>("averages"), 20,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const auto volume = reference::uniformNoise<T>(randomSize(random, 6), random);
      const splatting::View view = anyView(volume.size, random);
      const splatting::ShearWarp geometry(view);
      const double low = double(*std::min_element(volume.voxels.begin(), volume.voxels.end()));
      const double high = double(*std::max_element(volume.voxels.begin(), volume.voxels.end()));
      // The reference itself is good to some rounding errors of double.
      const double bound = errorBound<T>(mode.quality, low, high) +
        2e-13 * std::max(std::abs(low), std::abs(high)) + 1e-300;
      const double error = largestError(volume, geometry, mode, bound);
      worst = std::max(worst, error);
      check(error <= 1.0, "type ", int(splatting::scalarTypeOf<T>()), ", mode ", int(mode.quality),
        ": error of ", error, " bounds; axis ", geometry.principalAxis(), ", shear ",
        geometry.shear().x, " ", geometry.shear().y);
    });
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ": largest error " << worst
            << " of the bound" << std::endl;
}

/// NaN voxels are left out; infinities are values.
void testOddValues(Checks& check)
{
  reference::forScenes("NaN", 45,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const int share = 1 + n % 9; // out of ten
      auto volume = reference::uniformNoise<double>(randomSize(random, 5), random);
      reference::Random many = random.fork();
      for (double& voxel : volume.voxels)
      {
        voxel = many.chance(share / 10.0) ? std::numeric_limits<double>::quiet_NaN() : voxel;
      }
      const splatting::ShearWarp geometry(randomView(volume.size, random));
      const auto samples = reference::slabSamples(volume, referenceView(geometry), mode.reference);
      // The reference itself is good to some rounding errors of double.
      compareWithNaN(check, samples,
        toReference<double>(project(volume, geometry, settingsOf(mode))),
        errorBound<double>(mode.quality, -1.0, 1.0) + 2e-13,
        "NaN volume, mode " + std::to_string(int(mode.quality)));
    });
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

template <class T>
void testConstant(Checks& check)
{
  using Limits = std::numeric_limits<T>;
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>("constant volumes"), 5,
    [&](int, reference::Random& random)
    {
      const Mode mode = modes()[random.uniform(0, 4)];
      const T value = random.uniform<T>(Limits::lowest() / 2, Limits::max() / 2);
      const reference::Volume<T> volume(randomSize(random, 9), value);
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      const auto image = toReference<A>(project(volume, geometry, settingsOf(mode)));
      for (std::size_t p = 0; p < image.value.size(); ++p)
      {
        check(!image.hit[p] || image.value[p] == static_cast<A>(value),
          "a constant volume is not that constant");
      }
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
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testType<T>(check);
      testLongRows<T>(check);
      testConstant<T>(check);
    });
  testOddValues(check);
  testFigure1(check);
  return check.exitCode();
}
