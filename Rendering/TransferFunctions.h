// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TransferFunctions_h
#define TransferFunctions_h

#include "Warp.h"

class vtkVolumeProperty;

/**
 * The colour and opacity functions of one of a property's components, as a table for values from
 * dataLow to dataHigh; opacities are multiplied by the weight. Integers get sixteen entries per
 * grey level, as far as 65536 go, other values all of those.
 */
splatting::ColorTable tabulateColors(vtkVolumeProperty* property, int component, double weight,
  double dataLow, double dataHigh, bool integers);

#endif
