// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What one survey of the voxels finds, against loops over each brick's own: the range, and the
// largest voxels of the bricks along all axes. Bricks that are too high would be seen nowhere else:
// they give the right picture, slowly.
#include "CoreTesting.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace coretesting;

namespace
{
template <class T>
splatting::VolumeIndex indexOf(const reference::Volume<T>& volume)
{
  splatting::VolumeIndex index;
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  return index;
}

/// The volume's axes as a projection along one of them sees them: i, j and k.
std::array<int, 3> axesOf(int principalAxis)
{
  return { principalAxis == 0 ? 1 : 0, principalAxis == 2 ? 1 : 2, principalAxis };
}

template <class T>
T largestIn(const reference::Volume<T>& volume, const std::array<int, 3>& axes,
  const std::array<int, 3>& begin, const std::array<int, 3>& edges)
{
  T largest = splatting::leastValue<T>();
  std::array<int, 3> end;
  for (int a = 0; a < 3; ++a)
  {
    end[a] = std::min(begin[a] + edges[a], volume.size[axes[a]]);
  }
  for (int k = begin[2]; k < end[2]; ++k)
  {
    for (int j = begin[1]; j < end[1]; ++j)
    {
      for (int i = begin[0]; i < end[0]; ++i)
      {
        std::array<int, 3> place;
        place[axes[0]] = i;
        place[axes[1]] = j;
        place[axes[2]] = k;
        largest = std::max(largest, volume.at(place)); // which NaN never is
      }
    }
  }
  return largest;
}

template <class T>
void testMaxima(Checks& check, const reference::Volume<T>& volume)
{
  splatting::VolumeIndex index = indexOf(volume);
  check(index.hasBricks(), "no bricks of ", volume.size[0], " x ", volume.size[1], " x ",
    volume.size[2], " voxels");
  const std::array<int, 3> edges = { splatting::BrickWidth, splatting::BrickHeight,
    splatting::BrickDepth };
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::array<int, 3> axes = axesOf(axis);
    const splatting::BrickMaxima& bricks = index.bricks(axis);
    const glm::ivec3 count((volume.size[axes[0]] + edges[0] - 1) / edges[0],
      (volume.size[axes[1]] + edges[1] - 1) / edges[1],
      (volume.size[axes[2]] + edges[2] - 1) / edges[2]);
    if (!check(bricks.count == count, "axis ", axis, ": another number of bricks"))
    {
      continue;
    }
    for (int k = 0; k < count.z; ++k)
    {
      for (int j = 0; j < count.y; ++j)
      {
        for (int i = 0; i < count.x; ++i)
        {
          const T expected =
            largestIn(volume, axes, { i * edges[0], j * edges[1], k * edges[2] }, edges);
          check(bricks.row<T>(j, k)[i] == expected, "axis ", axis, ", brick ", i, " ", j, " ", k,
            " of ", volume.size[0], " x ", volume.size[1], " x ", volume.size[2], ": ",
            +bricks.row<T>(j, k)[i], ", not ", +expected);
        }
      }
    }
  }
}

/// Also of volumes with NaN, of those with infinities, which have no bricks, and of those without
/// room.
template <class T>
void testRange(Checks& check, const reference::Volume<T>& volume, bool hasRoom)
{
  T low = splatting::greatestValue<T>(), high = splatting::leastValue<T>();
  bool special = false, infinite = false;
  for (const T& voxel : volume.voxels)
  {
    low = voxel < low ? voxel : low;
    high = voxel > high ? voxel : high;
    special = special || !std::isfinite(static_cast<double>(voxel));
    infinite = infinite || std::isinf(static_cast<double>(voxel));
  }
  splatting::VolumeIndex index = indexOf(volume);
  if (!hasRoom)
  {
    index.setBudget(1);
  }
  const splatting::VolumeIndex::Range& range = index.range();
  check(range.low == static_cast<double>(low) && range.high == static_cast<double>(high) &&
      range.nonFinite == special,
    "range ", range.low, " to ", range.high, ", not ", +low, " to ", +high, ", special ",
    range.nonFinite, ", not ", special);
  check(range.hasInfinities() == infinite, "infinities: ", range.hasInfinities());
  check(index.hasBricks() == (hasRoom && !infinite), "bricks though infinite ", infinite,
    ", room for them ", hasRoom, ", or none without a reason");
}

template <class T>
void testType(Checks& check)
{
  // Several registers, less than one, and one row.
  const std::array<int, 3> sizes[] = { { 149, 5, 6 }, { 3, 9, 5 }, { 64, 8, 4 }, { 7, 1, 2 },
    { 1, 1, 1 } };
  reference::forScenes(seriesOf<T>("shapes"), 5,
    [&](int n, reference::Random& random)
    { testMaxima(check, reference::uniformNoise<T>(sizes[n], random)); });
  reference::forScenes(seriesOf<T>("any shape"), 20,
    [&](int, reference::Random& random)
    {
      const std::array<int, 3> size = randomSize(random, 40);
      reference::Volume<T> volume = reference::uniformNoise<T>(size, random);
      testMaxima(check, volume);
      if constexpr (!std::numeric_limits<T>::is_integer)
      {
        const double share = random.uniform(0.0, 1.0);
        reference::Random many = random.fork();
        for (T& voxel : volume.voxels)
        {
          voxel = many.chance(share) ? std::numeric_limits<T>::quiet_NaN() : voxel;
        }
        testMaxima(check, volume);
      }
      const bool hasRoom = random.uniform(0, 3) > 0;
      testRange(check, volumeWithOddValues<T>(size, random), hasRoom);
    });
  if constexpr (!std::numeric_limits<T>::is_integer)
  {
    // One thread of several finds it.
    reference::forScenes(seriesOf<T>("a single NaN"), 20,
      [&](int, reference::Random& random)
      {
        reference::Volume<T> volume({ 256, 96, 96 });
        volume.at(random.uniform(0, 255), random.uniform(0, 95), random.uniform(0, 95)) =
          std::numeric_limits<T>::quiet_NaN();
        testRange(check, volume, true);
      });
  }
}
}

int TestBricks(int, char*[])
{
  Checks check;
  forEachType([&](auto* null) { testType<std::remove_pointer_t<decltype(null)>>(check); });
  return check.exitCode();
}
