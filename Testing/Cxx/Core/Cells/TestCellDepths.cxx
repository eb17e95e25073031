// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where on their rays exact projections find their samples: the field has the sample's value there,
 * and none as large before. Of equal samples the nearest counts.
 */
#include "CellViews.h"

namespace
{
using namespace celltesting;

/// Whether samples lie where the field has their value, and whether none before is larger.
template <class T>
void compareDepths(const Scene<T>& scene, Counts& counts, Checks& check)
{
  using A = splatting::Accumulator<T>;
  using R = Real<T>;
  Engine<T> engine(scene);
  CellScreen screen;
  engine.project(screen);
  const Comparison<T> comparison(scene, engine.range(), check);
  const reference::CellOracle<R>& oracle = comparison.oracle();
  const bool isMaximum = scene.settings.reduction == Reduction::Maximum;
  for (int y = 0; y < scene.view.viewport.y; ++y)
  {
    for (int x = 0; x < scene.view.viewport.x; ++x)
    {
      const A value = valueAt<A>(screen, x, y);
      ++counts.pixels;
      if (!(value == value))
      {
        continue;
      }
      ++counts.samples;
      // From the engine's parameter to the oracle's: by the point in space.
      const reference::CellRay<R> ray = oracle.ray(x, y);
      const float t = depthAt(screen, x, y);
      const glm::dvec3 p = screen.rays.point(x, y, t);
      R at = 0;
      for (int a = 0; a < 3; ++a)
      {
        at += (p[a] - ray.start[a]) * ray.direction[a];
      }
      // Depths are float. Faces of cells are met at parameters that are wrong by their rounding.
      const double step = glm::length(screen.rays.direction(x, y));
      const R margin = step * (0x1p-22 * std::abs(t) + 0x1p-20) + 0x1p-20;
      // By so much the field changes within the margin.
      const R slope = 4 * comparison.tolerance() / Bound<T>;
      R least, largest;
      const bool isIn = oracle.fieldAt(ray, at, 8 * margin, least, largest) &&
        value >= least - slope * margin && value <= largest + slope * margin;
      R plateau = 0;
      const bool isFirst = !isMaximum || oracle.largest(ray).value != value ||
        !oracle.firstPlateau(ray, R(value), plateau) || at <= plateau + 64 * margin;
      if (!isIn || !isFirst)
      {
        // Rays along faces may have their samples on either side.
        ++counts.ambiguous;
        const R thickness = std::min({ std::fabs(ray.direction[0]), std::fabs(ray.direction[1]),
          std::fabs(ray.direction[2]) });
        check(thickness < 1e-3, "pixel ", x, ", ", y, ": ", value, " at ", at, " of ", ray.near,
          " to ", ray.far, ", where the field is ", least, " to ", largest, ", first at ", plateau);
      }
    }
  }
}

template <class T>
void testNoise(Checks& check)
{
  forFamily<T>("noise", 80, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 14);
      scene.volume = reference::uniformNoise<T>(size, random);
      scene.view = randomCellView(size, 80, random);
      scene.view.showsBoxes = random.oneIn(3);
      scene.locate = true;
      constexpr Reduction reductions[] = { Reduction::Maximum, Reduction::Minimum,
        Reduction::Signed, Reduction::Local };
      scene.settings.reduction = reductions[random.uniform(0, 3)];
      const auto [low, high] =
        std::minmax_element(scene.volume.voxels.begin(), scene.volume.voxels.end());
      scene.settings.origin = 0.5 * static_cast<double>(*low) + 0.5 * static_cast<double>(*high);
      scene.settings.threshold = scene.settings.origin;
      compareDepths(scene, counts, check);
    });
}

/// Boxes of equal value, one behind the other, on ground of the lowest value.
template <class T>
void testTies(Checks& check)
{
  forFamily<T>("ties", 120, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      scene.volume = reference::Volume<T>({ 22, 20, 21 }, T(3));
      for (int box = 0; box < 8; ++box)
      {
        glm::ivec3 low(0), high(0);
        for (int a = 0; a < 3; ++a)
        {
          low[a] = random.uniform(0, scene.volume.size[a] - 3);
          high[a] = std::min(low[a] + random.uniform(1, 6), scene.volume.size[a] - 1);
        }
        for (int k = low.z; k <= high.z; ++k)
        {
          for (int j = low.y; j <= high.y; ++j)
          {
            std::fill_n(&scene.volume.at(low.x, j, k), high.x - low.x + 1, T(100));
          }
        }
      }
      scene.view = randomCellView(scene.volume.size, 120, random);
      scene.locate = true;
      compareDepths(scene, counts, check);
    });
}
}

int TestCellDepths(int, char*[])
{
  Checks check;
  testNoise<std::uint8_t>(check);
  testNoise<float>(check);
  testNoise<double>(check);
  testTies<std::uint8_t>(check);
  testTies<float>(check);
  testTies<std::int32_t>(check);
  return check.exitCode();
}
