// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Picture_h
#define Picture_h

#include "vtkImageData.h"

#include <string>

/**
 * Writes a text into the top left corner of a picture in RGB, without OpenGL: white, or black on
 * paper.
 */
void DrawLabel(vtkImageData* picture, const std::string& text, bool isOnPaper);

#endif
