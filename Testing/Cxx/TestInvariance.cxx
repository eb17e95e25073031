// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What must not change a picture: threads, instruction sets, the 48 symmetries of the axes; and the
// grey-level maps that commute with the projection.
#include "CoreTesting.h"

#include <vtkSMPTools.h>

#include <cmath>
#include <string>

using namespace coretesting;
using splatting::Quality;

namespace
{
const Quality qualities[] = { Quality::Preview, Quality::Standard, Quality::High };

/// One and five threads of each backend that VTK has; each instruction set.
template <class T>
void testThreadsAndInstructionSets(Checks& check, bool perspective, std::uint64_t seed)
{
  reference::Random random(seed);
  const auto volume = wholeRangeNoise<T>({ 83, 61, 47 }, seed);
  for (Quality quality : qualities)
  {
    const splatting::ShearWarp geometry = perspective
      ? randomPerspectiveImage(volume.size, random)
      : splatting::ShearWarp(anyView(volume.size, random));
    splatting::ProjectionSettings settings;
    settings.quality = quality;
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
              threads, " threads gives other bits, mode ", int(quality));
          });
      }
      vtkSMPTools::SetBackend(usual.c_str());
    }
    for (auto set : { splatting::InstructionSet::Baseline, splatting::InstructionSet::AVX2,
           splatting::InstructionSet::AVX512 })
    {
      settings.instructionSet = set;
      check(sameImages(project(volume, geometry, settings), expected), splatting::nameOf(set),
        " gives other bits, mode ", int(quality), ", type ", int(splatting::scalarTypeOf<T>()));
    }
  }
}

template <class T>
void testSymmetries(Checks& check, std::uint64_t seed)
{
  using A = splatting::Accumulator<T>;
  reference::Random random(seed);
  const auto volume = reference::uniformNoise<T>({ 13, 9, 11 }, seed, T(0), T(100));
  const splatting::View view = randomView(volume.size, random);
  const splatting::ShearWarp geometry(view);
  for (const reference::AxisSymmetry& symmetry : reference::allAxisSymmetries())
  {
    const auto mirrored = reference::transformed(volume, symmetry);
    const splatting::ShearWarp mirroredGeometry(transformedView(view, symmetry));
    for (Quality quality : qualities)
    {
      splatting::ProjectionSettings settings;
      settings.quality = quality;
      const splatting::ShearImage plain = project(volume, geometry, settings);
      const splatting::ShearImage other = project(mirrored, mirroredGeometry, settings);
      const reference::ShearView from = referenceView(geometry);
      if (quality == Quality::Preview)
      {
        check(sameBits(reference::transformed(toReference<T>(plain), from, symmetry),
                toReference<T>(other)),
          "a symmetry changes the preview");
      }
      else
      {
        // Weights are rounded, and summed in another order: both are within the bound of the exact
        // average.
        const double difference = largestDifference(
          reference::transformed(toReference<A>(plain), from, symmetry), toReference<A>(other));
        check(difference <= 2.0 * errorBound<T>(quality, 0.0, 100.0), "a symmetry changes mode ",
          int(quality), " by ", difference);
      }
    }
  }
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
    const reference::PerspectiveRays from = referenceRays(image), to = referenceRays(other);
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
void compare(const splatting::ShearImage& left, const splatting::ShearImage& right,
  const MirroredRays& rays, Comparison& result)
{
  const auto plain = toReference<P>(left), other = toReference<P>(right);
  for (int v = 0; v < plain.height; ++v)
  {
    for (int u = 0; u < plain.width; ++u)
    {
      const int x = rays.pixels[0][u], y = rays.pixels[1][v];
      result.all += plain.isHit(u, v);
      if (x >= 0 && y >= 0)
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

template <class T>
void testPerspectiveSymmetries(Checks& check, std::uint64_t seed)
{
  using A = splatting::Accumulator<T>;
  reference::Random random(seed);
  const auto volume = reference::uniformNoise<T>({ 13, 9, 11 }, seed, T(0), T(100));
  std::vector<splatting::ShearWarp> images, others;
  Comparison pictures[3];
  for (const reference::AxisSymmetry& symmetry : reference::allAxisSymmetries())
  {
    const splatting::View view = randomPerspective(volume.size, random);
    const auto mirrored = reference::transformed(volume, symmetry);
    splatting::ShearWarp::factorise(view, images);
    splatting::ShearWarp::factorise(transformedView(view, symmetry), others);
    check(images.size() == others.size(), "a symmetry changes the number of images");
    for (const splatting::ShearWarp& image : images)
    {
      for (const splatting::ShearWarp& other : others)
      {
        const int axis = other.principalAxis();
        const bool turned = symmetry.sign[axis] < 0;
        if (symmetry.axis[axis] != image.principalAxis() ||
          (image.reversed() != turned) != other.reversed())
        {
          continue;
        }
        const MirroredRays rays(image, other, symmetry);
        for (Quality quality : qualities)
        {
          splatting::ProjectionSettings settings;
          settings.quality = quality;
          const splatting::ShearImage plain = project(volume, image, settings);
          const splatting::ShearImage turnedPlain = project(mirrored, other, settings);
          Comparison result;
          double bound = 0.0;
          if (quality == Quality::Preview)
          {
            compare<T>(plain, turnedPlain, rays, result);
          }
          else
          {
            compare<A>(plain, turnedPlain, rays, result);
            bound = 2.0 *
              perspectiveErrorBound<T>(referenceRays(image),
                { quality == Quality::Standard ? reference::Kernel::Nearest
                                               : reference::Kernel::Trilinear,
                  1.0 },
                0.0, 100.0);
          }
          check(result.difference <= bound, "a symmetry changes mode ", int(quality), " by ",
            result.difference, ", not ", bound, ", axis ", image.principalAxis());
          pictures[int(quality)].common += result.common;
          pictures[int(quality)].all += result.all;
        }
      }
    }
  }
  for (const Comparison& picture : pictures)
  {
    check(picture.common > 1000 && picture.common > 0.95 * picture.all, "only ", picture.common,
      " pixels of ", picture.all, " have a mirror image");
  }
}

/// Monotone maps commute with the preview, bit for bit.
void testMonotoneMap(Checks& check)
{
  reference::Random random(21);
  const auto volume = wholeRangeNoise<std::uint8_t>({ 20, 15, 10 }, 4);
  const auto map = [](std::uint8_t x) { return static_cast<std::uint8_t>(std::sqrt(x * 255.0)); };
  auto mapped = volume;
  for (auto& voxel : mapped.voxels)
  {
    voxel = map(voxel);
  }
  splatting::ProjectionSettings settings;
  settings.quality = Quality::Preview;
  for (int n = 0; n < 20; ++n)
  {
    const splatting::ShearWarp geometry(anyView(volume.size, random));
    auto before = toReference<std::uint8_t>(project(volume, geometry, settings));
    for (auto& pixel : before.value)
    {
      pixel = map(pixel);
    }
    check(sameBits(before, toReference<std::uint8_t>(project(mapped, geometry, settings))),
      "a monotone map does not commute with the preview");
  }
}

/// Increasing affine maps commute with all modes, up to rounding.
void testAffineMap(Checks& check)
{
  reference::Random random(22);
  const auto volume = reference::uniformNoise<float>({ 20, 15, 10 }, 4, -1.0f, 1.0f);
  auto mapped = volume;
  for (auto& voxel : mapped.voxels)
  {
    voxel = 8.0f * voxel - 64.0f; // exact in float but for the last bits
  }
  for (Quality quality : qualities)
  {
    splatting::ProjectionSettings settings;
    settings.quality = quality;
    const splatting::ShearWarp geometry(anyView(volume.size, random));
    auto before = toReference<float>(project(volume, geometry, settings));
    const auto after = toReference<float>(project(mapped, geometry, settings));
    for (std::size_t p = 0; p < before.value.size(); ++p)
    {
      before.value[p] = before.hit[p] ? 8.0f * before.value[p] - 64.0f : 0.0f;
    }
    const double bound = 2.0 * errorBound<float>(quality, -72.0, -56.0) + 72 * 0x1p-23;
    check(largestDifference(before, after) <= bound, "an affine map does not commute with mode ",
      int(quality), ": ", largestDifference(before, after));
  }
}
}

int TestInvariance(int, char*[])
{
  Checks check;
  std::uint64_t seed = 60;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testThreadsAndInstructionSets<T>(check, false, ++seed);
      testThreadsAndInstructionSets<T>(check, true, seed);
    });
  testSymmetries<std::uint8_t>(check, 1);
  testSymmetries<std::int16_t>(check, 2);
  testSymmetries<float>(check, 3);
  testSymmetries<double>(check, 4);
  testPerspectiveSymmetries<std::uint8_t>(check, 5);
  testPerspectiveSymmetries<std::int32_t>(check, 6);
  testPerspectiveSymmetries<float>(check, 7);
  testMonotoneMap(check);
  testAffineMap(check);
  return check.result();
}
