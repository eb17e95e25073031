// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DepthCoding_h
#define DepthCoding_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"
#include "vtkSplattingMIPProjection.h"

#include <string>

/**
 * The depths that have the first and the last hue, from the plane through a projection's focal
 * point across the view, away from the viewer.
 */
struct DepthRange
{
  double Near;
  double Far;
};

/**
 * The slab or, without one, what the volume has in all views.
 */
DepthRange FindDepthRange(vtkSplattingMIPProjection* projection);

/**
 * Colours for the brightness of each pixel, one byte: the hue goes from red, where the sample shown
 * is near, over green to blue. The projection must have recorded locations.
 */
vtkSmartPointer<vtkImageData> ColorByDepth(
  vtkImageData* bytes, vtkSplattingMIPProjection* projection, const DepthRange& range);

/**
 * What the hues mean, in two lines.
 */
std::string DescribeHues(const DepthRange& range, bool isInMillimeters);

#endif
