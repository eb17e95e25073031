// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TransferFunctions_h
#define TransferFunctions_h

#include "Warp.h"

class vtkVolumeProperty;

/**
 * The colour and opacity functions of a property's first component, as a table for values from
 * dataLow to dataHigh. Integers get sixteen entries per grey level, as far as 65536 go, other
 * values all of those.
 */
splatting::ColorTable tabulateColors(
  vtkVolumeProperty* property, double dataLow, double dataHigh, bool integers);

#endif
