// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMSegments_h
#define DICOMSegments_h

#include "Reading/DICOMFrames.h"
#include "Reading/VolumeReader.h"

/**
 * Return whether a file is a DICOM segmentation (SEG).
 */
bool IsSegmentation(const DICOMFile& file);

/**
 * Read a segmentation as a volume of segment numbers, 0 where no segment is, or of one segment
 * alone if a label is given. Frames that the file leaves out are empty. Throws std::runtime_error
 * with one sentence.
 */
void ReadSegments(const DICOMFiles& files, int label, const QuietReading& quiet, Volume& volume);

#endif
