// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef NIFTIVolume_h
#define NIFTIVolume_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include <string>

/**
 * Reads a NIfTI file, or a pair of .hdr and .img, which may be Analyze's, by either name. Values
 * are scaled as the header says. Throws std::runtime_error with one sentence.
 */
Volume ReadNIFTI(const std::string& path, const ReadSettings& settings, const QuietReading& quiet);

#endif
