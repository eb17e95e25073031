// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every kernel, table and view gives weights that sum to one, so that a volume of one value shows
// that value, along chains, too. A frame with general tables makes its table once.
#include "CoreTesting.h"
#include "Sampling/Footprint.h"

#include <cmath>
#include <ctime>

using namespace coretesting;
using splatting::Acceleration;
using splatting::GeneralTable;
using splatting::Kernel;
using splatting::Quality;
using splatting::Reconstruction;
using splatting::WeightTable;

namespace
{
const double radii[] = { 0.5, std::nextafter(0.5, 1.0), 0.5 + 1e-12, 0.5 + 1e-9, 0.5 + 1e-7,
  0.5 + 1e-5, std::nextafter(0.501, 0.0), 0.501, 0.51, 1.0, 1.5 };
const double shears[] = { 0.0, 0x1p-24, -0x1p-24, 1e-12, 0.5, -1.0 };
const double fractions[] = { -0.5, -1.0 / 3.0, -0.25, -0.125, 0.0, 0x1p-24, 1.0 / 6.0, 0.25, 0.37,
  std::nextafter(0.5, 0.0) };

GeneralTable tableOf(const Kernel& kernel, const glm::dvec2& shear, int sampling)
{
  GeneralTable table;
  table.set(kernel, shear, sampling);
  return table;
}

double sumOf(const WeightTable& weights)
{
  double sum = 0.0;
  for (const auto& slice : weights)
  {
    for (const auto& row : slice)
    {
      for (double weight : row)
      {
        sum += weight;
      }
    }
  }
  return sum;
}

void checkWeights(Checks& check, const GeneralTable& table, const Kernel& kernel, int sampling,
  const glm::dvec2& shear)
{
  for (double x : fractions)
  {
    for (double y : { fractions[0], x, 0.25 })
    {
      const WeightTable weights = table.weights({ x, y });
      check(std::abs(sumOf(weights) - 1.0) < 1e-13 && splatting::quantisedTaps(weights, 16).size(),
        "kernel ", int(kernel.shape), " of radius ", kernel.radius, ", ", sampling,
        " sub-pixels, shear ", shear.x, " ", shear.y, ", fraction ", x, " ", y, ": weights sum to ",
        sumOf(weights));
    }
  }
}

std::vector<Kernel> allKernels()
{
  std::vector<Kernel> kernels{ { Reconstruction::Box }, { Reconstruction::Hat } };
  for (double radius : radii)
  {
    kernels.push_back({ Reconstruction::CosineBell, radius });
  }
  return kernels;
}

void testWeights(Checks& check, const Kernel& kernel, int sampling)
{
  for (double x : shears)
  {
    for (double y : { 0.0, x, 0.5 })
    {
      checkWeights(check, tableOf(kernel, { x, y }, sampling), kernel, sampling, { x, y });
    }
  }
}

void testAllWeights(Checks& check)
{
  for (const Kernel& kernel : allKernels())
  {
    for (int sampling : { 1, 2, 3, 4, 7 })
    {
      testWeights(check, kernel, sampling);
    }
  }
}

/// A table that is set to something else is that table, whatever of it changes.
void testSettingAgain(Checks& check)
{
  const Kernel kernels[] = { { Reconstruction::Hat }, { Reconstruction::CosineBell, 1.0 },
    { Reconstruction::CosineBell, 1.3 } };
  GeneralTable table;
  int kernel = 0, sampling = 2;
  glm::dvec2 shear(0.25, 0.5);
  reference::Random random(7);
  for (int n = 0; n < 200; ++n)
  {
    switch (random.uniform(0, 2))
    {
      case 0:
        kernel = random.uniform(0, 2);
        break;
      case 1:
        sampling = 1 << random.uniform(0, 2);
        break;
      default:
        shear[random.uniform(0, 1)] = random.uniform(-1.0, 1.0);
    }
    table.set(kernels[kernel], shear, sampling);
    const glm::dvec2 fraction(0.125, -0.3);
    check(table.weights(fraction) == tableOf(kernels[kernel], shear, sampling).weights(fraction),
      "kernel ", kernel, ", ", sampling, " sub-pixels: a table that was another has other weights");
  }
}

const std::array<int, 3> size{ 50, 9, 8 };

/// One value everywhere is seen everywhere, and chains have the bits of the dense walk.
template <class T>
void testPicture(
  Checks& check, const splatting::ShearWarp& geometry, splatting::ProjectionSettings settings)
{
  const auto noise = reference::uniformNoise<T>(size, 5);
  settings.acceleration = Acceleration::Dense;
  const auto expected = project(noise, geometry, settings);
  for (Acceleration acceleration : { Acceleration::Dense, Acceleration::Bricks, Acceleration::Lines,
         Acceleration::SortedLines, Acceleration::SortedVolume, Acceleration::Auto })
  {
    settings.acceleration = acceleration;
    check(sameImages(expected, project(noise, geometry, settings)), "type ",
      int(splatting::scalarTypeOf<T>()), ": acceleration ", int(acceleration), " differs");
    const auto image = toReference<splatting::Accumulator<T>>(
      project(reference::Volume<T>(size, T(77)), geometry, settings));
    bool isFlat = true;
    for (std::size_t n = 0; n < image.value.size(); ++n)
    {
      isFlat = isFlat && (!image.hit[n] || image.value[n] == 77);
    }
    check(isFlat, "type ", int(splatting::scalarTypeOf<T>()), ", acceleration ", int(acceleration),
      ": a volume of 77 does not show 77");
  }
}

template <class T>
void testPictures(Checks& check)
{
  splatting::ProjectionSettings settings;
  settings.kernel = { Reconstruction::CosineBell, 0.5 };
  settings.footprintSampling = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (double shear : { 0.0, 0.5 })
    {
      const splatting::ShearWarp geometry(viewWithShear(size, axis, 0.0, shear));
      for (Quality quality : { Quality::Standard, Quality::High })
      {
        settings.quality = quality;
        testPicture<T>(check, geometry, settings);
      }
    }
  }
}

/// A frame with the largest table takes as long as a few tables, not as one for each slice. The
/// processors' time counts: other programs' does not.
void testTime(Checks& check)
{
  const auto secondsOf = [](const auto& body)
  {
    const std::clock_t start = std::clock();
    body();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const std::array<int, 3> thick{ 37, 26, 13 };
  const auto volume = reference::uniformNoise<std::uint8_t>(thick, 5);
  const splatting::ShearWarp geometry(viewWithShear(thick, 2, 0.31, 0.17));
  splatting::ProjectionSettings settings;
  settings.quality = Quality::High;
  settings.footprintSampling = 64;
  const double table = secondsOf([&] { tableOf(settings.kernel, geometry.shear(), 64); });
  const double frame = secondsOf([&] { project(volume, geometry, settings); });
  std::cout << "64 x 64 sub-pixels: a table takes " << table << " s, a frame " << frame << " s"
            << std::endl;
  check(frame < 5.0 * table, "a frame takes ", frame / table, " times as long as its table");
}
}

int TestFootprintSettings(int, char*[])
{
  Checks check;
  testAllWeights(check);
  testSettingAgain(check);
  testPictures<std::uint8_t>(check);
  testPictures<std::int16_t>(check);
  testPictures<float>(check);
  testPictures<std::int64_t>(check);
  testPictures<double>(check);
  testTime(check);
  return check.exitCode();
}
