// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact minima, depth-shaded, local and signed maxima of random scenes.
 */
#include "CellViews.h"

namespace
{
using namespace celltesting;

void setShading(ProjectionSettings& settings, Random& random)
{
  // Shares of both signs: samples may become darker than the darkest voxel.
  const bool usual = random.uniform(0, 1);
  settings.ambient = usual ? random.uniform(0.0, 1.0) : random.uniform(-0.5, 1.0);
  settings.changeRate = usual ? 1.0 - settings.ambient : random.uniform(-1.0, 1.0);
}

template <class T>
void setThreshold(Scene<T>& scene, Random& random)
{
  const int voxel = random.uniform(0, static_cast<int>(scene.volume.voxels.size()) - 1);
  const double threshold = static_cast<double>(scene.volume.voxels[voxel]);
  scene.settings.threshold = threshold == threshold && !random.oneIn(10)
    ? threshold
    : -std::numeric_limits<double>::infinity();
}

/// An origin between the voxels, so that both extrema are shown.
template <class T>
void setOrigin(Scene<T>& scene, Random& random)
{
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const T voxel : scene.volume.voxels)
  {
    const double value = static_cast<double>(voxel);
    low = std::isfinite(value) ? std::min(low, value) : low;
    high = std::isfinite(value) ? std::max(high, value) : high;
  }
  const double share = random.uniform(0.3, 0.7);
  scene.settings.origin = low <= high ? (1.0 - share) * low + share * high : 0.0;
}

/// Not on faces of cells, where rounding decides which shades there are.
void addCuts(View& view, const std::array<int, 3>& size, Random& random)
{
  if (random.oneIn(3))
  {
    view.halfSpaces = coretesting::anyHalfSpaces(size, random);
    for (glm::dvec4& h : view.halfSpaces)
    {
      h.w += 0.013;
    }
  }
  if (random.oneIn(3))
  {
    view.cropping = coretesting::anyCropping(size, random);
    for (glm::dvec2& planes : view.cropping.planes)
    {
      planes += glm::dvec2(0.013, 0.027); // and no regions without thickness
    }
  }
}

template <class T>
void testReduction(const std::string& name, Reduction reduction, bool holes, Checks& check)
{
  // Cells that a ray only touches are shaded by where it does, as octants have values of their own.
  const bool isContinuous = !holes && reduction != Reduction::DepthShaded;
  forFamily<T>(name + (holes ? ", holes" : ""), 160, isContinuous ? Continuous : Discontinuous,
    check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 18);
      scene.volume = holes ? coretesting::volumeWithOddValues<T>(size, random)
                           : reference::uniformNoise<T>(size, random);
      scene.view = randomCellView(size, 80, random);
      scene.view.showsBoxes = random.oneIn(3);
      scene.settings.reduction = reduction;
      setShading(scene.settings, random);
      setThreshold(scene, random);
      addCuts(scene.view, size, random);
      setOrigin(scene, random);
      counts.add(compareScene(scene, check));
    });
}

/// Shaded samples that are brightest where rays end. Rays end at the sides of the outermost voxels;
/// what rounding leaves of them beyond shows nothing.
template <class T>
void testFieldEnds(Checks& check)
{
  forFamily<T>("ends of the field", 160, Discontinuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      scene.volume = reference::uniformNoise<T>({ 4, 5, 3 }, random);
      for (std::size_t n = 0; n < scene.volume.voxels.size(); n += 2)
      {
        scene.volume.voxels[n] = std::numeric_limits<T>::quiet_NaN();
      }
      scene.view = randomCellView(scene.volume.size, 60, random);
      scene.view.showsBoxes = true;
      scene.settings.reduction = Reduction::DepthShaded;
      scene.settings.ambient = 1.0;
      scene.settings.changeRate = -0.9;
      counts.add(compareScene(scene, check));
    });
}

/// A view nearly along an axis, some up to rounding, whose rays run along faces of cells and cross
/// edges.
View viewAlongFaces(const std::array<int, 3>& size, Random& random)
{
  View view;
  view.dimensions = { size[0], size[1], size[2] };
  view.viewport = glm::ivec2(40);
  const int axis = random.uniform(0, 2);
  std::array<glm::dvec4, 3> rows{};
  for (int n = 0; n < 2; ++n)
  {
    // One pixel per voxel; the first one is at -19 + place.
    const int across = (axis + 1 + n) % 3, place = random.uniform(0, 10);
    const double tilt =
      (random.oneIn(2) ? 0.05 : -0.05) * std::pow(10.0, random.uniform(-18.0, -5.0));
    rows[n][across] = 0.05;
    rows[n][axis] = !random.oneIn(4) ? tilt : 0.0;
    rows[n].w = -0.05 * (0.5 + place);
  }
  rows[2][axis] = random.oneIn(2) ? 0.01 : -0.01;
  setRows(view, rows[0], rows[1], rows[2], { 0.0, 0.0, 0.0, 1.0 });
  return view;
}

/// Local maxima on rays that rounding moves from one side of a face to the other.
template <class T>
void testAlongFaces(Checks& check)
{
  forFamily<T>("local, along faces", 160, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 12);
      scene.volume = reference::uniformNoise<T>(size, random);
      scene.view = viewAlongFaces(size, random);
      scene.view.showsBoxes = true; // no ray runs along the end of the field
      scene.settings.reduction = Reduction::Local;
      scene.settings.threshold = random.uniform(-1.0, 1.0); // no voxel's value, which rays cross
      if (sizeof(T) == sizeof(double) && random.oneIn(2))
      {
        // Rounding grows with the magnitude of voxels.
        for (T& voxel : scene.volume.voxels)
        {
          voxel += T(1e6);
        }
        scene.settings.threshold += 1e6;
      }
      counts.add(compareScene(scene, check));
    });
}

template <class T>
void testAll(bool holes, Checks& check)
{
  testReduction<T>("minima", Reduction::Minimum, holes, check);
  testReduction<T>("depth-shaded", Reduction::DepthShaded, holes, check);
  testReduction<T>("local", Reduction::Local, holes, check);
  testReduction<T>("signed", Reduction::Signed, holes, check);
}
}

int TestCellReductions(int, char*[])
{
  Checks check;
  testAll<std::uint8_t>(false, check);
  testAll<std::int16_t>(false, check);
  testAll<float>(false, check);
  testAll<float>(true, check);
  testFieldEnds<float>(check);
  testAlongFaces<float>(check);
  testAlongFaces<double>(check);
  testAll<std::int64_t>(false, check);
  testAll<double>(true, check);
  return check.exitCode();
}
