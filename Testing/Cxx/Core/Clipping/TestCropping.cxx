// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cropping leaves the samples of the regions that are shown: each of the 27 regions by itself, the
// sets that VTK has names for and random ones, in all modes and with all accelerations; and planes
// at any angle besides.
#include "AverageTesting.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

using namespace coretesting;
using splatting::Acceleration;
using splatting::Quality;

namespace
{
/// Every region by itself, the named sets, and some that nobody has named.
std::vector<unsigned> allFlags(reference::Random& random)
{
  std::vector<unsigned> flags(std::begin(namedRegions), std::end(namedRegions));
  for (int region = 0; region < 27; ++region)
  {
    flags.push_back(1u << region);
  }
  for (int n = 0; n < 8; ++n)
  {
    flags.push_back(static_cast<unsigned>(random.bits()) & ((1u << 27) - 1));
  }
  flags.push_back(0);
  flags.push_back((1u << 27) - 1);
  return flags;
}

/// A few spots on a flat ground, so that bricks and chains have something to leave out.
template <class T>
reference::Volume<T> spots(reference::Random& random, const std::array<int, 3>& size)
{
  reference::Volume<T> volume = reference::uniformNoise<T>(size, random);
  if (random.oneIn(2))
  {
    reference::Random many = random.fork();
    for (T& voxel : volume.voxels)
    {
      voxel = !many.oneIn(31) ? T(0) : voxel;
    }
  }
  return volume;
}

template <class T>
void testPreview(Checks& check)
{
  reference::forScenes(seriesOf<T>("previews"), 16,
    [&](int, reference::Random& random)
    {
      const auto volume = spots<T>(random, randomSize(random, 14));
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(volume.size, random));
      scene.settings.quality = Quality::Preview;
      const reference::ImageRays rays = referenceRays(scene.geometry);
      const auto samples = reference::voxelSamples(volume, rays);
      for (unsigned flags : allFlags(random))
      {
        scene.cuts = {};
        scene.cuts = rayCutsOf({}, anyCropping(volume.size, random));
        scene.cuts.regions = flags;
        if (random.oneIn(4)) // no place is between exchanged planes
        {
          std::array<double, 2>& planes = scene.cuts.planes[random.uniform(0, 2)];
          std::swap(planes[0], planes[1]);
        }
        if (random.oneIn(5))
        {
          scene.cuts.halfSpaces = { { 0.3, -0.2, 1.0,
            -random.uniform(0.0, double(volume.size[2])) } };
        }
        scene.settings.acceleration = anyAcceleration(random);
        scene.settings.instructionSet = anyInstructionSet(random);
        check.same(reference::maximumOf(samples, rays, scene.cuts),
          toReference<T>(projected(volume, scene)), 0.0, "type ", int(splatting::scalarTypeOf<T>()),
          ", flags ", std::hex, flags, std::dec, ", acceleration ",
          int(scene.settings.acceleration), ", ", scene.cuts.halfSpaces.size(),
          " half-spaces: other samples; axis ", scene.geometry.principalAxis());
      }
    });
}

template <class T>
void testAverages(Checks& check)
{
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>("averages"), 6,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>(randomSize(random, 6), random);
      const Mode mode = modeOf(random.oneIn(2) ? Quality::Standard : Quality::High);
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(volume.size, random));
      scene.settings = settingsOf(mode);
      const reference::ImageRays rays = referenceRays(scene.geometry);
      const auto samples =
        reference::slabSamples(reference::toDouble(volume), rays, mode.reference);
      for (unsigned flags : allFlags(random))
      {
        scene.cuts = {};
        scene.cuts = rayCutsOf({}, anyCropping(volume.size, random));
        scene.cuts.regions = flags;
        scene.settings.acceleration = Acceleration::Dense;
        const auto dense = toReference<A>(projected(volume, scene));
        check.same(reference::maximumOf(samples, rays, scene.cuts), reference::toDouble(dense),
          averageBound(volume, scene.geometry, mode), "type ", int(splatting::scalarTypeOf<T>()),
          ", mode ", int(mode.quality), ", flags ", std::hex, flags, std::dec,
          ": other averages; axis ", scene.geometry.principalAxis());
        scene.settings.acceleration = anyAcceleration(random);
        check.same(dense, toReference<A>(projected(volume, scene)), 0.0, "mode ", int(mode.quality),
          ", acceleration ", int(scene.settings.acceleration), " changes the picture");
      }
    });
}

/// Rows that fill registers, whose slices count for runs of pixels: loops that are each instruction
/// set's own. Some rows are so long that slices along the second axis are read one after the other.
template <class T>
void testLongRows(Checks& check)
{
  reference::forScenes(seriesOf<T>("long rows"), 18,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int a = 0; a < 3; ++a)
      {
        size[a] = a == n % 3 ? random.uniform(64, 200) : random.uniform(6, 40);
      }
      const bool areOneByOne = n % 6 == 0;
      if (areOneByOne)
      {
        size[0] = 1024 / static_cast<int>(sizeof(T)) + random.uniform(0, 40);
      }
      const auto volume = spots<T>(random, size);
      Case scene;
      splatting::View sheared = anyView(size, random);
      if (areOneByOne)
      {
        const double shearX = random.uniform(-1.0, 1.0), shearY = random.uniform(-1.0, 1.0);
        sheared = viewWithShear(size, 1, shearX, shearY);
      }
      scene.geometry = splatting::ShearWarp(sheared);
      scene.settings.quality = Quality::Preview;
      const reference::ImageRays rays = referenceRays(scene.geometry);
      const auto samples = reference::voxelSamples(volume, rays);
      for (int m = 0; m < 6; ++m)
      {
        scene.cuts = m == 0 ? reference::RayCuts{} : anyCuts(size, random);
        const auto expected = reference::maximumOf(samples, rays, scene.cuts);
        for (int way = 0; way < 12; ++way)
        {
          scene.settings.acceleration = way % 3 == 1 ? Acceleration::Bricks : Acceleration::Dense;
          scene.settings.recordLocations = way % 3 == 2;
          scene.settings.instructionSet = instructionSets[way / 3];
          check.same(expected, toReference<T>(projected(volume, scene)), 0.0, "long rows, type ",
            int(splatting::scalarTypeOf<T>()), ", cuts ", m, ", way ", way,
            ": other samples; axis ", scene.geometry.principalAxis());
        }
        scene.settings.recordLocations = false;
        scene.settings.acceleration = anyAcceleration(random);
        check.same(expected, toReference<T>(projected(volume, scene)), 0.0, "long rows, type ",
          int(splatting::scalarTypeOf<T>()), ", cuts ", m, ", acceleration ",
          int(scene.settings.acceleration), ": other samples");
      }
    });
}

/// The same for averages. If a footprint lies in the volume, standard mode weights rows of voxels
/// without copying them.
template <class T>
void testLongAverages(Checks& check)
{
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>("long averages"), 8,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int a = 0; a < 3; ++a)
      {
        size[a] = a == n % 3 ? random.uniform(60, 150) : random.uniform(3, 10);
      }
      const auto volume = reference::uniformNoise<T>(size, random);
      const Mode mode = modeOf(n % 4 == 1 ? Quality::High : Quality::Standard);
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(size, random));
      scene.settings = settingsOf(mode);
      const reference::ImageRays rays = referenceRays(scene.geometry);
      const auto samples =
        reference::slabSamples(reference::toDouble(volume), rays, mode.reference);
      for (int m = 0; m < 3; ++m)
      {
        scene.cuts = m == 0 ? reference::RayCuts{} : anyCuts(size, random);
        const auto expected = reference::maximumOf(samples, rays, scene.cuts);
        reference::Image<A> first;
        for (int way = 0; way < 16; ++way)
        {
          scene.settings.acceleration = way % 2 ? Acceleration::Bricks : Acceleration::Dense;
          scene.settings.recordLocations = way / 2 % 2;
          scene.settings.instructionSet = instructionSets[way / 4];
          const auto image = toReference<A>(projected(volume, scene));
          first = way == 0 ? image : first;
          const std::string where = "long averages, type " +
            std::to_string(int(splatting::scalarTypeOf<T>())) + ", mode " +
            std::to_string(int(mode.quality)) + ", cuts " + std::to_string(m) + ", way " +
            std::to_string(way);
          check.same(expected, reference::toDouble(image),
            averageBound(volume, scene.geometry, mode), where, ": other averages");
          check.same(first, image, 0.0, where, ": other bits");
        }
      }
    });
}

/// Slices behind the eye are in no region.
void testBehindTheEye(Checks& check)
{
  Sightings behind;
  reference::forScenes("slices behind the eye", 60,
    [&](int, reference::Random& random)
    {
      const std::array<int, 3> size = randomSize(random, 17);
      const splatting::ShearWarp image = randomPerspectiveImage(size, random);
      const reference::ImageRays rays = referenceRays(image);
      int slices = 0;
      for (int k = 0; k < image.size().z; ++k)
      {
        const auto rows = splatting::regionsOf({}, image, k).rows;
        slices += !rays.sees(k);
        check(rays.sees(k) || std::all_of(rows.begin(), rows.end(), [](auto r) { return r == 0; }),
          "slice ", k, " has a region");
      }
      behind.add(slices > 0);
    });
  check(behind.areEnough(0.02), "slices are behind the eye in only ", behind);
}
}

int TestCropping(int, char*[])
{
  Checks check;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testPreview<T>(check);
      testAverages<T>(check);
      testLongRows<T>(check);
      testLongAverages<T>(check);
    });
  testBehindTheEye(check);
  return check.exitCode();
}
