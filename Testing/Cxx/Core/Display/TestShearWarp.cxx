// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The factorisation: shear and warp together are the view. Magnifications are those of the view.
#include "CoreTesting.h"
#include "Geometry/Magnification.h"
#include "WideViews.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace coretesting;

namespace
{
/// Where a view puts a point of index space, in pixels with centres at integers.
glm::dvec2 onScreen(const splatting::View& view, const glm::dvec3& p)
{
  const glm::dvec4 clip = view.indexToClip * glm::dvec4(p, 1.0);
  return 0.5 * (glm::dvec2(clip) / clip.w + 1.0) * glm::dvec2(view.viewport) - 0.5;
}

void testShearThenWarpIsTheView(Checks& check)
{
  reference::forScenes("parallel views", 500,
    [&](int, reference::Random& random)
    {
      const auto size = randomSize(random, 300);
      const splatting::View view = randomView(size, random);
      const splatting::ShearWarp geometry(view);
      if (!check(geometry.valid(), "a random view is invalid"))
      {
        return;
      }
      const auto& axes = geometry.axes();
      const glm::dvec3 ijk{ random.uniform(0.0, 300.0), random.uniform(0.0, 300.0),
        random.uniform(0.0, double(geometry.size().z)) };
      glm::dvec3 point;
      for (int a = 0; a < 3; ++a)
      {
        point[axes[a]] = ijk[a];
      }
      const glm::dvec2 pixel = glm::dvec2(ijk) + geometry.position(ijk.z);
      const glm::dvec2 warped(geometry.shearToScreen() * glm::dvec3(pixel, 1.0));
      const glm::dvec2 expected = onScreen(view, point);
      // Shears are rounded by up to 2^-25 pixels per slice; a pixel may be several on the screen.
      const glm::dmat3& m = geometry.shearToScreen();
      const double scale =
        std::abs(m[0].x) + std::abs(m[0].y) + std::abs(m[1].x) + std::abs(m[1].y);
      const double bound = 0x1p-25 * geometry.size().z * scale + 1e-9 * (1.0 + scale);
      check(glm::length(warped - expected) <= bound, "a voxel is ", glm::length(warped - expected),
        " pixels off");
      const glm::dvec2 back(geometry.screenToShear() * glm::dvec3(warped, 1.0));
      check(
        glm::length(back - pixel) < 1e-7 * (1.0 + glm::length(pixel)), "the warp is not inverted");
      check(std::abs(geometry.shear().x) <= 1.0 && std::abs(geometry.shear().y) <= 1.0,
        "a shear is above 1");
    });
}

/// A point of the volume in permuted coordinates.
glm::dvec3 permuted(const splatting::ShearWarp& image, const glm::dvec3& p)
{
  const auto& axes = image.axes();
  return { p[axes[0]], p[axes[1]], p[axes[2]] };
}

glm::dvec3 unpermuted(const splatting::ShearWarp& image, const glm::dvec3& p)
{
  glm::dvec3 result;
  for (int a = 0; a < 3; ++a)
  {
    result[image.axes()[a]] = p[a];
  }
  return result;
}

/// The rays of an image run where the view has them, and are no more than a voxel apart.
void checkRays(Checks& check, const splatting::View& view, const splatting::ShearWarp& image,
  reference::Random& random)
{
  const int u = random.uniform(0, image.rayCount().x - 1);
  const int v = random.uniform(0, image.rayCount().y - 1);
  const glm::dvec3 shown = image.shearToScreen() * glm::dvec3(u, v, 1.0);
  for (const double z : { image.faces(image.slices().begin).y, image.reference() })
  {
    const glm::dvec3 point(image.onRay(u, v, z), z);
    // Seen from the view's eye, the pixel's ray passes a point that is beside this one by as much
    // as the eye is rounded, 2^-11, and rays, 2^-21 and 2^-25 for each slice: by less than 2^-10.
    // Of such points those at the corners of a cube are seen farthest away if all are before the
    // eye.
    const glm::dvec2 expected = onScreen(view, unpermuted(image, point));
    double most = 0.0;
    bool isBefore = true;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 beside = unpermuted(image, point + 0x1p-10 * (2.0 * side - 1.0));
      isBefore = isBefore && (view.indexToClip * glm::dvec4(beside, 1.0)).w > 0.0;
      most = std::max(most, glm::length(onScreen(view, beside) - expected));
    }
    if (isBefore)
    {
      const glm::dvec2 found = glm::dvec2(shown) / shown.z;
      check(glm::length(expected - found) <= 1e-6 * (1.0 + glm::length(found)) + most, "a ray is ",
        glm::length(expected - found), " pixels off");
    }
  }
  check(std::abs(image.columns().slope[u]) <= 1.0 && std::abs(image.rows().slope[v]) <= 1.0,
    "a slope is above 1");
  check(u == 0 || image.columns().at[u] - image.columns().at[u - 1] < 0.9995,
    "rays are more than a voxel apart");
  const double far = std::abs(image.reference() - image.eye().z);
  check(image.pitch() * (1.001 + 1.0 / far) >= 1.0, "rays are ", image.pitch(), " voxels apart");
}

void testPerspectiveShearThenWarpIsTheView(Checks& check)
{
  Sightings seen, many;
  reference::forScenes("perspective views", 2000,
    [&](int, reference::Random& random)
    {
      std::vector<splatting::ShearWarp> images;
      const auto size = randomSize(random, 100);
      const splatting::View view = randomPerspective(size, random);
      splatting::ShearWarp::factorise(view, images);
      many.add(images.size() >= 3);
      for (const splatting::ShearWarp& image : images)
      {
        checkRays(check, view, image, random);
      }
      // What the viewport shows of the volume is in an image whose axis the ray follows most.
      const glm::dvec3 point{ random.uniform(-0.5, size[0] - 0.5),
        random.uniform(-0.5, size[1] - 0.5), random.uniform(-0.5, size[2] - 0.5) };
      const glm::dvec4 clip = view.indexToClip * glm::dvec4(point, 1.0);
      const bool isSeen = clip.w > 0.0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w;
      seen.add(isSeen);
      if (isSeen)
      {
        check(std::any_of(images.begin(), images.end(),
                [&](const splatting::ShearWarp& image)
                {
                  const glm::dvec3 p =
                    image.screenToShear() * glm::dvec3(onScreen(view, point), 1.0);
                  const glm::dvec3 d = permuted(image, point) - image.eye();
                  const double along = image.reversed() ? -d.z : d.z;
                  const double slack = 0x1p-8;
                  return along + slack >= std::max(std::abs(d.x), std::abs(d.y)) && p.z > 0.0 &&
                    p.x / p.z > -slack && p.x / p.z < image.rayCount().x - 1 + slack &&
                    p.y / p.z > -slack && p.y / p.z < image.rayCount().y - 1 + slack;
                }),
          "no image has a point of the volume");
      }
    });
  check(many.areEnough(0.02) && seen.areEnough(0.1), "three images or more in only ", many,
    ", a point of the volume in ", seen);
}

void testSymmetricViewsAreExact(Checks& check)
{
  // A camera on a symmetry plane: rounding errors in its matrix must not leave traces.
  splatting::View view = viewWithShear({ 10, 20, 30 }, 2, 1.0, -1.0);
  view.indexToClip = glm::rotate(glm::dmat4(1.0), 1e-17, glm::dvec3(0, 0, 1)) * view.indexToClip;
  view.indexToClip[2][0] *= 1.0 + 1e-15;
  const splatting::ShearWarp geometry(view);
  check(geometry.shear() == glm::dvec2(1.0, -1.0), "a diagonal view is not exact");
  check(geometry.principalAxis() == 2, "a tie does not go to the slowest axis");
}

void testDegenerateViews(Checks& check)
{
  splatting::View view = viewWithShear({ 4, 5, 6 }, 1, 0.25, 0.5);
  check(splatting::isParallel(view), "a parallel view is taken for a perspective one");
  check(splatting::ShearWarp(view).valid(), "a good view is invalid");
  splatting::View flat = view;
  for (int c = 0; c < 4; ++c)
  {
    flat.indexToClip[c][1] = 2.0 * flat.indexToClip[c][0];
  }
  check(!splatting::ShearWarp(flat).valid(), "a view onto a line is valid");
  splatting::View broken = view;
  broken.indexToClip[1][0] = std::numeric_limits<double>::quiet_NaN();
  check(!splatting::ShearWarp(broken).valid(), "a view with NaN is valid");
  splatting::View perspective = view;
  perspective.indexToClip[2][3] = 0.001;
  check(!splatting::isParallel(perspective), "a perspective view is taken for a parallel one");
}

/// Half the angle between two of the directions that are tried.
constexpr double HalfStep = 1e-3;

/// How many voxels a pixel spans across its ray, in the direction of the largest span of many. The
/// largest of all is that one over the cosine of half a step at most.
double largestSpan(const glm::dmat4& indexToCamera, double zoom)
{
  const glm::dmat3 toIndex(glm::inverse(indexToCamera));
  const glm::dvec3 ray = glm::normalize(toIndex[2]);
  double largest = 0.0;
  for (double angle = 0.0; angle < 3.15; angle += 2.0 * HalfStep)
  {
    const glm::dvec3 side = (std::cos(angle) * toIndex[0] + std::sin(angle) * toIndex[1]) / zoom;
    largest = std::max(largest, glm::length(side - glm::dot(side, ray) * ray));
  }
  return largest;
}

/// How wide a pixel is in voxels.
void testWidths(Checks& check)
{
  reference::forScenes("widths", 100,
    [&](int, reference::Random& random)
    {
      // So many pixels of the screen per unit of the world, and voxels of these sides.
      const double zoom = random.uniform(0.2, 3.0);
      const glm::dvec3 spacing = anyVector(random, 0.3, 3.0);
      splatting::View view;
      view.dimensions = toGlm(randomSize(random, 30));
      view.viewport = { 90, 70 };
      const glm::dvec3 eye = anyDirection(random) * 100.0;
      const glm::dvec2 half = 0.5 * glm::dvec2(view.viewport) / zoom;
      const glm::dmat4 camera = glm::lookAt(eye, glm::dvec3(0.0), anyVector(random, 1.0, -1.0));
      const glm::dmat4 projection = glm::ortho(-half.x, half.x, -half.y, half.y, 1.0, 1000.0);
      view.indexToClip = projection * camera * glm::scale(glm::dmat4(1.0), spacing);
      const double width = splatting::voxelsPerPixel(view);
      const double least = std::min({ spacing.x, spacing.y, spacing.z });
      const double most = std::max({ spacing.x, spacing.y, spacing.z });
      // Along the side of a voxel that lies across the view it is one over its pixels.
      check(width >= 1.0 / (zoom * most) - 1e-9 && width <= 1.0 / (zoom * least) + 1e-9,
        "pixels are ", width, " voxels wide");
      check(splatting::minifiesAnyAxis(view) == (width > 1.0 + 1e-6), "what an overview is");
      // Of cubes it is the same from everywhere.
      view.indexToClip = view.indexToClip * glm::scale(glm::dmat4(1.0), 1.0 / spacing);
      const double ofCubes = splatting::voxelsPerPixel(view);
      check(std::abs(ofCubes * zoom - 1.0) < 1e-6, "pixels are ", ofCubes, " cubes wide, not ",
        1.0 / zoom);
      view.indexToClip = projection * camera * glm::scale(glm::dmat4(1.0), spacing);
      const splatting::View skew = skewed(view, random);
      const double span = largestSpan(glm::inverse(projection) * skew.indexToClip, zoom);
      const double found = splatting::voxelsPerPixel(skew);
      check(found >= span - 1e-9 && found <= span / std::cos(HalfStep) + 1e-9, "pixels are ", found,
        " voxels of a skewed grid wide, not ", span);
    });
  splatting::View inside;
  inside.dimensions = { 30, 30, 30 };
  inside.viewport = { 8, 8 };
  inside.indexToClip = glm::perspective(1.0, 1.0, 0.1, 100.0) *
    glm::lookAt(glm::dvec3(15.0), glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
  check(!splatting::minifiesAnyAxis(inside), "from inside a volume there is no overview");
}
}

int TestShearWarp(int, char*[])
{
  Checks check;
  testShearThenWarpIsTheView(check);
  testPerspectiveShearThenWarpIsTheView(check);
  testSymmetricViewsAreExact(check);
  testDegenerateViews(check);
  testWidths(check);
  return check.exitCode();
}
