// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Selection_h
#define Selection_h

#include "Display/Picture.h"

class vtkHardwareSelector;

namespace splatting
{
/**
 * Makes a picture what the selector's current pass wants to see: opaque identifiers where the
 * picture is not transparent. A volume is one thing: it has the prop's and the process's
 * identifier, composite index 1 (as vtkPolyData's mapper has) and point and cell 0.
 */
void drawIdentifiers(vtkHardwareSelector* selector, Picture& picture);
}

#endif
