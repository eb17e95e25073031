// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Scenes whose winning samples are looked for: views with what cuts them, and their projections.
 */
#ifndef WinnerScenes_h
#define WinnerScenes_h

#include "CoreTesting.h"
#include "Display/Locations.h"
#include "Reductions.h"
#include "WideViews.h"

#include <algorithm>
#include <array>
#include <vector>

namespace winnerscenes
{
using namespace coretesting;

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
  if (mayBeCut && random.oneIn(3))
  {
    scene.view.halfSpaces = anyHalfSpaces(size, random);
  }
  if (mayBeCut && random.oneIn(3))
  {
    scene.view.cropping = anyCropping(size, random);
  }
  scene.cuts = rayCutsOf(scene.view.halfSpaces, scene.view.cropping);
  return scene;
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
    result.push_back(project(index, geometry, settings, cutsBy(geometry, scene.cuts)));
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
}

#endif
