// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tests the oracle of perspective projections: the difference between averages of parts and the
// average over the frustum of a pixel. Core tests compare both with projections.
#include "CoreTesting.h"

#include <algorithm>
#include <cmath>
#include <iostream>

using namespace coretesting;
using reference::ImageRays;
using reference::Kernel;

namespace
{
const Kernel kernels[] = { { Kernel::Nearest, 0.5 }, { Kernel::Trilinear, 1.0 },
  { Kernel::CosineBell, 1.0 } };

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
  testParts(check);
  return check.exitCode();
}
