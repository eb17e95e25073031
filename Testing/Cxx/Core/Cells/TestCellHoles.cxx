// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact maxima where voxels are hidden (NaN) or infinite: cells with such a corner consist of
 * octants of their nearest voxels.
 */
#include "CellViews.h"

namespace
{
using namespace celltesting;

enum HoleKind
{
  FewHidden,
  MostHidden,
  Masks,
  Infinities,
  Everything
};

/// Hides all but a layer one voxel thick.
template <class T>
void keepLayer(reference::Volume<T>& volume, Random& random)
{
  const glm::dvec3 normal = glm::normalize(coretesting::anyVector(random, -1.0, 1.0) + 1e-3);
  const double place = glm::dot(normal, 0.5 * glm::dvec3(coretesting::toGlm(volume.size)));
  for (int k = 0; k < volume.size[2]; ++k)
  {
    for (int j = 0; j < volume.size[1]; ++j)
    {
      for (int i = 0; i < volume.size[0]; ++i)
      {
        if (std::abs(glm::dot(normal, glm::dvec3(i, j, k)) - place) > 0.5)
        {
          volume.at(i, j, k) = std::numeric_limits<T>::quiet_NaN();
        }
      }
    }
  }
}

template <class T>
void makeHoles(reference::Volume<T>& volume, HoleKind kind, Random& random)
{
  constexpr T infinity = std::numeric_limits<T>::infinity();
  constexpr T hidden = std::numeric_limits<T>::quiet_NaN();
  if (kind == Masks)
  {
    keepLayer(volume, random);
    return;
  }
  const double share = kind == MostHidden ? 0.9 : random.uniform(0.01, 0.3);
  const int sign = random.uniform(0, 2); // of infinities
  Random many = random.fork();
  for (T& voxel : volume.voxels)
  {
    if (!many.chance(share))
    {
      continue;
    }
    const bool isHidden =
      kind == FewHidden || kind == MostHidden || (kind == Everything && many.oneIn(2));
    const bool isNegative = sign == 2 ? many.uniform(0, 1) : sign;
    voxel = isHidden ? hidden : isNegative ? -infinity : infinity;
  }
}

template <class T>
void testHoles(const std::string& name, HoleKind kind, Checks& check)
{
  forFamily<T>(name, 320, Discontinuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 14);
      scene.volume = reference::uniformNoise<T>(size, random);
      makeHoles(scene.volume, kind, random);
      scene.view = randomCellView(size, 80, random);
      scene.view.showsBoxes = random.oneIn(3);
      if (random.oneIn(3))
      {
        scene.settings.reduction = Reduction::Minimum;
      }
      if (random.oneIn(4))
      {
        const glm::dvec3 normal = coretesting::anyVector(random, -1.0, 1.0);
        scene.view.halfSpaces.emplace_back(
          normal, -glm::dot(normal, 0.5 * glm::dvec3(scene.view.dimensions)));
      }
      counts.add(compareScene(scene, check));
    });
}

/// A bright hidden voxel never shows, and a single voxel that is not hidden shows as its box.
void testSingleVoxels(Checks& check)
{
  for (const bool hidden : { true, false })
  {
    Random random(7);
    Scene<float> scene;
    const float outside = hidden ? 1.0f : std::numeric_limits<float>::quiet_NaN();
    scene.volume = reference::Volume<float>({ 9, 9, 9 }, outside);
    scene.volume.at(4, 4, 4) = hidden ? std::numeric_limits<float>::quiet_NaN() : 5.0f;
    scene.view =
      parallelView(scene.volume.size, 8.0, 100, glm::dvec3(0.0, 0.0, 1.0), glm::dmat3(1.0), random);
    Engine<float> engine(scene);
    CellScreen screen;
    engine.project(screen);
    int samples = 0;
    for (int y = 0; y < scene.view.viewport.y; ++y)
    {
      for (int x = 0; x < scene.view.viewport.x; ++x)
      {
        const float value = valueAt<float>(screen, x, y);
        samples += value == value;
        check(
          !(value == value) || value == (hidden ? 1.0f : 5.0f), "pixel ", x, ", ", y, ": ", value);
      }
    }
    check(hidden ? samples > 1000 : samples >= 49 && samples <= 81, samples, " samples");
  }
}

template <class T>
void testAll(Checks& check)
{
  testHoles<T>("few hidden", FewHidden, check);
  testHoles<T>("most hidden", MostHidden, check);
  testHoles<T>("masks of one voxel", Masks, check);
  testHoles<T>("infinities", Infinities, check);
  testHoles<T>("hidden and infinities", Everything, check);
}
}

int TestCellHoles(int, char*[])
{
  Checks check;
  testSingleVoxels(check);
  testAll<float>(check);
  testAll<double>(check);
  return check.exitCode();
}
