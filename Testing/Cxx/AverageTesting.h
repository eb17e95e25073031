// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How far averages may be from what they are defined to be, with and without NaN.
 */
#ifndef AverageTesting_h
#define AverageTesting_h

#include "CoreTesting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

namespace coretesting
{
/**
 * How far standard and high may be from the exact average, as the class documentation of
 * vtkSplattingMIPVolumeMapper derives it: rounded weights, of which one takes up all the others'
 * residue, then rounded products and sums.
 */
template <class T>
double errorBound(splatting::Quality quality, double low, double high)
{
  const double n = quality == splatting::Quality::Standard ? 9 : 75;
  const double range = high - low, largest = std::max(std::abs(low), std::abs(high));
  if (sizeof(T) == 1)
  {
    return n * 0x1p-17 * range;
  }
  return std::is_same_v<splatting::Accumulator<T>, float>
    ? n * 0x1p-24 * range + (n + 1) * 0x1p-24 * largest
    : n * 0x1p-48 * range + (n + 1) * 0x1p-53 * largest;
}

/**
 * The same for perspective views and the reference's averages of parts.
 *
 * A column's weight of a voxel is a second difference of the kernel integrated twice, divided by
 * w s, w being the distance of rays and s the way that they go in a part: four numbers below 6,
 * known to 8 roundings (those of bells to 2^-44 as well), for 5 voxels, and as much again as they
 * are divided by their sum, which of narrow bells is least between two voxels. Where s or w is next
 * to nothing, 1e-6 or 1e-3 stand in for it. Rows have the same. Then the weights' three factors, at
 * most 5 products and 45 sums of them are rounded to the accumulator.
 */
template <class T>
double perspectiveErrorBound(
  const reference::ImageRays& rays, const reference::Kernel& kernel, double low, double high)
{
  const bool isBell = kernel.shape == reference::Kernel::CosineBell;
  const double number = 8.0 * 6.0 * 0x1p-53 + (isBell ? 0x1p-44 : 0.0);
  const double least = isBell ? std::min(2.0 * kernel(0.5), 1.0) : 1.0;
  const int parts = reference::partsPerSlice(rays, kernel);
  double weights[2] = { 0.0, 0.0 };
  for (int k = 0; k < rays.size[2]; ++k)
  {
    const auto faces = rays.faces(k, k);
    const double thickness = (faces[1] - faces[0]) / parts;
    for (int a = 0; rays.sees(k) && a < 2; ++a)
    {
      // The narrowest part is next to the eye.
      const double w = std::min(
        rays.spacing(faces[0] + 0.5 * thickness), rays.spacing(faces[1] - 0.5 * thickness));
      for (double slope : rays.slope[a])
      {
        if (slope == 0.0)
        {
          continue; // no ray, see ShearWarp::rayCount()
        }
        const double s = std::abs(slope) * thickness;
        const double off =
          2.0 * 5.0 * 4.0 * number / (least * std::max(w, 1e-3) * std::max(s, 1e-6)) +
          (s < 1e-6 ? 1e-6 / w : 0.0) + (w < 1e-3 ? 1.0 : 0.0);
        weights[a] = std::max(weights[a], off);
      }
    }
  }
  const double rounding = std::is_same_v<splatting::Accumulator<T>, float> ? 0x1p-24 : 0x1p-53;
  return (weights[0] + weights[1]) * (high - low) +
    (3 + 5 + 45) * rounding * std::max(std::abs(low), std::abs(high));
}

/// The largest difference between averages of voxels, which are from low to high, and
/// slabSamples(), including the rounding errors of slabSamples(). Previews are exact.
template <class T>
double averageBound(const splatting::ShearWarp& geometry, const Mode& mode, double low, double high)
{
  if (mode.quality == splatting::Quality::Preview)
  {
    return 0.0;
  }
  const double bound = geometry.isPerspective()
    ? perspectiveErrorBound<T>(referenceRays(geometry), mode.reference, low, high)
    : errorBound<T>(mode.quality, low, high);
  return bound + 2e-13 * std::max(std::abs(low), std::abs(high)) + 1e-300;
}

template <class T>
double averageBound(
  const reference::Volume<T>& volume, const splatting::ShearWarp& geometry, const Mode& mode)
{
  const auto ends = std::minmax_element(volume.voxels.begin(), volume.voxels.end());
  return averageBound<T>(geometry, mode, double(*ends.first), double(*ends.second));
}

/**
 * Compares pixels with samples of averages over volumes of values from -1 to 1 and NaN, which are
 * left out: S / W, of the sum S of weighted values and the sum W of their weights. Where these are
 * off by no more than e each, S / W is off by no more than 2 e / (W - e): what is divided by little
 * is magnified. Of a ray's slices the least W counts, and where it is next to e nothing is sure.
 *
 * @param bound  of averages without NaN: at least 2 e
 */
inline void compareWithNaN(Checks& check, const reference::RaySamples<double>& samples,
  const reference::Image<double>& found, double bound, const std::string& name)
{
  if (!check(samples.size() == found.value.size(), name, ": another size"))
  {
    return;
  }
  for (std::size_t p = 0; p < samples.size(); ++p)
  {
    double least = 1.0, value = -std::numeric_limits<double>::infinity();
    for (const auto& sample : samples[p])
    {
      least = std::min(least, sample.weight > 0.0 ? sample.weight : 1.0);
      value = sample.weight > 0.0 ? std::max(value, sample.value) : value;
    }
    const bool sure = least > 100.0 * bound;
    check(!sure || (found.hit[p] != 0) == std::isfinite(value), name,
      ": a pixel of NaN, or not; weight ", least);
    check(!sure || !found.hit[p] || std::abs(found.value[p] - value) <= 2.0 * bound / least, name,
      ": ", found.value[p], ", not ", value, "; weight ", least);
  }
}
}

#endif
