// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Placement_h
#define Placement_h

#include "Reading/VolumeReader.h"

#include <array>
#include <string>

/**
 * Vectors from voxel to voxel along the three axes of an image.
 */
using Steps = std::array<std::array<double, 3>, 3>;

/**
 * Set spacing, orientation and origin of a volume whose image has been read. Steps and origin, the
 * first voxel, are in the patient's coordinates (LPS). A step without a usable length becomes 1 mm
 * along its axis, which a note and the caution say.
 */
void PlaceVolume(Volume& volume, Steps steps, const std::array<double, 3>& origin);

/**
 * Turn steps and origin from RAS (x to the right, y to the front) to LPS.
 */
void TurnToLPS(Steps& steps, std::array<double, 3>& origin);

/**
 * Convert a placed volume from a unit of length, by one of its names or symbols, to millimetres. A
 * note names units other than mm. Lengths of unknown units remain as they are.
 */
void ConvertToMillimeters(Volume& volume, const std::string& unit);

#endif
