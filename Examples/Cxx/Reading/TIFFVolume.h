// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TIFFVolume_h
#define TIFFVolume_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include <string>

/**
 * Read a TIFF stack with libtiff: one page for each slice, or ImageJ's or OME's slices, channels
 * and times, with the voxel size. Throws std::runtime_error with one sentence.
 */
Volume ReadTIFF(const std::string& path, const ReadSettings& settings, const QuietReading& quiet);

#endif
