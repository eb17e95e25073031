// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMVolume_h
#define DICOMVolume_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include <string>

/**
 * Reads a series of DICOM slices, or of objects with several frames, as a volume in which each
 * voxel is where the files say. Throws std::runtime_error with one sentence.
 */
Volume ReadDICOM(const std::string& path, const ReadSettings& settings, const QuietReading& quiet);

#endif
