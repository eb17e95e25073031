// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is carried along with the winners of a projection: in preview the voxel that the ray meets
// first of those that win, in the other modes the average over the footprint of the slice that
// wins.
#include "AverageTesting.h"
#include "Winners.h"

#include <algorithm>
#include <cmath>

using namespace coretesting;
using splatting::Quality;
using splatting::Reduction;

namespace
{
struct Projected
{
  splatting::ShearImage image, carried;
};

template <class T>
Projected projectAndCarry(const reference::Volume<T>& volume, const reference::Volume<T>& other,
  const splatting::ShearWarp& geometry, splatting::ProjectionSettings settings,
  const splatting::Cropping& cropping)
{
  settings.recordLocations = true;
  splatting::VolumeIndex index;
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  splatting::Projector projector;
  Projected result;
  result.carried.minima.resize(1); // of an earlier signed projection
  projector.project(index, geometry, settings, cutsBy(geometry, {}, cropping), result.image,
    glm::ivec3(0),
    { { { other.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(other.size) },
      result.carried } });
  return result;
}

/// Each voxel's place, so that what is carried says where it comes from.
reference::Volume<std::int32_t> places(const std::array<int, 3>& size)
{
  reference::Volume<std::int32_t> volume(size, 0);
  for (std::size_t n = 0; n < volume.voxels.size(); ++n)
  {
    volume.voxels[n] = static_cast<std::int32_t>(n);
  }
  return volume;
}

void testPreview(Checks& check)
{
  reference::forScenes("previews", 300,
    [&](int, reference::Random& random)
    {
      const std::array<int, 3> size = randomSize(random, 12);
      // Few values: ties are common.
      const auto volume = reference::uniformNoise<std::int32_t>(size, random, -3, 3);
      const splatting::ShearWarp geometry(anyView(size, random));
      const splatting::Cropping cropping = anyCropping(size, random);
      splatting::ProjectionSettings settings;
      settings.quality = Quality::Preview;
      settings.reduction = random.oneIn(2) ? Reduction::Maximum : Reduction::Minimum;
      const Projected found = projectAndCarry(volume, places(size), geometry, settings, cropping);
      const reference::ImageRays rays = referenceRays(geometry);
      const auto samples = reference::voxelSamples(volume, rays);
      const auto carried = reference::voxelSamples(places(size), rays);
      const reference::RayCutter cutter(rays, rayCutsOf({}, cropping));
      bool same = true;
      for (int v = 0; v < found.image.height && same; ++v)
      {
        for (int u = 0; u < found.image.width && same; ++u)
        {
          const std::size_t pixel = std::size_t(v) * rays.width() + u;
          const int winner = reference::winnerOf(samples[pixel], cutter, u, v, geometry.reversed(),
            settings.reduction == Reduction::Minimum);
          same = found.image.covers(u, v) == (winner >= 0) &&
            (winner < 0 || found.carried.row<std::int32_t>(v)[u] == carried[pixel][winner].value);
        }
      }
      check(same, "another voxel is carried");
    });
}

/// Carried by itself, a volume gives its own projection.
template <class T>
void testItself(Checks& check)
{
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>("itself"), 40,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>(randomSize(random, 10), random);
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      splatting::ProjectionSettings settings;
      settings.quality = random.oneIn(2) ? Quality::Standard : Quality::High;
      settings.reduction = static_cast<Reduction>(random.uniform(0, 1));
      const Projected found =
        projectAndCarry(volume, volume, geometry, settings, anyCropping(volume.size, random));
      check(found.carried.minima.empty(), "earlier minima remain");
      const double bound = averageBound(volume, geometry, modeOf(settings.quality));
      double worst = 0.0;
      for (int v = 0; v < found.image.height; ++v)
      {
        for (int u = 0; u < found.image.width; ++u)
        {
          if (found.image.covers(u, v))
          {
            worst = std::max(worst,
              std::abs(double(found.carried.row<A>(v)[u]) - double(found.image.row<A>(v)[u])));
          }
        }
      }
      check(worst <= 2.0 * bound, "type ", int(splatting::scalarTypeOf<T>()),
        ": what is carried is ", worst, " from the projection, more than ", 2.0 * bound);
    });
}
}

int TestValuesAtLocations(int, char*[])
{
  Checks check;
  testPreview(check);
  forEachType([&](auto* null) { testItself<std::remove_pointer_t<decltype(null)>>(check); });
  return check.exitCode();
}
