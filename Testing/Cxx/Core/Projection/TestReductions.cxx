// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of the samples along rays equals its definition, sample by sample: five reductions,
// three modes, every scalar type, views of both projections, half-spaces, cropping and NaN. Memory,
// accelerations, instruction sets and threads do not change a bit.
#include "ReductionTesting.h"

#include <iostream>

using namespace reductiontesting;

namespace
{
/// From either side of the volume, now and then with a matrix of negative w.
splatting::View viewFromAnySide(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::View view = anyView(size, random);
  const double side = random.sign();
  const double w = !random.oneIn(8) ? 1.0 : -1.0;
  for (int c = 0; c < 4; ++c)
  {
    view.indexToClip[c] *= w;
    view.indexToClip[c][2] *= side;
  }
  return view;
}

/// Whether the highest slice is nearest to the viewer: clip depth falls along +k of the ray.
bool isReversed(const splatting::View& view, const splatting::ShearWarp& geometry)
{
  glm::dvec4 ray(0.0);
  ray[geometry.axes()[0]] = -geometry.shear().x;
  ray[geometry.axes()[1]] = -geometry.shear().y;
  ray[geometry.axes()[2]] = 1.0;
  return (view.indexToClip * ray).z / view.indexToClip[3][3] < 0.0;
}

Case caseOf(const splatting::View& view)
{
  Case c;
  c.geometry = splatting::ShearWarp(view);
  c.reversed = isReversed(view, c.geometry);
  return c;
}

/// Of a view from any side.
Case randomCase(
  Checks& check, const std::array<int, 3>& size, bool perspective, reference::Random& random)
{
  if (perspective)
  {
    Case c;
    c.geometry = randomPerspectiveImage(size, random);
    c.reversed = c.geometry.reversed();
    return c;
  }
  const splatting::View view = viewFromAnySide(size, random);
  const Case c = caseOf(view);
  check(c.geometry.reversed() == c.reversed, "the viewer is on another side");
  return c;
}

template <class T>
void testType(Checks& check, bool perspective, Comparisons& comparisons)
{
  reference::forScenes(seriesOf<T>(nameOf("previews", perspective)), 80,
    [&](int, reference::Random& random)
    {
      const auto volume = randomVolume<T>(random, 12, Quality::Preview);
      testReductions(check, volume, volume, randomCase(check, volume.size, perspective, random),
        Quality::Preview, random, comparisons);
    });
  reference::forScenes(seriesOf<T>(nameOf("averages", perspective)), perspective ? 40 : 24,
    [&](int n, reference::Random& random)
    {
      const Quality quality = n % 2 ? Quality::Standard : Quality::High;
      const auto volume = randomVolume<T>(random, 6, quality);
      testReductions(check, volume, reference::toDouble(volume),
        randomCase(check, volume.size, perspective, random), quality, random, comparisons);
    });
}

/// Volumes of several bands, blocks of registers and bricks; threads.
template <class T>
void testLarge(Checks& check, bool perspective)
{
  reference::forScenes(seriesOf<T>(nameOf("large volumes", perspective)), 4,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>({ 75, 50, 41 }, random);
      Case c;
      if (perspective)
      {
        c = randomCase(check, volume.size, true, random);
      }
      else
      {
        // From both sides along the first axis, too, where slices may be transposed.
        const int axis = random.uniform(0, 2);
        const double shearX = random.uniform(-1.0, 1.0), shearY = random.uniform(-1.0, 1.0);
        splatting::View view = viewWithShear(volume.size, axis, shearX, shearY);
        view.indexToClip[axis][2] *= random.sign();
        c = caseOf(view);
      }
      c.cuts = anyCuts(volume.size, random);
      testLargeVolume(check, volume, c, random);
    });
}

/// What holds between pictures.
void testRelations(Checks& check)
{
  Sightings differ[5];
  reference::forScenes("relations", 30,
    [&](int n, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<std::int16_t>(randomSize(random, 9), random);
      splatting::View view = viewFromAnySide(volume.size, random);
      Case c = caseOf(view);
      c.settings.quality = static_cast<Quality>(n % 3);
      for (int column = 0; column < 4; ++column)
      {
        view.indexToClip[column][2] *= -1.0;
      }
      Case far = caseOf(view);
      for (Reduction reduction : reductions)
      {
        c.settings.reduction = far.settings.reduction = reduction;
        far.settings.quality = c.settings.quality;
        const bool isSame = sameImages(projected(volume, c), projected(volume, far));
        differ[int(reduction)].add(!isSame);
        check(isSame || reduction == Reduction::DepthShaded || reduction == Reduction::Local,
          "the far side has another maximum, minimum or mean");
      }
      c.settings.reduction = Reduction::Maximum;
      const splatting::ShearImage maximum = projected(volume, c);
      c.settings.reduction = Reduction::Local;
      c.settings.threshold = 1e9;
      check(sameImages(projected(volume, c), maximum), "no local maximum, and not the maximum");
      auto negative = volume;
      for (auto& voxel : negative.voxels)
      {
        voxel = static_cast<std::int16_t>(~voxel); // -1 - voxel
      }
      c.settings.quality = Quality::Preview;
      c.settings.reduction = Reduction::Maximum;
      auto negated = toReference<std::int16_t>(projected(negative, c));
      for (std::size_t p = 0; p < negated.value.size(); ++p)
      {
        negated.value[p] = static_cast<std::int16_t>(negated.hit[p] ? ~negated.value[p] : 0);
      }
      c.settings.reduction = Reduction::Minimum;
      check.same(toReference<std::int16_t>(projected(volume, c)), negated, 0.0,
        "the minimum is not the negative's maximum");
    });
  const Sightings& shades = differ[int(Reduction::DepthShaded)];
  const Sightings& hills = differ[int(Reduction::Local)];
  check(shades.areEnough(0.4) && hills.areEnough(0.2),
    "the far side has other depth shades in only ", shades, ", other local maxima in ", hills);
}
}

int TestReductions(int, char*[])
{
  Checks check;
  for (bool perspective : { false, true })
  {
    Comparisons comparisons;
    forEachType([&](auto* null)
      { testType<std::remove_pointer_t<decltype(null)>>(check, perspective, comparisons); });
    comparisons.judge(check);
    testLarge<std::uint8_t>(check, perspective);
    testLarge<std::int32_t>(check, perspective);
    testLarge<float>(check, perspective);
  }
  testRelations(check);
  return check.exitCode();
}
