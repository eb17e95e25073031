// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef AbortCheck_h
#define AbortCheck_h

#include "vtkAlgorithm.h"
#include "vtkVersionMacros.h"

namespace splatting
{
/// Whether a filter, or with VTK 9.3 and newer one upstream, is to stop.
inline bool isAborted(vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  return algorithm->CheckAbort();
#else
  return algorithm->GetAbortExecute() != 0;
#endif
}
}

#endif
