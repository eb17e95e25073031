// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ValueFile_h
#define ValueFile_h

#include "vtkSplattingMIPProjection.h"

#include <array>
#include <string>

/**
 * Whether a name is that of a file of values: .nii, .nii.gz or .mha.
 */
bool IsValueFile(const std::string& path);

/**
 * Writes the values of a projection's one view where it lies in the patient: the plane through the
 * middle of the volume, whose first voxel has the given origin (LPS). Pixels in which nothing is
 * seen are NaN. Throws std::runtime_error with one sentence.
 */
void WriteValues(vtkSplattingMIPProjection* projection, const std::array<double, 3>& origin,
  const std::string& path);

#endif
