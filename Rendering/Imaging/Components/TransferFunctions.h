// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TransferFunctions_h
#define TransferFunctions_h

#include "Display/ScreenColors.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkVolumeProperty;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Window and level of the picture. A colour c from 0 to 1, before it is multiplied by its opacity,
 * becomes (c - level) / window + 1/2. The opacity stays. Premultiplied colours are clamped to [0,
 * 1], so a colour above its opacity adds to the background, as in VTK's ray casters.
 */
struct FinalColor
{
  float window = 1.0f;
  float level = 0.5f;

  bool operator==(const FinalColor& other) const
  {
    return this->window == other.window && this->level == other.level;
  }
  /// Whether both numbers are finite and the window is not 0.
  bool isValid() const;
};

/**
 * The range of a table.
 */
struct ScalarRange
{
  double low;
  double high;
  bool integers;
};

/**
 * The colour and opacity functions of one component as a table. Opacities are multiplied by the
 * weight. Integers have sixteen entries per grey level, at most 65536 in all; other types have
 * 65536.
 */
ColorTable tabulateColors(vtkVolumeProperty* property, int component, double weight,
  const ScalarRange& range, const FinalColor& finalColor);

// Tables for dependent components, whose functions are those of the first one.
/// The colours, with opacity 1.
ColorTable tabulateOpaque(
  vtkVolumeProperty* property, const ScalarRange& range, const FinalColor& finalColor);
/// The opacities, as premultiplied white.
ColorTable tabulateOpacity(vtkVolumeProperty* property, const ScalarRange& range);
/// Unsigned char values as shades of red (0), green (1) or blue (2).
ColorTable tabulatePrimary(int primary, const FinalColor& finalColor);
}

#endif
