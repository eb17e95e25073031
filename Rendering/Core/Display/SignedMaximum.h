// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Reduction::Signed: the maximum and the minimum of a ray are projected separately, and combined
 * when the values of pixels are final.
 */
#ifndef splattingSignedMaximum_h
#define splattingSignedMaximum_h

#include "Splat/Projection/ShearImage.h"

#include <cmath>

namespace splatting
{
class CellScreen;

/// Whether a pixel shows its minimum: whether this is farther from the origin than the maximum.
/// Distances have double precision. Both values are NaN if there is no sample.
template <class T>
bool showsMinimum(T maximum, T minimum, double origin)
{
  return std::abs(static_cast<double>(minimum) - origin) >
    std::abs(static_cast<double>(maximum) - origin);
}

/// The values that the pixels of a signed image show, without its winners.
ShearImage shownValues(const ShearImage& image);

/// Replaces values, and depths if there are any, by those of the minima where these are shown.
void takeMinima(CellScreen& screen, double origin);
}

#endif
