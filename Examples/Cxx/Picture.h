// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Picture_h
#define Picture_h

#include "vtkImageData.h"

#include <string>

/**
 * Writes a text into the top left corner of each slice of bytes, with the brightest, without
 * OpenGL.
 */
void DrawLabel(vtkImageData* slices, const std::string& text);

#endif
