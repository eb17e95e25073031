// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Reading_h
#define Reading_h

#include "Reading/QuietReading.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <cstddef>
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
 * The beginning of a file, where its header is, if that is text.
 */
std::string ReadHead(const std::string& path);

/**
 * Refuse a number (from 1 on, or 0 for any) of one of several volumes, channels or components that
 * a file does not have.
 */
void CheckChoice(const std::string& path, const std::string& what, int number, int count);

/**
 * A note about one (from 1 on, or 0 for the first) of several, with the option that chooses.
 */
std::string DescribeChoice(const std::string& what, int number, int count);

/**
 * One of the components of an image, from 1 on.
 */
vtkSmartPointer<vtkImageData> ExtractComponent(vtkImageData* image, int number);

/**
 * VTK's name for a type of numbers, or VTK_VOID if there is none.
 */
int FindScalarType(std::size_t bytes, bool isFloat, bool isSigned);

/**
 * As in ".a, .b or .c".
 */
std::string JoinWords(const std::vector<std::string>& words);

template <class Reader>
bool HasFailed(Reader* reader, const QuietReading& quiet)
{
  return quiet.HasErrors() || reader->GetErrorCode() != vtkErrorCode::NoError;
}

#endif
