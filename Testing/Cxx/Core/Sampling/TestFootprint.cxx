// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares footprint weights with numerical integration, and digitised weights with those in closed
// form. Tests properties of all weights, and that a frame computes a general table once.
#include "CoreTesting.h"
#include "Splat/Sampling/Footprint.h"

#include <cmath>
#include <ctime>
#include <iostream>

using namespace coretesting;
using splatting::GeneralTable;
using splatting::Kernel;
using splatting::Quality;
using splatting::Reconstruction;
using splatting::WeightTable;

namespace
{
const Kernel kernels[] = { { Reconstruction::Box, 1.0 }, { Reconstruction::Hat, 1.0 },
  { Reconstruction::CosineBell, 1.0 }, { Reconstruction::CosineBell, 0.5 },
  { Reconstruction::CosineBell, 1.5 } };

glm::dvec2 anyShear(reference::Random& random)
{
  if (random.oneIn(2))
  {
    return { specialShear(random), specialShear(random) };
  }
  return { random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0) };
}

glm::dvec2 anyFraction(reference::Random& random)
{
  if (!random.oneIn(4))
  {
    return { random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5) };
  }
  return { random.uniform(-1, 1) / 2.0, 0.0 };
}

/// The definition, by the midpoint rule in x, y and z over pixel and slice.
double directWeight(const Kernel& kernel, const glm::dvec2& shear, const glm::dvec2& offset, int c)
{
  constexpr int n = 40;
  double sum = 0.0;
  for (int z = 0; z < n; ++z)
  {
    const double depth = (z + 0.5) / n - 0.5;
    double x = 0.0, y = 0.0;
    for (int p = 0; p < n; ++p)
    {
      const double inPixel = (p + 0.5) / n - 0.5;
      x += kernel(offset.x + inPixel - shear.x * depth);
      y += kernel(offset.y + inPixel - shear.y * depth);
    }
    sum += kernel(depth - c) * (x / n) * (y / n) / n;
  }
  return sum;
}

GeneralTable tableOf(const Kernel& kernel, const glm::dvec2& shear, int sampling)
{
  GeneralTable table;
  table.set(kernel, shear, sampling);
  return table;
}

template <class F>
void forEachWeight(const WeightTable& weights, F&& f)
{
  for (int c = -1; c <= 1; ++c)
  {
    for (int dj = -2; dj <= 2; ++dj)
    {
      for (int di = -2; di <= 2; ++di)
      {
        f(c, di, dj, weights[c + 1][dj + 2][di + 2]);
      }
    }
  }
}

double sumOf(const WeightTable& weights)
{
  double sum = 0.0;
  forEachWeight(weights, [&](int, int, int, double w) { sum += w; });
  return sum;
}

double largestDifference(const WeightTable& a, const WeightTable& b)
{
  double largest = 0.0;
  forEachWeight(a,
    [&](int c, int di, int dj, double w)
    { largest = std::max(largest, std::abs(w - b[c + 1][dj + 2][di + 2])); });
  return largest;
}

void testClosedForm(Checks& check)
{
  reference::forScenes("closed form", 60,
    [&](int n, reference::Random& random)
    {
      const Kernel& kernel = kernels[n % 5];
      const glm::dvec2 shear = anyShear(random), fraction = anyFraction(random);
      const WeightTable weights = splatting::closedFormWeights(kernel, shear, fraction);
      WeightTable direct;
      forEachWeight(weights,
        [&](int c, int di, int dj, double)
        {
          direct[c + 1][dj + 2][di + 2] =
            directWeight(kernel, shear, -glm::dvec2(di, dj) - fraction, c);
        });
      const double sum = sumOf(direct);
      // The midpoint rule errs by at most 1/(2 n) of a step of height 1 for the box, per dimension;
      // by far less for continuous kernels: 1/24 n^-2 of the second derivative and kinks.
      const double bound = kernel.shape == Reconstruction::Box ? 3 * 0.5 / 40 : 2e-3;
      forEachWeight(weights,
        [&](int c, int di, int dj, double w)
        {
          check(std::abs(w - direct[c + 1][dj + 2][di + 2] / sum) < bound, "weight ", w,
            " is not the integral ", direct[c + 1][dj + 2][di + 2] / sum);
        });
    });
}

void testPromises(Checks& check)
{
  reference::forScenes("promises", 2000,
    [&](int n, reference::Random& random)
    {
      const Kernel& kernel = kernels[random.uniform(0, 4)];
      const glm::dvec2 shear = anyShear(random), fraction = anyFraction(random);
      WeightTable weights;
      if (n % 10 == 0)
      {
        weights = tableOf(kernel, shear, random.uniform(1, 12)).weights(fraction);
      }
      else
      {
        weights = splatting::closedFormWeights(kernel, shear, fraction);
      }
      check(std::abs(sumOf(weights) - 1.0) < 1e-14, "weights sum to ", sumOf(weights));
      forEachWeight(weights,
        [&](int c, int di, int dj, double w)
        {
          check(w >= 0.0, "a weight is negative: ", w);
          const bool narrow = kernel.shape == Reconstruction::Box;
          check(!narrow || w == 0.0 || (c == 0 && std::abs(di) <= 1 && std::abs(dj) <= 1),
            "standard mode needs more than 3 x 3 weights");
        });
      for (int bits : { 16, 24, 48 })
      {
        double sum = 0.0;
        for (const splatting::Tap& tap : splatting::quantisedTaps(weights, bits))
        {
          check(tap.weight > 0.0, "a rounded weight is not positive: ", tap.weight);
          sum += tap.weight; // exact: multiples of 2^-bits up to 1
        }
        check(sum == 1.0, "rounded weights do not sum to 1 but to ", sum);
      }
    });
}

/// Kernels for which tables may have very small weights.
const double radii[] = { 0.5, std::nextafter(0.5, 1.0), 0.5 + 1e-12, 0.5 + 1e-9, 0.5 + 1e-7,
  0.5 + 1e-5, std::nextafter(0.501, 0.0), 0.501, 0.51, 1.0, 1.5 };
const double shears[] = { 0.0, 0x1p-24, -0x1p-24, 1e-12, 0.5, -1.0 };
const double fractions[] = { -0.5, -1.0 / 3.0, -0.25, -0.125, 0.0, 0x1p-24, 1.0 / 6.0, 0.25, 0.37,
  std::nextafter(0.5, 0.0) };

std::vector<Kernel> allKernels()
{
  std::vector<Kernel> kernels{ { Reconstruction::Box }, { Reconstruction::Hat } };
  for (double radius : radii)
  {
    kernels.push_back({ Reconstruction::CosineBell, radius });
  }
  return kernels;
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

/// The kernels that sum to one do so by themselves at every depth; seen through the closed form.
void testPartitionOfUnity(Checks& check)
{
  for (const Kernel& kernel : { kernels[0], kernels[1], kernels[2] })
  {
    for (double x = -0.5; x <= 0.5; x += 1.0 / 64)
    {
      double points = 0.0, pixels = 0.0;
      for (int i = -3; i <= 3; ++i)
      {
        points += kernel(x - i);
        pixels += kernel.overPixel(x - i, 1.0);
      }
      const bool onFace = kernel.shape == Reconstruction::Box && std::abs(x) == 0.5;
      check(onFace || std::abs(points - 1.0) < 1e-14, "h does not sum to 1 but to ", points);
      check(std::abs(pixels - 1.0) < 1e-14, "H does not sum to 1 but to ", pixels);
    }
  }
}

/// How far a digitised weight may be off: a pixel's border cuts sub-pixels that the table counts
/// whole, an error of half a sub-pixel along each of its four sides, times the largest
/// thickness, 1.
double digitisedBound(int sampling)
{
  return 2.0 / sampling;
}

/// The largest error of a digitised weight.
double digitisedError(
  const Kernel& kernel, const glm::dvec2& shear, const glm::dvec2& fraction, int sampling)
{
  return largestDifference(tableOf(kernel, shear, sampling).weights(fraction),
    splatting::closedFormWeights(kernel, shear, fraction));
}

/// The larger the tables, the closer they come, over views that fill the range evenly.
void testDigitisedConverges(Checks& check)
{
  const char* names[] = { "standard", "trilinear", "cosine bell" };
  const auto share = [](double step) { return 2.0 * (step - std::floor(step)) - 1.0; };
  for (int k = 0; k < 3; ++k)
  {
    double before = 1.0;
    for (int sampling = 4; sampling <= 32; sampling *= 2)
    {
      double largest = 0.0;
      for (int n = 0; n < 20; ++n)
      {
        const glm::dvec2 shear(share(n * std::sqrt(2.0)), share(n * std::sqrt(3.0)));
        const glm::dvec2 fraction(0.5 * share(n * std::sqrt(5.0)), 0.5 * share(n * std::sqrt(7.0)));
        largest = std::max(largest, digitisedError(kernels[k], shear, fraction, sampling));
      }
      std::cout << names[k] << ", " << sampling << " x " << sampling
                << " sub-pixels: weights are off by at most " << largest << std::endl;
      check(largest <= digitisedBound(sampling), "a digitised weight is off by ", largest);
      check(largest < 0.75 * before, "the digitised weights do not converge");
      before = largest;
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

int TestFootprint(int, char*[])
{
  Checks check;
  testClosedForm(check);
  testPromises(check);
  testPartitionOfUnity(check);
  testAllWeights(check);
  testSettingAgain(check);
  testDigitisedConverges(check);
  testTime(check);
  return check.exitCode();
}
