// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact maxima of random scenes at every pixel: all voxel types, views from anywhere, volumes of
 * one voxel along axes, scalars of cells.
 */
#include "CellViews.h"

namespace
{
using namespace celltesting;

template <class T>
void testNoise(Checks& check)
{
  forFamily<T>("noise", 400, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      std::array<int, 3> size = coretesting::randomSize(random, 14);
      scene.volume = reference::uniformNoise<T>(size, random);
      scene.view = randomCellView(size, 150, random);
      scene.view.showsBoxes = random.oneIn(3);
      counts.add(compareScene(scene, check));
    });
}
}

int TestCells(int, char*[])
{
  Checks check;
  coretesting::forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testNoise<T>(check);
    });
  return check.exitCode();
}
