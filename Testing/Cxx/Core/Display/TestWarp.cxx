// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The warp: linear images stay linear, the picture ends where the volume's box ends, missing
// samples and infinities do not spread.
#include "WarpTesting.h"
#include "WideViews.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace coretesting;

namespace
{
/// Whether the ray of a screen pixel meets the box from the first voxel centres to the last, grown
/// by `margin` voxels.
bool meetsBox(const splatting::View& view, const splatting::ShearWarp& geometry,
  const reference::ImageRays& rays, int x, int y, double margin)
{
  const glm::dvec2 pixel(geometry.screenToShear() * glm::dvec3(x, y, 1.0));
  glm::dvec3 point = rays.point(0, 0, rays.start);
  point[rays.axes[0]] += pixel.x;
  point[rays.axes[1]] += pixel.y;
  const auto box = reference::boxOfVolume(view.dimensions, false, margin);
  return reference::inside(box, point, rays.direction(0, 0)).length() >= 0.0;
}

void testLinearImages(Checks& check)
{
  reference::forScenes("linear images", 60,
    [&](int n, reference::Random& random)
    {
      // Three volumes in four are one voxel thick along an axis.
      auto size = randomSize(random, 40);
      if (n % 4 < 3)
      {
        size[n % 4] = 1;
      }
      const splatting::View view = magnified(anyView(size, random));
      const splatting::ShearWarp geometry(view);
      const reference::ImageRays rays = referenceRays(geometry);
      const double a = random.uniform(-1.0, 1.0), b = random.uniform(-1.0, 1.0);
      const auto f = [=](double u, double v) { return a * u + b * v; };
      const std::vector<splatting::ShearImage> images{ imageOf(geometry, f) };
      const splatting::ShearImage& image = images.front();
      const splatting::ColorTable table = countingTable(-400.0, 400.0);
      const splatting::Picture picture =
        pictureOf(images, { geometry }, table, view.viewport, anyInstructionSet(random));
      for (int y = 0; y < view.viewport.y; ++y)
      {
        for (int x = 0; x < view.viewport.x; ++x)
        {
          const std::uint32_t color = colorAt(picture, x, y);
          // Rays within a thousandth of a voxel of the rim may go either way.
          if (!meetsBox(view, geometry, rays, x, y, 1e-3))
          {
            check(color == 0, "a pixel outside the volume has a colour");
            continue;
          }
          if (!meetsBox(view, geometry, rays, x, y, -1e-3))
          {
            continue;
          }
          if (!check(color != 0, "a pixel inside the volume is transparent"))
          {
            continue;
          }
          const glm::dvec2 p(geometry.screenToShear() * glm::dvec3(x, y, 1.0));
          // At the rim the last samples stand for missing neighbours, up to a pixel away in u and
          // v.
          bool rim = false;
          for (int corner = 0; corner < 4; ++corner)
          {
            rim = rim ||
              !image.covers(int(std::floor(p.x)) + corner % 2, int(std::floor(p.y)) + corner / 2);
          }
          const double bound =
            (rim ? std::abs(a) + std::abs(b) : 0.0) + 800.0 / 65535 + 800.0 * 0x1p-22;
          const double found = (double(color) - 1.0) * 800.0 / 65535 - 400.0;
          check(std::abs(found - f(p.x, p.y)) <= bound, "a linear image is off by ",
            found - f(p.x, p.y));
        }
      }
    });
}

void testOddPixels(Checks& check)
{
  const splatting::View view = viewWithShear({ 30, 30, 5 }, 2, 0.0, 0.0);
  const splatting::ShearWarp geometry(view);
  const auto odd = [&](float value)
  {
    std::vector<splatting::ShearImage> images{ imageOf(geometry, [](int, int) { return 50.0; }) };
    images.front().row<float>(15)[15] = value;
    images.front().nonFinite = true;
    const splatting::Picture picture =
      pictureOf(images, { geometry }, countingTable(0.0, 100.0), view.viewport);
    // One screen pixel per shear pixel, perhaps half-way between: at most four show the odd one.
    int others = 0;
    for (std::uint32_t color : picture.pixels)
    {
      others += color != 0 && std::abs(double(color) - 32768.5) > 2;
    }
    return std::make_pair(others, std::count(picture.pixels.begin(), picture.pixels.end(), 0u));
  };
  const auto usual = odd(50.0f);
  check(usual.first == 0, "a constant image is not constant");
  const auto hole = odd(std::numeric_limits<float>::quiet_NaN());
  check(hole.first == 0, "NaN spreads into other pixels");
  check(hole.second - usual.second <= 1, "NaN makes more than one pixel transparent");
  const auto bright = odd(std::numeric_limits<float>::infinity());
  check(bright.first >= 1 && bright.first <= 4, "infinity shows in ", bright.first, " pixels");
  check(bright.second == usual.second, "infinity makes pixels transparent");
}

void testOutsideTheViewport(Checks& check)
{
  splatting::View view = viewWithShear({ 30, 30, 5 }, 2, 0.25, 0.5);
  view.indexToClip[3][0] = 5.0; // far to the right
  const splatting::ShearWarp geometry(view);
  const splatting::Picture picture = pictureOf({ imageOf(geometry, [](int, int) { return 1.0; }) },
    { geometry }, countingTable(0.0, 1.0), view.viewport);
  check(picture.pixels.empty(), "a volume outside the viewport leaves a picture");
}
}

int TestWarp(int, char*[])
{
  Checks check;
  testLinearImages(check);
  testOddPixels(check);
  testOutsideTheViewport(check);
  return check.exitCode();
}
