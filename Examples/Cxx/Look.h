// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Look_h
#define Look_h

#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <string>
#include <vector>

/**
 * How values become colours: Window wide around Level, in Colormap.
 */
struct LookSettings
{
  double Window = 1.0;
  double Level = 0.5;
  std::string Colormap = "gray";
};

/**
 * The names that LookSettings::Colormap may have.
 */
std::vector<std::string> GetColormapNames();

/**
 * The colours of values.
 */
vtkSmartPointer<vtkColorTransferFunction> MakeColors(const LookSettings& look);

/**
 * The same for values that are bytes: 0 for the low end of the window, 255 for the high one.
 */
using Palette = std::array<std::array<unsigned char, 3>, 256>;
Palette MakePalette(const LookSettings& look);

/**
 * Of maxima black at the median value, white at the value that one voxel in 2000 exceeds: the
 * maximum of a ray is seldom below the one, and a few outliers do not decide the other. Of minima
 * the other way round, of means what lies between a twentieth of the voxels and another. The whole
 * range where these two are equal. Throws a sentence if no value is finite.
 */
void ChooseWindowLevel(vtkImageData* image, int blendMode, double& window, double& level);

#endif
