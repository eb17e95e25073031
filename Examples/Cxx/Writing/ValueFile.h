// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ValueFile_h
#define ValueFile_h

#include "vtkImageData.h"

#include <array>
#include <string>
#include <vector>

/**
 * List the endings of files of values.
 */
std::vector<std::string> GetValueEndings();

/**
 * Return whether a name has one of those endings.
 */
bool IsValueFile(const std::string& path);

/**
 * Write the values of a picture by vtkSplattingMIPProjection with its position in the patient
 * (LPS), which is relative to an origin. Throws std::runtime_error with one sentence.
 */
void WriteValues(
  vtkImageData* picture, const std::array<double, 3>& origin, const std::string& path);

#endif
