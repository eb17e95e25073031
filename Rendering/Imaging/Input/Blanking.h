// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Voxels that a data set or a mask hides.
 */
#ifndef Blanking_h
#define Blanking_h

#include "vtkSplattingMIPNamespace.h"

#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataSet;
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * An error message for the ghost arrays of a data set, whose voxels are cells or points, or for the
 * mask (may be nullptr); else an empty string.
 */
std::string problemOfBlanking(vtkDataSet* data, bool cells, vtkImageData* mask);

/**
 * One flag per voxel, not 0 if it is hidden; empty if no voxel is hidden.
 *
 * HIDDENPOINT hides points, and cells with such a point. HIDDENCELL hides cells, and points whose
 * cells all have it. A mask hides voxels where it is 0. Duplicates are not hidden.
 */
std::vector<unsigned char> findBlanked(vtkDataSet* data, bool cells, vtkImageData* mask);
}

#endif
