// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What TestReductions shows of parallel views, in perspective ones: what becomes of the samples
// along rays equals its definition, and nothing else changes a bit.
#include "ReductionTesting.h"

#include <iostream>

using namespace reductiontesting;

namespace
{
Case randomCase(const std::array<int, 3>& size, reference::Random& random)
{
  Case c;
  c.geometry = randomPerspectiveImage(size, random);
  c.reversed = c.geometry.reversed();
  return c;
}

template <class T>
void testType(Checks& check, Comparisons& comparisons)
{
  reference::forScenes(seriesOf<T>("previews"), 80,
    [&](int, reference::Random& random)
    {
      const auto volume = randomVolume<T>(random, 12, Quality::Preview);
      testReductions(check, volume, volume, randomCase(volume.size, random), Quality::Preview,
        random, comparisons);
    });
  reference::forScenes(seriesOf<T>("averages"), 40,
    [&](int n, reference::Random& random)
    {
      const Quality quality = n % 2 ? Quality::Standard : Quality::High;
      const auto volume = randomVolume<T>(random, 6, quality);
      testReductions(check, volume, reference::toDouble(volume), randomCase(volume.size, random),
        quality, random, comparisons);
    });
}

/// Volumes of several bands, blocks of registers and bricks; threads.
template <class T>
void testLarge(Checks& check)
{
  reference::forScenes(seriesOf<T>("large volumes"), 4,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>({ 75, 50, 41 }, random);
      Case c = randomCase(volume.size, random);
      c.cuts = anyCuts(volume.size, random);
      testLargeVolume(check, volume, c, random);
    });
}
}

int TestPerspectiveReductions(int, char*[])
{
  Checks check;
  Comparisons comparisons;
  forEachType(
    [&](auto* null) { testType<std::remove_pointer_t<decltype(null)>>(check, comparisons); });
  comparisons.judge(check);
  testLarge<std::uint8_t>(check);
  testLarge<std::int32_t>(check);
  testLarge<float>(check);
  return check.exitCode();
}
