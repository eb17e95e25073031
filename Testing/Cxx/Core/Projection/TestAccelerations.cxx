// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whatever is left out, and in whatever order the rest is met, the picture is that of the plain
// walk bit for bit: every scalar type, mode, instruction set, memory budget and floor, over random
// views.
#include "CoreTesting.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace coretesting;
using splatting::Acceleration;
using splatting::Quality;

namespace
{
/// Noise on a flat background, with a few voxels that stand out wherever they like: at rims, too.
template <class T>
reference::Volume<T> spottedVolume(reference::Random& random)
{
  const std::array<int, 3> size = randomSize(random, 45);
  reference::Volume<T> volume = reference::uniformNoise<T>(size, random);
  const T low = *std::min_element(volume.voxels.begin(), volume.voxels.end());
  const bool flat = random.oneIn(4);
  reference::Random many = random.fork();
  for (T& voxel : volume.voxels)
  {
    if (flat || !many.oneIn(3))
    {
      voxel = low;
    }
    else if (!many.oneIn(201))
    {
      voxel = static_cast<T>(voxel / 4); // leaves room above
    }
  }
  const int spots = random.uniform(0, 12);
  for (int n = 0; n < spots; ++n)
  {
    const int x = random.uniform(0, size[0] - 1), y = random.uniform(0, size[1] - 1);
    const int z = random.oneIn(2) ? random.uniform(0, size[2] - 1) : 0;
    volume.at(x, y, z) = std::numeric_limits<T>::is_integer ? std::numeric_limits<T>::max() : T(1);
  }
  return volume;
}

Case randomCase(reference::Random& random, const std::array<int, 3>& size)
{
  Case c;
  c.settings.quality = static_cast<Quality>(random.uniform(0, 2));
  c.settings.instructionSet = anyInstructionSet(random);
  if (random.oneIn(4))
  {
    c.settings.kernel = { splatting::Reconstruction::CosineBell, random.uniform(0.5, 1.5) };
  }
  if (random.oneIn(4))
  {
    c.cuts = anyCuts(size, random);
  }
  return c;
}

/// The image, and what made it.
struct Result
{
  splatting::ShearImage image;
  Acceleration used = Acceleration::Auto;
  std::size_t memory = 0;
  double share = 0.0; ///< of tiles that bricks did not leave out
};

template <class T>
Result projected(const reference::Volume<T>& volume, const splatting::ShearWarp& geometry,
  const Case& c, Acceleration acceleration)
{
  splatting::VolumeIndex index;
  index.setBudget(c.budget);
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  splatting::ProjectionSettings settings = c.settings;
  settings.acceleration = acceleration;
  splatting::Projector projector;
  Result result;
  result.used =
    projector.project(index, geometry, settings, cutsBy(geometry, c.cuts), result.image);
  result.memory = index.memorySize();
  result.share =
    index.statistics(geometry.principalAxis(), static_cast<int>(settings.quality), false).share;
  return result;
}

Acceleration linesLike(int n)
{
  const Acceleration all[] = { Acceleration::Lines, Acceleration::SortedLines,
    Acceleration::SortedVolume };
  return all[n % 3];
}

template <class T>
void testBricks(Checks& check, Sightings& skipping)
{
  reference::forScenes(seriesOf<T>("bricks"), 120,
    [&](int n, reference::Random& random)
    {
      const reference::Volume<T> volume = spottedVolume<T>(random);
      const splatting::ShearWarp geometry = anyGeometry(volume.size, n % 3 == 0, random);
      const Case c = randomCase(random, volume.size);
      const Result dense = projected(volume, geometry, c, Acceleration::Dense);
      const Result bricks = projected(volume, geometry, c, Acceleration::Bricks);
      check(bricks.used == Acceleration::Bricks, "bricks were not used");
      check(sameImages(dense.image, bricks.image), "type ", int(splatting::scalarTypeOf<T>()),
        ", mode ", int(c.settings.quality), ": bricks change the picture");
      if (geometry.isPerspective())
      {
        const Result lines = projected(volume, geometry, c, linesLike(n / 3));
        check(lines.used == Acceleration::Bricks && sameImages(dense.image, lines.image), "type ",
          int(splatting::scalarTypeOf<T>()), ", mode ", int(c.settings.quality),
          ": lines are not bricks in perspective");
      }
      skipping.add(bricks.share < 0.5);
    });
}

/// Hides single voxels, some of all, those beyond a plane, or all.
template <class T>
void hideSome(reference::Volume<T>& volume, reference::Random& random)
{
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  const int kind = random.uniform(0, 9), last = static_cast<int>(volume.voxels.size()) - 1;
  const double share = random.uniform(0.0, 1.0);
  const int plane = random.uniform(0, volume.size[2]);
  const int single = random.uniform(0, last);
  for (int n = 0; n <= last; ++n)
  {
    const bool isHidden = kind < 3 ? n == single
      : kind < 6                   ? random.chance(share)
      : kind < 9                   ? n / (volume.size[0] * volume.size[1]) < plane
                                   : true;
    volume.voxels[n] = isHidden ? nan : volume.voxels[n];
  }
}

/// Where voxels are NaN, most of the volume is walked as if there were none, and only what reads
/// them is looked at closely. With recorded locations every sample is read.
template <class T>
void testNaN(Checks& check)
{
  reference::forScenes(seriesOf<T>("NaN"), 160,
    [&](int n, reference::Random& random)
    {
      reference::Volume<T> volume = spottedVolume<T>(random);
      hideSome(volume, random);
      const splatting::ShearWarp geometry = anyGeometry(volume.size, n % 2 == 0, random);
      Case c = randomCase(random, volume.size);
      c.settings.quality = static_cast<Quality>(random.uniform(0, 2));
      const Result dense = projected(volume, geometry, c, Acceleration::Dense);
      c.settings.instructionSet = anyInstructionSet(random);
      const Result bricks = projected(volume, geometry, c, Acceleration::Bricks);
      check(bricks.used == Acceleration::Bricks, "bricks were not used");
      check(sameImages(dense.image, bricks.image), "type ", int(splatting::scalarTypeOf<T>()),
        ", mode ", int(c.settings.quality), ": bricks change the picture of a volume with NaN");
      c.settings.recordLocations = true;
      check(sameImages(dense.image, projected(volume, geometry, c, Acceleration::Auto).image),
        "type ", int(splatting::scalarTypeOf<T>()), ", mode ", int(c.settings.quality), ", axis ",
        geometry.principalAxis(), geometry.isPerspective() ? " in perspective" : "",
        ": single samples of a volume with NaN have another maximum");
    });
}

/// A flat volume in which a few voxels at the end of a layer of bricks are bright, and those across
/// the layers' border are NaN: samples there are of the bright voxels alone.
template <class T>
reference::Volume<T> brightAtLayer(
  const std::array<int, 3>& size, int axis, reference::Random& random)
{
  reference::Volume<T> volume(size, T(0));
  const int borders = (size[axis] - 1) / splatting::BrickDepth;
  const int border = splatting::BrickDepth * random.uniform(1, borders);
  const bool isBefore = random.uniform(0, 1);
  std::array<int, 3> first, p;
  for (int& f : first)
  {
    f = random.uniform(0, 6);
  }
  const int width = random.uniform(1, 4), height = random.uniform(1, 4);
  for (int n = 0; n < width * height; ++n)
  {
    p[(axis + 1) % 3] = first[(axis + 1) % 3] + n % width;
    p[(axis + 2) % 3] = first[(axis + 2) % 3] + n / width;
    p[axis] = isBefore ? border - 1 : border;
    volume.at(p) = T(1);
    p[axis] = isBefore ? border : border - 1;
    volume.at(p) = std::numeric_limits<T>::quiet_NaN();
  }
  return volume;
}

/// What a layer of bricks can add may be all of a neighbouring layer's voxels.
template <class T>
void testNaNAtLayers(Checks& check)
{
  reference::forScenes(seriesOf<T>("NaN between layers"), 80,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size{ random.uniform(10, 30), random.uniform(10, 30),
        random.uniform(10, 30) };
      const splatting::ShearWarp geometry = anyGeometry(size, n % 2 == 0, random);
      const auto volume = brightAtLayer<T>(size, geometry.principalAxis(), random);
      Case c = randomCase(random, size);
      c.settings.quality = Quality::High;
      check(sameImages(projected(volume, geometry, c, Acceleration::Dense).image,
              projected(volume, geometry, c, Acceleration::Bricks).image),
        "type ", int(splatting::scalarTypeOf<T>()),
        ": bricks lose what counts alone beside NaN in the next layer");
    });
}

/// Steep views with narrow kernels of volumes that are flat but for some voxels at the rim: there
/// worksheets see voxels of the next slice only by repeating them, beyond the tiles that see the
/// slice itself.
void testRims(Checks& check)
{
  reference::forScenes("rims", 3000,
    [&](int, reference::Random& random)
    {
      const auto steep = [&]
      {
        const double shear = random.uniform(0.6, 1.0);
        return random.oneIn(2) ? shear : -shear;
      };
      const std::array<int, 3> size{ random.uniform(4, 20), random.uniform(4, 20),
        random.uniform(5, 12) };
      reference::Volume<std::int16_t> volume(size, 0);
      for (int spot = random.uniform(1, 3); spot > 0; --spot)
      {
        std::array<int, 3> at{ random.uniform(0, size[0] - 1), random.uniform(0, size[1] - 1),
          random.uniform(0, size[2] - 1) };
        const int rim = random.uniform(0, 1);
        at[rim] = random.oneIn(2) ? size[rim] - 1 : 0;
        volume.at(at) = 30000;
      }
      const double shearX = steep(), shearY = steep();
      const splatting::ShearWarp geometry(viewWithShear(size, 2, shearX, shearY));
      Case c;
      c.settings.kernel = { splatting::Reconstruction::CosineBell, random.uniform(0.52, 0.8) };
      check(sameImages(projected(volume, geometry, c, Acceleration::Dense).image,
              projected(volume, geometry, c, Acceleration::Bricks).image),
        "bricks change the picture at a rim");
    });
}

/// An eye inside the volume sees only some slices of its layer of bricks. The last of them reads
/// voxels of the next layer.
void testEyeInLayer(Checks& check)
{
  Sightings inside;
  reference::forScenes("the eye's layer", 1500,
    [&](int, reference::Random& random)
    {
      const std::array<int, 3> size{ random.uniform(8, 24), random.uniform(8, 24),
        random.uniform(8, 24) };
      const splatting::ShearWarp geometry = randomPerspectiveImage(size, random);
      reference::Volume<std::int16_t> volume(size, 0);
      for (int spot = random.uniform(1, 3); spot > 0; --spot)
      {
        std::array<int, 3> at{ random.uniform(0, size[0] - 1), random.uniform(0, size[1] - 1),
          random.uniform(0, size[2] - 1) };
        int& slice = at[geometry.principalAxis()];
        slice -= slice % splatting::BrickDepth; // the first of a layer
        volume.at(at) = 30000;
      }
      Case c;
      c.settings.quality = Quality::High;
      c.settings.kernel = { splatting::Reconstruction::CosineBell, random.uniform(1.0, 1.5) };
      check(sameImages(projected(volume, geometry, c, Acceleration::Dense).image,
              projected(volume, geometry, c, Acceleration::Bricks).image),
        "bricks change the picture");
      const splatting::Span& slices = geometry.slices();
      inside.add(slices.end - slices.begin < geometry.size().z);
    });
  check(inside.areEnough(0.1), "the eye is inside in only ", inside);
}

/// Without memory for a copy, slices along the first axis are transposed some at a time.
template <class T>
void testBudget(Checks& check)
{
  reference::forScenes(seriesOf<T>("budgets"), 40,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size{ random.uniform(1, 90), random.uniform(1, 20),
        random.uniform(1, 20) };
      const reference::Volume<T> volume = reference::uniformNoise<T>(size, random);
      const double shearX = random.uniform(-1.0, 1.0), shearY = random.uniform(-1.0, 1.0);
      splatting::ShearWarp geometry(viewWithShear(size, 0, shearX, shearY));
      while (n % 4 == 0 && (geometry.principalAxis() != 0 || !geometry.isPerspective()))
      {
        geometry = randomPerspectiveImage(volume.size, random);
      }
      Case c = randomCase(random, volume.size);
      const Result rich = projected(volume, geometry, c, Acceleration::Dense);
      c.budget = 0;
      const Result poor = projected(volume, geometry, c, Acceleration::Bricks);
      check(poor.memory == 0, "a budget of nothing holds ", poor.memory, " bytes");
      check(poor.used == Acceleration::Dense, "bricks without memory for them");
      check(sameImages(rich.image, poor.image), "slices some at a time change the picture");
      // Room for bricks, but not for the copy.
      c.budget = volume.voxels.size() * sizeof(T) / 2 + 4096;
      const Result middle = projected(volume, geometry, c, Acceleration::Bricks);
      check(middle.memory <= c.budget, "the budget is exceeded");
      check(sameImages(rich.image, middle.image), "bricks of some slices change the picture");
    });
}

/// The floor raises all lower pixels and no others, also with recorded locations.
template <class T>
void testFloor(Checks& check)
{
  reference::forScenes(seriesOf<T>("floors"), 30,
    [&](int n, reference::Random& random)
    {
      const reference::Volume<T> volume = spottedVolume<T>(random);
      const splatting::ShearWarp geometry = anyGeometry(volume.size, n % 3 == 0, random);
      Case c = randomCase(random, volume.size);
      const Result plain = projected(volume, geometry, c, Acceleration::Dense);
      // Most voxels are the lowest.
      T value = volume.voxels.front();
      for (int tries = 0; tries < 4; ++tries)
      {
        value = std::max(value, volume.voxels[random.uniform(0, int(volume.voxels.size()) - 1)]);
      }
      if constexpr (std::numeric_limits<T>::is_integer && sizeof(T) == 8)
      {
        // A double holds it, and it is not above all voxels, which no pixel would be.
        value = value & ~T(4095);
      }
      c.settings.floor = static_cast<double>(value);
      if (std::numeric_limits<T>::is_integer && sizeof(T) < 8 &&
        c.settings.quality == Quality::Preview && random.oneIn(2))
      {
        c.settings.floor += 0.5; // rounded down
      }
      splatting::dispatch(plain.image.type,
        [&](auto* null)
        {
          using P = std::remove_pointer_t<decltype(null)>;
          auto expected = toReference<P>(plain.image);
          for (std::size_t p = 0; p < expected.value.size(); ++p)
          {
            if (expected.hit[p])
            {
              expected.value[p] = std::max(expected.value[p], static_cast<P>(value));
            }
          }
          // With recorded locations no acceleration is used.
          for (Acceleration acceleration :
            { Acceleration::Auto, Acceleration::Bricks, linesLike(0), linesLike(1), linesLike(2) })
          {
            c.settings.recordLocations = acceleration == Acceleration::Auto;
            const Result raised = projected(volume, geometry, c, acceleration);
            check(!c.settings.recordLocations || raised.used == Acceleration::Dense,
              "an acceleration with recorded locations: ", int(raised.used));
            check.same(expected, toReference<P>(raised.image), 0.0, "type ",
              int(splatting::scalarTypeOf<T>()), ", mode ", int(c.settings.quality), ", axis ",
              geometry.principalAxis(), geometry.isPerspective() ? " in perspective" : "",
              ", acceleration ", int(acceleration), ": the floor does more or less");
          }
        });
    });
}

/// Frames of which Auto takes bricks; `share` is what was left of the tiles.
std::vector<int> framesOfBricks(
  const reference::Volume<std::uint8_t>& volume, Quality quality, int frames, double& share)
{
  const splatting::ShearWarp geometry(viewWithShear(volume.size, 2, 0.3, -0.4));
  splatting::VolumeIndex index;
  index.reset({ volume.voxels.data(), splatting::ScalarType::UInt8, toGlm(volume.size) });
  splatting::Projector projector;
  splatting::ShearImage image;
  splatting::ProjectionSettings settings;
  settings.quality = quality;
  settings.instructionSet = splatting::InstructionSet::AVX2; // AVX-512 has lower limits
  std::vector<int> result;
  for (int frame = 0; frame < frames; ++frame)
  {
    if (projector.project(index, geometry, settings, {}, image) == Acceleration::Bricks)
    {
      result.push_back(frame);
    }
  }
  share = index.statistics(2, static_cast<int>(quality), false).share;
  return result;
}

/// Auto takes bricks, learns that they do not pay in noise, and tries again later; sooner where
/// they nearly pay, and always where they do.
void testAuto(Checks& check)
{
  reference::forScenes("automatic choice", 1,
    [&](int, reference::Random& random)
    {
      const auto noise =
        reference::uniformNoise<std::uint8_t>({ 96, 96, 96 }, random.bits(), 0, 255);
      // With some rows flat, which are left out.
      for (int flat : { 0, 20, 90 })
      {
        auto volume = noise;
        for (int k = 0; k < 96; ++k)
        {
          const auto slice = volume.voxels.begin() + std::ptrdiff_t(k) * 96 * 96;
          std::fill(slice, slice + std::ptrdiff_t(flat) * 96, std::uint8_t(0));
        }
        for (Quality quality : { Quality::Preview, Quality::High })
        {
          double share = 0.0;
          const std::vector<int> frames = framesOfBricks(volume, quality, 70, share);
          check(
            std::abs(share - (96.0 - flat) / 96.0) < 0.15, flat, " rows flat: ", share, " left");
          const double patience = flat == 90
            ? 0.0
            : (quality == Quality::Preview ? 32.0 : 32.0 * std::min((share - 0.6) / 0.4, 1.0));
          const int gap = static_cast<int>(std::ceil(patience)) + 1;
          check(frames.size() == std::size_t(69 / gap + 1) && frames.back() == 69 / gap * gap, flat,
            " rows flat, ", share, " of the tiles left: bricks in ", frames.size(),
            " frames, not in all ", gap);
        }
      }
    });
}

/// Bricks stay within 3 % of a volume.
void testMemory(Checks& check)
{
  const reference::Volume<std::int16_t> volume({ 128, 120, 136 }, 7);
  const splatting::ShearWarp geometry(viewWithShear(volume.size, 2, 0.3, -0.4));
  const Result bricks = projected(volume, geometry, Case(), Acceleration::Bricks);
  const double share = double(bricks.memory) / double(volume.voxels.size() * sizeof(std::int16_t));
  check(share > 0.02 && share <= 0.03, "bricks take ", share, " of the volume");
}
}

int TestAccelerations(int, char*[])
{
  Checks check;
  Sightings skipping;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testBricks<T>(check, skipping);
      testFloor<T>(check);
    });
  testNaN<float>(check);
  testNaN<double>(check);
  testNaNAtLayers<float>(check);
  testNaNAtLayers<double>(check);
  check(skipping.areEnough(0.01), "bricks leave half of the tiles out in only ", skipping);
  testRims(check);
  testEyeInLayer(check);
  testBudget<std::uint8_t>(check);
  testBudget<std::int16_t>(check);
  testBudget<float>(check);
  testBudget<double>(check);
  testAuto(check);
  testMemory(check);
  return check.exitCode();
}
