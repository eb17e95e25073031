// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How a volume in the world is seen, from VTK's matrices, planes and regions to numbers.
 */
#ifndef WorldView_h
#define WorldView_h

#include "Geometry/View.h"
#include "Input/VolumeGrid.h"

class vtkMatrix4x4;
class vtkPlaneCollection;

namespace splatting
{
glm::dmat4 toGlm(const vtkMatrix4x4* matrix);

/**
 * Whether the matrix from index space to the world flattens the volume, or has no meaning (NaN).
 */
bool isSingular(const glm::dmat4& indexToWorld);

/**
 * Half-spaces: those of the near and far plane that cut into the volume.
 */
View viewOf(const VolumeGrid& grid, const glm::dmat4& indexToWorld, const glm::dmat4& worldToClip,
  const glm::ivec2& viewport);

/**
 * Adds the half-spaces of clipping planes in the world.
 */
void addPlanes(View& view, const glm::dmat4& indexToWorld, vtkPlaneCollection* planes);

/**
 * VTK's cropping, whose planes lie across the axes of the image, wherever its direction matrix
 * turns these.
 */
Cropping croppingOf(const VolumeGrid& grid, const double planes[6], int flags);

/**
 * Adds the two half-spaces of a slab across the direction of projection: that of the rays of a
 * parallel view; in perspective that in which w, the fourth coordinate of clip space, grows. Centre
 * and thickness are in the world.
 */
void addSlab(View& view, const glm::dmat4& indexToWorld, const double centre[3], double thickness);
}

#endif
