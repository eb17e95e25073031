// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Preview mode equals an exact voxel traversal along the same rays, bit for bit: every scalar type,
// 2500 views, half of them through edges and corners of voxels.
#include "CoreTesting.h"

using namespace coretesting;

namespace
{
template <class T>
void testViews(Checks& check)
{
  reference::forScenes(seriesOf<T>("previews"), 250,
    [&](int, reference::Random& random)
    {
      const reference::Volume<T> volume = volumeWithOddValues<T>(randomSize(random, 12), random);
      const splatting::View view = anyView(volume.size, random);
      const splatting::ShearWarp geometry(view);
      splatting::ProjectionSettings settings;
      settings.quality = splatting::Quality::Preview;
      settings.instructionSet = anyInstructionSet(random);
      const auto expected = reference::exactTraversal(volume, referenceView(geometry));
      const auto found = toReference<T>(project(volume, geometry, settings));
      check.same(expected, found, 0.0, "type ", int(splatting::scalarTypeOf<T>()),
        ": the preview is not the traversal; axis ", geometry.principalAxis(), ", shear ",
        geometry.shear().x, " ", geometry.shear().y, ", size ", volume.size[0], " ", volume.size[1],
        " ", volume.size[2]);
    });
}

/// Rows of a kilobyte or more, which along the second axis are read slice by slice.
template <class T>
void testLongRows(Checks& check)
{
  reference::forScenes(seriesOf<T>("long rows"), 6,
    [&](int, reference::Random& random)
    {
      const std::array<int, 3> size = { 1024 / static_cast<int>(sizeof(T)) + random.uniform(0, 40),
        random.uniform(6, 40), random.uniform(6, 40) };
      const auto volume = reference::uniformNoise<T>(size, random);
      const double shearX = random.uniform(-1.0, 1.0), shearY = random.uniform(-1.0, 1.0);
      const splatting::ShearWarp geometry(viewWithShear(size, 1, shearX, shearY));
      const auto expected = reference::exactTraversal(volume, referenceView(geometry));
      splatting::ProjectionSettings settings;
      settings.quality = splatting::Quality::Preview;
      settings.acceleration = splatting::Acceleration::Dense;
      for (splatting::InstructionSet set : instructionSets)
      {
        settings.instructionSet = set;
        check.same(expected, toReference<T>(project(volume, geometry, settings)), 0.0,
          "long rows, type ", int(splatting::scalarTypeOf<T>()), ", ", splatting::nameOf(set),
          ": the preview is not the traversal; shear ", geometry.shear().x, " ", geometry.shear().y,
          ", size ", size[0], " ", size[1], " ", size[2]);
      }
    });
}
}

int TestPreview(int, char*[])
{
  Checks check;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testViews<T>(check);
      testLongRows<T>(check);
    });
  // A volume of several bands and blocks of registers.
  reference::forScenes("large volumes", 12,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<std::uint8_t>({ 150, 70, 90 }, random);
      const splatting::ShearWarp geometry(anyView(volume.size, random));
      splatting::ProjectionSettings settings;
      settings.quality = splatting::Quality::Preview;
      check.same(reference::exactTraversal(volume, referenceView(geometry)),
        toReference<std::uint8_t>(project(volume, geometry, settings)), 0.0,
        "large volume: the preview is not the traversal");
    });
  return check.exitCode();
}
