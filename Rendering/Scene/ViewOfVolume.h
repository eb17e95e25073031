// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The view of a volume by a renderer: WorldView.h for VTK's scene.
 */
#ifndef ViewOfVolume_h
#define ViewOfVolume_h

#include "Geometry/View.h"
#include "Input/VolumeGrid.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Whether spacing, direction and prop matrix are singular or not finite.
 */
bool isFlat(const VolumeGrid& grid, vtkVolume* volume);

/**
 * The view of the renderer's active camera, with the half-spaces of the mapper's clipping planes
 * and of the near and far plane that cut the volume, and the mapper's cropping.
 */
View makeView(
  const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer, vtkVolumeMapper* mapper);

/**
 * Index space (first voxel at 0) to world space.
 */
glm::dmat4 indexToWorld(const VolumeGrid& grid, vtkVolume* volume);

/**
 * World space to index space. The volume must not be flat.
 */
glm::dmat4 worldToIndex(const VolumeGrid& grid, vtkVolume* volume);

/**
 * As in WorldView.h.
 */
void addSlab(
  View& view, const VolumeGrid& grid, vtkVolume* volume, const double centre[3], double thickness);
}

#endif
