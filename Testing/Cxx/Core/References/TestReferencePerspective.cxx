// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The oracle of perspective projections itself: by hand, and how far averages of parts are from
// what a pixel sees.
#include "CoreTesting.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>

using namespace coretesting;
using reference::ImageRays;
using reference::Kernel;

namespace
{
const Kernel Box = { Kernel::Nearest, 0.5 };
const Kernel Hat = { Kernel::Trilinear, 1.0 };
const Kernel Bell = { Kernel::CosineBell, 1.0 };
const Kernel kernels[] = { Box, Hat, Bell };

/// Rays through an eye that pass whole numbers at some depth, with such slopes and so many rays
/// before it.
struct Pencil
{
  std::array<double, 2> slope{ 0.0, 0.0 }; ///< of the ray through the first voxel's column
  double turn = 0.0;                       ///< slope from one ray to the next
  double depth = 0.0;
  std::array<int, 2> margin{ 0, 0 };
  std::array<int, 2> pixels{ 1, 1 };
};

/// An eye at infinity where rays do not turn.
ImageRays raysOf(const std::array<int, 3>& size, const Pencil& pencil)
{
  ImageRays rays;
  rays.size = size;
  rays.start = size[2] - 0.5;
  rays.eye = pencil.turn > 0.0 ? pencil.depth - 1.0 / pencil.turn : -1e12;
  rays.pitch = 1.0 + pencil.turn * (rays.start - pencil.depth);
  for (int a = 0; a < 2; ++a)
  {
    for (int n = -pencil.margin[a]; n < pencil.pixels[a] - pencil.margin[a]; ++n)
    {
      rays.slope[a].push_back(pencil.slope[a] + n * pencil.turn);
      rays.at[a].push_back(n + rays.slope[a].back() * (rays.start - pencil.depth));
    }
  }
  return rays;
}

void testTraversalByHand(Checks& check)
{
  using Voxels = std::vector<std::array<int, 3>>;
  // An eye in the middle of voxel (0, 0) of the slice before the first, looking along k.
  ImageRays rays;
  rays.size = { 3, 3, 2 };
  rays.start = 1.5;
  rays.eye = -1.0;
  rays.at = { { { 0.0, 1.25, 2.5 }, { 0.0, 2.5 } } };
  rays.slope = { { { 0.0, 0.5, 1.0 }, { 0.0, 1.0 } } };
  check(reference::crossedVoxels(rays, 0, 0) == Voxels{ { 0, 0, 0 }, { 0, 0, 1 } }, "straight on");
  // It is in voxel 0 up to x = 1/2, which is at z = 0.
  check(reference::crossedVoxels(rays, 1, 0) == Voxels{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 1 } },
    "half a voxel per slice");
  // The diagonal runs from z = -1/2 and x = 1/2 through voxels' corners.
  check(reference::crossedVoxels(rays, 2, 1) == Voxels{ { 1, 1, 0 }, { 2, 2, 1 } }, "diagonal");
  check(reference::crossedVoxels(rays, 2, 0) == Voxels{ { 1, 0, 0 }, { 2, 0, 1 } }, "edges");
  // From within slice 0, whose middle is behind the eye; seen the other way, before it.
  rays.eye = 0.25;
  check(reference::crossedVoxels(rays, 1, 0) == Voxels{ { 1, 0, 1 } }, "a slice behind the eye");
  rays.reversed = true;
  check(reference::crossedVoxels(rays, 1, 0) == Voxels{ { 0, 0, 0 }, { 1, 0, 0 } }, "reversed");
  // Within a face, all along.
  rays.at[0] = { 0.5, 0.5, 0.5 };
  rays.slope[0] = { 0.0, 0.0, 0.0 };
  check(reference::crossedVoxels(rays, 0, 0) == Voxels{ { 1, 0, 0 } }, "a ray within a face");
}

/// Voxel (i, j, k) = f(i, j, k).
template <class F>
reference::Volume<double> volumeOf(const std::array<int, 3>& size, F&& f)
{
  reference::Volume<double> volume(size);
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i)
      {
        volume.at(i, j, k) = f(double(i), double(j), double(k));
      }
    }
  }
  return volume;
}

/// The hat continues i, j, k and their products as they are, so averages can be told.
void testAveragesOfProducts(Checks& check)
{
  const std::array<int, 3> size{ 14, 14, 5 };
  Pencil pencil;
  pencil.slope = { 0.25, -0.75 };
  pencil.turn = 0x1p-5;
  pencil.depth = 2.0;
  pencil.margin = { -6, -6 };
  pencil.pixels = { 2, 2 };
  const ImageRays rays = raysOf(size, pencil);
  const int parts = reference::partsPerSlice(rays, Hat);
  check(parts == 2, "slices are cut into ", parts, " parts"); // 0.47 * 0.56 <= 0.48
  for (int u = 0; u < 2; ++u)
  {
    for (int v = 0; v < 2; ++v)
    {
      const int pixel = 2 * v + u;
      const double x = u + 6, y = v + 6, a = rays.slope[0][u], b = rays.slope[1][v];
      const auto is = [&](const reference::Volume<double>& volume, double expected, double lost)
      {
        for (int exact = 0; exact < 2; ++exact)
        {
          const auto samples = exact ? reference::frustumSamples(volume, rays, Hat)
                                     : reference::slabSamples(volume, rays, Hat);
          const double value = samples[pixel][2].value;
          check(std::abs(value - (exact ? expected : expected - lost)) < 1e-12,
            exact ? "exact" : "parts", ", pixel ", pixel, ": ", value, ", not ", expected);
          check(samples[pixel][2].slice == 2 && std::abs(samples[pixel][2].weight - 1.0) < 1e-13,
            "another slice");
        }
      };
      const double n = parts * parts;
      is(volumeOf(size, [](double i, double, double) { return i; }), x, 0.0);
      is(volumeOf(size, [](double, double j, double) { return j; }), y, 0.0);
      is(volumeOf(size, [](double, double, double k) { return k; }), 2.0, 0.0);
      // What is lost is the covariance within a part.
      is(volumeOf(size, [](double i, double j, double) { return i * j; }), x * y + a * b / 12.0,
        a * b / 12.0 / n);
      is(volumeOf(size, [](double i, double, double k) { return i * k; }), x * 2.0 + a / 12.0,
        a / 12.0 / n);
      is(volumeOf(size, [](double, double j, double k) { return j * k; }), y * 2.0 + b / 12.0,
        b / 12.0 / n);
    }
  }
}

void testBoxByHand(Checks& check)
{
  // One ray of slope 1/2 through x = 1 at z = 0 in the middle slice of three; the eye is 2 from it,
  // so windows are 1/2 wide at z = 0: x = 1 + a / 2 + b / 2 has a triangular density on
  // [1/2, 3/2], all of it in voxel 1.
  ImageRays rays;
  rays.size = { 4, 1, 1 };
  rays.start = 0.5;
  rays.eye = -2.0;
  rays.pitch = 0.625;
  rays.at = { { { 1.25 }, { 0.0 } } };
  rays.slope = { { { 0.5 }, { 0.0 } } };
  reference::Volume<double> volume({ 4, 1, 1 });
  volume.voxels = { 0.0, 8.0, 16.0, 0.0 };
  check(reference::partsPerSlice(rays, Box) == 1, "a part");
  check(reference::slabSamples(volume, rays, Box)[0][0].value == 8.0, "one voxel");
  // Through x = 3/2 half of it is voxel 2's; through 5/4 a quarter of the width, squared and
  // halved.
  rays.at[0][0] = 1.75;
  check(std::abs(reference::slabSamples(volume, rays, Box)[0][0].value - 12.0) < 1e-13, "half");
  rays.at[0][0] = 1.5;
  check(std::abs(reference::slabSamples(volume, rays, Box)[0][0].value - 9.0) < 1e-13, "an eighth");
  // Without voxel 1 nothing but the eighth is left.
  volume.voxels[1] = std::numeric_limits<double>::quiet_NaN();
  const auto left = reference::slabSamples(volume, rays, Box)[0][0];
  check(left.value == 16.0 && std::abs(left.weight - 0.125) < 1e-13, "NaN is left out");
}

/// Cutting slices into parts costs no more than lostByParts() says.
void testParts(Checks& check)
{
  Sightings differing;
  reference::forScenes("parts", 180,
    [&](int n, reference::Random& random)
    {
      const Kernel& kernel = kernels[n % 3];
      const auto size = randomSize(random, 5);
      auto volume = reference::uniformNoise<double>(size, random, 0.0, 1.0);
      for (double& voxel : volume.voxels)
      {
        voxel = n % 2 ? std::round(voxel) : voxel;
      }
      std::vector<splatting::ShearWarp> images;
      splatting::ShearWarp::factorise(randomPerspective(size, random), images);
      double largest = 0.0, share = 0.0;
      for (const splatting::ShearWarp& image : images)
      {
        const ImageRays rays = referenceRays(image);
        const auto exact = reference::frustumSamples(volume, rays, kernel);
        const auto parts = reference::slabSamples(volume, rays, kernel);
        for (std::size_t pixel = 0; pixel < exact.size(); ++pixel)
        {
          const int u = int(pixel) % rays.width(), v = int(pixel) / rays.width();
          for (std::size_t m = 0; m < exact[pixel].size(); ++m)
          {
            const auto& sample = parts[pixel][m];
            const double off = std::abs(exact[pixel][m].value - sample.value);
            const double bound = reference::lostByParts(rays, kernel, u, v, sample.slice);
            check(off <= bound + 1e-11, "parts are off by ", off, ", not ", bound, ", kernel ",
              int(kernel.shape));
            largest = std::max(largest, off);
            share = std::max(share, off / (bound + 1e-6));
          }
        }
      }
      differing.add(largest > 1e-4 && share > 0.05);
    });
  std::cout << "parts differ from the whole in " << differing << std::endl;
  check(differing.areEnough(0.1), "parts differ from the whole in only ", differing);
}
}

int TestReferencePerspective(int, char*[])
{
  Checks check;
  testTraversalByHand(check);
  testAveragesOfProducts(check);
  testBoxByHand(check);
  testParts(check);
  return check.exitCode();
}
