// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ITKVolume_h
#define ITKVolume_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include <string>

/**
 * Read NRRD or MetaImage with ITK. Axes beyond the third, and a list of values in each voxel of
 * NRRD, are frames. Throws std::runtime_error with one sentence.
 */
Volume ReadNRRD(const std::string& path, const ReadSettings& settings, const QuietReading& quiet);
Volume ReadMeta(const std::string& path, const ReadSettings& settings, const QuietReading& quiet);

#endif
