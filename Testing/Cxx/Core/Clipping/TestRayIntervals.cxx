// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where parallel rays begin and end, against their definition in index space, ray by ray and slice
// by slice: half-spaces, closed surfaces, depth buffers, and all of them together. Surfaces are
// watertight in any view.
#include "CutScenes.h"
#include "Splat/Warp/Outline.h"

#include <iostream>

using namespace cutscenes;

namespace
{
/// The volume takes a part of the depth range, as in a scene.
void spreadDepths(View& view, Random& random)
{
  double low = Infinity, high = -Infinity;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 p(corner & 1 ? view.dimensions.x : 0, corner & 2 ? view.dimensions.y : 0,
      corner & 4 ? view.dimensions.z : 0);
    const double z = (view.indexToClip * glm::dvec4(p, 1.0)).z;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  const double scale = (random.oneIn(2) ? 1.2 : -1.2) / (high - low);
  for (int c = 0; c < 4; ++c)
  {
    view.indexToClip[c][2] *= scale;
  }
  view.indexToClip[3][2] -= 0.5 * scale * (low + high);
  // Special shears would put points on edges between pixels, where rounding decides.
  view.indexToClip[3][0] += 0.3 / view.viewport.x;
  view.indexToClip[3][1] += 0.2 / view.viewport.y;
}

Depths randomDepths(const View& view, Random& random)
{
  splatting::Picture picture;
  splatting::placePicture({ ShearWarp(view) }, view.viewport, picture);
  return cutscenes::randomDepths(
    picture.origin, picture.size, random, [](Random& r) { return r.uniform(0.0, 1.0); });
}

Scene randomScene(Random& random, int cutters)
{
  Scene scene;
  const std::array<int, 3> size = coretesting::randomSize(random, 17);
  scene.view = coretesting::anyView(size, random);
  if (cutters & HalfSpaces)
  {
    scene.view.halfSpaces = anyHalfSpaces(toArray(scene.view.dimensions), random);
  }
  if (cutters & (Convex | Bumpy))
  {
    scene.mesh = randomBlob(random, scene.view.dimensions, cutters & Bumpy ? 0.6 : 0.0);
  }
  if (cutters & Depth)
  {
    spreadDepths(scene.view, random);
    scene.depths = randomDepths(scene.view, random);
  }
  return scene;
}

/// A random box. If its corners are rounded, rays without shear pass through them.
void compareAnyBox(
  Checks& check, const View& view, bool isRounded, Random& random, BoxCounts& counts)
{
  glm::dvec3 low = anyPoint(toArray(view.dimensions), random);
  glm::dvec3 high = low + glm::abs(anyVector(random, 1.0, -1.0)) * 20.0;
  if (isRounded)
  {
    low = glm::floor(low);
    high = glm::floor(high) + 1.0;
  }
  compareBox(check, view, low, high, Doubt, random, counts);
}

void testBoxes(Checks& check)
{
  BoxCounts counts;
  reference::forScenes("boxes", 300,
    [&](int n, Random& random)
    {
      const std::array<int, 3> size = coretesting::randomSize(random, 20);
      compareAnyBox(check, coretesting::anyView(size, random), n % 2 == 1, random, counts);
    });
  std::cout << "boxes: " << counts.cut << " are cut, " << counts.sure << " leave few rays out"
            << std::endl;
  check(counts.cut.areEnough(0.4) && counts.sure.areEnough(0.6),
    "Boxes cut, and few rays are left out.");
}

/// Rays pass along two faces at next to no angle, and steeply beside them.
void testGrazedBoxes(Checks& check)
{
  BoxCounts counts;
  reference::forScenes("grazed boxes", 4000,
    [&](int n, Random& random)
    {
      const std::array<int, 3> size = coretesting::randomSize(random, 20);
      const int axis = random.uniform(0, 2);
      glm::dvec2 shear;
      shear[n % 2] = random.uniform(-1.0, 1.0);
      shear[1 - n % 2] = (n % 4 < 2 ? 1.0 : -1.0) * std::exp2(-random.uniform(22.0, 28.0));
      const View view = coretesting::viewWithShear(size, axis, shear.x, shear.y);
      compareAnyBox(check, view, true, random, counts);
    });
  std::cout << "grazed boxes: " << counts.cut << " are cut, " << counts.sure
            << " leave few rays out" << std::endl;
  check(counts.cut.areEnough(0.4), "Grazed boxes cut.");
}

void testNothingCut(Checks& check)
{
  reference::forScenes("nothing is cut", 50,
    [&](int, Random& random)
    {
      Scene scene;
      scene.view = coretesting::anyView({ 9, 12, 7 }, random);
      check(Found(scene).cutsNothing(), "Nothing cuts.");
      const glm::dvec3 low(-12.0), high(30.0);
      scene.mesh = boxOfTriangles(random, low, high, 2);
      check(Found(scene).cutsNothing(), "A surface around the volume cuts nothing.");
      scene.mesh = {};
      spreadDepths(scene.view, random);
      scene.depths = randomDepths(scene.view, random);
      std::fill(scene.depths.samples.begin(), scene.depths.samples.end(), 0.999f);
      check(Found(scene).cutsNothing(), "What lies behind cuts nothing.");
      std::fill(scene.depths.samples.begin(), scene.depths.samples.end(), 0.001f);
      check(Found(scene).cutsNothing(), "What lies in front hides on the screen.");
    });
}

/// A closed surface over a rectangle of pixels whose every corner lies on a ray, so that rays pass
/// edges and corners only, as exactly as rounding allows.
struct Lattice
{
  glm::ivec2 first, last; // pixels
  std::vector<double> fronts, backs;
  Mesh mesh;

  int cornerAt(int u, int v) const
  {
    return (v - this->first.y) * (this->last.x - this->first.x + 1) + u - this->first.x;
  }
};

Lattice randomLattice(const Oracle& oracle, const ShearWarp& image, Random& random)
{
  Lattice lattice;
  const glm::ivec2 end(image.rayCount() - 1);
  lattice.first = { random.uniform(0, end.x / 2), random.uniform(0, end.y / 2) };
  lattice.last = { random.uniform(end.x / 2 + 1, end.x), random.uniform(end.y / 2 + 1, end.y) };
  const splatting::Span& slices = image.slices();
  const double low = image.faces(slices.begin).x, high = image.faces(slices.end - 1).y;
  const double middle = random.uniform(0.7 * low + 0.3 * high, 0.3 * low + 0.7 * high);
  const int count = lattice.cornerAt(lattice.last.x, lattice.last.y) + 1;
  for (int side = 0; side < 2; ++side)
  {
    for (int v = lattice.first.y; v <= lattice.last.y; ++v)
    {
      for (int u = lattice.first.x; u <= lattice.last.x; ++u)
      {
        const double bound = side ? std::min(high, middle + 2.0) : std::max(low, middle - 2.0);
        const double share = random.uniform(0.05, 0.95);
        const double z = (1.0 - share) * middle + share * bound;
        (side ? lattice.backs : lattice.fronts).push_back(z);
        lattice.mesh.points.push_back(oracle.rays().point(u, v, z));
      }
    }
  }
  auto& triangles = lattice.mesh.triangles;
  const auto addWall = [&](int a, int b)
  {
    triangles.push_back({ a, b, b + count });
    triangles.push_back({ a, b + count, a + count });
  };
  for (int v = lattice.first.y; v < lattice.last.y; ++v)
  {
    for (int u = lattice.first.x; u < lattice.last.x; ++u)
    {
      for (int side = 0; side < 2; ++side)
      {
        const int a = lattice.cornerAt(u, v) + side * count;
        const int b = lattice.cornerAt(u, v + 1) + side * count;
        triangles.push_back({ a, a + 1, b + 1 });
        triangles.push_back({ a, b + 1, b });
      }
      addWall(lattice.cornerAt(u, lattice.first.y), lattice.cornerAt(u + 1, lattice.first.y));
      addWall(lattice.cornerAt(u, lattice.last.y), lattice.cornerAt(u + 1, lattice.last.y));
    }
    addWall(lattice.cornerAt(lattice.first.x, v), lattice.cornerAt(lattice.first.x, v + 1));
    addWall(lattice.cornerAt(lattice.last.x, v), lattice.cornerAt(lattice.last.x, v + 1));
  }
  return lattice;
}

/// The least front and the greatest back of a corner and its neighbours.
Stretch around(const Lattice& lattice, int u, int v)
{
  Stretch stretch{ Infinity, -Infinity };
  for (int n = 0; n < 9; ++n)
  {
    const int x = std::clamp(u + n % 3 - 1, lattice.first.x, lattice.last.x);
    const int y = std::clamp(v + n / 3 - 1, lattice.first.y, lattice.last.y);
    stretch.begin = std::min(stretch.begin, lattice.fronts[lattice.cornerAt(x, y)]);
    stretch.end = std::max(stretch.end, lattice.backs[lattice.cornerAt(x, y)]);
  }
  return stretch;
}

/// No ray slips through between triangles, in either projection, nor meets them where they are not.
void testWatertight(Checks& check)
{
  coretesting::Sightings corners;
  reference::forScenes("watertight", 400,
    [&](int n, Random& random)
    {
      int rays = 0;
      Scene scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 17);
      scene.view =
        n % 2 ? coretesting::randomPerspective(size, random) : coretesting::anyView(size, random);
      std::vector<ShearWarp> images;
      ShearWarp::factorise(scene.view, images);
      for (const ShearWarp& image : images)
      {
        if (image.rayCount().x < 2 || image.rayCount().y < 2)
        {
          continue;
        }
        const Lattice lattice = randomLattice(Oracle(scene, image), image, random);
        splatting::ClosedSurface surface;
        surface.reset(lattice.mesh.points, lattice.mesh.triangles);
        const splatting::SurfaceDepths& depths = surface.project(image);
        for (int v = lattice.first.y; v <= lattice.last.y; ++v)
        {
          for (int u = lattice.first.x; u <= lattice.last.x; ++u)
          {
            const int corner = lattice.cornerAt(u, v);
            ++rays;
            const Stretch own = around(lattice, u, v);
            check(depths.near(v)[u] >= own.begin - 1e-6 && depths.far(v)[u] <= own.end + 1e-6,
              "A triangle is met beside its corners: ", depths.near(v)[u], " to ", depths.far(v)[u],
              ", not ", own.begin, " to ", own.end);
            check(depths.near(v)[u] <= lattice.fronts[corner] + 1e-6 &&
                depths.far(v)[u] >= lattice.backs[corner] - 1e-6,
              "A ray slips through between triangles: ", depths.near(v)[u], " to ",
              depths.far(v)[u], ", not ", lattice.fronts[corner], " to ", lattice.backs[corner]);
          }
        }
      }
      corners.add(rays > 0);
    });
  std::cout << "watertight: rays pass corners in " << corners << std::endl;
  check(corners.areEnough(0.5), "Rays pass corners in only ", corners);
}

/// A tetrahedron with a small face about pixel (u, v), whose corners are up to 16 slices apart.
/// @param width  how narrow the face is seen, in pixels
Mesh randomNeedle(const Oracle& oracle, const ShearWarp& image, const glm::ivec2& pixel,
  Random& random, double& width)
{
  const double z = image.reference(), eye = image.eye().z;
  const double half = image.isPerspective() ? std::min(8.0, 0.7 * std::abs(eye - z)) : 8.0;
  Mesh mesh;
  const auto add = [&](const glm::dvec2& p)
  {
    const double depth = z + random.uniform(-half, half);
    const double scale = image.isPerspective() ? (depth - eye) / (z - eye) : 1.0;
    glm::dvec3 point = oracle.rays().point(pixel.x, pixel.y, depth);
    point[image.axes()[0]] += scale * p.x;
    point[image.axes()[1]] += scale * p.y;
    mesh.points.push_back(point);
  };
  const double size = std::exp2(-random.uniform(2.0, 13.0)), turn = random.uniform(0.0, 6.3);
  glm::dvec2 corners[3];
  for (int c = 0; c < 3; ++c)
  {
    const double angle = turn + 2.1 * (c + random.uniform(-0.4, 0.4));
    corners[c] = size * random.uniform(0.02, 1.0) * glm::dvec2(std::cos(angle), std::sin(angle));
    add(corners[c]);
  }
  const double x = random.uniform(-8.0, 8.0), y = random.uniform(-8.0, 8.0);
  add({ x, y });
  mesh.triangles = { { 0, 1, 2 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
  width = std::abs(a.x * b.y - a.y * b.x) /
    std::max({ glm::length(a), glm::length(b), glm::length(a - b) });
  return mesh;
}

/// No ray slips through triangles that are long, and narrow as rays see them.
void testNeedles(Checks& check)
{
  coretesting::Sightings met;
  reference::forScenes("needles", 4000,
    [&](int n, Random& random)
    {
      Scene scene;
      const ShearWarp image = n % 2 ? coretesting::randomPerspectiveImage({ 20, 20, 20 }, random)
                                    : ShearWarp(coretesting::anyView({ 20, 20, 20 }, random));
      const Oracle oracle(scene, image);
      const glm::ivec2 pixel = image.rayCount() / 2;
      double width = 0.0;
      const Mesh mesh = randomNeedle(oracle, image, pixel, random, width);
      const double z = image.reference();
      const glm::dvec3 from = oracle.rays().point(pixel.x, pixel.y, z);
      const Crossings crossings =
        crossMesh(mesh, from, oracle.rays().point(pixel.x, pixel.y, z + 1.0) - from);
      // Rounding moves crossings by about 2^-53 20^3 / width^2.
      const bool isMet = crossings.places.size() == 2 && !crossings.doubtful && width > 1e-4;
      met.add(isMet);
      if (isMet)
      {
        splatting::ClosedSurface surface;
        surface.reset(mesh.points, mesh.triangles);
        const splatting::SurfaceDepths& depths = surface.project(image);
        const double near = depths.near(pixel.y)[pixel.x], far = depths.far(pixel.y)[pixel.x];
        const auto places = std::minmax(crossings.places[0], crossings.places[1]);
        check(near <= z + places.first + 1e-3 && far >= z + places.second - 1e-3,
          "A ray slips through a needle of width ", width, ": it is met from ", near, " to ", far,
          ", not ", z + places.first, " to ", z + places.second);
      }
    });
  std::cout << "needles: met in " << met << std::endl;
  check(met.areEnough(0.3), "Needles are met in only ", met);
}

/// A surface with a hole: rays through the hole cross it once.
void testOpenSurface(Checks& check)
{
  reference::forScenes("open surface", 1,
    [&](int, reference::Random& random)
    {
      Scene scene;
      scene.view = coretesting::viewWithShear({ 12, 12, 12 }, 2, 0.25, -0.125);
      scene.mesh = boxOfTriangles(random, { 2.3, 2.3, 2.3 }, { 8.6, 8.6, 8.6 }, 1);
      scene.mesh.triangles.resize(scene.mesh.triangles.size() - 2); // the last face is across z
      const Found found(scene);
      const glm::ivec2 pixel = found.images[0].margin() + 5;
      const RayIntervals& intervals = found.intervals[0];
      check(intervals.first(pixel.y)[pixel.x] > intervals.last(pixel.y)[pixel.x],
        "A ray that crosses the surface once shows nothing.");
    });
}
}

//------------------------------------------------------------------------------
int TestRayIntervals(int, char*[])
{
  Checks check;
  for (const Series& series : allSeries)
  {
    compareSeries(series, 250, randomScene, check);
  }
  testBoxes(check);
  testGrazedBoxes(check);
  testNothingCut(check);
  testWatertight(check);
  testNeedles(check);
  testOpenSurface(check);
  return check.exitCode();
}
