// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * VTK's inline namespace, which VTK 9.2 and newer have. Empty before.
 */
#ifndef vtkSplattingMIPNamespace_h
#define vtkSplattingMIPNamespace_h

#include "vtkType.h" // includes VTK's own header of the namespace

#ifndef VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_END
#endif

#endif
