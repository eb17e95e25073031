// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which voxels a data set or a mask hides.
 */
#ifndef Blanking_h
#define Blanking_h

#include <string>
#include <vector>

class vtkDataSet;
class vtkImageData;

namespace splatting
{
/**
 * What is wrong with the ghost arrays of a data set, whose voxels are cells or points, or with the
 * mask (may be nullptr); empty if nothing is.
 */
std::string problemOfBlanking(vtkDataSet* data, bool cells, vtkImageData* mask);

/**
 * One flag per voxel, not 0 where it is hidden; no flags if none is.
 *
 * Points are hidden by HIDDENPOINT, and if all cells that use them have HIDDENCELL; cells by
 * HIDDENCELL, and if one of their points has HIDDENPOINT. Where the mask is 0, voxels are hidden,
 * too. Duplicates are not hidden.
 */
std::vector<unsigned char> findBlanked(vtkDataSet* data, bool cells, vtkImageData* mask);
}

#endif
