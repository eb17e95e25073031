// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Picture_h
#define Picture_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"
#include "vtkSplattingMIPProjection.h"

#include <string>

/**
 * Write a text into the top left corner of each slice of bytes or colours, in the brightest value,
 * without OpenGL.
 */
void DrawLabel(vtkImageData* slices, const std::string& text);

/**
 * Write the patient's sides at the edges of each view of a projection by DICOM's letters: R and L,
 * A and P, H and F (head, feet). A further letter is added where an edge is more than 15 degrees
 * off.
 */
void DrawSides(vtkImageData* slices, vtkSplattingMIPProjection* projection);

/**
 * Draw a bar of 1, 2 or 5 times a power of ten millimetres at the bottom right.
 */
void DrawScaleBar(vtkImageData* slices, double millimetersPerPixel);

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
