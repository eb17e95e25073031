// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ValueFile_h
#define ValueFile_h

#include "vtkImageData.h"

#include <array>
#include <string>
#include <vector>

/**
 * How the names of files of values end.
 */
std::vector<std::string> GetValueEndings();

/**
 * Whether a name ends so.
 */
bool IsValueFile(const std::string& path);

/**
 * Writes the values of a picture by vtkSplattingMIPProjection where it lies in the patient, if the
 * picture's place is relative to the given one (LPS). Throws std::runtime_error with one sentence.
 */
void WriteValues(
  vtkImageData* picture, const std::array<double, 3>& origin, const std::string& path);

#endif
