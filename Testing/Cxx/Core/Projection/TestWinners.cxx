// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the samples lie that a projection shows: the voxel of previews and the slice of averages
// are those that brute force finds; of equal samples the nearest to the viewer wins, for any
// acceleration, instruction set and number of threads.
#include "AverageTesting.h"
#include "WinnerScenes.h"
#include "Winners.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace winnerscenes;
using splatting::Acceleration;
using splatting::Quality;
using splatting::Reduction;

namespace
{
/// Few values, so that ties are common, on a background of the lowest.
template <class T>
reference::Volume<T> withTies(const std::array<int, 3>& size, reference::Random& random)
{
  auto volume = reference::uniformNoise<T>(size, random, T(0), T(3));
  const int background = random.uniform(0, 3) * 100;
  for (std::size_t n = 0; n < volume.voxels.size(); ++n)
  {
    // Whole stretches are empty.
    volume.voxels[n] = static_cast<int>(n % 397) < background ? T(0) : volume.voxels[n];
  }
  return volume;
}

/// The same of any size so that there are several bricks.
template <class T>
reference::Volume<T> volumeWithTies(reference::Random& random)
{
  return withTies<T>(randomSize(random, random.oneIn(2) ? 40 : 12), random);
}

/// Hides some voxels or most of them, if the type has NaN.
template <class T>
void hideVoxels(reference::Volume<T>& volume, reference::Random& random)
{
  const double share = random.oneIn(2) ? random.uniform(0.0, 1.0) : 0.0;
  for (T& voxel : volume.voxels)
  {
    if (std::numeric_limits<T>::has_quiet_NaN && random.chance(share))
    {
      voxel = std::numeric_limits<T>::quiet_NaN();
    }
  }
}

/// Of each pixel of a scene's images the voxel that brute force finds, -1 for none.
using Voxels = std::vector<std::vector<glm::ivec3>>;

template <class T>
Voxels winningVoxels(const reference::Volume<T>& volume, const Scene& scene, bool minimum)
{
  Voxels result;
  for (const splatting::ShearWarp& geometry : scene.images)
  {
    const reference::ImageRays rays = referenceRays(geometry);
    const auto samples = reference::voxelSamples(volume, rays);
    const reference::RayCutter cutter(rays, scene.cuts);
    std::vector<glm::ivec3>& voxels = result.emplace_back(samples.size(), glm::ivec3(-1));
    for (int v = 0; v < geometry.rayCount().y; ++v)
    {
      for (int u = 0; u < geometry.rayCount().x; ++u)
      {
        const std::size_t at = std::size_t(v) * geometry.width() + u;
        const int winner =
          reference::winnerOf(samples[at], cutter, u, v, geometry.reversed(), minimum);
        if (winner >= 0)
        {
          voxels[at] = toGlm(reference::crossedVoxels(rays, u, v)[winner]);
        }
      }
    }
  }
  return result;
}

template <class T>
void comparePreview(Checks& check, const reference::Volume<T>& volume, const Scene& scene,
  splatting::ProjectionSettings settings, const Voxels& expected, const std::string& name)
{
  const auto images = projectScene(volume, scene, settings);
  const splatting::Located where = located(volume, scene, images, settings);
  for (std::size_t m = 0; m < images.size(); ++m)
  {
    const splatting::ShearWarp& geometry = scene.images[m];
    std::vector<glm::ivec3> voxels;
    splatting::findVoxels(where, m, voxels);
    bool same = true;
    for (int v = 0; v < geometry.rayCount().y; ++v)
    {
      const auto row = voxels.begin() + std::ptrdiff_t(v) * geometry.width();
      const auto other = expected[m].begin() + std::ptrdiff_t(v) * geometry.width();
      same = same && std::equal(row, row + geometry.rayCount().x, other);
    }
    check(same, name, ", image ", m, ": another voxel");
  }
}

template <class T>
void testPreview(Checks& check, bool perspective)
{
  reference::forScenes(seriesOf<T>(nameOf("previews", perspective)), 40,
    [&](int, reference::Random& random)
    {
      auto volume = volumeWithTies<T>(random);
      hideVoxels(volume, random);
      const Scene scene = anyScene(volume.size, perspective, random);
      splatting::ProjectionSettings settings;
      settings.quality = Quality::Preview;
      settings.reduction = !random.oneIn(4) ? Reduction::Maximum : Reduction::Minimum;
      settings.acceleration = anyAcceleration(random);
      comparePreview(check, volume, scene, settings,
        winningVoxels(volume, scene, settings.reduction == Reduction::Minimum), "preview");
    });
}

/// Rows of pixels that fill registers, and volumes deep enough for pairs of layers: there previews
/// note winners by other loops, which are each instruction set's own.
template <class T>
void testLongRows(Checks& check)
{
  reference::forScenes(seriesOf<T>("long rows"), 12,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int a = 0; a < 3; ++a)
      {
        size[a] = a == n % 3 ? random.uniform(64, 300) : random.uniform(9, 36);
      }
      const auto volume = withTies<T>(size, random);
      const Scene scene = anyScene(size, false, random, n % 2 == 0);
      const Voxels expected = winningVoxels(volume, scene, false);
      for (int way = 0; way < 8; ++way)
      {
        splatting::ProjectionSettings settings;
        settings.quality = Quality::Preview;
        settings.acceleration = way % 2 ? Acceleration::Bricks : Acceleration::Dense;
        settings.instructionSet = instructionSets[way / 2];
        comparePreview(
          check, volume, scene, settings, expected, "long rows, way " + std::to_string(way));
      }
    });
}

/// More slices than walks have notes for.
void testDeepVolume(Checks& check)
{
  reference::forScenes("deep volumes", 2,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size = { 3, 4, 11000 };
      const auto volume = withTies<std::uint8_t>(size, random);
      Scene scene;
      scene.view = viewWithShear(size, 2, 1e-3, -2e-4);
      scene.view.indexToClip[2][2] = n % 2 ? 1e-4 : -1e-4;
      splatting::ShearWarp::factorise(scene.view, scene.images);
      splatting::ProjectionSettings settings;
      settings.quality = Quality::Preview;
      comparePreview(
        check, volume, scene, settings, winningVoxels(volume, scene, false), "deep volume");
    });
}

/// What a voxel weighs in an average: that of a volume where it alone is 1.
double shareOf(const std::array<int, 3>& size, const splatting::ShearWarp& geometry,
  const reference::Kernel& kernel, const glm::ivec3& voxel, int u, int v, int k)
{
  reference::Volume<double> single(size, 0.0);
  single.at(std::array<int, 3>{ voxel.x, voxel.y, voxel.z }) = 1.0;
  return reference::slabSample(single, referenceRays(geometry), kernel, u, v, k).value;
}

/// Of one pixel, the voxel that adds most to its average: none adds more, but for what weights are
/// rounded by, which is no more than averages may be off.
template <class T>
void testShare(Checks& check, const reference::Volume<T>& volume, const Scene& scene,
  const Mode& mode, double bound, const glm::ivec3& found, std::size_t m, int u, int v, int k)
{
  const splatting::ShearWarp& geometry = scene.images[m];
  const double low =
    static_cast<double>(*std::min_element(volume.voxels.begin(), volume.voxels.end()));
  const auto share = [&](const glm::ivec3& voxel)
  {
    const double value =
      static_cast<double>(volume.at(std::array<int, 3>{ voxel.x, voxel.y, voxel.z }));
    return (value - low) * shareOf(volume.size, geometry, mode.reference, voxel, u, v, k);
  };
  const double own = share(found);
  const int axis = geometry.principalAxis();
  check(found[axis] == k, "the voxel is of slice ", found[axis], ", not ", k);
  for (int di = -2; di <= 2; ++di)
  {
    for (int dj = -2; dj <= 2; ++dj)
    {
      glm::ivec3 other = found;
      other[geometry.axes()[0]] += di;
      other[geometry.axes()[1]] += dj;
      if (glm::clamp(other, glm::ivec3(0), toGlm(volume.size) - 1) == other)
      {
        check(share(other) <= own + 2.0 * bound, "another voxel adds more: ", share(other),
          ", not ", own);
      }
    }
  }
}

/// A projection by averages.
template <class T>
struct AverageScene
{
  reference::Volume<T> volume;
  Scene scene;
  Mode mode;
  splatting::ProjectionSettings settings;
  std::vector<splatting::ShearImage> images;
};

template <class T>
AverageScene<T> anyAverages(bool perspective, reference::Random& random)
{
  AverageScene<T> averages;
  averages.volume = reference::uniformNoise<T>(randomSize(random, 9), random);
  averages.scene = anyScene(averages.volume.size, perspective, random);
  averages.mode = modes()[random.uniform(0, 2)];
  splatting::ProjectionSettings& settings = averages.settings;
  settings = settingsOf(averages.mode);
  settings.reduction = !random.oneIn(4) ? Reduction::Maximum : Reduction::Minimum;
  settings.acceleration = anyAcceleration(random);
  averages.images = projectScene(averages.volume, averages.scene, settings);
  return averages;
}

/// The averages of all slices that the rays of an image cross, and how far others may be off.
struct ExactAverages
{
  reference::RaySamples<double> rays;
  double bound;
};

template <class T>
ExactAverages exactAverages(const AverageScene<T>& averages, std::size_t m)
{
  const splatting::ShearWarp& geometry = averages.scene.images[m];
  return { reference::slabSamples(reference::toDouble(averages.volume), referenceRays(geometry),
             averages.mode.reference),
    averageBound(averages.volume, geometry, averages.mode) };
}

/// Whether the slices that win in an image have the extrema. Returns false if a ray has a sample
/// and its pixel has none, or the other way round.
template <class T>
bool compareSlices(
  Checks& check, const AverageScene<T>& averages, const ExactAverages& exact, std::size_t m)
{
  const splatting::ShearWarp& geometry = averages.scene.images[m];
  const reference::ImageRays rays = referenceRays(geometry);
  const reference::RayCutter cutter(rays, averages.scene.cuts);
  const bool smallest = averages.settings.reduction == Reduction::Minimum;
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    for (int u = 0; u < geometry.rayCount().x; ++u)
    {
      const std::size_t at = std::size_t(v) * geometry.width() + u;
      const auto& ray = exact.rays[at];
      if (!rays.isParallel() && ray.empty() && meets(rays, u, v, GrazeWidth))
      {
        continue; // it may be counted to the volume or not, see ShearImage::spans
      }
      const int winner = reference::winnerOf(ray, cutter, u, v, geometry.reversed(), smallest);
      const int step = averages.images[m].winners[at];
      if (!check((winner >= 0) == (step >= 0), "averages: one has a sample"))
      {
        return false;
      }
      const auto own = std::find_if(ray.begin(), ray.end(),
        [=](const auto& s) { return s.slice == step / splatting::StepsPerSlice; });
      check(step < 0 ||
          (own != ray.end() && std::abs(own->value - ray[winner].value) <= 2.0 * exact.bound),
        "averages, pixel ", u, " ", v, ": slice ", step / splatting::StepsPerSlice,
        " has not the extremum");
    }
  }
  return true;
}

/// The voxel of the pixel in the middle of an image, if that has one.
template <class T>
void testMiddleShare(Checks& check, const AverageScene<T>& averages, double bound, std::size_t m)
{
  const splatting::ShearWarp& geometry = averages.scene.images[m];
  const std::vector<splatting::ShearImage>& images = averages.images;
  std::vector<glm::ivec3> voxels;
  splatting::findVoxels(
    located(averages.volume, averages.scene, images, averages.settings), m, voxels);
  const int u = geometry.rayCount().x / 2, v = geometry.rayCount().y / 2;
  const std::size_t at = std::size_t(v) * geometry.width() + u;
  if (images[m].winners[at] >= 0)
  {
    testShare(check, averages.volume, averages.scene, averages.mode, bound, voxels[at], m, u, v,
      images[m].winners[at] / splatting::StepsPerSlice);
  }
}

template <class T>
void testAverages(Checks& check, bool perspective)
{
  reference::forScenes(seriesOf<T>(nameOf("averages", perspective)), 12,
    [&](int n, reference::Random& random)
    {
      const AverageScene<T> averages = anyAverages<T>(perspective, random);
      const bool smallest = averages.settings.reduction == Reduction::Minimum;
      for (std::size_t m = 0; m < averages.images.size(); ++m)
      {
        const ExactAverages exact = exactAverages(averages, m);
        if (!compareSlices(check, averages, exact, m))
        {
          return;
        }
        if (!smallest && n < 4 && sizeof(T) == 1)
        {
          testMiddleShare(check, averages, exact.bound, m);
        }
      }
    });
}

/// Footprints in the midst of a slice, which are looked at in another way than those at the rim,
/// and outermost slices, whose voxels are met again beyond them.
void testWholeFootprints(Checks& check)
{
  reference::forScenes("whole footprints", 36,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size{ 13, 13, random.uniform(1, 5) };
      const auto volume = reference::uniformNoise<std::uint8_t>(size, random, 0, 255);
      Scene scene;
      const double shearX = specialShear(random), shearY = specialShear(random);
      scene.view = viewWithShear(volume.size, 2, shearX, shearY);
      scene.images.emplace_back(scene.view);
      const Mode mode = modes()[n % 3];
      splatting::ProjectionSettings settings = settingsOf(mode);
      const auto images = projectScene(volume, scene, settings);
      std::vector<glm::ivec3> voxels;
      splatting::findVoxels(located(volume, scene, images, settings), 0, voxels);
      const int u = scene.images[0].width() / 2, v = scene.images[0].height() / 2;
      const std::size_t at = std::size_t(v) * scene.images[0].width() + u;
      testShare(check, volume, scene, mode, errorBound<std::uint8_t>(mode.quality, 0.0, 255.0),
        voxels[at], 0, u, v, images[0].winners[at] / splatting::StepsPerSlice);
    });
}

/// Slices that are all alike: the nearest one wins.
void testEqualSlices(Checks& check)
{
  reference::forScenes("equal slices", 48,
    [&](int n, reference::Random& random)
    {
      const int axis = n % 3;
      const std::array<int, 3> size = { 21, 22, 23 };
      const auto noise = reference::uniformNoise<std::uint8_t>(size, random, 0, 255);
      auto volume = noise;
      for (int k = 0; k < size[2]; ++k)
      {
        for (int j = 0; j < size[1]; ++j)
        {
          for (int i = 0; i < size[0]; ++i)
          {
            std::array<int, 3> at = { i, j, k }, first = at;
            first[axis] = 0;
            volume.at(at) = noise.at(first);
          }
        }
      }
      Scene scene;
      scene.view = viewWithShear(size, axis, 0.0, 0.0);
      scene.view.indexToClip[axis][2] = n % 2 ? 1e-3 : -1e-3;
      splatting::ShearWarp::factorise(scene.view, scene.images);
      splatting::ProjectionSettings settings;
      settings.quality = static_cast<Quality>(n / 3 % 3);
      settings.acceleration = n % 5 ? Acceleration::Bricks : Acceleration::Dense;
      const auto images = projectScene(volume, scene, settings);
      const int nearest = scene.images[0].reversed() ? size[axis] - 1 : 0;
      check(std::all_of(images[0].winners.begin(), images[0].winners.end(),
              [=](int step) { return step < 0 || step / splatting::StepsPerSlice == nearest; }),
        "equal slices: not the nearest one");
    });
}

template <class T>
void testInvariance(Checks& check, bool perspective)
{
  reference::forScenes(seriesOf<T>(nameOf("invariance", perspective)), 8,
    [&](int n, reference::Random& random)
    {
      const auto volume = volumeWithTies<T>(random);
      const Scene scene = anyScene(volume.size, perspective, random);
      splatting::ProjectionSettings settings;
      settings.quality = static_cast<Quality>(n % 3);
      settings.acceleration = Acceleration::Dense;
      const auto expected = projectScene(volume, scene, settings);
      splatting::ProjectionSettings plain = settings;
      for (int way = 0; way < 8; ++way)
      {
        settings.acceleration = way % 2 ? Acceleration::Bricks : Acceleration::Dense;
        settings.instructionSet = instructionSets[way / 2];
        std::vector<splatting::ShearImage> found;
        vtkSMPTools::LocalScope(vtkSMPTools::Config{ 1 + way % 3 },
          [&]() { found = projectScene(volume, scene, settings); });
        for (std::size_t m = 0; m < found.size(); ++m)
        {
          check(found[m].winners == expected[m].winners && sameImages(found[m], expected[m]),
            "quality ", n % 3, ", way ", way, ": other winners");
          check(sameImages(found[m],
                  project(volume, scene.images[m], plain, cutsBy(scene.images[m], scene.cuts))),
            "quality ", n % 3, ", way ", way, ": winners change the image");
        }
      }
    });
}
}

int TestWinners(int, char*[])
{
  Checks check;
  for (bool perspective : { false, true })
  {
    testPreview<std::uint8_t>(check, perspective);
    testPreview<std::int16_t>(check, perspective);
    testPreview<std::uint64_t>(check, perspective);
    testPreview<float>(check, perspective);
    testAverages<std::uint8_t>(check, perspective);
    testAverages<std::int16_t>(check, perspective);
    testAverages<float>(check, perspective);
    testInvariance<std::uint8_t>(check, perspective);
    testInvariance<float>(check, perspective);
  }
  testLongRows<std::uint8_t>(check);
  testLongRows<std::int8_t>(check);
  testLongRows<std::int16_t>(check);
  testLongRows<std::uint32_t>(check);
  testLongRows<float>(check);
  testLongRows<double>(check);
  testDeepVolume(check);
  testWholeFootprints(check);
  testEqualSlices(check);
  return check.exitCode();
}
