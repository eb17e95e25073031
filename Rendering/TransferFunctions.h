// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TransferFunctions_h
#define TransferFunctions_h

#include "Warp.h"

class vtkVolumeProperty;

/**
 * Window and level of the picture: a colour c from 0 to 1, before it is multiplied by its opacity,
 * becomes (c - level) / window + 1/2. The opacity stays. Premultiplied colours are cut off at 0 and
 * 1, so that one above its opacity adds to what is behind, as in VTK's ray casters.
 */
struct FinalColor
{
  float window = 1.0f;
  float level = 0.5f;

  bool operator==(const FinalColor& other) const
  {
    return this->window == other.window && this->level == other.level;
  }
  /// Whether there are such colours: finite numbers, and the window is not 0.
  bool isValid() const;
};

/**
 * The colour and opacity functions of one of a property's components, as a table for values from
 * dataLow to dataHigh; opacities are multiplied by the weight. Integers get sixteen entries per
 * grey level, as far as 65536 go, other values all of those.
 */
splatting::ColorTable tabulateColors(vtkVolumeProperty* property, int component, double weight,
  double dataLow, double dataHigh, bool integers, const FinalColor& finalColor);

#endif
