// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What tests of the exact mode share: the rays that see the field, and how far maxima may be off.
 */
#ifndef ExactTesting_h
#define ExactTesting_h

#include "CoreTesting.h"
#include "FieldMaximum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace coretesting
{
/**
 * How far the maximum may be from the field's, of voxels that are no larger than `largest` without
 * the base that is subtracted.
 *
 * A Bernstein coefficient is a sum of eight products with weights that were rounded, 9 roundings of
 * what adds up to no more than the largest voxel; a peak is found by six interpolations of two
 * products and a sum each, in three layers of 4 roundings. Where the peak is looked for matters to
 * second order only. Last, the base is added.
 */
template <class T>
double exactBound(double low, double high)
{
  using A = splatting::Accumulator<T>;
  const double rounding = std::numeric_limits<A>::epsilon() / 2;
  const double largest = std::max(std::abs(low), std::abs(high));
  const bool hasBase = std::numeric_limits<T>::is_integer && sizeof(T) < 8;
  return rounding * ((9.0 + 3.0 * 4.0 + 3.0) * (hasBase ? high - low : largest) + largest);
}

/**
 * In perspective views a coefficient is interpolated three times, with five roundings each, and a
 * mean of three, with four; where the ray is in its cell, and where pieces begin and end, is a sum
 * and a product of numbers up to 3, 12 roundings for each of three coordinates.
 */
template <class T>
double perspectiveExactBound(double low, double high)
{
  using A = splatting::Accumulator<T>;
  const double rounding = std::numeric_limits<A>::epsilon() / 2;
  return exactBound<T>(low, high) +
    rounding * (3.0 * 5.0 + 4.0) * std::max(std::abs(low), std::abs(high)) +
    rounding * 3.0 * 12.0 * (high - low);
}

/// The size of a volume along its own axes.
inline std::array<int, 3> volumeSizeOf(const splatting::ShearWarp& geometry)
{
  std::array<int, 3> volumeSize;
  for (int a = 0; a < 3; ++a)
  {
    volumeSize[geometry.axes()[a]] = geometry.size()[a];
  }
  return volumeSize;
}

inline reference::FieldRay rayOf(const splatting::ShearWarp& geometry, int u, int v)
{
  return geometry.isPerspective()
    ? reference::fieldRay(referenceRays(geometry), u, v)
    : reference::fieldRay(volumeSizeOf(geometry), referenceView(geometry), u, v);
}

/// Where a ray is in the field. Slices behind the eye are not seen at all.
inline std::array<double, 2> depthsOf(
  const splatting::ShearWarp& geometry, const reference::FieldRay& ray)
{
  const splatting::Span& slices = geometry.slices();
  return reference::depthsInField(volumeSizeOf(geometry), ray,
    geometry.showsBoxes() ? reference::FieldDomain::Boxes : reference::FieldDomain::Centres,
    geometry.faces(slices.begin).x, geometry.faces(slices.end - 1).y);
}

/// Within a face that a ray runs in it belongs to the higher voxels, of which there are none behind
/// the last one.
inline bool runsAlongLastFace(const splatting::ShearWarp& geometry, const reference::FieldRay& ray)
{
  const auto runs = [&](int a)
  { return ray.slope[a] == 0.0 && ray.at[a] == geometry.size()[a] - 0.5; };
  return runs(0) || runs(1);
}

/// Whether a pixel sees the field over some way, more than rounding moves its borders by.
inline bool seesField(const splatting::ShearWarp& geometry, int u, int v)
{
  const reference::FieldRay ray = rayOf(geometry, u, v);
  const auto depths = depthsOf(geometry, ray);
  return depths[1] - depths[0] >= (geometry.isPerspective() ? 2e-3 : 1e-6) &&
    !runsAlongLastFace(geometry, ray);
}
}

#endif
