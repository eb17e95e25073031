// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The warp of perspective views: each pixel is what a slow, independent look-up in the image of its
// ray gives, images meet without seams, and every way gives the same bits.
#include "WarpTesting.h"
#include "WideViews.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <vector>

using namespace coretesting;

namespace
{
/// A perspective view as its matrix has it: the eye and the rays of pixels.
struct Camera
{
  glm::dvec3 x, y, w; // rows of the matrix
  glm::dvec3 eye;
  glm::dvec2 viewport;

  explicit Camera(const splatting::View& view) : viewport(view.viewport)
  {
    const glm::dmat4& m = view.indexToClip;
    for (int c = 0; c < 3; ++c)
    {
      this->x[c] = m[c][0];
      this->y[c] = m[c][1];
      this->w[c] = m[c][3];
    }
    // Where three planes meet.
    const glm::dvec3 yw = glm::cross(this->y, this->w), wx = glm::cross(this->w, this->x),
                     xy = glm::cross(this->x, this->y);
    this->eye = -(m[3][0] * yw + m[3][1] * wx + m[3][3] * xy) / glm::dot(this->x, yw);
  }
  /// Where neither pixel coordinate changes.
  glm::dvec3 direction(double px, double py) const
  {
    const glm::dvec2 clip = 2.0 * (glm::dvec2(px, py) + 0.5) / this->viewport - 1.0;
    const glm::dvec3 d =
      glm::normalize(glm::cross(this->x - clip.x * this->w, this->y - clip.y * this->w));
    return glm::dot(d, this->w) < 0.0 ? -d : d;
  }
};

/// Whether a ray meets the box that pictures show, enlarged by `margin` voxels.
bool meets(
  const splatting::View& view, const glm::dvec3& eye, const glm::dvec3& direction, double margin)
{
  reference::Stretch<double> ray{ 0.0 };
  ray.narrow(reference::inside(
    reference::boxOfVolume(view.dimensions, view.showsBoxes, margin), eye, direction));
  return ray.length() >= 0.0;
}

/// Whether a ray meets slices along an axis whose centre is in front of the eye. The slices are
/// reduced by a margin.
bool meetsSlices(const splatting::View& view, const glm::dvec3& eye, int axis, bool reversed,
  const glm::dvec3& direction, double margin)
{
  glm::dvec3 low(-0.5), high = glm::dvec3(view.dimensions) - 0.5;
  double& end = reversed ? high[axis] : low[axis];
  end = reversed ? std::min(end, std::ceil(eye[axis]) - 0.5)
                 : std::max(end, std::floor(eye[axis]) + 0.5);
  reference::Stretch<double> ray{ 0.0 };
  ray.narrow(
    reference::inside(reference::halfSpacesOfBox(low + margin, high - margin), eye, direction));
  return ray.length() >= 0.0;
}

/// The direction that an image's rays follow, axes permuted.
glm::dvec3 inImage(const splatting::ShearWarp& image, const glm::dvec3& direction)
{
  const auto& axes = image.axes();
  return { direction[axes[0]], direction[axes[1]],
    image.reversed() ? -direction[axes[2]] : direction[axes[2]] };
}

/// Of pixels: rays may belong to either image where that is what they are off the line between two.
/// Images are 3 pixels wide or more from slope -1 to 1.
constexpr double OnTheLine = 1e-8;

/// Whether a ray follows the image's axis most.
bool follows(const splatting::ShearWarp& image, const glm::dvec3& direction)
{
  const glm::dvec3 d = inImage(image, direction);
  return d.z * (1.0 + OnTheLine) >= std::max(std::abs(d.x), std::abs(d.y));
}

/// How many axes a ray follows most: more than one on the line between images.
int axesFollowed(const glm::dvec3& direction)
{
  const glm::dvec3 d = glm::abs(direction) * (1.0 + OnTheLine);
  const double most = std::max({ d.x, d.y, d.z }) / (1.0 + OnTheLine);
  return int(d.x >= most) + int(d.y >= most) + int(d.z >= most);
}

/// Where a ray lies between the columns and rows of an image, told by what these pass.
glm::dvec2 placeIn(const splatting::ShearWarp& image, const glm::dvec3& direction)
{
  const glm::dvec3 d = inImage(image, direction);
  const double far = std::abs(image.reference() - image.eye().z);
  const glm::dvec2 at = glm::dvec2(image.eye()) + far * glm::dvec2(d) / d.z;
  return (at - glm::dvec2(image.columns().at.front(), image.rows().at.front())) / image.pitch();
}

/// Columns and rows are rounded to 2^-20 of a voxel, the first one as well.
constexpr double Misplaced = 2.0 * 0x1p-20;
/// Interpolation and colours, of values in [0, 1].
constexpr double Rounded = 8.0 * 0x1p-24 + 1.0 / 65535;

/// The values that an image may have at p: interpolated between the four pixels around, or, where
/// some of them are no samples, anything between the others.
bool mayBe(const splatting::ShearImage& image, const glm::dvec2& p, double found)
{
  const glm::ivec2 last(image.width - 1, image.height - 1);
  const glm::ivec2 low = glm::clamp(glm::ivec2(glm::floor(p - Misplaced)), glm::ivec2(0), last);
  const glm::ivec2 high =
    glm::clamp(glm::ivec2(glm::floor(p + Misplaced)) + 1, glm::ivec2(0), last);
  double least = 1e30, greatest = -1e30;
  bool all = true;
  for (int v = low.y; v <= high.y; ++v)
  {
    for (int u = low.x; u <= high.x; ++u)
    {
      all = all && image.covers(u, v);
      if (image.covers(u, v))
      {
        least = std::min<double>(least, image.row<float>(v)[u]);
        greatest = std::max<double>(greatest, image.row<float>(v)[u]);
      }
    }
  }
  if (found < least - Rounded || found > greatest + Rounded)
  {
    return false;
  }
  double expected = 0.0;
  for (int v = low.y; all && v <= high.y; ++v)
  {
    for (int u = low.x; u <= high.x; ++u)
    {
      const double weight =
        std::max(0.0, 1.0 - std::abs(p.x - u)) * std::max(0.0, 1.0 - std::abs(p.y - v));
      expected += weight * image.row<float>(v)[u];
    }
  }
  // Neighbours differ by at most 1, along u and along v.
  return !all || std::abs(found - expected) <= 2.0 * Misplaced + Rounded;
}

struct PixelCounts
{
  int shown = 0, beside = 0;
};

void checkPerspectivePicture(Checks& check, const splatting::View& view,
  const std::vector<splatting::ShearWarp>& geometries,
  const std::vector<splatting::ShearImage>& images, const splatting::Picture& picture,
  PixelCounts& counts)
{
  const Camera camera(view);
  glm::dvec3 eye = camera.eye;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    for (int a = 0; a < 3; ++a)
    {
      eye[geometry.axes()[a]] = geometry.eye()[a]; // rounded
    }
  }
  check(glm::length(eye - camera.eye) <= 0x1p-10 + 1e-9 * glm::length(eye), "the eye has moved");
  for (int y = 0; y < view.viewport.y; ++y)
  {
    for (int x = 0; x < view.viewport.x; ++x)
    {
      const std::uint32_t color = colorAt(picture, x, y);
      const glm::dvec3 ray = camera.direction(x, y);
      constexpr double margin = 1e-6;
      counts.shown += color != 0;
      if (!meets(view, eye, ray, margin))
      {
        counts.beside += check(color == 0, "a pixel outside the volume has a colour");
        continue;
      }
      int axes = 0;
      bool crosses = true, matches = false;
      for (std::size_t n = 0; n < geometries.size(); ++n)
      {
        const splatting::ShearWarp& image = geometries[n];
        if (follows(image, ray))
        {
          // From within half a voxel of the rim a ray may leave before it comes to a slice.
          ++axes;
          crosses =
            crosses && meetsSlices(view, eye, image.principalAxis(), image.reversed(), ray, 1e-5);
          matches = matches || mayBe(images[n], placeIn(image, ray), (double(color) - 1.0) / 65535);
        }
      }
      check(color != 0 || axes < axesFollowed(ray) || !crosses || !meets(view, eye, ray, -margin),
        "a pixel inside the volume is transparent, ", x, ", ", y);
      check(color == 0 || matches, "a pixel has another colour than its ray, ", x, ", ", y);
    }
  }
}

std::vector<splatting::ShearImage> noiseImages(
  const std::vector<splatting::ShearWarp>& geometries, reference::Random& random)
{
  std::vector<splatting::ShearImage> images;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    images.push_back(imageOf(geometry, [&](int, int) { return random.uniform(0.0, 1.0); }));
  }
  return images;
}

void testPerspective(Checks& check)
{
  const splatting::ColorTable table = countingTable(0.0, 1.0);
  Sightings shown, beside, many;
  reference::forScenes("perspective", 500,
    [&](int n, reference::Random& random)
    {
      std::vector<splatting::ShearWarp> geometries;
      PixelCounts counts;
      auto size = randomSize(random, 30);
      if (n % 6 < 3)
      {
        size[n % 3] = 1;
      }
      splatting::View view = magnified(randomPerspective(size, random));
      view.showsBoxes = n % 4 == 0;
      splatting::ShearWarp::factorise(view, geometries);
      std::vector<splatting::ShearImage> images = noiseImages(geometries, random);
      images.resize(images.size() + random.uniform(0, 2)); // spare ones
      for (bool special : { false, true }) // where all pixels go the way of those near holes
      {
        for (splatting::ShearImage& image : images)
        {
          image.nonFinite = special;
        }
        const splatting::Picture picture =
          pictureOf(images, geometries, table, view.viewport, anyInstructionSet(random));
        checkPerspectivePicture(check, view, geometries, images, picture, counts);
      }

      shown.add(counts.shown > 0);
      beside.add(counts.beside > 0);
      many.add(geometries.size() >= 3);
    });
  std::cout << "perspective: the volume is shown in " << shown << ", pixels beside it in " << beside
            << ", three or more images in " << many << std::endl;
  check(shown.areEnough(0.3) && beside.areEnough(0.3) && many.areEnough(0.02),
    "the volume is shown in only ", shown, ", pixels beside it in ", beside,
    ", three or more images in ", many);
}

/// A view from a place in index space, its middle ray along `direction`. Along axes and between
/// two, rays of pixels have slopes of exactly 1: those of the 16th from the middle, and the middle.
splatting::View wideView(const std::array<int, 3>& size, const glm::dvec3& eye,
  const glm::dvec3& direction, const glm::dvec3& up, int pixels)
{
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { pixels, pixels };
  const double right = 0.1 * pixels / 32.0;
  view.indexToClip =
    glm::frustum(-right, right, -right, right, 0.1, 1000.0) * glm::lookAt(eye, eye + direction, up);
  return view;
}

/// A smooth function of a ray's direction.
struct SmoothFunction
{
  glm::dvec3 slope{ 0.11, -0.13, 0.17 };

  double at(const glm::dvec3& d) const { return 0.5 + glm::dot(this->slope, glm::normalize(d)); }
  /// How far it may be from what is interpolated between pixels that are such a step of slopes
  /// apart.
  double bound(double step) const
  {
    // Second derivatives of each component of a direction with regard to a slope are at most 1.
    return step * step / 4.0 *
      (std::abs(this->slope.x) + std::abs(this->slope.y) + std::abs(this->slope.z)) +
      Misplaced * step + Rounded;
  }
};

splatting::ShearImage smoothImage(const splatting::ShearWarp& geometry, const SmoothFunction& f)
{
  const auto atPixel = [&](int u, int v)
  {
    const double forwards = geometry.reversed() ? -1.0 : 1.0;
    const glm::dvec3 d(
      forwards * geometry.columns().slope[u], forwards * geometry.rows().slope[v], forwards);
    glm::dvec3 direction;
    for (int a = 0; a < 3; ++a)
    {
      direction[geometry.axes()[a]] = d[a];
    }
    return f.at(direction);
  };
  splatting::ShearImage image = imageOf(geometry, atPixel);
  for (int v = 0; v < geometry.height(); ++v)
  {
    // Beside the volume, too: all points have four neighbours.
    image.spans[v] = { 0, geometry.rayCount().x };
    for (int u = 0; u < geometry.width(); ++u)
    {
      image.row<float>(v)[u] = static_cast<float>(atPixel(u, v));
    }
  }
  return image;
}

/// Each of six places with each direction; half of the views are random.
splatting::View seamView(int n, reference::Random& random)
{
  const glm::dvec3 z(0.0, 0.0, 1.0);
  const std::array<int, 3> size{ 31, 27, 35 };
  // From the first five places, along these directions, one to five images show the volume.
  const glm::dvec3 eyes[] = { { -30.0, 13.0, 17.0 }, { -30.0, -20.0, 17.0 }, { -9.0, -9.0, -9.0 },
    { -3.0, 13.0, 17.0 }, { 15.0, 13.0, 17.0 }, { 7.3, 20.1, 11.9 } };
  const glm::dvec3 directions[] = { { 1.0, 0.0, 0.0 }, { 1.0, 1.0, 0.0 }, { 1.0, 1.0, 1.0 }, z, z };
  const int place = n % 6, way = (n + n / 6) % 9;
  const glm::dvec3 direction = n < 5 ? directions[n]
    : way < 4                        ? directions[way]
                                     : anyVector(random, -1.0, 1.0);
  const glm::dvec3 up = direction == z ? glm::dvec3(0.0, 1.0, 0.0) : z;
  return wideView(size, eyes[place], direction, up, !random.oneIn(3) ? 65 : 129);
}

/// What a pixel's ray and those of its area's outline have.
struct ShownOnOutline
{
  double least, largest;
  bool isWhole; ///< all on the outline meet the volume
};

ShownOnOutline lookAround(
  const Camera& camera, const splatting::View& view, const SmoothFunction& f, int x, int y)
{
  const double middle = f.at(camera.direction(x, y));
  ShownOnOutline outline{ middle, middle, true };
  for (int side = 0; side < 64; ++side)
  {
    const double along = (side % 16) / 16.0 - 0.5;
    const glm::dvec2 border[] = { { along, -0.5 }, { 0.5, along }, { -along, 0.5 },
      { -0.5, -along } };
    const glm::dvec3 d = camera.direction(x + border[side / 16].x, y + border[side / 16].y);
    outline.least = std::min(outline.least, f.at(d));
    outline.largest = std::max(outline.largest, f.at(d));
    outline.isWhole = outline.isWhole && meets(view, camera.eye, d, -0.01);
  }
  return outline;
}

/// Compares all pixels with the function. Returns whether the volume is shown.
bool compareWithFunction(Checks& check, const splatting::View& view,
  const splatting::Picture& picture, const SmoothFunction& f, double bound)
{
  const Camera camera(view);
  bool isShown = false;
  for (int y = 0; y < view.viewport.y; ++y)
  {
    for (int x = 0; x < view.viewport.x; ++x)
    {
      const std::uint32_t color = colorAt(picture, x, y);
      const glm::dvec3 ray = camera.direction(x, y);
      isShown |= color != 0;
      check(color != 0 || !meets(view, camera.eye, ray, -0.01), "a gap at ", x, ", ", y);
      const double value = (double(color) - 1.0) / 65535;
      if (!splatting::minifiesAnyAxis(view))
      {
        const double off = value - f.at(ray);
        check(color == 0 || std::abs(off) <= bound, "a seam: ", off, " at ", x, ", ", y,
          ", not within ", bound);
        continue;
      }
      // The function has its extrema on the outline, but where it is flat.
      const auto [least, largest, isWhole] = lookAround(camera, view, f, x, y);
      check(!isWhole || (value >= least - bound - 1e-3 && value <= largest + bound + 1e-3),
        "a seam: ", value, " at ", x, ", ", y, ", not between ", least, " and ", largest,
        " within ", bound);
    }
  }
  return isShown;
}

/// Images of a smooth function of the ray's direction show that function, whatever the image.
void testSeams(Checks& check)
{
  const SmoothFunction f;
  const splatting::ColorTable table = countingTable(0.0, 1.0);
  Sightings shown;
  reference::forScenes("seams", 54,
    [&](int n, reference::Random& random)
    {
      const splatting::View view = seamView(n, random);
      std::vector<splatting::ShearWarp> geometries;
      splatting::ShearWarp::factorise(view, geometries);
      check(n >= 5 || int(geometries.size()) == n + 1, "place ", n, " has ", geometries.size(),
        " images");
      std::vector<splatting::ShearImage> images;
      double step = 0.0; // of slopes
      for (const splatting::ShearWarp& geometry : geometries)
      {
        images.push_back(smoothImage(geometry, f));
        step = std::max(step, geometry.pitch() / std::abs(geometry.reference() - geometry.eye().z));
      }
      const splatting::Picture picture = pictureOf(images, geometries, table, view.viewport);
      shown.add(compareWithFunction(check, view, picture, f, f.bound(step)));
    });
  std::cout << "seams: the volume is shown in " << shown << std::endl;
  check(shown.areEnough(0.3), "the volume is shown in only ", shown);
}

void testEveryWayGivesTheSameBits(Checks& check)
{
  reference::forScenes("every way", 1,
    [&](int, reference::Random& random)
    {
      const splatting::ColorTable table = countingTable(0.0, 1.0);
      const splatting::View view =
        wideView({ 31, 27, 35 }, { 7.0, 13.0, 17.0 }, { 1.0, 0.3, 0.8 }, { 0.0, 0.0, 1.0 }, 257);
      std::vector<splatting::ShearWarp> geometries;
      splatting::ShearWarp::factorise(view, geometries);
      const std::vector<splatting::ShearImage> images = noiseImages(geometries, random);
      const splatting::Picture expected =
        pictureOf(images, geometries, table, view.viewport, splatting::InstructionSet::Baseline);
      for (splatting::InstructionSet set : instructionSets)
      {
        for (int threads : { 1, 2 })
        {
          vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads },
            [&]
            {
              const splatting::Picture picture =
                pictureOf(images, geometries, table, view.viewport, set);
              check(picture.pixels == expected.pixels, splatting::nameOf(set), " with ", threads,
                " threads gives other bits");
            });
        }
      }
    });
}
}

int TestPerspectiveWarp(int, char*[])
{
  Checks check;
  testPerspective(check);
  testSeams(check);
  testEveryWayGivesTheSameBits(check);
  return check.exitCode();
}
