// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef VTKVolume_h
#define VTKVolume_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include <string>

/**
 * Read an image (.vti, .vtk) or a rectilinear grid (.vtr, .vtk) of VTK: point data, or cell data as
 * voxels in the middle of the cells. Uneven rectilinear grids are interpolated. Throws
 * std::runtime_error with one sentence.
 */
Volume ReadVTK(const std::string& path, const ReadSettings& settings, const QuietReading& quiet);

/**
 * The same for the text of a .vti file; the name is for messages.
 */
Volume ReadVTKText(const std::string& text, const std::string& name, const QuietReading& quiet);

#endif
