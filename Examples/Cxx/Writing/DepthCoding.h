// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DepthCoding_h
#define DepthCoding_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"
#include "vtkSplattingMIPProjection.h"

#include <string>

/**
 * The depths of the first and the last hue: distances from the plane through the focal point across
 * the view, positive away from the viewer.
 */
struct DepthRange
{
  double Near;
  double Far;
};

/**
 * Find the range of a slab, or that of the volume in all views.
 */
DepthRange FindDepthRange(vtkSplattingMIPProjection* projection);

/**
 * Colour brightness, a byte for each pixel, by depth: the hue goes from red, where the sample is
 * near, over green to blue. The projection must have recorded locations.
 */
vtkSmartPointer<vtkImageData> ColorByDepth(
  vtkImageData* bytes, vtkSplattingMIPProjection* projection, const DepthRange& range);

/**
 * Describe the hues in two lines.
 */
std::string DescribeHues(const DepthRange& range, bool isInMillimeters);

#endif
