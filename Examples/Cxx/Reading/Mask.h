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
 * Hides the voxels that a mask does not show: each whose nearest voxel of the mask is none of
 * those, or lies outside it. A note says so if their voxels differ. Throws std::runtime_error with
 * one sentence.
 */
void ApplyMask(const MaskSettings& settings, Volume& volume);

#endif
