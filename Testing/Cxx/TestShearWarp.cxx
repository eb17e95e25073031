// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The factorisation: shear followed by warp is the view, and rays cross the voxels they should.
#include "CoreTesting.h"

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

void testShearThenWarpIsTheView(Checks& check, reference::Random& random)
{
  for (int n = 0; n < 500; ++n)
  {
    const auto size = randomSize(random, 300);
    const splatting::View view = randomView(size, random);
    const splatting::ShearWarp geometry(view);
    if (!check(geometry.valid(), "a random view is invalid"))
    {
      continue;
    }
    const auto& axes = geometry.axes();
    const glm::dvec3 ijk(random.uniform(0.0, 300.0), random.uniform(0.0, 300.0),
      random.uniform(0.0, double(geometry.size().z)));
    glm::dvec3 point;
    for (int a = 0; a < 3; ++a)
    {
      point[axes[a]] = ijk[a];
    }
    const glm::dvec2 pixel = glm::dvec2(ijk) + geometry.position(ijk.z);
    const glm::dvec2 warped = geometry.shearToScreen() * glm::dvec3(pixel, 1.0);
    const glm::dvec2 expected = onScreen(view, point);
    // Shears are rounded by up to 2^-25 pixels per slice; a pixel may be several on the screen.
    const glm::dmat3x2& m = geometry.shearToScreen();
    const double scale = std::abs(m[0].x) + std::abs(m[0].y) + std::abs(m[1].x) + std::abs(m[1].y);
    const double bound = 0x1p-25 * geometry.size().z * scale + 1e-9 * (1.0 + scale);
    check(glm::length(warped - expected) <= bound, "a voxel is ", glm::length(warped - expected),
      " pixels off");
    const glm::dvec2 back = geometry.screenToShear() * glm::dvec3(warped, 1.0);
    check(
      glm::length(back - pixel) < 1e-7 * (1.0 + glm::length(pixel)), "the warp is not inverted");
    check(std::abs(geometry.shear().x) <= 1.0 && std::abs(geometry.shear().y) <= 1.0,
      "a shear is above 1");
  }
}

void testRayPaths(Checks& check, reference::Random& random)
{
  for (int n = 0; n < 1000; ++n)
  {
    const auto size = randomSize(random, 9);
    const splatting::View view = anyView(size, random);
    const splatting::ShearWarp geometry(view);
    const auto grid = reference::makeShearGrid(size, referenceView(geometry));
    check(grid.width == geometry.width() && grid.height == geometry.height(), "image size differs");
    const int u = random.uniform(0, grid.width - 1), v = random.uniform(0, grid.height - 1);
    auto expected = reference::crossedVoxels(size, referenceView(geometry), u, v);
    std::vector<std::array<int, 3>> found;
    for (int k = 0; k < geometry.size().z; ++k)
    {
      const splatting::RayPath path = geometry.rayPath(k);
      const splatting::Span span = geometry.coverage(path, v);
      int inside = 0;
      for (int t = 0; t < path.count; ++t)
      {
        const std::array<int, 3> ijk{ u + path.di[t], v + path.dj[t], k };
        if (ijk[0] >= 0 && ijk[0] < geometry.size().x && ijk[1] >= 0 && ijk[1] < geometry.size().y)
        {
          std::array<int, 3> voxel;
          for (int a = 0; a < 3; ++a)
          {
            voxel[geometry.axes()[a]] = ijk[a];
          }
          found.push_back(voxel);
          ++inside;
        }
      }
      check((inside > 0) == (u >= span.begin && u < span.end), "coverage differs from the path");
    }
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    check(expected == found, "ray path differs from the traversal: ", found.size(), " voxels, not ",
      expected.size(), "; shear ", geometry.shear().x, " ", geometry.shear().y);
  }
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
}

int TestShearWarp(int, char*[])
{
  Checks check;
  reference::Random random(7);
  testShearThenWarpIsTheView(check, random);
  testRayPaths(check, random);
  testSymmetricViewsAreExact(check);
  testDegenerateViews(check);
  return check.result();
}
