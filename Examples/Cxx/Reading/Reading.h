// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Reading_h
#define Reading_h

#include "Reading/FileHeaders.h"
#include "Reading/QuietReading.h"

#include "vtkAlgorithm.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

/**
 * Throws a sentence about a file.
 */
[[noreturn]] void Refuse(const std::string& path, const std::string& reason);
[[noreturn]] void RefuseDamaged(const std::string& path, const QuietReading& quiet);

/**
 * A damaged header can ask for any amount of memory: refuse before it is allocated.
 */
void CheckMemory(double voxels, const std::string& path);

/**
 * Refuse a number (from 1 on, or 0 for any) of a volume, or of a component, that a file does not
 * have.
 */
void CheckFrame(const std::string& path, int number, int count);
void CheckComponent(const std::string& path, int number, int count);

/**
 * What is said of one component (from 1 on, or 0 for the first) of several.
 */
std::string DescribeComponent(int number, int count);

/**
 * As in ".a, .b or .c".
 */
std::string JoinWords(const std::vector<std::string>& words);

template <class Reader>
bool HasFailed(Reader* reader, const QuietReading& quiet)
{
  return quiet.HasErrors() || reader->GetErrorCode() != vtkErrorCode::NoError;
}

/**
 * Run one of VTK's readers to its image; whatever goes wrong becomes one sentence. The header,
 * where the format has one, tells whether the data are complete.
 */
vtkSmartPointer<vtkImageData> RunReader(vtkAlgorithm* reader, const std::string& path,
  const QuietReading& quiet, const TextHeader* header = nullptr);

#endif
