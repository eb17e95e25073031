// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Footprint weights: against direct numerical integration, digitised against closed form, and the
// promises that all of them make.
#include "CoreTesting.h"
#include "Sampling/Footprint.h"

#include <cmath>
#include <iostream>

using namespace coretesting;
using splatting::Kernel;
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
        splatting::GeneralTable table;
        table.set(kernel, shear, random.uniform(1, 12));
        weights = table.weights(fraction);
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
  splatting::GeneralTable table;
  table.set(kernel, shear, sampling);
  return largestDifference(
    table.weights(fraction), splatting::closedFormWeights(kernel, shear, fraction));
}

void testDigitised(Checks& check)
{
  reference::forScenes("digitised", 60,
    [&](int n, reference::Random& random)
    {
      const glm::dvec2 shear = anyShear(random), fraction = anyFraction(random);
      const int sampling = random.uniform(4, 12);
      const double error = digitisedError(kernels[n % 3], shear, fraction, sampling);
      check(error <= digitisedBound(sampling), "a digitised weight is off by ", error);
    });
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
}

int TestFootprint(int, char*[])
{
  Checks check;
  testClosedForm(check);
  testPromises(check);
  testPartitionOfUnity(check);
  testDigitised(check);
  testDigitisedConverges(check);
  return check.exitCode();
}
