// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What must not change a picture: threads, instruction sets, the 48 symmetries of the axes; and the
// grey-level maps that commute with the projection.
#include "AverageTesting.h"

#include <vtkSMPTools.h>

#include <cmath>
#include <string>

using namespace coretesting;
using splatting::Quality;

namespace
{
const Quality qualities[] = { Quality::Preview, Quality::Standard, Quality::High };
const splatting::Acceleration accelerations[] = { splatting::Acceleration::Auto,
  splatting::Acceleration::Lines, splatting::Acceleration::SortedLines,
  splatting::Acceleration::SortedVolume };

/// One and five threads of each backend that VTK has; each instruction set.
template <class T>
void testThreadsAndInstructionSets(Checks& check, bool perspective)
{
  const int type = static_cast<int>(splatting::scalarTypeOf<T>());
  reference::forScenes(seriesOf<T>(perspective ? "threads, in perspective" : "threads"), 4,
    [&](int n, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>({ 83, 61, 47 }, random);
      const splatting::ShearWarp geometry = anyGeometry(volume.size, perspective, random);
      splatting::ProjectionSettings settings;
      settings.quality = qualities[(n + type) % 3]; // a few scenes of all types have all modes
      settings.acceleration = accelerations[(n + type / 3) % 4]; // and all accelerations
      const splatting::ShearImage expected = project(volume, geometry, settings);
      for (const char* backend : { "Sequential", "STDThread", "TBB" })
      {
        const std::string usual = vtkSMPTools::GetBackend();
        if (!vtkSMPTools::SetBackend(backend))
        {
          continue; // this VTK was built without it
        }
        // TBB starts no more threads than there are cores and says so; the others do as told.
        for (int threads : { 1, backend == std::string("TBB") ? 2 : 5 })
        {
          vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads },
            [&]
            {
              check(sameImages(project(volume, geometry, settings), expected), backend, " with ",
                threads, " threads gives other bits, mode ", int(settings.quality));
            });
        }
        vtkSMPTools::SetBackend(usual.c_str());
      }
      for (splatting::InstructionSet set : instructionSets)
      {
        settings.instructionSet = set;
        check(sameImages(project(volume, geometry, settings), expected), splatting::nameOf(set),
          " gives other bits, mode ", int(settings.quality), ", type ", type);
      }
    });
}

/// Where a ray of one image is in the other one, whose axis a has been axis `source` in the first.
/// Rays that only one of them has are left out.
struct MirroredRays
{
  std::array<std::vector<int>, 2> pixels; ///< of the other image's columns and rows, or -1
  bool transposed = false;

  MirroredRays(const splatting::ShearWarp& image, const splatting::ShearWarp& other,
    const reference::AxisSymmetry& symmetry)
  {
    const reference::ImageRays from = referenceRays(image), to = referenceRays(other);
    const int along = symmetry.sign[to.axes[2]];
    this->transposed = symmetry.axis[to.axes[0]] != from.axes[0];
    for (int a = 0; a < 2; ++a)
    {
      const int b = this->transposed ? 1 - a : a; // what has become of it
      const int sign = symmetry.sign[to.axes[b]];
      const double last = from.size[a] - 1;
      for (int n = 0; n < int(from.at[a].size()); ++n)
      {
        const double at = sign > 0 ? from.at[a][n] : last - from.at[a][n];
        int found = -1;
        for (int m = 0; m < int(to.at[b].size()); ++m)
        {
          found =
            to.at[b][m] == at && to.slope[b][m] == sign * along * from.slope[a][n] ? m : found;
        }
        this->pixels[a].push_back(found);
      }
    }
  }
};

/// Pixels that both images have, and by how much they differ.
struct Comparison
{
  int common = 0, all = 0;
  double difference = 0.0;
};

template <class P>
void compare(const splatting::ShearWarp& image, const reference::Image<P>& plain,
  const reference::Image<P>& other, const MirroredRays& rays, Comparison& result)
{
  const reference::ImageRays own = referenceRays(image);
  for (int v = 0; v < plain.height; ++v)
  {
    for (int u = 0; u < plain.width; ++u)
    {
      const int x = rays.pixels[0][u], y = rays.pixels[1][v];
      result.all += plain.isHit(u, v);
      // Rays that graze the volume may be counted to it in one image only, see ShearImage::spans.
      if (x >= 0 && y >= 0 && meets(own, u, v, GrazeWidth) == meets(own, u, v, -GrazeWidth))
      {
        const int p = rays.transposed ? y : x, q = rays.transposed ? x : y;
        const double difference = std::abs(double(plain.at(u, v)) - double(other.at(p, q)));
        result.common += plain.isHit(u, v);
        result.difference = std::max(result.difference,
          plain.isHit(u, v) == other.isHit(p, q) ? difference
                                                 : std::numeric_limits<double>::infinity());
      }
    }
  }
}

/// Compares an image with that of the volume whose axes were permuted and reversed, in all modes.
template <class T>
void compareMirrored(Checks& check, const reference::Volume<T>& volume,
  const splatting::ShearWarp& image, const reference::Volume<T>& mirrored,
  const splatting::ShearWarp& other, const MirroredRays& rays, Comparison (&pictures)[3])
{
  for (Quality quality : qualities)
  {
    splatting::ProjectionSettings settings;
    settings.quality = quality;
    const splatting::ShearImage plain = project(volume, image, settings);
    const splatting::ShearImage turned = project(mirrored, other, settings);
    Comparison result;
    splatting::dispatch(plain.type,
      [&](auto* null)
      {
        using P = std::remove_pointer_t<decltype(null)>;
        compare(image, toReference<P>(plain), toReference<P>(turned), rays, result);
      });
    const double bound = 2.0 * averageBound<T>(image, modeOf(quality), 0.0, 100.0);
    check(result.difference <= bound, "a symmetry changes mode ", int(quality), " by ",
      result.difference, ", not ", bound, ", axis ", image.principalAxis());
    pictures[int(quality)].common += result.common;
    pictures[int(quality)].all += result.all;
  }
}

template <class T>
void testSymmetries(Checks& check, bool perspective, Sightings (&mirrored)[3])
{
  const auto symmetries = reference::allAxisSymmetries();
  reference::forScenes(seriesOf<T>(nameOf("symmetries", perspective)), 48,
    [&](int n, reference::Random& random)
    {
      // In no order, so that any share of them has some of all kinds.
      const reference::AxisSymmetry& symmetry = symmetries[n * 29 % 48];
      const auto volume = reference::uniformNoise<T>({ 13, 9, 11 }, random, T(0), T(100));
      const auto turned = reference::transformed(volume, symmetry);
      const splatting::View view =
        perspective ? randomPerspective(volume.size, random) : randomView(volume.size, random);
      std::vector<splatting::ShearWarp> images, others;
      splatting::ShearWarp::factorise(view, images);
      splatting::ShearWarp::factorise(transformedView(view, symmetry), others);
      check(images.size() == others.size(), "a symmetry changes the number of images");
      Comparison pictures[3];
      for (const splatting::ShearWarp& image : images)
      {
        for (const splatting::ShearWarp& other : others)
        {
          const int axis = other.principalAxis();
          const bool isTurned = symmetry.sign[axis] < 0;
          if (symmetry.axis[axis] == image.principalAxis() &&
            (image.reversed() != isTurned) == other.reversed())
          {
            compareMirrored(
              check, volume, image, turned, other, MirroredRays(image, other, symmetry), pictures);
          }
        }
      }
      for (Quality quality : qualities)
      {
        const Comparison& picture = pictures[int(quality)];
        mirrored[int(quality)].add(picture.common > 0 && picture.common > 0.95 * picture.all);
      }
    });
}

/// Monotone maps commute with the preview, bit for bit.
void testMonotoneMap(Checks& check)
{
  const auto volume = reference::uniformNoise<std::uint8_t>({ 20, 15, 10 }, 4);
  const auto map = [](std::uint8_t x) { return static_cast<std::uint8_t>(std::sqrt(x * 255.0)); };
  auto mapped = volume;
  for (auto& voxel : mapped.voxels)
  {
    voxel = map(voxel);
  }
  splatting::ProjectionSettings settings;
  settings.quality = Quality::Preview;
  reference::forScenes("monotone maps", 20,
    [&](int, reference::Random& random)
    {
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      auto before = toReference<std::uint8_t>(project(volume, geometry, settings));
      for (auto& pixel : before.value)
      {
        pixel = map(pixel);
      }
      check.same(before, toReference<std::uint8_t>(project(mapped, geometry, settings)), 0.0,
        "a monotone map does not commute with the preview");
    });
}

/// Increasing affine maps commute with all modes, up to rounding.
void testAffineMap(Checks& check)
{
  reference::forScenes("affine maps", 20,
    [&](int n, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<float>({ 20, 15, 10 }, random, -1.0f, 1.0f);
      auto mapped = volume;
      for (auto& voxel : mapped.voxels)
      {
        voxel = 8.0f * voxel - 64.0f; // exact in float but for the last bits
      }
      const Quality quality = qualities[n % 3];
      splatting::ProjectionSettings settings;
      settings.quality = quality;
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      auto before = toReference<float>(project(volume, geometry, settings));
      const auto after = toReference<float>(project(mapped, geometry, settings));
      for (std::size_t p = 0; p < before.value.size(); ++p)
      {
        before.value[p] = before.hit[p] ? 8.0f * before.value[p] - 64.0f : 0.0f;
      }
      const double bound =
        2.0 * averageBound<float>(geometry, modeOf(quality), -72.0, -56.0) + 72 * 0x1p-23;
      const double difference = largestDifference(before, after);
      check(difference <= bound, "an affine map does not commute with mode ", int(quality), ": ",
        difference);
    });
}
}

int TestInvariance(int, char*[])
{
  Checks check;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testThreadsAndInstructionSets<T>(check, false);
      testThreadsAndInstructionSets<T>(check, true);
    });
  for (bool perspective : { false, true })
  {
    Sightings mirrored[3];
    testSymmetries<std::uint8_t>(check, perspective, mirrored);
    testSymmetries<std::int16_t>(check, perspective, mirrored);
    testSymmetries<std::int32_t>(check, perspective, mirrored);
    testSymmetries<float>(check, perspective, mirrored);
    testSymmetries<double>(check, perspective, mirrored);
    for (const Sightings& pictures : mirrored)
    {
      check(pictures.areEnough(0.3), "nearly all pixels have a mirror image in only ", pictures);
    }
  }
  testMonotoneMap(check);
  testAffineMap(check);
  return check.exitCode();
}
