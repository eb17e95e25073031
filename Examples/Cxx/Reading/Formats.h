// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Formats_h
#define Formats_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include <string>

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

#endif
