// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How a renderer sees a volume: WorldView.h for VTK's scene.
 */
#ifndef ViewOfVolume_h
#define ViewOfVolume_h

#include "Geometry/View.h"
#include "Input/VolumeGrid.h"

class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

namespace splatting
{
/**
 * Whether spacing, direction and prop matrix flatten the volume, or have no meaning (NaN).
 */
bool isFlat(const VolumeGrid& grid, vtkVolume* volume);

/**
 * The view of the renderer's active camera. Half-spaces: those of the mapper's clipping planes and
 * of the near and far plane that cut into the volume. Cropping: the mapper's.
 */
View makeView(
  const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer, vtkVolumeMapper* mapper);

/**
 * Index space (first voxel at 0) to world space.
 */
glm::dmat4 indexToWorld(const VolumeGrid& grid, vtkVolume* volume);

/**
 * World space to index space, of a volume that is not flat.
 */
glm::dmat4 worldToIndex(const VolumeGrid& grid, vtkVolume* volume);

/**
 * As in WorldView.h.
 */
void addSlab(
  View& view, const VolumeGrid& grid, vtkVolume* volume, const double centre[3], double thickness);
}

#endif
