// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Mask_h
#define Mask_h

#include "Reading/VolumeReader.h"

#include <string>

/**
 * Which voxels are shown: where a file has one label, or any but 0.
 */
struct MaskSettings
{
  std::string Path; // empty: all voxels
  int Label = 0;    // 0: any
};

/**
 * Hides the voxels that a mask does not show. Its voxels must be those of the volume, in any order
 * of axes and directions. Throws std::runtime_error with one sentence.
 */
void ApplyMask(const MaskSettings& settings, Volume& volume);

#endif
