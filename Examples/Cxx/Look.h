// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Look_h
#define Look_h

#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

/**
 * Mapping from values to colours: a window around a level, and a colormap or, if a colour is named,
 * the colours from black to it.
 */
struct LookSettings
{
  double Window = 1.0;
  double Level = 0.5;
  std::string Colormap = "gray";
  std::string Color; // a name of vtkNamedColors
};

/**
 * List the names of the colormaps.
 */
std::vector<std::string> GetColormapNames();

/**
 * Make the colours of values.
 */
vtkSmartPointer<vtkColorTransferFunction> MakeColors(const LookSettings& look);

/**
 * Make the colours of bytes: 0 is the low end of the window, 255 the high one.
 */
vtkSmartPointer<vtkColorTransferFunction> MakePalette(const LookSettings& look);

/**
 * Choose a window from the values. For maxima, black is the median value and white the value that
 * one voxel in 2000 exceeds: few rays have a maximum below the median, and a few outliers do not
 * determine white. For minima it is the reverse. For means it is the range without the lowest and
 * the highest twentieth of the voxels. If these limits are equal, it is the whole range. Throws
 * std::runtime_error if no value is finite.
 */
void ChooseWindowLevel(vtkImageData* image, int blendMode, double& window, double& level);

/**
 * The same for signed maxima: the level is the origin. One voxel in 2000 is farther from it than
 * the ends of the window.
 */
void ChooseSignedWindow(vtkImageData* image, double origin, double& window, double& level);

#endif
