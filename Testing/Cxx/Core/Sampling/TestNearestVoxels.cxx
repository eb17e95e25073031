// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestNearestVoxels
//
// Images of which each ray meets the nearest voxel of a slice only.
#include "CoreTesting.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <vector>

using namespace coretesting;

namespace
{
/// What the largest voxel may be that a ray meets: rays that pass between two may meet either.
template <class T>
struct NearestVoxels
{
  T least = std::numeric_limits<T>::lowest(), most = least;
  bool isHit = false;  ///< a voxel is met in any case
  bool isOpen = false; ///< the ray passes between voxels somewhere
};

template <class T>
NearestVoxels<T> nearestVoxels(
  const reference::Volume<T>& volume, const splatting::ShearWarp& geometry, int u, int v)
{
  NearestVoxels<T> nearest;
  for (int k = geometry.slices().begin; k < geometry.slices().end; ++k)
  {
    const glm::dvec2 p = geometry.onRay(u, v, k);
    const glm::dvec2 off = glm::abs(glm::fract(p) - 0.5);
    const bool isTie = std::min(off.x, off.y) < 1e-9;
    nearest.isOpen = nearest.isOpen || isTie;
    for (int way = 0; way < (isTie ? 4 : 1); ++way)
    {
      const glm::dvec2 nudge(way % 2 ? 1e-6 : -1e-6, way / 2 ? 1e-6 : -1e-6);
      glm::ivec3 voxel(glm::ivec2(glm::floor(p + 0.5 + (isTie ? nudge : glm::dvec2(0.0)))), k);
      if (voxel.x < 0 || voxel.y < 0 || voxel.x >= geometry.size().x ||
        voxel.y >= geometry.size().y)
      {
        continue;
      }
      std::array<int, 3> at;
      for (int a = 0; a < 3; ++a)
      {
        at[geometry.axes()[a]] = voxel[a];
      }
      const T value = volume.at(at[0], at[1], at[2]);
      nearest.most = std::max(nearest.most, value);
      nearest.least = isTie ? nearest.least : std::max(nearest.least, value);
      nearest.isHit = nearest.isHit || !isTie;
    }
  }
  return nearest;
}

/// Of each slice a ray meets the voxel that it passes nearest to in the middle.
template <class T>
void testNearest(Checks& check)
{
  reference::forScenes(seriesOf<T>("nearest"), 12,
    [&](int n, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<T>(randomSize(random, 20), random);
      std::vector<splatting::ShearWarp> geometries;
      const splatting::View view =
        n % 2 ? randomPerspective(volume.size, random) : anyView(volume.size, random);
      splatting::ShearWarp::factorise(view, geometries, splatting::Meets::Nearest);
      for (const splatting::ShearWarp& geometry : geometries)
      {
        splatting::ProjectionSettings settings;
        settings.quality = splatting::Quality::Preview;
        settings.instructionSet = anyInstructionSet(random);
        settings.acceleration =
          n % 3 ? splatting::Acceleration::Dense : splatting::Acceleration::Bricks;
        const auto found = toReference<T>(project(volume, geometry, settings));
        for (int v = 0; v < geometry.rayCount().y; ++v)
        {
          for (int u = 0; u < geometry.rayCount().x; ++u)
          {
            const NearestVoxels<T> nearest = nearestVoxels(volume, geometry, u, v);
            if (nearest.isHit || !nearest.isOpen)
            {
              check(found.isHit(u, v) == nearest.isHit, "a ray has a sample or not: ", u, ", ", v);
            }
            if (found.isHit(u, v))
            {
              check(found.at(u, v) >= nearest.least && found.at(u, v) <= nearest.most,
                "the nearest voxels are not met: ", double(found.at(u, v)), ", not ",
                double(nearest.least));
            }
          }
        }
      }
    });
}

/// In parallel views each voxel is met by one ray: their sum is the volume's.
void testEachVoxelOnce(Checks& check)
{
  reference::forScenes("each voxel once", 40,
    [&](int, reference::Random& random)
    {
      const auto size = randomSize(random, 20);
      const splatting::ShearWarp geometry(anyView(size, random), splatting::Meets::Nearest);
      auto volume = reference::constant<float>(size, 0.0f);
      const int voxel = random.uniform(0, static_cast<int>(volume.voxels.size()) - 1);
      volume.voxels[voxel] = 1.0f;
      splatting::ProjectionSettings settings;
      settings.quality = splatting::Quality::Preview;
      const splatting::ShearImage image = project(volume, geometry, settings);
      int count = 0;
      for (int v = 0; v < image.height; ++v)
      {
        for (int u = 0; u < image.width; ++u)
        {
          count += image.covers(u, v) && image.row<float>(v)[u] == 1.0f;
        }
      }
      check(count == 1, count, " rays meet a voxel");
    });
}
}

int TestNearestVoxels(int, char*[])
{
  Checks check;
  forEachType([&](auto* null) { testNearest<std::remove_pointer_t<decltype(null)>>(check); });
  testEachVoxelOnce(check);
  return check.result();
}
