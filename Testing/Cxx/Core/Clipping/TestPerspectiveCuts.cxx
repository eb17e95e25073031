// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the rays of perspective views begin and end, in all images of a view, against their
// definition in index space: from afar, from nearby and from inside the volume and what cuts it.
// And previews of what a plane leaves, against a search of all voxels that rays cross.
#include "CutScenes.h"

#include "Reductions.h"

#include <cstdint>
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

bool isWithin(const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high)
{
  return glm::all(glm::lessThan(low, p)) && glm::all(glm::lessThan(p, high));
}

/// Where the rays of an image come from, axes not permuted.
glm::dvec3 eyeOf(const ShearWarp& image)
{
  glm::dvec3 eye;
  for (int a = 0; a < 3; ++a)
  {
    eye[image.axes()[a]] = image.eye()[a];
  }
  return eye;
}

/// More than rounding moves rays and the eye by.
constexpr double BoxMargin = 1e-4;

/// A view that a box cuts: as planes and as a surface, and a wider and a narrower one as planes.
struct BoxScenes
{
  glm::dvec3 low, high;
  Scene planes, mesh, wide, narrow;
};

/// Half of the boxes have their corners at voxels' corners; some hold the eye, which is at such
/// places, too.
BoxScenes anyBox(int n, Random& random)
{
  BoxScenes box;
  View& view = box.planes.view;
  view = coretesting::randomPerspective(coretesting::randomSize(random, 20), random);
  box.mesh.view = box.wide.view = box.narrow.view = view;
  box.low = anyPoint(toArray(view.dimensions), random);
  if (n % 3 == 0)
  {
    const glm::dvec4 eye = glm::inverse(view.indexToClip)[2];
    box.low = glm::dvec3(eye) / eye.w - random.uniform(0.1, 5.0);
  }
  box.high = box.low + glm::abs(anyVector(random, 1.0, -1.0)) * 20.0;
  if (n % 2)
  {
    box.low = glm::floor(box.low) + 0.5;
    box.high = glm::floor(box.high) + 1.5;
  }
  view.halfSpaces = halfSpacesOfBox(box.low, box.high);
  box.wide.view.halfSpaces = halfSpacesOfBox(box.low - BoxMargin, box.high + BoxMargin);
  box.narrow.view.halfSpaces = halfSpacesOfBox(box.low + BoxMargin, box.high - BoxMargin);
  box.mesh.mesh = boxOfTriangles(random, box.low, box.high, random.uniform(1, 5));
  return box;
}

/// What the core makes of the scenes of a box.
struct FoundBox
{
  Found planes, mesh, wide, narrow;

  explicit FoundBox(const BoxScenes& box)
    : planes(box.planes),
      mesh(box.mesh),
      wide(box.wide),
      narrow(box.narrow)
  {
  }
};

/// Compares all rays of one image, but for those that rounding decides on.
void compareBox(
  Checks& check, const BoxScenes& box, const FoundBox& found, std::size_t number, Counts& counts)
{
  const ShearWarp& image = found.planes.images[number];
  const glm::dvec3 eye = eyeOf(image), low = box.low, high = box.high;
  // For an eye on a face rounding decides whether the box holds it.
  const bool isOnFace = isWithin(eye, low - BoxMargin, high + BoxMargin) &&
    !isWithin(eye, low + BoxMargin, high - BoxMargin);
  const Oracle oracle(box.planes, image);
  forEachRay(oracle, image,
    [&](int u, int v, const std::vector<int>& crossed)
    {
      const auto slicesOf = [&](const Found& one)
      { return left(one.intervals[number], u, v, crossed); };
      // Rays that meet an edge are for rounding to decide.
      const bool isDoubtful = isOnFace || slicesOf(found.wide) != slicesOf(found.narrow) ||
        meetsEdge(oracle, u, v, box.wide.view.halfSpaces, box.narrow.view.halfSpaces);
      ++counts.rays;
      counts.doubtful += isDoubtful;
      check(isDoubtful || slicesOf(found.planes) == slicesOf(found.mesh), "A surface cuts pixel ",
        u, ", ", v, " as planes do. Eye ", eye.x, " ", eye.y, " ", eye.z, ", box ", low.x, " ",
        low.y, " ", low.z, " to ", high.x, " ", high.y, " ", high.z);
    });
}

void testBoxes(Checks& check)
{
  coretesting::Sightings cut, holding, sure;
  reference::forScenes("boxes", 400,
    [&](int n, Random& random)
    {
      const BoxScenes box = anyBox(n, random);
      const FoundBox found(box);
      cut.add(!found.planes.cutsNothing());
      bool isHolding = false;
      Counts counts;
      for (std::size_t image = 0; image < found.planes.images.size(); ++image)
      {
        isHolding |= isWithin(eyeOf(found.planes.images[image]), box.low, box.high);
        compareBox(check, box, found, image, counts);
      }
      holding.add(isHolding);
      sure.add(10 * counts.doubtful <= counts.rays);
    });
  std::cout << "boxes: " << cut << " are cut, " << holding << " have the eye inside, " << sure
            << " leave few rays out" << std::endl;
  check(cut.areEnough(0.4) && holding.areEnough(0.05) && sure.areEnough(0.6),
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

/// Previews show the largest of the voxels whose slices count.
void testPictures(Checks& check)
{
  coretesting::Sightings cut;
  reference::forScenes("pictures", 80,
    [&](int n, Random& random)
    {
      const std::array<int, 3> size = coretesting::randomSize(random, 30);
      const auto volume = reference::uniformNoise<std::uint8_t>(size, random, 0, 255);
      const View view = coretesting::randomPerspective(volume.size, random);
      const glm::dvec3 point = anyPoint(toArray(view.dimensions), random);
      const glm::dvec4 plane = halfSpaceThrough(point, anyVector(random, -1.0, 1.0));
      reference::RayCuts cuts;
      cuts.halfSpaces.push_back({ plane.x, plane.y, plane.z, plane.w });
      splatting::ProjectionSettings settings;
      settings.quality = splatting::Quality::Preview;
      settings.acceleration =
        n % 2 ? splatting::Acceleration::Bricks : splatting::Acceleration::Dense;
      std::vector<ShearWarp> images;
      ShearWarp::factorise(view, images);
      for (const ShearWarp& geometry : images)
      {
        const auto image = coretesting::project(volume, geometry, settings,
          coretesting::cutsBy(geometry, std::vector<glm::dvec4>{ plane }));
        const reference::PerspectiveRays rays = coretesting::referenceRays(geometry);
        const reference::RayCutter cutter(rays, cuts);
        const auto samples = reference::voxelSamples(volume, rays);
        cut.add(!image.mask.empty());
        for (int v = 0; v < geometry.rayCount().y; ++v)
        {
          for (int u = 0; u < geometry.rayCount().x; ++u)
          {
            const auto& ray = samples[std::size_t(v) * rays.width() + u];
            const auto expected =
              reference::largest(reference::cutRay(ray, cutter, u, v, geometry.reversed())).front();
            check(!expected.hit ||
                (image.covers(u, v) && image.row<std::uint8_t>(v)[u] == expected.value),
              "Pixel ", u, ", ", v, " shows another voxel than the largest that counts.");
          }
        }
      }
    });
  check(cut.areEnough(0.3), "Planes cut.");
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
  testPictures(check);
  return check.exitCode();
}
