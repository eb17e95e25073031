// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Called by functions.py through ctypes, which releases Python's lock.
#include "vtkAlgorithm.h"

#include <new>

/// False if there is not enough memory.
extern "C" VTK_ABI_EXPORT bool splattingmip_update(void* algorithm)
{
  try
  {
    static_cast<vtkAlgorithm*>(algorithm)->Update();
    return true;
  }
  catch (const std::bad_alloc&)
  {
    return false;
  }
}
