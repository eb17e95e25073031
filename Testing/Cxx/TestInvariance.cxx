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

bool sameImage(const splatting::ShearImage& a, const splatting::ShearImage& b)
{
  return a.type == b.type && a.width == b.width && a.height == b.height && a.bytes == b.bytes;
}

/// One and five threads of each backend that VTK has; each instruction set.
template <class T>
void testThreadsAndInstructionSets(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  const auto volume = wholeRangeNoise<T>({ 83, 61, 47 }, seed);
  for (Quality quality : qualities)
  {
    const splatting::ShearWarp geometry(anyView(volume.size, random));
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
            check(sameImage(project(volume, geometry, settings), expected), backend, " with ",
              threads, " threads gives other bits, mode ", int(quality));
          });
      }
      vtkSMPTools::SetBackend(usual.c_str());
    }
    for (auto set : { splatting::InstructionSet::Baseline, splatting::InstructionSet::AVX2,
           splatting::InstructionSet::AVX512 })
    {
      settings.instructionSet = set;
      check(sameImage(project(volume, geometry, settings), expected), splatting::nameOf(set),
        " gives other bits, mode ", int(quality), ", type ", int(splatting::scalarTypeOf<T>()));
    }
  }
}

/// The view of a volume whose axes were permuted and reversed, so that it looks the same.
splatting::View transformedView(
  const splatting::View& view, const reference::AxisSymmetry& symmetry)
{
  splatting::View result = view;
  glm::dvec4 last = view.indexToClip[3];
  for (int a = 0; a < 3; ++a)
  {
    const int source = symmetry.axis[a];
    result.dimensions[a] = view.dimensions[source];
    result.indexToClip[a] = view.indexToClip[source] * double(symmetry.sign[a]);
    if (symmetry.sign[a] < 0)
    {
      last += view.indexToClip[source] * double(view.dimensions[source] - 1);
    }
  }
  result.indexToClip[3] = last;
  return result;
}

template <class P>
double largestDifference(const reference::Image<P>& a, const reference::Image<P>& b)
{
  if (a.width != b.width || a.height != b.height || a.hit != b.hit)
  {
    return 1e30;
  }
  double largest = 0.0;
  for (std::size_t p = 0; p < a.value.size(); ++p)
  {
    largest = std::max(largest, std::abs(double(a.value[p]) - double(b.value[p])));
  }
  return largest;
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
  forEachType([&](auto* null)
    { testThreadsAndInstructionSets<std::remove_pointer_t<decltype(null)>>(check, ++seed); });
  testSymmetries<std::uint8_t>(check, 1);
  testSymmetries<std::int16_t>(check, 2);
  testSymmetries<float>(check, 3);
  testSymmetries<double>(check, 4);
  testMonotoneMap(check);
  testAffineMap(check);
  return check.result();
}
