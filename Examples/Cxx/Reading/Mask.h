// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Mask_h
#define Mask_h

#include "Reading/VolumeReader.h"

#include <string>

/**
 * Choice of the voxels to show: those with one label, or with any but 0.
 */
struct MaskSettings
{
  std::string Path; // empty: all voxels
  int Label = 0;    // 0: any
};

/**
 * Hide the voxels of a volume whose nearest voxel of the mask is not chosen, or that lie outside
 * the mask. A note says whether their voxels differ. Throws std::runtime_error with one sentence.
 */
void ApplyMask(const MaskSettings& settings, Volume& volume);

#endif
