// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Edges of labels, drawn over a picture.
 */
#ifndef LabelEdges_h
#define LabelEdges_h

#include "Display/Picture.h"

#include "vtkSplattingMIPNamespace.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkImageData;
class vtkScalarsToColors;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/// The point scalars or, without any, the cell scalars.
vtkDataArray* scalarsOfLabels(vtkImageData* labels);

/// An error message for labels of a volume with so many voxels along each axis, or an empty string.
std::string validateLabels(vtkImageData* labels, const glm::ivec3& size);

/**
 * Draws each pixel whose label is not 0 and differs from that of one of its four neighbours, in the
 * label's colour, opaque. Pixels outside the picture have label 0.
 *
 * @param voxels  i, j and k of the voxel whose label each pixel has; -1: none, label 0
 * @param colors  nullptr: six colours in turn
 */
void drawLabelEdges(Picture& picture, const std::vector<int>& voxels, vtkImageData* labels,
  vtkScalarsToColors* colors);
}

#endif
