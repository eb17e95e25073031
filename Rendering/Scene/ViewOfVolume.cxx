// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ViewOfVolume.h"

#include "Input/WorldView.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"

#include <glm/matrix.hpp>

namespace splatting
{
glm::dmat4 indexToWorld(const VolumeGrid& grid, vtkVolume* volume)
{
  return toGlm(volume->GetMatrix()) * grid.indexToPhysical;
}

bool isFlat(const VolumeGrid& grid, vtkVolume* volume)
{
  return isSingular(indexToWorld(grid, volume));
}

View makeView(
  const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer, vtkVolumeMapper* mapper)
{
  int width, height, left, bottom;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  // The camera's composite matrix omits stereo.
  vtkCamera* const camera = renderer->GetActiveCamera();
  const glm::dmat4 worldToClip =
    toGlm(camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1.0, 1.0)) *
    toGlm(camera->GetViewTransformMatrix());
  const glm::dmat4 world = indexToWorld(grid, volume);
  View view = viewOf(grid, world, worldToClip, { width, height });
  if (vtkPlaneCollection* const planes = mapper->GetClippingPlanes())
  {
    addPlanes(view, world, planes);
  }
  if (mapper->GetCropping())
  {
    view.cropping =
      croppingOf(grid, mapper->GetCroppingRegionPlanes(), mapper->GetCroppingRegionFlags());
  }
  return view;
}

glm::dmat4 worldToIndex(const VolumeGrid& grid, vtkVolume* volume)
{
  return glm::inverse(indexToWorld(grid, volume));
}

void addSlab(
  View& view, const VolumeGrid& grid, vtkVolume* volume, const double centre[3], double thickness)
{
  addSlab(view, indexToWorld(grid, volume), centre, thickness);
}
}
