// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cropping leaves the samples of the regions that are shown: each of the 27 regions by itself, the
// sets that VTK has names for and random ones, in all modes and with all accelerations; and planes
// at any angle besides.
#include "AverageTesting.h"
#include "CoreTesting.h"
#include "Reductions.h"

#include "Clipping/Cuts.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <utility>

using namespace coretesting;
using splatting::Acceleration;
using splatting::Quality;

namespace
{
/// The maximum over the samples that count.
template <class S>
reference::Image<S> expectedOf(const reference::RaySamples<S>& rays,
  const reference::ShearGrid& grid, const reference::ShearView& view,
  const reference::RayCuts& cuts)
{
  const reference::RayCutter cutter(grid, view, cuts);
  reference::Image<S> image(grid.width, grid.height);
  for (int v = 0; v < grid.height; ++v)
  {
    for (int u = 0; u < grid.width; ++u)
    {
      const auto ray = reference::cutRay(rays[image.index(u, v)], cutter, u, v, false);
      const auto maximum = reference::largest(ray)[0];
      if (maximum.hit)
      {
        image.raise(u, v, maximum.value);
      }
    }
  }
  return image;
}

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
      const reference::ShearView view = referenceView(scene.geometry);
      const auto grid = reference::makeShearGrid(volume.size, view);
      const auto rays = reference::voxelSamples(volume, view);
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
        const auto expected = expectedOf(rays, grid, view, scene.cuts);
        check.same(expected, toReference<T>(projected(volume, scene)), 0.0, "type ",
          int(splatting::scalarTypeOf<T>()), ", flags ", std::hex, flags, std::dec,
          ", acceleration ", int(scene.settings.acceleration), ", ", scene.cuts.halfSpaces.size(),
          " half-spaces: other samples; axis ", view.axis, ", shear ", view.shear[0], " ",
          view.shear[1], ", size ", volume.size[0], " ", volume.size[1], " ", volume.size[2]);
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
      const bool isStandard = random.uniform(0, 1);
      const auto bounds = std::minmax_element(volume.voxels.begin(), volume.voxels.end());
      const double low = double(*bounds.first), high = double(*bounds.second);
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(volume.size, random));
      scene.settings.quality = isStandard ? Quality::Standard : Quality::High;
      const reference::ShearView view = referenceView(scene.geometry);
      const auto grid = reference::makeShearGrid(volume.size, view);
      const auto rays = reference::slabSamples(reference::toDouble(volume), view,
        { isStandard ? reference::Kernel::Nearest : reference::Kernel::Trilinear, 1.0 });
      // The reference itself is good to some rounding errors of double.
      const double bound = errorBound<T>(scene.settings.quality, low, high) +
        2e-13 * std::max(std::abs(low), std::abs(high)) + 1e-300;
      for (unsigned flags : allFlags(random))
      {
        scene.cuts = {};
        scene.cuts = rayCutsOf({}, anyCropping(volume.size, random));
        scene.cuts.regions = flags;
        scene.settings.acceleration = Acceleration::Dense;
        const auto expected = expectedOf(rays, grid, view, scene.cuts);
        const auto dense = toReference<A>(projected(volume, scene));
        bool within = dense.hit == expected.hit;
        for (std::size_t p = 0; within && p < dense.value.size(); ++p)
        {
          within = !dense.hit[p] || std::abs(double(dense.value[p]) - expected.value[p]) <= bound;
        }
        check(within, "type ", int(splatting::scalarTypeOf<T>()), ", mode ",
          int(scene.settings.quality), ", flags ", std::hex, flags, std::dec,
          ": other averages; axis ", view.axis, ", shear ", view.shear[0], " ", view.shear[1],
          ", size ", volume.size[0], " ", volume.size[1], " ", volume.size[2]);
        scene.settings.acceleration = anyAcceleration(random);
        check.same(dense, toReference<A>(projected(volume, scene)), 0.0, "mode ",
          int(scene.settings.quality), ", acceleration ", int(scene.settings.acceleration),
          " changes the picture");
      }
    });
}

/// Tiles of bricks and several bands, with all accelerations in all modes.
void testLarge(Checks& check)
{
  reference::forScenes("large volumes", 40,
    [&](int n, reference::Random& random)
    {
      const auto volume = spots<std::int16_t>(random, { 70, 58, 45 });
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(volume.size, random));
      scene.settings.quality = static_cast<Quality>(n % 3);
      scene.cuts = rayCutsOf({}, anyCropping(volume.size, random));
      scene.cuts.regions = anyRegions(random);
      if (random.oneIn(3))
      {
        // A slab, which may be thinner than a slice.
        const double normal[] = { random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 1.0 };
        const double offset = normal[0] * 35.0 + normal[1] * 29.0 + normal[2] * 22.0;
        scene.cuts.halfSpaces = { { normal[0], normal[1], normal[2], -offset },
          { -normal[0], -normal[1], -normal[2], offset + random.uniform(0.1, 20.0) } };
      }
      scene.settings.acceleration = Acceleration::Dense;
      const splatting::ShearImage dense = projected(volume, scene);
      if (n % 3 == 0)
      {
        const reference::ShearView view = referenceView(scene.geometry);
        const auto grid = reference::makeShearGrid(volume.size, view);
        check.same(toReference<std::int16_t>(dense),
          expectedOf(reference::voxelSamples(volume, view), grid, view, scene.cuts), 0.0,
          "large volume: other samples");
      }
      for (int acceleration = 0; acceleration < 6; ++acceleration)
      {
        scene.settings.acceleration = static_cast<Acceleration>(acceleration);
        const splatting::ShearImage image = projected(volume, scene);
        const bool same = n % 3 == 0
          ? sameBits(toReference<std::int16_t>(dense), toReference<std::int16_t>(image))
          : sameBits(toReference<float>(dense), toReference<float>(image));
        check(same, "large volume: acceleration ", acceleration, " changes the picture");
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
      const reference::ShearView view = referenceView(scene.geometry);
      const auto grid = reference::makeShearGrid(size, view);
      const auto rays = reference::voxelSamples(volume, view);
      for (int m = 0; m < 6; ++m)
      {
        scene.cuts = anyCuts(size, random);
        const auto expected = expectedOf(rays, grid, view, scene.cuts);
        for (int way = 0; way < 12; ++way)
        {
          scene.settings.acceleration = way % 3 == 1 ? Acceleration::Bricks : Acceleration::Dense;
          scene.settings.recordLocations = way % 3 == 2;
          scene.settings.instructionSet = instructionSets[way / 3];
          check.same(expected, toReference<T>(projected(volume, scene)), 0.0, "long rows, type ",
            int(splatting::scalarTypeOf<T>()), ", cuts ", m, ", way ", way,
            ": other samples; axis ", view.axis, ", shear ", view.shear[0], " ", view.shear[1],
            ", size ", size[0], " ", size[1], " ", size[2]);
        }
      }
    });
}

/// Likewise averages in standard mode, which weighs rows of voxels without a copy where all of a
/// footprint lies in the volume.
template <class T>
void testLongAverages(Checks& check)
{
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>("long averages"), 6,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int a = 0; a < 3; ++a)
      {
        size[a] = a == n % 3 ? random.uniform(60, 150) : random.uniform(4, 12);
      }
      const auto volume = reference::uniformNoise<T>(size, random);
      const auto bounds = std::minmax_element(volume.voxels.begin(), volume.voxels.end());
      const double low = double(*bounds.first), high = double(*bounds.second);
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(size, random));
      scene.settings.quality = Quality::Standard;
      const reference::ShearView view = referenceView(scene.geometry);
      const auto grid = reference::makeShearGrid(size, view);
      const auto rays = reference::slabSamples(
        reference::toDouble(volume), view, { reference::Kernel::Nearest, 1.0 });
      const double bound = errorBound<T>(Quality::Standard, low, high) +
        2e-13 * std::max(std::abs(low), std::abs(high)) + 1e-300;
      for (int m = 0; m < 3; ++m)
      {
        scene.cuts = m == 0 ? reference::RayCuts{} : anyCuts(size, random);
        const auto expected = expectedOf(rays, grid, view, scene.cuts);
        reference::Image<A> first;
        for (int way = 0; way < 16; ++way)
        {
          scene.settings.acceleration = way % 2 ? Acceleration::Bricks : Acceleration::Dense;
          scene.settings.recordLocations = way / 2 % 2;
          scene.settings.instructionSet = instructionSets[way / 4];
          const auto image = toReference<A>(projected(volume, scene));
          bool within = image.hit == expected.hit;
          for (std::size_t p = 0; within && p < image.value.size(); ++p)
          {
            within = !image.hit[p] || std::abs(double(image.value[p]) - expected.value[p]) <= bound;
          }
          first = way == 0 ? image : first;
          check(within && sameBits(first, image), "long averages, type ",
            int(splatting::scalarTypeOf<T>()), ", cuts ", m, ", way ", way,
            within ? ": other bits" : ": other averages", "; axis ", view.axis, ", shear ",
            view.shear[0], " ", view.shear[1], ", size ", size[0], " ", size[1], " ", size[2]);
        }
      }
    });
}

/// The region of a place along an axis; -1 if rounding decides. Of slices only the place matters:
/// where the middle region has none it has the one that is nearest to its middle.
int regionOf(std::array<double, 2> planes, double place, bool isSlice)
{
  const double doubt = 1e-6;
  if (isSlice && planes[0] <= planes[1] && std::ceil(planes[0]) > std::floor(planes[1]))
  {
    planes[0] = planes[1] = std::floor(0.5 * (planes[0] + planes[1]) + 0.5);
  }
  else if (!isSlice && std::min(std::abs(place - planes[0]), std::abs(place - planes[1])) < doubt)
  {
    return -1;
  }
  return place < planes[0] ? 0 : place <= planes[1] ? 1 : 2;
}

/// Which samples of perspective images count, in index space.
void testPerspective(Checks& check)
{
  Sightings mixed, sure;
  reference::forScenes("regions in perspective", 300,
    [&](int, reference::Random& random)
    {
      int samples = 0, doubtful = 0, shown = 0;
      std::vector<splatting::ShearWarp> images;
      const std::array<int, 3> size = randomSize(random, 17);
      splatting::ShearWarp::factorise(randomPerspective(size, random), images);
      const splatting::Cropping cropping = anyCropping(size, random);
      const reference::RayCuts cuts = rayCutsOf({}, cropping);
      for (const splatting::ShearWarp& image : images)
      {
        for (int k = 0; k < image.size().z; ++k)
        {
          const splatting::SliceRegions regions = splatting::regionsOf(cropping, image, k);
          const bool exists = k >= image.slices().begin && k < image.slices().end;
          for (int pixel = 0; pixel < image.width() * image.height(); ++pixel)
          {
            const int u = pixel % image.width(), v = pixel / image.width();
            const glm::dvec2 place = image.onRay(u, v, k);
            const double point[3] = { place.x, place.y, double(k) };
            int number = 0;
            bool isDoubtful = false;
            for (int a = 0; a < 3; ++a)
            {
              const int axis = image.axes()[a];
              const int region = regionOf(cuts.planes[axis], point[a], a == 2);
              isDoubtful |= region < 0;
              number += region * (axis == 0 ? 1 : axis == 1 ? 3 : 9);
            }
            const int i = u < regions.u[0] ? 0 : u < regions.u[1] ? 1 : 2;
            const bool counts = regions.regionsOfRow(v) >> i & 1u;
            ++samples;
            doubtful += exists && isDoubtful;
            shown += counts;
            check(exists ? isDoubtful || counts == (cropping.flags >> number & 1u) : !counts,
              "slice ", k, ", pixel ", u, ", ", v, ": another region than ", number);
          }
        }
      }
      mixed.add(shown > samples / 10 && shown < samples * 9 / 10);
      sure.add(100 * doubtful <= samples);
    });
  std::cout << "perspective: some samples are shown and some are not in " << mixed
            << ", few are left out in " << sure << std::endl;
  check(mixed.areEnough(0.2) && sure.areEnough(0.6), "some samples are shown and some are not in ",
    mixed, ", few are left out in only ", sure);
}

/// Shown regions are a union: the maximum of all is the largest of the regions' maxima.
void testUnion(Checks& check)
{
  reference::forScenes("unions", 6,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<std::uint8_t>(randomSize(random, 12), random);
      const auto quality = static_cast<Quality>(random.uniform(0, 2));
      Case scene;
      scene.geometry = splatting::ShearWarp(anyView(volume.size, random));
      scene.settings.quality = quality;
      scene.cuts = rayCutsOf({}, anyCropping(volume.size, random));
      const auto imageOf = [&](unsigned flags)
      {
        scene.cuts.regions = flags;
        const splatting::ShearImage image = projected(volume, scene);
        return quality == Quality::Preview ? reference::toDouble(toReference<std::uint8_t>(image))
                                           : reference::toDouble(toReference<float>(image));
      };
      const auto whole = imageOf((1u << 27) - 1);
      reference::Image<double> together(whole.width, whole.height);
      for (int region = 0; region < 27; ++region)
      {
        const auto part = imageOf(1u << region);
        for (int v = 0; v < part.height; ++v)
        {
          for (int u = 0; u < part.width; ++u)
          {
            if (part.isHit(u, v))
            {
              together.raise(u, v, part.at(u, v));
            }
          }
        }
      }
      check.same(whole, together, 0.0, "regions together are not the whole, mode ", int(quality));
    });
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
  testLarge(check);
  testUnion(check);
  testPerspective(check);
  return check.exitCode();
}
