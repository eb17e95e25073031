// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Orientation_h
#define Orientation_h

#include "vtkMatrix4x4.h"
#include "vtkSmartPointer.h"

/**
 * The matrix whose columns are the image axes in patient coordinates, or the identity where they do
 * not span space. Files that count from left to right and back to front (RAS) are turned to LPS.
 */
vtkSmartPointer<vtkMatrix4x4> MakeOrientation(const double axes[3][3], bool isRAS = false);

/**
 * The same for a matrix with these columns, or nullptr for the identity's.
 */
vtkSmartPointer<vtkMatrix4x4> MakeOrientation(vtkMatrix4x4* columns, bool isRAS = false);

#endif
