// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What things in a scene leave of a volume: with a plane across the view, what is before it; and
// whether that is what it was.
#include "CoreTesting.h"
#include "Scene/SceneCuts.h"
#include "Splat/Projection/SplatView.h"
#include "Splat/Warp/Outline.h"

#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

struct Scene
{
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkVolume> volume;
  splatting::View view;
  splatting::SplatView splat;
  splatting::SplatView kept;
  SceneCuts cuts;
  double depth = 1.0; ///< of all pixels
  bool isRead = false;

  explicit Scene(reference::Random& random)
  {
    const auto size = coretesting::randomSize(random, 9);
    // Depths of views are about 1/2, however the volume is turned.
    this->view = coretesting::randomView(size, random);
    this->splat.set(this->view, {});
    this->renderer->PreserveDepthBufferOn(); // there is something to intermix with
  }

  void find(bool intermixes)
  {
    this->isRead = false;
    this->cuts.Find(this->view, this->renderer, this->volume, intermixes,
      [this](const int*, const int* extent, float* depths)
      {
        this->isRead = true;
        std::fill_n(depths, extent[0] * extent[1], float(this->depth));
        return true;
      });
    this->splat.set(this->view, this->cuts.Get());
  }

  bool isKept() const { return this->splat.projectsAs(this->kept, true); }
};

/// Whether the plane is in the volume where a pixel shows it. Next to where the volume ends it may
/// or may not be.
enum Place
{
  Outside,
  Unclear,
  Inside
};

Place placeOf(const Scene& scene, const glm::dvec2& pixel)
{
  const glm::dvec2 clip = (2.0 * glm::round(pixel) + 1.0) / glm::dvec2(scene.view.viewport) - 1.0;
  const glm::dvec4 point =
    glm::inverse(scene.view.indexToClip) * glm::dvec4(clip, 2.0 * scene.depth - 1.0, 1.0);
  bool isIn = true, isOut = false;
  for (int a = 0; a < 3; ++a)
  {
    const double last = scene.view.dimensions[a] - 1.0, thin = last > 0.0 ? 0.0 : 0.5;
    const double beyond = std::max(-point[a], point[a] - last);
    isIn = isIn && beyond < thin - 1e-2;
    isOut = isOut || beyond > 0.5 + 1e-2;
  }
  return isIn ? Inside : isOut ? Outside : Unclear;
}

/// Rays end at the plane where it is in the volume. Returns how many lose samples.
int testIntervals(Checks& check, const Scene& scene)
{
  const splatting::ShearWarp& image = scene.splat.geometries.front();
  const splatting::RayIntervals& intervals = scene.splat.cuts.front().intervals;
  splatting::Picture picture;
  splatting::placePicture(scene.splat.geometries, scene.view.viewport, picture);
  int cut = 0;
  for (int v = 0; v < image.height(); ++v)
  {
    for (int u = 0; u < image.width(); ++u)
    {
      const glm::dvec2 pixel(image.shearToScreen() * glm::dvec3(u, v, 1.0));
      const glm::dvec2 from = pixel - glm::dvec2(picture.origin);
      const glm::dvec2 toNext = glm::abs(glm::fract(pixel) - 0.5);
      const Place place = placeOf(scene, pixel);
      if (from.x < 0.0 || from.y < 0.0 || from.x > picture.size.x - 1.0 ||
        from.y > picture.size.y - 1.0 || std::min(toNext.x, toNext.y) < 1e-6 || place == Unclear)
      {
        continue; // nothing is known of what is there, or two pixels are as near
      }
      bool isCut = false;
      for (int k = 0; k < image.size().z; ++k)
      {
        glm::dvec4 point(1.0);
        point[image.axes()[0]] = image.onRay(u, v, k).x;
        point[image.axes()[1]] = image.onRay(u, v, k).y;
        point[image.axes()[2]] = k;
        const glm::dvec3 middle = 0.5 * glm::dvec3(scene.view.dimensions - 1);
        if (glm::any(glm::greaterThan(glm::abs(glm::dvec3(point) - middle), middle + 0.5)))
        {
          continue; // not in a voxel
        }
        const double away = (scene.view.indexToClip * point).z - (2.0 * scene.depth - 1.0);
        const bool isIn =
          intervals.empty() || (k >= intervals.first(v)[u] && k <= intervals.last(v)[u]);
        isCut = isCut || (place == Inside && away > 1e-6);
        // Depths and shears are rounded.
        check(std::abs(away) < 1e-6 || isIn == (place == Outside || away < 0.0), "a sample ", away,
          " behind the plane is ", isIn ? "kept" : "cut");
      }
      cut += isCut;
    }
  }
  return cut;
}

/// The number of pixels that may show the volume and that the scene does not hide.
std::size_t countSeen(const Scene& scene)
{
  splatting::Picture picture;
  splatting::placePicture(scene.splat.geometries, scene.view.viewport, picture);
  picture.pixels.assign(std::size_t(picture.size.x) * picture.size.y, 0u);
  for (const splatting::ShearWarp& geometry : scene.splat.geometries)
  {
    const splatting::Outline outline =
      geometry.minifiesAnyAxis() ? splatting::metByAreas(geometry) : splatting::shownBy(geometry);
    for (int y = 0; y < picture.size.y; ++y)
    {
      const glm::dvec3 start(picture.origin.x, picture.origin.y + y, 1.0);
      const splatting::Span row = outline.cut({ 0, picture.size.x }, start);
      for (int x = row.begin; x < row.end; ++x)
      {
        picture.pixels[std::size_t(y) * picture.size.x + x] = 1;
      }
    }
  }
  scene.cuts.Hide(picture);
  return picture.pixels.size() - std::count(picture.pixels.begin(), picture.pixels.end(), 0u);
}

void testScene(Checks& check, coretesting::Sightings& seen, reference::Random& random)
{
  Scene scene(random);
  if (scene.splat.geometries.empty())
  {
    return;
  }
  scene.find(false);
  check(!scene.isRead && scene.splat.cuts.front().intervals.empty(),
    "depths are read although nothing intermixes");
  const std::size_t all = countSeen(scene);
  scene.kept = scene.splat;
  scene.find(true);
  check(scene.isRead && scene.isKept(), "an empty scene cuts");
  // A plane somewhere in the volume.
  const glm::dvec4 middle(0.5 * glm::dvec3(scene.view.dimensions - 1), 1.0);
  const double reach = 0.002 * glm::length(glm::dvec3(scene.view.dimensions));
  scene.depth = 0.5 + 0.5 * ((scene.view.indexToClip * middle).z + random.uniform(-reach, reach));
  scene.depth = double(float(scene.depth));
  scene.find(true);
  const int cut = testIntervals(check, scene);
  check(cut == 0 || !scene.isKept(), "a plane is not noticed");
  seen.add(cut > 0);
  scene.kept = scene.splat;
  scene.find(true);
  check(scene.isKept(), "the same plane is taken for another");
  scene.depth = 0.0;
  scene.find(true);
  check(countSeen(scene) == 0 && all > 0, "what is behind everything is seen");
  scene.view.cropping.flags = 1;
  scene.depth = 1.0;
  scene.find(true);
  check(!scene.isKept() && countSeen(scene) == all, "cropping is not noticed");
}
}

int TestSceneCuts(int, char*[])
{
  Checks check;
  coretesting::Sightings seen;
  reference::forScenes(
    "scenes", 200, [&](int, reference::Random& random) { testScene(check, seen, random); });
  check(seen.areEnough(0.3), "planes cut in only ", seen);
  return check.exitCode();
}
