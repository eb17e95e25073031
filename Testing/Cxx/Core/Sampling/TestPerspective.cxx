// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projections along the rays of an eye. Preview mode equals the exact traversal bit for bit,
// standard and high mode the averages of parts within their rounding; where the images of two axes
// meet they show the same.
#include "AverageTesting.h"
#include "CoreTesting.h"

#include "Sampling/PerspectiveFootprints.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace coretesting;
using splatting::Acceleration;
using splatting::Quality;

namespace
{
/// What a view is, for messages.
std::string nameOf(const splatting::ShearWarp& image)
{
  const glm::dvec3& eye = image.eye();
  return "axis " + std::to_string(image.principalAxis()) + (image.reversed() ? " reversed" : "") +
    ", size " + std::to_string(image.size().x) + " " + std::to_string(image.size().y) + " " +
    std::to_string(image.size().z) + ", eye " + std::to_string(eye.x) + " " +
    std::to_string(eye.y) + " " + std::to_string(eye.z);
}

template <class T>
void testPreviewOf(Checks& check, const reference::Volume<T>& volume,
  const splatting::ShearWarp& image, reference::Random& random, int& hits)
{
  splatting::ProjectionSettings settings;
  settings.quality = Quality::Preview;
  settings.instructionSet = anyInstructionSet(random);
  settings.acceleration = anyAcceleration(random);
  const auto expected = reference::exactTraversal(volume, referenceRays(image));
  auto found = toReference<T>(project(volume, image, settings));
  forgetGrazes(
    image, [&](int u, int v) { return expected.isHit(u, v); }, found);
  hits += static_cast<int>(std::count(expected.hit.begin(), expected.hit.end(), 1));
  check.same(expected, found, 0.0, "type ", int(splatting::scalarTypeOf<T>()),
    ": the preview is not the traversal; ", nameOf(image), ", instruction set ",
    splatting::nameOf(settings.instructionSet), ", acceleration ", int(settings.acceleration));
}

template <class T>
void testPreviews(Checks& check, Sightings& seen)
{
  reference::forScenes(seriesOf<T>("previews"), 150,
    [&](int n, reference::Random& random)
    {
      const int largest = n % 8 == 0 ? 40 : n % 2 ? 12 : 4;
      const auto volume = volumeWithOddValues<T>(randomSize(random, largest), random);
      const splatting::View view = randomPerspective(volume.size, random);
      std::vector<splatting::ShearWarp> images;
      splatting::ShearWarp::factorise(view, images);
      int hits = 0;
      for (const splatting::ShearWarp& image : images)
      {
        testPreviewOf(check, volume, image, random, hits);
      }
      seen.add(hits > 0);
    });
}

/// Volumes of several bands, blocks of registers and bricks.
template <class T>
void testLargePreviews(Checks& check)
{
  reference::forScenes(seriesOf<T>("large previews"), 4,
    [&](int, reference::Random& random)
    {
      const auto volume = reference::uniformNoise<T>({ 150, 70, 90 }, random);
      std::vector<splatting::ShearWarp> images;
      splatting::ShearWarp::factorise(randomPerspective(volume.size, random), images);
      int hits = 0;
      for (const splatting::ShearWarp& image : images)
      {
        testPreviewOf(check, volume, image, random, hits);
      }
    });
}

/// The oracle's picture in standard or high mode.
reference::Image<double> averagePicture(const reference::Volume<double>& volume,
  const splatting::ShearWarp& image, const reference::Kernel& kernel)
{
  const reference::PerspectiveRays rays = referenceRays(image);
  return reference::maximumOf(
    reference::slabSamples(volume, rays, kernel), rays.width(), rays.height());
}

template <class T>
void testAverages(Checks& check)
{
  using A = splatting::Accumulator<T>;
  double worst = 0.0;
  reference::forScenes(seriesOf<T>("averages"), 60,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const auto volume = reference::uniformNoise<T>(randomSize(random, n % 3 ? 7 : 20), random);
      const splatting::ShearWarp image = randomPerspectiveImage(volume.size, random);
      const double low = double(*std::min_element(volume.voxels.begin(), volume.voxels.end()));
      const double high = double(*std::max_element(volume.voxels.begin(), volume.voxels.end()));
      // The reference itself is good to some rounding errors of double.
      const double bound =
        perspectiveErrorBound<T>(referenceRays(image), mode.reference, low, high) +
        2e-13 * std::max(std::abs(low), std::abs(high)) + 1e-300;
      splatting::ProjectionSettings settings = settingsOf(mode);
      settings.instructionSet = anyInstructionSet(random);
      settings.acceleration = anyAcceleration(random);
      const auto expected = averagePicture(reference::toDouble(volume), image, mode.reference);
      auto found = reference::toDouble(toReference<A>(project(volume, image, settings)));
      forgetGrazes(
        image, [&](int u, int v) { return expected.isHit(u, v); }, found);
      const double error = largestDifference(expected, found) / bound;
      worst = std::max(worst, error);
      check.same(expected, found, bound, "type ", int(splatting::scalarTypeOf<T>()), ", mode ",
        int(mode.quality), ", kernel ", int(mode.kernel.shape), " ", mode.kernel.radius,
        ": error of ", error, " bounds; ", nameOf(image));
    });
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ": largest error " << worst
            << " of the bound" << std::endl;
}

/// NaN voxels are left out.
void testNaN(Checks& check)
{
  reference::forScenes("NaN", 45,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const int share = 1 + n % 9; // out of ten
      auto volume = reference::uniformNoise<double>(randomSize(random, 6), random);
      reference::Random many = random.fork();
      for (double& voxel : volume.voxels)
      {
        voxel = many.chance(share / 10.0) ? std::numeric_limits<double>::quiet_NaN() : voxel;
      }
      const splatting::ShearWarp image = randomPerspectiveImage(volume.size, random);
      const reference::PerspectiveRays rays = referenceRays(image);
      const auto samples = reference::slabSamples(volume, rays, mode.reference);
      const double bound = perspectiveErrorBound<double>(rays, mode.reference, -1.0, 1.0);
      auto found = toReference<double>(project(volume, image, settingsOf(mode)));
      forgetGrazes(
        image, [&](int u, int v) { return !samples[std::size_t(v) * rays.width() + u].empty(); },
        found);
      compareWithNaN(check, samples, found, bound,
        "mode " + std::to_string(int(mode.quality)) + ", " + nameOf(image));
    });
}

template <class T>
void testConstant(Checks& check)
{
  using A = splatting::Accumulator<T>;
  using Limits = std::numeric_limits<T>;
  reference::forScenes(seriesOf<T>("constant volumes"), 20,
    [&](int n, reference::Random& random)
    {
      const Mode mode = modes()[n % 5];
      const T value = random.uniform<T>(Limits::lowest() / 2, Limits::max() / 2);
      const reference::Volume<T> volume(randomSize(random, 30), value);
      const splatting::ShearWarp image = randomPerspectiveImage(volume.size, random);
      const auto found = toReference<A>(project(volume, image, settingsOf(mode)));
      for (std::size_t p = 0; p < found.value.size(); ++p)
      {
        check(!found.hit[p] || found.value[p] == static_cast<A>(value), "a constant volume of ",
          double(value), " is ", double(found.value[p]), ", mode ", int(mode.quality));
      }
    });
}

/// Weights that add up to more than one would show in plateaus.
template <class T>
void testNeverAbove(Checks& check)
{
  using A = splatting::Accumulator<T>;
  reference::forScenes(seriesOf<T>("plateaus"), 5,
    [&](int, reference::Random& random)
    {
      const Mode mode = modes()[random.uniform(0, 4)];
      reference::Volume<T> volume(randomSize(random, 30), T(101));
      reference::Random many = random.fork();
      for (T& voxel : volume.voxels)
      {
        voxel = !many.oneIn(100) ? voxel : T(many.uniform(0, 100));
      }
      const splatting::ShearWarp image = randomPerspectiveImage(volume.size, random);
      const auto found = toReference<A>(project(volume, image, settingsOf(mode)));
      const A largest = *std::max_element(found.value.begin(), found.value.end());
      check(largest <= A(101), "a pixel is above all voxels by ", double(largest) - 101.0,
        ", mode ", int(mode.quality));
    });
}

/// A view of a cube from a point, of 120 degrees.
splatting::View wideView(int size, const glm::dvec3& eye, const glm::dvec3& direction)
{
  splatting::View view;
  view.dimensions = { size, size, size };
  view.viewport = { 100, 100 };
  view.indexToClip = glm::perspective(glm::radians(120.0), 1.0, 0.1, 1000.0) *
    glm::lookAt(eye, eye + direction, glm::dvec3(0.1, 0.2, 0.9));
  return view;
}

/// What pixels read of some slices is from the first to the last voxel of all of them.
void compareVoxels(Checks& check, const splatting::AxisFootprints<float>& footprints, int parts,
  const splatting::Span& slices, const splatting::Span& pixels)
{
  splatting::Span read{ std::numeric_limits<int>::max(), std::numeric_limits<int>::min() };
  for (int k = slices.begin; k < slices.end; ++k)
  {
    for (int q = 0; q < parts; ++q)
    {
      const auto part = footprints.part(k, q);
      for (int p = pixels.begin; p < pixels.end; ++p)
      {
        read.begin = std::min(read.begin, part.first[p]);
        read.end = std::max(read.end, part.first[p] + part.taps);
      }
    }
  }
  const splatting::Span voxels = footprints.voxels(slices, pixels);
  check(voxels.begin <= read.begin && voxels.end >= read.end, "pixels ", pixels.begin, " to ",
    pixels.end, " of slices ", slices.begin, " to ", slices.end, " read voxels ", read.begin,
    " to ", read.end, ", not ", voxels.begin, " to ", voxels.end);
}

/// An eye in the volume, of whose nearest slice all pixels on one side read from the same place on:
/// the pixels' points are as much wider there as rays are farther apart. The place is between two
/// voxels as nearly as eyes, which are multiples of 2^-10, allow; false if that is not near.
bool placeAtVoxelEnd(
  splatting::View& view, const splatting::Kernel& kernel, reference::Random& random)
{
  const int size = random.uniform(4, 24);
  const glm::dvec3 direction = anyVector(random, -1.0, 1.0);
  glm::dvec3 eye = glm::round(0x1p10 * anyVector(random, 1.0, size - 2.0)) * 0x1p-10;
  std::vector<splatting::ShearWarp> images;
  splatting::ShearWarp::factorise(wideView(size, eye, direction), images);
  if (images.empty())
  {
    return false;
  }
  const splatting::ShearWarp& image = images.front();
  const int k = image.reversed() ? image.slices().end - 1 : image.slices().begin;
  const glm::dvec2 faces = image.faces(k);
  const double middle = 0.5 * (faces.y - faces.x) / splatting::partsOf(image, kernel);
  const double pitch = image.pitch() * middle / std::abs(image.reference() - image.eye().z);
  const double place = kernel.support() + 0.5 * pitch;
  for (int a = 0; a < 2; ++a)
  {
    double& at = eye[image.axes()[a]];
    at = std::floor(at) + std::round(0x1p10 * place) * 0x1p-10;
  }
  view = wideView(size, eye, direction);
  return std::abs(place - std::round(0x1p10 * place) * 0x1p-10) < 0x1p-21;
}

/// Rounding decides which voxel pixels read first; then these do not ascend from pixel to pixel.
void testVoxelsRead(Checks& check)
{
  Sightings descending;
  reference::forScenes("voxels read", 60,
    [&](int n, reference::Random& random)
    {
      const splatting::Kernel kernel{ static_cast<splatting::Reconstruction>(n % 3) };
      splatting::View view;
      while (!placeAtVoxelEnd(view, kernel, random)) // one in about 80 is
      {
      }
      const splatting::Kernels& kernels = splatting::kernelsFor(anyInstructionSet(random));
      std::vector<splatting::ShearWarp> images;
      splatting::ShearWarp::factorise(view, images);
      bool descends = false;
      for (const splatting::ShearWarp& image : images)
      {
        splatting::PerspectiveFootprints<float> footprints;
        footprints.find(image, image, kernel, kernels);
        for (int a = 0; a < 2; ++a)
        {
          const auto& own = a == 0 ? footprints.columns : footprints.rows;
          const int count = image.rayCount()[a];
          for (int k = image.slices().begin; k < image.slices().end; ++k)
          {
            for (int p = 0; p < count; ++p)
            {
              const int end = random.uniform(p, count - 1) + 1;
              compareVoxels(check, own, footprints.parts, { k, k + 1 }, { p, end });
            }
            for (int q = 0; q < footprints.parts; ++q)
            {
              const std::int32_t* const voxels = own.part(k, q).first;
              descends = descends || !std::is_sorted(voxels, voxels + count);
            }
          }
        }
      }
      descending.add(descends);
    });
  std::cout << "voxels read: they descend in " << descending << std::endl;
  check(descending.areEnough(0.1), "voxels that pixels read descend in only ", descending);
}

/// The direction of a ray, to be compared exactly, and its pixel.
struct BorderRay
{
  std::array<double, 3> direction;
  int u, v;
};

/// The rays of an image that run half-way to another axis and direction.
std::vector<BorderRay> borderRays(const splatting::ShearWarp& image, int axis, double direction)
{
  const reference::PerspectiveRays rays = referenceRays(image);
  const double along = image.reversed() ? -1.0 : 1.0;
  std::vector<BorderRay> border;
  for (int v = 0; v < rays.height(); ++v)
  {
    for (int u = 0; u < rays.width(); ++u)
    {
      BorderRay ray{ {}, u, v };
      ray.direction[rays.axes[0]] = along * rays.slope[0][u];
      ray.direction[rays.axes[1]] = along * rays.slope[1][v];
      ray.direction[rays.axes[2]] = along;
      if (ray.direction[axis] == direction)
      {
        border.push_back(ray);
      }
    }
  }
  return border;
}

/// Compares the pixels of rays that two images have in common; returns their number.
template <class T>
int compareBorders(Checks& check, const reference::Volume<T>& volume,
  const splatting::ShearWarp& left, const splatting::ShearWarp& right)
{
  splatting::ProjectionSettings settings;
  settings.quality = Quality::Preview;
  const auto one = toReference<T>(project(volume, left, settings));
  const auto other = toReference<T>(project(volume, right, settings));
  int compared = 0;
  for (const BorderRay& a : borderRays(left, right.principalAxis(), right.reversed() ? -1.0 : 1.0))
  {
    for (const BorderRay& b : borderRays(right, left.principalAxis(), left.reversed() ? -1.0 : 1.0))
    {
      if (a.direction == b.direction)
      {
        check(
          one.isHit(a.u, a.v) == other.isHit(b.u, b.v) && one.at(a.u, a.v) == other.at(b.u, b.v),
          "images that meet differ: ", nameOf(left), ", pixel ", a.u, " ", a.v, "; ", nameOf(right),
          ", pixel ", b.u, " ", b.v);
        compared += one.isHit(a.u, a.v);
      }
    }
  }
  return compared;
}

/// From a diagonal of a cube, and from its centre, the images of different axes have the same
/// pitch: they share the rays where they meet, and what these show.
template <class T>
void testImagesThatMeet(Checks& check, Sightings& meeting)
{
  reference::forScenes(seriesOf<T>("images that meet"), 60,
    [&](int n, reference::Random& random)
    {
      std::vector<splatting::ShearWarp> images;
      int compared = 0;
      const int size = random.uniform(1, 30);
      const auto volume = reference::uniformNoise<T>({ size, size, size }, random);
      // On one of the four diagonals; eyes are multiples of 2^-10.
      const double distance =
        n % 3 ? std::round(0x1p10 * random.uniform(0.0, 1.5) * size) * 0x1p-10 : 0.0;
      glm::dvec3 eye, direction;
      for (int a = 0; a < 3; ++a)
      {
        const double side = random.sign();
        eye[a] = 0.5 * (size - 1) + side * distance;
        direction[a] = random.uniform(-0.5, 0.5) - side;
      }
      splatting::ShearWarp::factorise(wideView(size, eye, direction), images);
      for (std::size_t left = 0; left < images.size(); ++left)
      {
        for (std::size_t right = left + 1; right < images.size(); ++right)
        {
          if (images[left].pitch() == images[right].pitch())
          {
            compared += compareBorders(check, volume, images[left], images[right]);
          }
        }
      }
      meeting.add(compared > 0);
    });
}
}

int TestPerspective(int, char*[])
{
  Checks check;
  Sightings seen, meeting;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testPreviews<T>(check, seen);
      testAverages<T>(check);
      testConstant<T>(check);
      testNeverAbove<T>(check);
      testImagesThatMeet<T>(check, meeting);
    });
  std::cout << "previews show the volume in " << seen << ", images share rays in " << meeting
            << std::endl;
  check(seen.areEnough(0.3), "previews show the volume in only ", seen);
  check(meeting.areEnough(0.1), "images share rays in only ", meeting);
  testLargePreviews<std::uint8_t>(check);
  testLargePreviews<std::int16_t>(check);
  testLargePreviews<double>(check);
  testVoxelsRead(check);
  testNaN(check);
  return check.exitCode();
}
