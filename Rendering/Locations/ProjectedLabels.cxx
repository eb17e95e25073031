// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Locations/ProjectedLabels.h"

#include "Common/Parallel.h"
#include "Display/Locations.h"
#include "Locations/LabelEdges.h"
#include "Scene/SceneCuts.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"

#include <algorithm>
#include <utility>

namespace splatting
{
// Returns whether labels have changed.
bool ProjectedLabels::Load(vtkImageData* labels, const glm::ivec3& size)
{
  if (this->Labels == labels && this->Time == labels->GetMTime())
  {
    return false;
  }
  vtkDataArray* const scalars = scalarsOfLabels(labels);
  this->IsLabel.resize(std::size_t(size.x) * size.y * size.z);
  parallelFor(0, static_cast<std::ptrdiff_t>(this->IsLabel.size()), 0,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t n = first; n < last; ++n)
      {
        this->IsLabel[n] = scalars->GetComponent(n, 0) != 0.0;
      }
    });
  this->Index.reset({ this->IsLabel.data(), ScalarType::UInt8, size });
  this->Labels = labels;
  this->Time = labels->GetMTime();
  return true;
}

std::vector<int> ProjectedLabels::VoxelsOf(const Picture& picture, vtkImageData* labels,
  const View& view, SceneCuts& scene, std::size_t budget)
{
  std::vector<int> voxels(3 * picture.pixels.size(), -1);
  SplatView rays;
  if (!rays.set(view, scene.Get()) || rays.geometries.empty())
  {
    return voxels;
  }
  ProjectionSettings settings;
  settings.quality = Quality::Preview;
  settings.recordLocations = true;
  const bool isOutdated = this->Load(labels, view.dimensions) || !rays.projectsAs(this->Rays, true);
  this->Index.setBudget(budget);
  this->Rays = std::move(rays);
  if (isOutdated)
  {
    this->Images.resize(std::max(this->Images.size(), this->Rays.geometries.size()));
    for (std::size_t n = 0; n < this->Rays.geometries.size(); ++n)
    {
      this->Projector.project(
        this->Index, this->Rays.geometries[n], settings, this->Rays.cuts[n], this->Images[n]);
    }
  }
  Located located;
  located.images = &this->Images;
  located.geometries = &this->Rays.geometries;
  located.volume = this->Index.volume();
  located.high = 1.0;
  located.settings = settings;
  located.view = view;
  Locator::Arrays arrays;
  arrays.voxels = voxels.data();
  Locator(located).fill(picture.origin, picture.size, arrays);
  scene.Hide(picture, voxels);
  return voxels;
}
}
