// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Converts VTK's matrices, planes and regions of a volume's view to numbers.
 */
#ifndef WorldView_h
#define WorldView_h

#include "Geometry/View.h"
#include "Input/VolumeGrid.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkMatrix4x4;
class vtkPlaneCollection;
VTK_ABI_NAMESPACE_END

namespace splatting
{
glm::dmat4 toGlm(const vtkMatrix4x4* matrix);

/**
 * Whether the matrix from index space to world space is singular or not finite.
 */
bool isSingular(const glm::dmat4& indexToWorld);

/**
 * The view, with the half-spaces of the near and far plane that cut the volume.
 */
View viewOf(const VolumeGrid& grid, const glm::dmat4& indexToWorld, const glm::dmat4& worldToClip,
  const glm::ivec2& viewport);

/**
 * Adds the half-spaces of clipping planes in world space.
 */
void addPlanes(View& view, const glm::dmat4& indexToWorld, vtkPlaneCollection* planes);

/**
 * VTK's cropping. Its planes are orthogonal to the axes of the image, for any direction matrix.
 */
Cropping croppingOf(const VolumeGrid& grid, const double planes[6], int flags);

/**
 * Adds the two half-spaces of a slab that is orthogonal to the direction of projection. In a
 * parallel view this is the direction of the rays. In perspective it is the direction in which w,
 * the fourth coordinate of clip space, grows. Centre and thickness are in world space.
 */
void addSlab(View& view, const glm::dmat4& indexToWorld, const double centre[3], double thickness);
}

#endif
