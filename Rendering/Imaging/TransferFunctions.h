// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TransferFunctions_h
#define TransferFunctions_h

#include "Display/Warp.h"

class vtkVolumeProperty;

namespace splatting
{
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
 * The values that a table is for.
 */
struct ScalarRange
{
  double low;
  double high;
  bool integers;
};

/**
 * The colour and opacity functions of one of a property's components, as a table; opacities are
 * multiplied by the weight. Integers get sixteen entries per grey level, at most 65536 in all;
 * other values get 65536.
 */
ColorTable tabulateColors(vtkVolumeProperty* property, int component, double weight,
  const ScalarRange& range, const FinalColor& finalColor);

// Tables for dependent components, whose functions are those of the first one.
/// The colours, with opacity 1.
ColorTable tabulateOpaque(
  vtkVolumeProperty* property, const ScalarRange& range, const FinalColor& finalColor);
/// The opacities, as premultiplied white.
ColorTable tabulateOpacity(vtkVolumeProperty* property, const ScalarRange& range);
/// Unsigned char as shades of red (0), green (1) or blue (2).
ColorTable tabulatePrimary(int primary, const FinalColor& finalColor);
}

#endif
