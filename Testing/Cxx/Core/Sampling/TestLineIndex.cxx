// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projections along chains of voxels have the same bits as dense ones: every scalar type, mode,
// order. Delta encoding stays within its bound.
#include "AverageTesting.h"
#include "LineTesting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>

using namespace linetesting;
using splatting::Quality;

namespace
{
splatting::ProjectionSettings settingsOf(Quality quality, Acceleration acceleration)
{
  splatting::ProjectionSettings settings;
  settings.quality = quality;
  settings.acceleration = acceleration;
  return settings;
}

bool sameImage(const splatting::ShearImage& a, const splatting::ShearImage& b)
{
  return a.type == b.type && a.width == b.width && a.height == b.height && a.bytes == b.bytes;
}

/// All modes and orders against the dense walk, whatever the other settings are.
template <class T>
void compareWithDense(Checks& check, const reference::Volume<T>& volume,
  const splatting::ShearWarp& geometry, splatting::ProjectionSettings settings,
  const std::vector<glm::dvec4>& halfSpaces, const char* what)
{
  for (Quality quality : { Quality::Preview, Quality::Standard, Quality::High })
  {
    settings.quality = quality;
    settings.acceleration = Acceleration::Dense;
    const auto expected = project(volume, geometry, settings, cutsBy(geometry, halfSpaces));
    for (Acceleration acceleration : lineAccelerations)
    {
      settings.acceleration = acceleration;
      check(sameImage(project(volume, geometry, settings, cutsBy(geometry, halfSpaces)), expected),
        what, ": type ", int(splatting::scalarTypeOf<T>()), ", mode ", int(quality),
        ", acceleration ", int(acceleration), " differs from dense; axis ",
        geometry.principalAxis(), ", shear ", geometry.shear().x, " ", geometry.shear().y,
        ", size ", volume.size[0], " ", volume.size[1], " ", volume.size[2]);
    }
  }
}

template <class T>
void testExact(Checks& check)
{
  const splatting::Kernel kernels[] = { {}, { splatting::Reconstruction::CosineBell, 0.5 },
    { splatting::Reconstruction::CosineBell, 1.5 } };
  reference::forScenes(seriesOf<T>("any volume"), 60,
    [&](int, reference::Random& random)
    {
      const auto volume = anyVolume<T>(random);
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      splatting::ProjectionSettings settings;
      settings.kernel = kernels[random.uniform(0, 2)];
      settings.footprintSampling = std::max(random.uniform(-2, 2), 0);
      settings.instructionSet = anyInstructionSet(random);
      std::vector<glm::dvec4> halfSpaces;
      if (random.oneIn(3))
      {
        halfSpaces = anyHalfSpaces(volume.size, random);
      }
      compareWithDense(check, volume, geometry, settings, halfSpaces, "any volume");
    });
}

/// Volumes of several bands, pieces and chains longer than 256 voxels.
void testLargeVolumes(Checks& check)
{
  const std::array<int, 3> sizes[] = { { 300, 60, 20 }, { 20, 600, 30 }, { 30, 40, 550 } };
  reference::forScenes("large volumes", 12,
    [&](int n, reference::Random& random)
    {
      const auto volume = boxes<std::uint8_t>(sizes[n % 3], 5, random);
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      splatting::ProjectionSettings settings;
      compareWithDense(check, volume, geometry, settings, {}, "large volume");
    });
  // More voxels in a row than sorted chains can tell apart.
  reference::forScenes("long rows", 1,
    [&](int, reference::Random& random)
    {
      const auto row = boxes<std::int16_t>({ LineIndex::MostSorted + 3, 2, 1 }, 3, random);
      const splatting::ShearWarp geometry(viewWithShear(row.size, 2, 0.5, -0.25));
      compareWithDense(check, row, geometry, {}, {}, "long row");
    });
}

/// One voxel, one value, the type's lowest value.
template <class T>
void testFlat(Checks& check)
{
  const std::array<int, 3> sizes[] = { { 1, 1, 1 }, { 40, 3, 5 }, { 1, 7, 50 } };
  const int shares[] = { 0, 77, 255 };
  reference::forScenes(seriesOf<T>("flat volumes"), 9,
    [&](int n, reference::Random& random)
    {
      const int share = shares[n / 3];
      const reference::Volume<T> volume(sizes[n % 3], level<T>(share));
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      splatting::ProjectionSettings settings;
      compareWithDense(check, volume, geometry, settings, {}, "flat volume");
      settings.lineTolerance = 100.0;
      compareWithDense(check, volume, geometry, settings, {}, "flat volume with tolerance");
    });
}

/// Volumes with NaN and infinities are projected densely.
template <class T>
void testOddValues(Checks& check)
{
  reference::forScenes(seriesOf<T>("odd values"), 20,
    [&](int, reference::Random& random)
    {
      auto volume = boxes<T>(randomSize(random, 8), 4, random);
      reference::Random many = random.fork();
      for (T& voxel : volume.voxels)
      {
        const T odd[] = { std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
          -std::numeric_limits<T>::infinity() };
        voxel = many.chance(0.4) ? odd[many.uniform(0, 2)] : voxel;
      }
      volume.voxels[0] = std::numeric_limits<T>::quiet_NaN();
      splatting::ProjectionSettings settings;
      settings.lineTolerance = 20.0;
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      compareWithDense(check, volume, geometry, settings, {}, "odd values");
    });
}

/// Scenes where a tolerance saves memory, and where it changes pixels.
struct Savings
{
  Sightings bytes, pixels;
};

/// Compares chains that have a tolerance with exact ones. Returns whether those of all orders
/// together take a tenth less memory.
template <class T>
bool savesMemory(Checks& check, const reference::Volume<T>& volume)
{
  std::size_t exactBytes = 0, roughBytes = 0;
  for (LineOrder order : orders)
  {
    const auto exact = makeLines(volume, { order, 0.0 });
    const auto rough = makeLines(volume, { order, 60.0 });
    // Chains within a tolerance join exact ones, so there are no more of them. Sorted orders also
    // hold each value that chains have: those half-way may be more than the exact ones.
    check(rough.chainCount() <= exact.chainCount(), "a tolerance makes ", rough.chainCount(),
      " chains of ", exact.chainCount());
    check(order != LineOrder::Lines || rough.memorySize() <= exact.memorySize(),
      "a tolerance costs memory");
    exactBytes += exact.memorySize();
    roughBytes += rough.memorySize();
  }
  return roughBytes < exactBytes * 9 / 10;
}

/// Pictures with delta encoding: within dv of the exact pixel; pixels at the top stay.
template <class T>
void testTolerance(Checks& check, Savings& savings)
{
  reference::forScenes(seriesOf<T>("tolerances"), 25,
    [&](int, reference::Random& random)
    {
      int deviations = 0;
      const std::array<int, 3> size = anyLongSize(random);
      const auto volume =
        random.oneIn(2) ? reference::uniformNoise<T>(size, random) : boxes<T>(size, 200, random);
      const T low = *std::min_element(volume.voxels.begin(), volume.voxels.end());
      const T high = *std::max_element(volume.voxels.begin(), volume.voxels.end());
      const splatting::ShearWarp geometry(anyView(size, random));
      const double levels[] = { 1.0, 5.0, 10.0, 60.0, 255.0 };
      const double tolerance = levels[random.uniform(0, 4)];
      for (Quality quality : { Quality::Preview, Quality::Standard, Quality::High })
      {
        splatting::dispatch(quality == Quality::Preview
            ? splatting::scalarTypeOf<T>()
            : splatting::scalarTypeOf<splatting::Accumulator<T>>(),
          [&](auto* null)
          {
            using P = std::remove_pointer_t<decltype(null)>;
            const auto exact =
              toReference<P>(project(volume, geometry, settingsOf(quality, Acceleration::Dense)));
            splatting::ProjectionSettings settings =
              settingsOf(quality, lineAccelerations[random.uniform(0, 2)]);
            settings.lineTolerance = tolerance;
            const auto found = toReference<P>(project(volume, geometry, settings));
            check(exact.hit == found.hit, "a tolerance changes what is covered");
            // Rounded sums may be wrong in both pictures.
            const double rounding = quality == Quality::Preview
              ? 0.0
              : 2.0 * errorBound<T>(quality, double(low), double(high));
            for (std::size_t p = 0; p < exact.value.size(); ++p)
            {
              const long double x = exact.value[p], top = high;
              const long double difference = std::abs(x - static_cast<long double>(found.value[p]));
              check(!exact.hit[p] || difference <= tolerance * (top - x) / 255 + rounding, "type ",
                int(splatting::scalarTypeOf<T>()), ", mode ", int(quality), ": ", double(x),
                " becomes ", double(found.value[p]), " with tolerance ", tolerance);
              deviations += difference > rounding;
            }
          });
      }
      savings.bytes.add(savesMemory(check, volume));
      savings.pixels.add(deviations > 0);
    });
}

/// Other voxels, other encodings; what is held is counted and given back.
void testRenewal(Checks& check)
{
  reference::forScenes("renewal", 6,
    [&](int, reference::Random& random)
    {
      splatting::VolumeIndex index;
      splatting::Projector projector;
      for (int n = 0; n < 2; ++n)
      {
        const auto volume = boxes<std::int16_t>({ 45, 12, 9 }, 90, random);
        index.reset({ volume.voxels.data(), splatting::ScalarType::Int16, toGlm(volume.size) });
        check(index.memorySize() == 0, "a reset index holds memory");
        const splatting::ShearWarp geometry(anyView(volume.size, random));
        for (int turn = 0; turn < 12; ++turn)
        {
          const auto quality = static_cast<Quality>(random.uniform(0, 2));
          splatting::ProjectionSettings settings =
            settingsOf(quality, lineAccelerations[random.uniform(0, 2)]);
          settings.lineTolerance = random.oneIn(2) ? 50.0 : 0.0;
          splatting::ShearImage image;
          projector.project(index, geometry, settings, {}, image);
          check(sameImage(image, project(volume, geometry, settings)), "an index is out of date");
        }
        const std::size_t held = index.memorySize();
        for (LineOrder order : orders)
        {
          const LineIndex& lines = *index.lines(geometry.principalAxis(), { order, 0.0 });
          check(lines.memorySize() > 0 && index.memorySize() >= lines.memorySize(),
            "chains are not counted");
          check(&lines == index.lines(geometry.principalAxis(), { order, 0.0 }) &&
              lines.holds({ order, 0.0 }),
            "chains are not kept");
        }
        check(held > 0, "no memory is held");
      }
    });
}

/// The reported progress of making chains ends at 1.
void testProgress(Checks& check)
{
  reference::forScenes("progress", 1,
    [&](int, reference::Random& random)
    {
      const auto volume = boxes<std::uint8_t>({ 5, 6, 100 }, 3, random);
      splatting::VolumeIndex index;
      index.reset({ volume.voxels.data(), splatting::ScalarType::UInt8, toGlm(volume.size) });
      double done = 0.0;
      const std::thread::id thread = std::this_thread::get_id();
      index.lines(2, {},
        [&](double now)
        {
          check(now > done && thread == std::this_thread::get_id(), "progress goes astray");
          done = now;
          return true;
        });
      check(done == 1.0, "progress ends at ", done);
    });
}
}

int TestLineIndex(int, char*[])
{
  Checks check;
  Savings savings;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testExact<T>(check);
      testFlat<T>(check);
      testTolerance<T>(check, savings);
    });
  check(savings.bytes.areEnough(0.2), "a tolerance saves memory in only ", savings.bytes);
  check(savings.pixels.areEnough(0.2), "a tolerance changes pixels in only ", savings.pixels);
  testLargeVolumes(check);
  testOddValues<float>(check);
  testOddValues<double>(check);
  testRenewal(check);
  testProgress(check);
  return check.exitCode();
}
