// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingLocalMaxima_h
#define splattingLocalMaxima_h

#include "Cells/TileSplatter.h"

namespace splatting
{
/**
 * Replaces the maxima of rays by the first local maximum, from the viewer, at or above a threshold
 * [Sato et al. 1998]; rays without one keep their maximum.
 *
 * A value is a local maximum if the field falls behind it, or if the ray ends. A decrease by less
 * than 2^-40 of the range of finite voxels and 2^-48 of their largest magnitude is regarded as
 * rounding. If parts of a ray are hidden, the other parts are joined in their order, and the field
 * is evaluated along them.
 * @param range   of the frame's volume
 * @param screen  of the frame's global maxima, with depths
 */
template <class T>
void findLocalMaxima(
  const CellFrame<T>& frame, const VolumeIndex::Range& range, double threshold, CellScreen& screen);
}

#endif
