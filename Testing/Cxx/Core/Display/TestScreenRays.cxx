// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What exact mode shows on the screen is the largest value that the field has on the pixel's own
// ray: to rounding at the rim of the field, and elsewhere where the four rays of the shear image
// that the pixel lies between have their maxima.
#include "ScreenRayOracle.h"
#include "WideViews.h"

#include <algorithm>
#include <iostream>
#include <string>

using namespace screenrays;

namespace
{
struct Worst
{
  double rim = 0.0, inside = 0.0; ///< beyond what is surely there, of the range
  double definition = 0.0;        ///< from what is beside winners, of the range
  long atRim = 0, within = 0, defined = 0;
  long kept = 0, ended = 0; ///< beside pixels of the shear image without a sample
};

/// Compares pixels of a picture; of fields with NaN those at the rim.
template <class T>
void comparePixels(Checks& check, const Scene<T>& scene, reference::Random& random, Worst& worst)
{
  const auto field = reference::toDouble(scene.volume);
  const glm::dvec2 range = rangeOfNumbers(field);
  const double low = range[0], high = range[1];
  const bool hasNaN = std::any_of(
    field.voxels.begin(), field.voxels.end(), [](double voxel) { return std::isnan(voxel); });
  const glm::dvec3 steps = stepsOf(field);
  const Shown<T> picture = pictureOf(scene, random);
  check(picture.isSameWithoutBricks, "bricks change what screen rays find");
  const bool perspective = !splatting::isParallel(scene.view);
  const double rounding = 4.0 * perspectiveExactBound<T>(low, high) + 1e-9 * (high - low);
  // The eye is rounded to 2^-10 voxels along each axis, slopes to 2^-24.
  const double turn =
    0x1p-24 * *std::max_element(scene.volume.size.begin(), scene.volume.size.end());
  const double exactly = (perspective ? 0x1p-10 : 0.0) + 2.0 * turn + 1e-8;
  for (int y = 0; y < scene.view.viewport.y; ++y)
  {
    for (int x = 0; x < scene.view.viewport.x; ++x)
    {
      const double shown = double(picture.pixels[std::size_t(y) * scene.view.viewport.x + x]);
      const ScreenRay ray = screenRay(scene.view, x, y);
      const Place place = placeOf(scene.images, ray, x, y);
      const double without = place == Inside ? lostOf(scene, picture, ray, x, y) : 0.5;
      if (std::abs(without - 0.5) > 1e-6)
      {
        check((shown == shown) == (without < 0.5), "pixel ", x, " ", y, " is ", shown, ", where ",
          without, " of it have no sample");
        (without < 0.5 ? worst.kept : worst.ended) += without > 0.0;
      }
      // Brute force takes its time: some of them.
      if (shown != shown || place == Unclear || (hasNaN && place == Inside) ||
        random.uniform(0, place == AtRim ? 3 : 31))
      {
        continue;
      }
      double pitch = 0.0;
      for (const splatting::ShearWarp& image : scene.images)
      {
        pitch = std::max(pitch, image.pitch() * (1.0 + 1e-9));
      }
      // The intervals are those of a ray beside the pixel's.
      const Ways ways{ exactly, scene.halfSpaces.empty() ? exactly : pitch };
      const Limits limits = hasNaN ? limitsWithNaN(scene, field, steps, ray, ways)
                                   : limitsOf(scene, field, steps, ray, ways);
      if (limits.low == -Infinite)
      {
        continue; // what is shown where a ray may have no sample is the warp's affair
      }
      // Inside, a ray of the image is within a pixel of this one. So it has the maximum but for
      // what the field changes by on that way, and where it has its own, this one has that but for
      // the same. Of cut rays it may have lost the maximum's slice.
      const double lost = place == AtRim ? 0.0
        : scene.halfSpaces.empty() && !scene.cropping.cuts()
        ? 2.0 * pitch * (steps[ray.line.axes[0]] + steps[ray.line.axes[1]])
        : high - low;
      const double above = shown - limits.high, below = limits.low - lost - shown;
      check(above <= rounding && below <= rounding, "pixel ", x, " ", y,
        place == AtRim ? " at the rim" : " inside", " is ", shown, ", not from ", limits.low,
        " to ", limits.high, ", axis ", ray.line.axes[2], ", slope ", ray.line.slope[0], " ",
        ray.line.slope[1]);
      (place == AtRim ? worst.rim : worst.inside) =
        std::max(place == AtRim ? worst.rim : worst.inside, std::max(above, below) / (high - low));
      ++(place == AtRim ? worst.atRim : worst.within);
      if (place == Inside && isCutClearly(scene, picture, ray, x, y))
      {
        const double change = exactly * (steps[ray.line.axes[0]] + steps[ray.line.axes[1]]);
        const double grown = besideWinners(scene, picture, field, ray, x, y, exactly);
        const double shrunk = besideWinners(scene, picture, field, ray, x, y, -exactly);
        const double most = std::max(grown, shrunk), least = std::min(grown, shrunk);
        const double error = std::max(shown - most, least - shown) - change;
        check(error <= rounding, "pixel ", x, " ", y, " is ", shown, ", not from ", least, " to ",
          most, " as beside winners");
        // Nothing is said to be at the eye itself: see Locator::pointAt().
        const double atEye = perspective ? 2e-6 * steps[ray.line.axes[2]] : 0.0;
        const double found = atLocation(scene, picture, field, x, y);
        check(std::abs(shown - found) <= rounding + change + atEye, "pixel ", x, " ", y, " is ",
          shown, ", but ", found, " where it is said to be");
        worst.definition = std::max(worst.definition, error / (high - low));
        ++worst.defined;
      }
    }
  }
}

/// Planes that the middle of some slice lies between.
splatting::Cropping anyCropping(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::Cropping cropping;
  for (int a = 0; a < 3; ++a)
  {
    cropping.planes[a][0] = random.uniform(0.0, 0.4 * size[a]);
    cropping.planes[a][1] = cropping.planes[a][0] + 1.01 + random.uniform(0.0, 0.5 * size[a]);
  }
  cropping.flags = static_cast<std::uint32_t>(random.bits()) & splatting::Cropping::All;
  return cropping;
}

/// Leaves few voxels above the lowest, so that bricks rule most of a ray out.
template <class T>
void thinOut(reference::Volume<T>& volume, reference::Random& random)
{
  const T lowest = *std::min_element(volume.voxels.begin(), volume.voxels.end());
  for (T& voxel : volume.voxels)
  {
    const bool isKept = random.uniform(0, 15) == 0;
    voxel = isKept ? voxel : lowest;
  }
}

/// A view and cuts of a volume of noise.
template <class T>
Scene<T> anyScene(const std::array<int, 3>& size, bool perspective, reference::Random& random)
{
  Scene<T> scene;
  scene.volume = wholeRangeNoise<T>(size, random);
  if (random.uniform(0, 1))
  {
    thinOut(scene.volume, random);
  }
  scene.view = magnified(perspective ? randomPerspective(size, random) : randomView(size, random));
  scene.view.showsBoxes = random.uniform(0, 2) == 0;
  if (random.uniform(0, 3) == 0)
  {
    scene.cropping = anyCropping(size, random);
  }
  if (random.uniform(0, 3) == 0)
  {
    const glm::dvec3 normal = anyVector(random, -1.0, 1.0);
    const glm::dvec3 point = anyVector(random, 0.0, 1.0) * glm::dvec3(toGlm(size) - 1);
    scene.halfSpaces.push_back({ normal, -glm::dot(normal, point) });
  }
  splatting::ShearWarp::factorise(scene.view, scene.images, anySampling(random));
  return scene;
}

/// The scene with some voxels hidden, which makes them NaN, in the type of averages.
template <class T>
Scene<splatting::Accumulator<T>> withHidden(const Scene<T>& from, reference::Random& random)
{
  return { coretesting::withHidden(from.volume, random), from.view, from.images, from.halfSpaces,
    from.cropping };
}

template <class T>
void testType(Checks& check, Sightings& seen, Sightings& seenWithNaN)
{
  Worst worst, worstWithNaN;
  reference::forScenes(seriesOf<T>("noise"), 40,
    [&](int n, reference::Random& random)
    {
      const auto size = randomSize(random, 12);
      const long before = worst.atRim;
      comparePixels(check, anyScene<T>(size, n % 2 == 1, random), random, worst);
      seen.add(worst.atRim > before);
    });
  reference::forScenes(seriesOf<T>("hidden voxels"), 40,
    [&](int n, reference::Random& random)
    {
      const auto size = randomSize(random, 12);
      const auto scene = withHidden(anyScene<T>(size, n % 2 == 1, random), random);
      const long before = worstWithNaN.atRim;
      comparePixels(check, scene, random, worstWithNaN);
      seenWithNaN.add(worstWithNaN.atRim > before);
    });
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ": " << worst.atRim
            << " pixels at the rim, " << worst.rim << " beyond; " << worst.within
            << " pixels inside, " << worst.inside << " beyond, " << worst.definition
            << " at most from what is beside winners in " << worst.defined
            << "; with hidden voxels " << worstWithNaN.atRim << " pixels at the rim, "
            << worstWithNaN.rim << " beyond; beside cuts and NaN " << worst.kept + worstWithNaN.kept
            << " shown, " << worst.ended + worstWithNaN.ended << " not" << std::endl;
}
}

int TestScreenRays(int, char*[])
{
  Checks check;
  Sightings seen, seenWithNaN;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testType<T>(check, seen, seenWithNaN);
    });
  check(seen.areEnough(0.4), "a rim is compared in only ", seen);
  check(seenWithNaN.areEnough(0.3), "a rim beside hidden voxels is compared in only ", seenWithNaN);
  std::cout << seenWithNaN << " with hidden voxels" << std::endl;
  return check.result();
}
