// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Placement_h
#define Placement_h

#include "Reading/VolumeReader.h"

#include <array>
#include <string>
#include <vector>

/**
 * Vectors from voxel to voxel along the three axes of an image.
 */
using Steps = std::array<std::array<double, 3>, 3>;

/**
 * Set spacing, orientation and origin of a volume whose image has been read. Steps and origin, the
 * first voxel, are in the patient's coordinates (LPS), in a unit of length by one of its names or
 * symbols; empty if it is unknown. They are converted to millimetres, and a note names other units.
 * Where a step has no usable length it becomes 1 mm along its axis, with a note and a caution.
 */
void PlaceVolume(
  Volume& volume, Steps steps, std::array<double, 3> origin, const std::string& unit);

/**
 * Turn steps and origin from RAS (x to the right, y to the front) to LPS.
 */
void TurnToLPS(Steps& steps, std::array<double, 3>& origin);

/**
 * Add a line to the warnings that pictures must show.
 */
void AddCaution(Volume& volume, const std::string& caution);

/**
 * Return even places from the first of the given ones, which rise or fall, to the last. The step
 * is the mean of those within a tenth of the least, or a little less, so that it divides the
 * length. Places that are off by less than the tolerance, in steps, are returned as they are.
 * Returns nothing if there were more than eight times as many.
 */
std::vector<double> SpaceEvenly(const std::vector<double>& places, double tolerance);

/**
 * Interpolate an image linearly along an axis, as floating point.
 */
vtkSmartPointer<vtkImageData> Interpolate(vtkImageData* image, int axis,
  const std::vector<double>& places, const std::vector<double>& newPlaces);

#endif
