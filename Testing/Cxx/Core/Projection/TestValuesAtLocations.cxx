// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is carried along with the winners of a projection: in preview the voxel that the ray meets
// first of those that win, in the other modes the average over the footprint of the slice that
// wins.
#include "AverageTesting.h"
#include "CoreTesting.h"

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
  projector.project(index, geometry, settings, cutsBy(geometry, {}, cropping), result.image);
  projector.takeAtLocations(
    { other.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(other.size) }, geometry, settings,
    result.image, result.carried);
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

/// The voxel that wins, of those that a ray crosses, from the viewer; nullptr without one.
const std::int32_t* winnerOf(const reference::Volume<std::int32_t>& volume,
  const splatting::ShearWarp& geometry, const splatting::Cropping& cropping, Reduction reduction,
  int u, int v)
{
  const reference::ShearView view = referenceView(geometry);
  const auto grid = reference::makeShearGrid(volume.size, view);
  auto path = reference::crossedVoxels(volume.size, view, u, v);
  if (geometry.reversed())
  {
    std::reverse(path.begin(), path.end());
  }
  const std::int32_t* winner = nullptr;
  for (const auto& voxel : path)
  {
    const int k = voxel[grid.axes[2]];
    const double middle[3] = { u - grid.margin[0] - view.shear[0] * (k - grid.middle),
      v - grid.margin[1] - view.shear[1] * (k - grid.middle), double(k) };
    int bit = 0;
    const int strides[3] = { 1, 3, 9 };
    for (int a = 0; a < 3; ++a)
    {
      const glm::dvec2& planes = cropping.planes[grid.axes[a]];
      bit += strides[grid.axes[a]] * (middle[a] < planes[0] ? 0 : middle[a] <= planes[1] ? 1 : 2);
    }
    if (cropping.flags >> bit & 1u)
    {
      const std::int32_t& value = volume.at(voxel);
      const bool wins =
        !winner || (reduction == Reduction::Minimum ? value < *winner : value > *winner);
      winner = wins ? &value : winner;
    }
  }
  return winner;
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
      splatting::Cropping cropping = anyCropping(size, random);
      for (auto& planes : cropping.planes)
      {
        planes[1] = std::max(planes[1], planes[0] + 1.0); // not thinner than a slice
      }
      splatting::ProjectionSettings settings;
      settings.quality = Quality::Preview;
      settings.reduction = random.oneIn(2) ? Reduction::Maximum : Reduction::Minimum;
      const Projected found = projectAndCarry(volume, places(size), geometry, settings, cropping);
      bool same = true;
      for (int v = 0; v < found.image.height && same; ++v)
      {
        for (int u = 0; u < found.image.width && same; ++u)
        {
          const std::int32_t* const winner =
            winnerOf(volume, geometry, cropping, settings.reduction, u, v);
          same = found.image.covers(u, v) == (winner != nullptr) &&
            (!winner || found.carried.row<std::int32_t>(v)[u] == winner - volume.voxels.data());
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
      const auto range = std::minmax_element(volume.voxels.begin(), volume.voxels.end());
      const double bound = errorBound<T>(
        settings.quality, static_cast<double>(*range.first), static_cast<double>(*range.second));
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
