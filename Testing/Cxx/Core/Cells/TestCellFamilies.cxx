// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact maxima of scenes in which thin structures may be lost: vessels before and behind plates,
 * single voxels, tubes along the view, noise, checkerboards.
 */
#include "CellViews.h"
#include "CellVolumes.h"

#include <cstring>

namespace
{
using namespace celltesting;

/// A view along a direction, as any other but for that.
View viewAlong(const std::array<int, 3>& size, const glm::dvec3& direction, Random& random)
{
  const double pixels = random.uniform(1.0, random.oneIn(2) ? 3.0 : 8.0);
  const glm::dmat3 placement = randomPlacement(random);
  return random.oneIn(2)
    ? parallelView(size, pixels, 120, direction, placement, random)
    : perspectiveView(size, pixels, 120, random.uniform(1.0, 5.0), direction, placement, random);
}

template <class T>
void compareAlong(reference::Volume<T> volume, const glm::dvec3& direction, Random& random,
  Counts& counts, Checks& check)
{
  Scene<T> scene;
  scene.volume = std::move(volume);
  scene.view = viewAlong(scene.volume.size, direction, random);
  counts.add(compareScene(scene, check));
}

template <class T>
void testVessels(bool across, Checks& check)
{
  forFamily<T>(across ? "vessels across" : "vessels oblique", 80, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      const std::array<int, 3> size = { 21, 19, 22 };
      const glm::dvec3 middle(10.0, 9.0, 10.5);
      const glm::dvec3 view = glm::normalize(randomDirection(random));
      Vessel vessel;
      vessel.width = random.uniform(1.0, 2.5);
      vessel.direction = vesselDirection(view, across, random);
      // The plate lies behind the vessel or before it.
      const double sense = random.sign();
      vessel.point = middle - sense * random.uniform(3.0, 5.0) * view;
      Plate plate{ view, 0.0, 0.0, random.uniform(0.3, 0.9) };
      plate.from = glm::dot(middle, view) + sense * 4.0 - 1.2;
      plate.to = plate.from + 2.4;
      const auto volume =
        volumeOf<T>(size, [&](const glm::dvec3& p) { return std::max(vessel.at(p), plate.at(p)); });
      compareAlong<T>(volume, view, random, counts, check);
    });
}

template <class T>
void testSingleVoxels(Checks& check)
{
  forFamily<T>("single voxels", 80, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      const glm::dvec3 view = glm::normalize(randomDirection(random));
      const glm::dvec3 middle(8.0);
      const glm::dvec3 voxel = glm::round(middle - random.uniform(2.0, 5.0) * view);
      Plate plate{ view, glm::dot(middle, view) + 1.5, glm::dot(middle, view) + 4.0,
        random.uniform(0.3, 0.9) };
      const auto volume = volumeOf<T>(
        { 17, 17, 17 }, [&](const glm::dvec3& p) { return p == voxel ? 1.0 : plate.at(p); });
      compareAlong<T>(volume, view, random, counts, check);
    });
}

template <class T>
void testTubes(Checks& check)
{
  forFamily<T>("tubes along the view", 60, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      const glm::dvec3 view = glm::normalize(randomDirection(random));
      const double tilt = std::pow(10.0, random.uniform(-6.0, -0.7));
      Vessel vessel;
      vessel.width = random.uniform(1.0, 2.0);
      vessel.direction = glm::normalize(view + tilt * coretesting::anyDirection(random));
      vessel.point = glm::dvec3(8.0) + coretesting::anyVector(random, -2.0, 2.0);
      const auto volume =
        volumeOf<T>({ 18, 16, 17 }, [&](const glm::dvec3& p) { return vessel.at(p); });
      compareAlong<T>(volume, view, random, counts, check);
    });
}

template <class T>
void testNoise(Checks& check)
{
  forFamily<T>("noise", 80, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      // Sparse noise has few bright voxels.
      const double power = random.uniform(1.0, 20.0);
      auto volume = volumeOf<T>({ 17, 18, 16 },
        [&](const glm::dvec3&) { return std::pow(random.uniform(0.0, 1.0), power); });
      compareAlong<T>(std::move(volume), randomDirection(random), random, counts, check);
    });
}

/// Each tile sees hundreds of bricks, and the last ones cannot raise any pixel. One voxel is 0, all
/// others are bright. Pixels are therefore near their final values early.
template <class T>
void testManyBricks(Checks& check)
{
  forFamily<T>("many bricks", 12, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      const std::array<int, 3> size = { 49, 45, 42 };
      auto volume = volumeOf<T>(size,
        [&](const glm::dvec3& p)
        { return p == glm::dvec3(24.0, 22.0, 21.0) ? 0.0 : random.uniform(0.6, 1.0); });
      compareAlong<T>(std::move(volume), randomDirection(random), random, counts, check);
    });
}

template <class T>
void testCheckerboards(Checks& check)
{
  forFamily<T>("checkerboards", 60, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      const int width = random.uniform(1, 3);
      const double rise = random.oneIn(2) ? 0.0 : 0.01;
      auto volume = volumeOf<T>({ 15, 17, 16 },
        [&](const glm::dvec3& p)
        {
          const glm::ivec3 box = glm::ivec3(p) / width;
          return ((box.x + box.y + box.z) & 1) * (0.5 + rise * (p.x + p.y + p.z));
        });
      compareAlong<T>(std::move(volume), randomDirection(random), random, counts, check);
    });
}

/// A plate of 600 in slices 8 to 10 and a line of 1000 along x in slice 32, which shows 999.
void testPlateAndLine(Checks& check)
{
  Counts counts;
  Scene<std::uint16_t> scene;
  scene.volume = reference::Volume<std::uint16_t>({ 63, 63, 63 });
  for (int k = 8; k <= 10; ++k)
  {
    std::fill_n(&scene.volume.at(0, 0, k), 63 * 63, std::uint16_t(600));
  }
  std::fill_n(&scene.volume.at(0, 31, 32), 63, std::uint16_t(1000));
  const glm::dvec3 forward = glm::normalize(glm::dvec3(0.0, 0.5, 1.0));
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.0, 1.0, -0.5)), middle(31.0);
  scene.view.dimensions = glm::ivec3(63);
  scene.view.viewport = { 160, 161 };
  const auto row = [&](const glm::dvec3& d, double scale)
  { return scale * glm::dvec4(d, -glm::dot(d, middle)); };
  setRows(scene.view, row({ 1.0, 0.0, 0.0 }, 4.0 / 160), row(up, 4.0 / 161), row(forward, 1e-3),
    { 0.0, 0.0, 0.0, 1.0 });
  counts.add(compareScene(scene, check));
  Engine<std::uint16_t> engine(scene);
  CellScreen screen;
  engine.project(screen);
  float largest = 0.0f;
  int above = 0;
  for (int y = 0; y < 161; ++y)
  {
    for (int x = 0; x < 160; ++x)
    {
      const float value = valueAt<float>(screen, x, y);
      largest = std::max(largest, value);
      above += value > 601.0f;
    }
  }
  check(largest > 900.0f && above > 120, "The line shows ", largest, " at most, ", above,
    " pixels of it are above the plate");
  counts.report("plate and line", check);
}

template <class T>
void testFamilies(Checks& check)
{
  testVessels<T>(true, check);
  testVessels<T>(false, check);
  testSingleVoxels<T>(check);
  testTubes<T>(check);
  testNoise<T>(check);
  testManyBricks<T>(check);
  testCheckerboards<T>(check);
}
}

int TestCellFamilies(int, char*[])
{
  Checks check;
  testPlateAndLine(check);
  testFamilies<std::uint8_t>(check);
  testFamilies<std::int16_t>(check);
  testFamilies<float>(check);
  testFamilies<double>(check);
  return check.exitCode();
}
