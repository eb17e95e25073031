// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Perspective projections: two images have the same values at their common border, and pixels read
// only the voxels in their tables.
#include "CoreTesting.h"

#include "Splat/Sampling/PerspectiveFootprints.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace coretesting;
using splatting::Quality;

namespace
{
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
  const reference::ImageRays rays = referenceRays(image);
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
          "images that meet differ: ", describe(left), ", pixel ", a.u, " ", a.v, "; ",
          describe(right), ", pixel ", b.u, " ", b.v);
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
  Sightings meeting;
  forEachType(
    [&](auto* null) { testImagesThatMeet<std::remove_pointer_t<decltype(null)>>(check, meeting); });
  std::cout << "images share rays in " << meeting << std::endl;
  check(meeting.areEnough(0.1), "images share rays in only ", meeting);
  testVoxelsRead(check);
  return check.exitCode();
}
