// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Selection_h
#define Selection_h

#include "Display/Picture.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkHardwareSelector;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Replaces a picture by the identifiers of the selector's current pass, opaque where the picture is
 * not transparent. A volume is selected as a whole: prop, process, composite index 1 (as in
 * vtkPolyDataMapper), point 0 and cell 0.
 */
void drawIdentifiers(vtkHardwareSelector* selector, Picture& picture);
}

#endif
