// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Reading_h
#define Reading_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

/**
 * Throw a sentence about a file.
 */
[[noreturn]] void Refuse(const std::string& path, const std::string& reason);

/**
 * Throw the sentence about a damaged file, with what a library reports, which may be empty.
 */
[[noreturn]] void RefuseDamaged(const std::string& path, const std::string& report);

/**
 * Replace control characters and bytes that are not UTF-8 by question marks. Files must not control
 * the terminal.
 */
std::string MakePrintable(const std::string& text);

/**
 * Refuse a volume that does not fit into memory, before it is allocated: damaged headers can ask
 * for any amount.
 */
void CheckMemory(double voxels, const std::string& path);

/**
 * Read the first MiB of a file.
 */
std::string ReadHead(const std::string& path);

/**
 * Choose one of several volumes, channels or components by a number from 1 on, or 0 for the first.
 * Refuses numbers that the file does not have. If there are several, a note names the option that
 * chooses. Returns the number, from 1 on.
 */
int Choose(const std::string& path, const std::string& what, int number, int count,
  std::vector<std::string>& notes);

/**
 * Return one of the components of an image, from 1 on; the image itself if it has one.
 */
vtkSmartPointer<vtkImageData> ExtractComponent(vtkImageData* image, int number);

/**
 * Return VTK's name for a type of numbers, or VTK_VOID if there is none.
 */
int FindScalarType(std::size_t bytes, bool isFloat, bool isSigned);

/**
 * Return the type of floating-point numbers that has all values of another of VTK's types.
 */
int FindFloatType(int type);

/**
 * Join words as in ".a, .b or .c".
 */
std::string JoinWords(const std::vector<std::string>& words);

/**
 * Return the names of the entries of a table.
 */
template <class Table>
std::vector<std::string> ListNames(const Table& table)
{
  std::vector<std::string> names;
  for (const auto& entry : table)
  {
    names.emplace_back(entry.Name);
  }
  return names;
}

/**
 * Find the entry of a table whose name is the end of a path in lower case; nullptr if there is
 * none.
 */
template <class Entry, std::size_t Size>
const Entry* FindByEnding(const Entry (&table)[Size], const std::string& path)
{
  const auto* const found = std::find_if(std::begin(table), std::end(table),
    [&](const Entry& entry) { return vtksys::SystemTools::StringEndsWith(path, entry.Name); });
  return found == std::end(table) ? nullptr : found;
}

/**
 * Read a volume of one format, placed in the patient's coordinates (LPS) as far as the file gives
 * its orientation. Libraries' messages go to the last argument. They throw std::runtime_error with
 * one sentence.
 */
using ReadFunction = Volume(const std::string&, const ReadSettings&, const QuietReading&);

ReadFunction ReadVTK;   // images and rectilinear grids
ReadFunction ReadMeta;  // MetaImage
ReadFunction ReadNRRD;  //
ReadFunction ReadNIFTI; // and Analyze
ReadFunction ReadTIFF;  // stacks, also by ImageJ and OME
ReadFunction ReadDICOM; // a file, a folder or a DICOMDIR

/**
 * Read the text of a .vti file.
 */
Volume ReadVTKText(const std::string& text, const std::string& name, const QuietReading& quiet);

template <class Reader>
bool HasFailed(Reader* reader, const QuietReading& quiet)
{
  return quiet.HasErrors() || reader->GetErrorCode() != vtkErrorCode::NoError;
}

#endif
