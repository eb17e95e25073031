// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact maxima of rays that are cut: by half-spaces, cropping, a closed surface, a depth buffer.
 */
#include "CellViews.h"

namespace
{
using namespace celltesting;
using coretesting::anyPoint;

/// What is visible of a scene.
enum CutKind
{
  HalfSpaces,
  NearAndFar,
  Regions,
  Surface,
  DepthBuffer,
  All
};

/// The camera's own planes, somewhere in the volume.
void addNearAndFar(View& view, const std::array<int, 3>& size, Random& random)
{
  const glm::dvec4 z = glm::row(view.indexToClip, 2), w = glm::row(view.indexToClip, 3);
  const glm::dvec4 p(anyPoint(size, random), 1.0), q(anyPoint(size, random), 1.0);
  const double sense = glm::dot(w, p) < 0.0 ? -1.0 : 1.0;
  const double a = glm::dot(z, p) / glm::dot(w, p), b = glm::dot(z, q) / glm::dot(w, q);
  view.halfSpaces.push_back(sense * (z - std::min(a, b) * w));
  view.halfSpaces.push_back(sense * (std::max(a, b) * w - z));
}

/// A tetrahedron or a star of triangles around a point: rays may meet it several times.
template <class T>
void addSurface(Scene<T>& scene, Random& random)
{
  const std::array<int, 3>& size = scene.volume.size;
  const glm::dvec3 middle = anyPoint(size, random);
  const double reach = random.uniform(0.2, 0.8) * std::max({ size[0], size[1], size[2], 2 });
  // The octahedron, whose corners are moved in and out.
  for (int n = 0; n < 6; ++n)
  {
    glm::dvec3 corner(0.0);
    corner[n / 2] = n % 2 ? 1.0 : -1.0;
    corner += coretesting::anyVector(random, -0.4, 0.4);
    scene.points.push_back(middle + reach * random.uniform(0.3, 1.5) * corner);
  }
  for (int n = 0; n < 8; ++n)
  {
    const glm::ivec3 triangle(n & 1, 2 + (n >> 1 & 1), 4 + (n >> 2));
    // Each with a corner of its own between: 24 triangles.
    const glm::dvec3 centre =
      (scene.points[triangle[0]] + scene.points[triangle[1]] + scene.points[triangle[2]]) / 3.0;
    const int last = static_cast<int>(scene.points.size());
    scene.points.push_back(centre + random.uniform(-0.4, 0.6) * (centre - middle));
    for (int e = 0; e < 3; ++e)
    {
      scene.triangles.emplace_back(triangle[e], triangle[(e + 1) % 3], last);
    }
  }
}

/// Depths of points in and around the volume; some pixels show nothing else.
template <class T>
void addDepths(Scene<T>& scene, Random& random)
{
  const glm::ivec2& viewport = scene.view.viewport;
  for (int n = 0; n < viewport.x * viewport.y; ++n)
  {
    const glm::dvec4 p(anyPoint(scene.volume.size, random), 1.0);
    const glm::dvec4 clip = scene.view.indexToClip * p;
    const double depth = 0.5 * (clip.z / clip.w + 1.0);
    scene.depths.push_back(
      !random.oneIn(6) ? static_cast<float>(std::clamp(depth, 0.0, 1.0)) : 1.0f);
  }
}

template <class T>
void addCut(Scene<T>& scene, CutKind kind, Random& random)
{
  View& view = scene.view;
  const std::array<int, 3>& size = scene.volume.size;
  const auto has = [&](CutKind one) { return kind == one || (kind == All && random.oneIn(2)); };
  if (has(HalfSpaces))
  {
    view.halfSpaces = coretesting::anyHalfSpaces(size, random);
  }
  if (has(NearAndFar) && kind != All)
  {
    addNearAndFar(view, size, random);
  }
  if (has(Regions))
  {
    view.cropping = coretesting::anyCropping(size, random);
  }
  if (has(Surface))
  {
    addSurface(scene, random);
  }
  if (has(DepthBuffer))
  {
    addDepths(scene, random);
  }
}

template <class T>
void testCut(const std::string& name, CutKind kind, int scenes, Checks& check)
{
  forFamily<T>(name, scenes, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 18);
      scene.volume = reference::uniformNoise<T>(size, random);
      scene.view = randomCellView(size, 90, random);
      scene.view.showsBoxes = random.oneIn(3);
      addCut(scene, kind, random);
      counts.add(compareScene(scene, check));
    });
}

template <class T>
void testCuts(int scenes, Checks& check)
{
  testCut<T>("half-spaces", HalfSpaces, 2 * scenes, check);
  testCut<T>("near and far plane", NearAndFar, scenes, check);
  testCut<T>("cropping", Regions, 2 * scenes, check);
  testCut<T>("closed surface", Surface, 2 * scenes, check);
  testCut<T>("depth buffer", DepthBuffer, scenes, check);
  testCut<T>("all cuts", All, scenes, check);
}
}

int TestCellCuts(int, char*[])
{
  Checks check;
  testCuts<std::uint8_t>(160, check);
  testCuts<float>(160, check);
  testCuts<std::int32_t>(80, check);
  return check.exitCode();
}
