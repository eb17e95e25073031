// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Scenes whose winning samples are looked for: views with what cuts them, and their projections.
 */
#ifndef WinnerScenes_h
#define WinnerScenes_h

#include "CoreTesting.h"
#include "Projection/Locations.h"
#include "Reductions.h"
#include "WideViews.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace winnerscenes
{
using namespace coretesting;

inline std::string nameOf(const char* series, bool perspective)
{
  return std::string(series) + (perspective ? ", in perspective" : "");
}

/// A view with one or more shear images, and what cuts it.
struct Scene
{
  splatting::View view;
  std::vector<splatting::ShearWarp> images;
  reference::RayCuts cuts;
};

inline Scene anyScene(
  const std::array<int, 3>& size, bool perspective, reference::Random& random, bool mayBeCut = true)
{
  Scene scene;
  while (scene.images.empty())
  {
    scene.view = magnified(perspective ? randomPerspective(size, random) : anyView(size, random));
    splatting::ShearWarp::factorise(scene.view, scene.images);
  }
  if (mayBeCut && random.uniform(0, 2) == 0)
  {
    const glm::dvec3 normal = anyVector(random, -1.0, 1.0);
    const glm::dvec3 middle = 0.5 * glm::dvec3(scene.view.dimensions - 1);
    scene.view.halfSpaces.emplace_back(normal, -glm::dot(normal, middle) + 0.1);
  }
  if (mayBeCut && random.uniform(0, 2) == 0)
  {
    for (int a = 0; a < 3; ++a)
    {
      const double low = random.uniform(0.0, size[a] - 1.0);
      scene.view.cropping.planes[a] = { low, low + 1.0 + random.uniform(0.0, 4.0) };
    }
    scene.view.cropping.flags =
      static_cast<std::uint32_t>(random.bits()) & splatting::Cropping::All;
  }
  for (const glm::dvec4& h : scene.view.halfSpaces)
  {
    scene.cuts.halfSpaces.push_back({ h.x, h.y, h.z, h.w });
  }
  for (int a = 0; a < 3; ++a)
  {
    scene.cuts.planes[a] = { scene.view.cropping.planes[a].x, scene.view.cropping.planes[a].y };
  }
  scene.cuts.regions = scene.view.cropping.flags;
  return scene;
}

inline reference::RayCutter cutterOf(
  const splatting::ShearWarp& geometry, const std::array<int, 3>& size, const Scene& scene)
{
  if (geometry.isPerspective())
  {
    return { referenceRays(geometry), scene.cuts };
  }
  const reference::ShearView view = referenceView(geometry);
  return { reference::makeShearGrid(size, view), view, scene.cuts };
}

template <class T>
splatting::VoxelArray arrayOf(const reference::Volume<T>& volume)
{
  return { volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) };
}

template <class T>
std::vector<splatting::ShearImage> projectScene(
  const reference::Volume<T>& volume, const Scene& scene, splatting::ProjectionSettings& settings)
{
  settings.recordLocations = true;
  splatting::VolumeIndex index;
  index.reset(arrayOf(volume));
  std::vector<splatting::ShearImage> result;
  for (const splatting::ShearWarp& geometry : scene.images)
  {
    result.push_back(project(
      index, geometry, settings, cutsBy(geometry, scene.view.halfSpaces, scene.view.cropping)));
  }
  return result;
}

template <class T>
splatting::Located located(const reference::Volume<T>& volume, const Scene& scene,
  const std::vector<splatting::ShearImage>& images, const splatting::ProjectionSettings& settings)
{
  splatting::Located located;
  located.images = &images;
  located.geometries = &scene.images;
  located.volume = arrayOf(volume);
  const auto range = std::minmax_element(volume.voxels.begin(), volume.voxels.end());
  located.low = static_cast<double>(*range.first);
  located.high = static_cast<double>(*range.second);
  located.settings = settings;
  located.view = scene.view;
  return located;
}

template <class T>
reference::RaySamples<T> voxelsOf(
  const reference::Volume<T>& volume, const splatting::ShearWarp& geometry)
{
  return geometry.isPerspective() ? reference::voxelSamples(volume, referenceRays(geometry))
                                  : reference::voxelSamples(volume, referenceView(geometry));
}

inline std::vector<std::array<int, 3>> pathOf(
  const std::array<int, 3>& size, const splatting::ShearWarp& geometry, int u, int v)
{
  return geometry.isPerspective() ? reference::crossedVoxels(referenceRays(geometry), u, v)
                                  : reference::crossedVoxels(size, referenceView(geometry), u, v);
}
}

#endif
