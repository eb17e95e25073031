// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Preview mode equals an exact voxel traversal along the same rays, bit for bit: every scalar type,
// parallel views, half of them through edges and corners of voxels, and perspective views.
#include "CoreTesting.h"

#include <algorithm>

using namespace coretesting;

namespace
{
/// Compares all images of a view. Returns whether they show the volume.
template <class T>
bool comparePreviews(
  Checks& check, const reference::Volume<T>& volume, bool perspective, reference::Random& random)
{
  std::vector<splatting::ShearWarp> images;
  splatting::ShearWarp::factorise(
    perspective ? randomPerspective(volume.size, random) : anyView(volume.size, random), images);
  bool isSeen = false;
  for (const splatting::ShearWarp& image : images)
  {
    splatting::ProjectionSettings settings;
    settings.quality = splatting::Quality::Preview;
    settings.instructionSet = anyInstructionSet(random);
    settings.acceleration = anyAcceleration(random);
    const auto expected = reference::exactTraversal(volume, referenceRays(image));
    auto found = toReference<T>(project(volume, image, settings));
    forgetGrazes(
      image, [&](int u, int v) { return expected.isHit(u, v); }, found);
    isSeen = isSeen || std::count(expected.hit.begin(), expected.hit.end(), 1) > 0;
    check.same(expected, found, 0.0, "type ", int(splatting::scalarTypeOf<T>()),
      ": the preview is not the traversal; ", describe(image), ", instruction set ",
      splatting::nameOf(settings.instructionSet), ", acceleration ", int(settings.acceleration));
  }
  return isSeen;
}

template <class T>
void testViews(Checks& check, bool perspective, Sightings& seen)
{
  reference::forScenes(seriesOf<T>(nameOf("previews", perspective)), 250,
    [&](int n, reference::Random& random)
    {
      const int largest = perspective && n % 8 == 0 ? 40 : n % 2 ? 12 : 4;
      const auto volume = volumeWithOddValues<T>(randomSize(random, largest), random);
      seen.add(comparePreviews(check, volume, perspective, random));
    });
}

/// Volumes of several bands, blocks of registers and bricks.
template <class T>
void testLargeVolumes(Checks& check, bool perspective)
{
  reference::forScenes(seriesOf<T>(nameOf("large volumes", perspective)), 4,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>({ 150, 70, 90 }, random);
      comparePreviews(check, volume, perspective, random);
    });
}
}

int TestPreview(int, char*[])
{
  Checks check;
  for (bool perspective : { false, true })
  {
    Sightings seen;
    forEachType([&](auto* null)
      { testViews<std::remove_pointer_t<decltype(null)>>(check, perspective, seen); });
    std::cout << nameOf("previews", perspective) << " show the volume in " << seen << std::endl;
    check(seen.areEnough(0.3), nameOf("previews", perspective), " show the volume in only ", seen);
    testLargeVolumes<std::uint8_t>(check, perspective);
    testLargeVolumes<std::int16_t>(check, perspective);
    testLargeVolumes<double>(check, perspective);
  }
  return check.exitCode();
}
