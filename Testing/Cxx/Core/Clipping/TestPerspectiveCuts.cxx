// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the rays of perspective views begin and end, in all images of a view, against their
// definition in index space: from afar, from nearby and from inside the volume and what cuts it.
#include "CutScenes.h"

#include <iostream>

using namespace cutscenes;

namespace
{
/// Near and far plane, in units of w.
struct DepthRange
{
  double near, far;

  double depthOf(double w) const
  {
    return this->far / (this->far - this->near) * (1.0 - this->near / w);
  }
};

/// Planes close around the volume, as far as it lies before the eye, or within it.
DepthRange placePlanes(View& view, Random& random)
{
  double least = Infinity, greatest = -Infinity;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 p(corner & 1 ? view.dimensions.x : 0, corner & 2 ? view.dimensions.y : 0,
      corner & 4 ? view.dimensions.z : 0);
    const double w = (view.indexToClip * glm::dvec4(p - 0.5, 1.0)).w; // voxels are boxes
    least = std::min(least, w);
    greatest = std::max(greatest, w);
  }
  greatest = std::max(greatest, 0.1);
  const double near = std::max(0.9 * least, random.uniform(0.02, 0.1) * greatest);
  const DepthRange range{ near, 1.1 * greatest };
  const double extent = range.far - range.near;
  for (int c = 0; c < 4; ++c)
  {
    view.indexToClip[c][2] = (range.far + range.near) / extent * view.indexToClip[c][3];
  }
  view.indexToClip[3][2] -= 2.0 * range.far * range.near / extent;
  return range;
}

/// As a mapper adds it.
void addNearPlane(View& view)
{
  const glm::dmat4& m = view.indexToClip;
  glm::dvec4 plane;
  for (int c = 0; c < 4; ++c)
  {
    plane[c] = m[c][3] + m[c][2];
  }
  view.halfSpaces.push_back(plane);
}

Depths randomDepths(const View& view, const DepthRange& range, Random& random)
{
  const glm::ivec2 origin{ random.uniform(0, view.viewport.x / 4),
    random.uniform(0, view.viewport.y / 4) };
  return cutscenes::randomDepths(origin, view.viewport - origin, random,
    [&](Random& r) { return range.depthOf(r.uniform(range.near, range.far)); });
}

Scene randomScene(Random& random, int cutters)
{
  Scene scene;
  scene.view = coretesting::randomPerspective(coretesting::randomSize(random, 17), random);
  const DepthRange range = placePlanes(scene.view, random);
  if (cutters & HalfSpaces)
  {
    scene.view.halfSpaces = anyHalfSpaces(toArray(scene.view.dimensions), random);
    if (random.oneIn(2))
    {
      addNearPlane(scene.view);
    }
  }
  if (cutters & (Convex | Bumpy))
  {
    scene.mesh = randomBlob(random, scene.view.dimensions, cutters & Bumpy ? 0.6 : 0.0);
  }
  if (cutters & Depth)
  {
    scene.depths = randomDepths(scene.view, range, random);
  }
  return scene;
}

/// Half of the boxes have their corners at voxels' corners; some hold the eye, which is at such
/// places, too.
void testBoxes(Checks& check)
{
  BoxCounts counts;
  reference::forScenes("boxes", 400,
    [&](int n, Random& random)
    {
      const auto size = coretesting::randomSize(random, 20);
      const View view = coretesting::randomPerspective(size, random);
      glm::dvec3 low = anyPoint(size, random);
      if (n % 3 == 0)
      {
        const glm::dvec4 eye = glm::inverse(view.indexToClip)[2];
        low = glm::dvec3(eye) / eye.w - random.uniform(0.1, 5.0);
      }
      glm::dvec3 high = low + glm::abs(anyVector(random, 1.0, -1.0)) * 20.0;
      if (n % 2)
      {
        low = glm::floor(low) + 0.5;
        high = glm::floor(high) + 1.5;
      }
      compareBox(check, view, low, high, 1e-4, random, counts);
    });
  std::cout << "boxes: " << counts.cut << " are cut, " << counts.holding << " have the eye inside, "
            << counts.sure << " leave few rays out" << std::endl;
  check(counts.cut.areEnough(0.4) && counts.holding.areEnough(0.05) && counts.sure.areEnough(0.6),
    "Boxes cut, some hold the eye, and few rays are left out.");
}

void testNothingCut(Checks& check)
{
  reference::forScenes("nothing is cut", 100,
    [&](int, Random& random)
    {
      Scene scene;
      scene.view = coretesting::randomPerspective({ 9, 12, 7 }, random);
      const DepthRange range = placePlanes(scene.view, random);
      check(Found(scene).cutsNothing(), "Nothing cuts.");
      // From within as well as from outside.
      scene.mesh = boxOfTriangles(random, glm::dvec3(-12.3), glm::dvec3(30.7), 2);
      check(Found(scene).cutsNothing(), "A surface around the volume cuts nothing.");
      // Near enough to cut slices that the rays have left the volume before.
      scene.mesh =
        boxOfTriangles(random, glm::dvec3(-1.1), glm::dvec3(scene.view.dimensions) + 0.1, 2);
      check(Found(scene).cutsNothing(), "A surface close around the volume cuts nothing.");
      scene.mesh = {};
      scene.depths = randomDepths(scene.view, range, random);
      std::fill(scene.depths.samples.begin(), scene.depths.samples.end(),
        static_cast<float>(range.depthOf(0.999 * range.far)));
      check(Found(scene).cutsNothing(), "What lies behind cuts nothing.");
    });
}

/// Octahedra around the eye, or beside it, whose corners are where the lines along the axes meet
/// them.
void testEyeAndCorners(Checks& check)
{
  std::vector<ShearWarp> images;
  reference::forScenes("octahedra about the eye", 100,
    [&](int, Random& random)
    {
      ShearWarp::factorise(coretesting::randomPerspective({ 9, 12, 7 }, random), images);
      for (const ShearWarp& image : images)
      {
        const glm::dvec3 eye = eyeOf(image);
        for (int place = -1; place < 6; ++place)
        {
          glm::dvec3 centre = eye;
          if (place >= 0)
          {
            centre[place / 2] += place % 2 ? 4.0 : -4.0;
          }
          Mesh mesh;
          for (int corner = 0; corner < 6; ++corner)
          {
            mesh.points.push_back(centre);
            mesh.points.back()[corner / 2] += corner % 2 ? 2.0 : -2.0;
          }
          for (int face = 0; face < 8; ++face)
          {
            mesh.triangles.push_back({ face & 1, 2 + (face >> 1 & 1), 4 + (face >> 2) });
          }
          splatting::ClosedSurface surface;
          surface.reset(mesh.points, mesh.triangles);
          const splatting::SurfaceDepths& depths = surface.project(image);
          const double found = image.reversed() ? depths.far(0)[0] : depths.near(0)[0];
          check((found == image.eye().z) == (place < 0), "Octahedron ", place,
            ": the eye is taken to be elsewhere.");
        }
      }
    });
}

/// Each direction has a projection of its own, which is the right one whatever came before.
void testReuse(Checks& check)
{
  reference::forScenes("a surface in ten views", 10,
    [&](int, Random& random)
    {
      splatting::ClosedSurface surface;
      const Mesh mesh = randomBlob(random, { 9, 12, 7 }, 0.3);
      surface.reset(mesh.points, mesh.triangles);
      std::vector<ShearWarp> images;
      for (int n = 0; n < 10; ++n)
      {
        const View view = n % 3 ? coretesting::randomPerspective({ 9, 12, 7 }, random)
                                : coretesting::anyView({ 9, 12, 7 }, random);
        ShearWarp::factorise(view, images);
        std::vector<const splatting::SurfaceDepths*> depths;
        for (const ShearWarp& image : images)
        {
          depths.push_back(&surface.project(image));
        }
        for (std::size_t m = 0; m < images.size(); ++m)
        {
          splatting::ClosedSurface fresh;
          fresh.reset(mesh.points, mesh.triangles);
          const splatting::SurfaceDepths& expected = fresh.project(images[m]);
          const std::size_t pixels = std::size_t(images[m].width()) * images[m].height();
          check(std::equal(expected.near(0), expected.near(0) + pixels, depths[m]->near(0)) &&
              std::equal(expected.far(0), expected.far(0) + pixels, depths[m]->far(0)) &&
              &surface.project(images[m]) == depths[m],
            "View ", n, ", image ", m, ": another projection than that of a new surface.");
        }
      }
    });
}
}

//------------------------------------------------------------------------------
int TestPerspectiveCuts(int, char*[])
{
  Checks check;
  for (const Series& series : allSeries)
  {
    compareSeries(series, 400, randomScene, check);
  }
  testBoxes(check);
  testNothingCut(check);
  testEyeAndCorners(check);
  testReuse(check);
  return check.exitCode();
}
