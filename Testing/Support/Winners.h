// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Winners.h
 * @brief   which sample of a ray an extremum comes from, by looking at all of them
 */
#ifndef reference_Winners_h
#define reference_Winners_h

#include "Reductions.h"

#include <vector>

namespace reference
{

/**
 * The number of the largest (or smallest) of a ray's samples that count, which come by ascending
 * depth; of equal ones that nearest to the viewer, who is on the side of the lowest slices or,
 * `reversed`, of the highest. -1 if there is none. NaN does not count.
 */
template <class T>
int winnerOf(const std::vector<Sample<T>>& samples, const RayCutter& cutter, int u, int v,
  bool reversed, bool smallest)
{
  int winner = -1;
  const int count = static_cast<int>(samples.size());
  for (int n = 0; n < count; ++n)
  {
    const int number = reversed ? count - 1 - n : n;
    const Sample<T>& sample = samples[number];
    if (sample.value == sample.value && cutter.inHalfSpaces(u, v, sample.slice) &&
      cutter.inRegions(u, v, sample.slice))
    {
      const bool wins = winner < 0 ||
        (smallest ? sample.value < samples[winner].value : sample.value > samples[winner].value);
      winner = wins ? number : winner;
    }
  }
  return winner;
}

} // namespace reference

#endif
