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

/// A pixel of a picture, and its ray.
struct Pixel
{
  int x, y;
  double shown;
  ScreenRay ray;
  Place place;
};

/// Compares pixels of a picture; of fields with NaN those at the rim.
template <class T>
class PictureComparison
{
public:
  /// All but the random numbers must outlive its use.
  PictureComparison(Checks& check, const Scene<T>& scene, reference::Random& random, Worst& worst)
    : Check(check),
      Source(scene),
      Results(worst),
      Field(reference::toDouble(scene.volume)),
      Steps(stepsOf(this->Field)),
      Picture(pictureOf(scene, random))
  {
    const glm::dvec2 range = rangeOfNumbers(this->Field);
    this->Low = range[0];
    this->High = range[1];
    this->HasNaN = std::any_of(this->Field.voxels.begin(), this->Field.voxels.end(),
      [](double voxel) { return std::isnan(voxel); });
    check(this->Picture.isSameWithoutBricks, "bricks change what screen rays find");
    this->Perspective = !splatting::isParallel(scene.view);
    this->Rounding =
      4.0 * perspectiveExactBound<T>(this->Low, this->High) + 1e-9 * (this->High - this->Low);
    // The eye is rounded to 2^-10 voxels along each axis, slopes to 2^-24.
    const double turn =
      0x1p-24 * *std::max_element(scene.volume.size.begin(), scene.volume.size.end());
    this->Exactly = (this->Perspective ? 0x1p-10 : 0.0) + 2.0 * turn + 1e-8;
    for (const splatting::ShearWarp& image : scene.images)
    {
      this->Pitch = std::max(this->Pitch, image.pitch() * (1.0 + 1e-9));
    }
  }

  void compare(int x, int y, reference::Random& random)
  {
    const int width = this->Source.view.viewport.x;
    const double shown = double(this->Picture.pixels[std::size_t(y) * width + x]);
    const ScreenRay ray = screenRay(this->Source.view, x, y);
    const Pixel pixel{ x, y, shown, ray, placeOf(this->Source.images, ray, x, y) };
    this->compareEnd(pixel);
    // Brute force takes its time: some of them.
    if (shown != shown || pixel.place == Unclear || (this->HasNaN && pixel.place == Inside) ||
      random.uniform(0, pixel.place == AtRim ? 3 : 31))
    {
      return;
    }
    if (this->compareValue(pixel) && pixel.place == Inside &&
      isCutClearly(this->Source, this->Picture, ray, x, y))
    {
      this->compareLocation(pixel);
    }
  }

private:
  /// Whether anything is shown where the picture ends beside rays without a sample.
  void compareEnd(const Pixel& pixel)
  {
    const double without = pixel.place == Inside
      ? lostOf(this->Source, this->Picture, pixel.ray, pixel.x, pixel.y)
      : 0.5;
    if (std::abs(without - 0.5) > 1e-6)
    {
      this->Check((pixel.shown == pixel.shown) == (without < 0.5), "pixel ", pixel.x, " ", pixel.y,
        " is ", pixel.shown, ", where ", without, " of it have no sample");
      (without < 0.5 ? this->Results.kept : this->Results.ended) += without > 0.0;
    }
  }

  /// With what the ray surely has, and with what it may have. Returns false if nothing is sure.
  bool compareValue(const Pixel& pixel)
  {
    const ScreenRay& ray = pixel.ray;
    // The intervals are those of a ray beside the pixel's.
    const Ways ways{ this->Exactly, this->Source.halfSpaces.empty() ? this->Exactly : this->Pitch };
    const Limits limits = this->HasNaN
      ? limitsWithNaN(this->Source, this->Field, this->Steps, ray, ways)
      : limitsOf(this->Source, this->Field, this->Steps, ray, ways);
    if (limits.low == -Infinite)
    {
      return false; // what is shown where a ray may have no sample is the warp's affair
    }
    const double above = pixel.shown - limits.high;
    const double below = limits.low - this->mayLose(pixel) - pixel.shown;
    const bool isAtRim = pixel.place == AtRim;
    this->Check(above <= this->Rounding && below <= this->Rounding, "pixel ", pixel.x, " ", pixel.y,
      isAtRim ? " at the rim" : " inside", " is ", pixel.shown, ", not from ", limits.low, " to ",
      limits.high, ", axis ", ray.line.axes[2], ", slope ", ray.line.slope[0], " ",
      ray.line.slope[1]);
    double& most = isAtRim ? this->Results.rim : this->Results.inside;
    most = std::max(most, std::max(above, below) / (this->High - this->Low));
    ++(isAtRim ? this->Results.atRim : this->Results.within);
    return true;
  }

  /// How much less than the ray has a pixel may show: at the rim nothing.
  double mayLose(const Pixel& pixel) const
  {
    // Inside, a ray of the image is within a pixel of this one. So it has the maximum but for what
    // the field changes by on that way, and where it has its own, this one has that but for the
    // same. Of cut rays it may have lost the maximum's slice.
    const auto& axes = pixel.ray.line.axes;
    return pixel.place == AtRim ? 0.0
      : this->Source.halfSpaces.empty() && !this->Source.cropping.cuts()
      ? 2.0 * this->Pitch * (this->Steps[axes[0]] + this->Steps[axes[1]])
      : this->High - this->Low;
  }

  /// With what the ray has beside winners, and with the field where the sample is said to be.
  void compareLocation(const Pixel& pixel)
  {
    const ScreenRay& ray = pixel.ray;
    const int x = pixel.x, y = pixel.y;
    const double change =
      this->Exactly * (this->Steps[ray.line.axes[0]] + this->Steps[ray.line.axes[1]]);
    const auto beside = [&](double more)
    { return besideWinners(this->Source, this->Picture, this->Field, ray, x, y, more); };
    const double grown = beside(this->Exactly), shrunk = beside(-this->Exactly);
    const double most = std::max(grown, shrunk), least = std::min(grown, shrunk);
    const double error = std::max(pixel.shown - most, least - pixel.shown) - change;
    this->Check(error <= this->Rounding, "pixel ", x, " ", y, " is ", pixel.shown, ", not from ",
      least, " to ", most, " as beside winners");
    // Nothing is said to be at the eye itself: see Locator::pointAt().
    const double atEye = this->Perspective ? 2e-6 * this->Steps[ray.line.axes[2]] : 0.0;
    const double found = atLocation(this->Source, this->Picture, this->Field, x, y);
    this->Check(std::abs(pixel.shown - found) <= this->Rounding + change + atEye, "pixel ", x, " ",
      y, " is ", pixel.shown, ", but ", found, " where it is said to be");
    this->Results.definition = std::max(this->Results.definition, error / (this->High - this->Low));
    ++this->Results.defined;
  }

  Checks& Check;
  const Scene<T>& Source;
  Worst& Results;
  const reference::Volume<double> Field;
  const glm::dvec3 Steps; // the most that neighbours along each axis differ by
  const Shown<T> Picture;
  double Low, High;
  bool HasNaN, Perspective;
  double Rounding;    // of values
  double Exactly;     // how far rays may be displaced
  double Pitch = 0.0; // the largest of all images
};

template <class T>
void comparePixels(Checks& check, const Scene<T>& scene, reference::Random& random, Worst& worst)
{
  PictureComparison<T> comparison(check, scene, random, worst);
  for (int y = 0; y < scene.view.viewport.y; ++y)
  {
    for (int x = 0; x < scene.view.viewport.x; ++x)
    {
      comparison.compare(x, y, random);
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
