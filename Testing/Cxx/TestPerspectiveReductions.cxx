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
void testType(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  Count preview[5], averages[5];
  for (int n = 0; n < 80; ++n)
  {
    const auto volume = randomVolume<T>(random, 12, Quality::Preview);
    testReductions(
      check, volume, volume, randomCase(volume.size, random), Quality::Preview, random, preview);
  }
  for (int n = 0; n < 40; ++n)
  {
    const Quality quality = n % 2 ? Quality::Standard : Quality::High;
    const auto volume = randomVolume<T>(random, 6, quality);
    testReductions(check, volume, reference::toDouble(volume), randomCase(volume.size, random),
      quality, random, averages);
  }
  judgeCounts<T>(check, preview, averages);
}

/// Volumes of several bands, blocks of registers and bricks; threads.
template <class T>
void testLarge(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  const auto volume = wholeRangeNoise<T>({ 75, 50, 41 }, seed);
  for (int n = 0; n < 4; ++n)
  {
    Case c = randomCase(volume.size, random);
    c.cuts.halfSpaces = randomHalfSpaces(random, volume.size);
    if (n % 2)
    {
      cropAtRandom(random, volume.size, c.cuts);
    }
    testLargeVolume(check, volume, c, random);
  }
}
}

int TestPerspectiveReductions(int, char*[])
{
  Checks check;
  std::uint64_t seed = 1900;
  forEachType([&](auto* null) { testType<std::remove_pointer_t<decltype(null)>>(check, ++seed); });
  testLarge<std::uint8_t>(check, 1);
  testLarge<std::int32_t>(check, 2);
  testLarge<float>(check, 3);
  return check.result();
}
