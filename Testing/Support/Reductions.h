// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Reductions.h
 * @brief   the oracle of what becomes of the samples along a ray, and of what cuts rays
 *
 * Computed sample by sample from the definitions; shares no code with the module.
 *
 * Some reductions jump: whether a sample counts, or ends a search, hangs on a comparison. Where the
 * samples are known with an error only, every decision that the error leaves open is taken both
 * ways, and the result is all that may come out: one outcome mostly, never none.
 */
#ifndef reference_Reductions_h
#define reference_Reductions_h

#include "Projection.h"

#include <array>
#include <vector>

namespace reference
{

/**
 * What cuts a volume, in index space.
 */
struct RayCuts
{
  /// Half-spaces h with h[0] x + h[1] y + h[2] z + h[3] >= 0.
  std::vector<std::array<double, 4>> halfSpaces;
  /// VTK's cropping: along each axis the middle region lies between two planes and has them both.
  std::array<std::array<double, 2>, 3> planes = {};
  /// Bit i + 3 j + 9 k shows region (i, j, k).
  unsigned regions = (1u << 27) - 1;
};

/**
 * Which slices of a ray count: a slice's sample counts where the ray crosses the middle of the
 * slice inside the half-spaces and in a shown region.
 *
 * What is thinner than a slice takes one all the same. Where the half-spaces leave a ray (which
 * begins at the eye) an interval of positive length that has no slice's middle, the slice nearest
 * to the middle of the interval counts. Where the middle region along the principal axis has no
 * slice's middle, the slice nearest to its middle is in it. Points within 1e-9 slices of a plane
 * (relative to their depth, or to the plane's position) are inside.
 */
class RayCutter
{
public:
  RayCutter(const ImageRays& rays, const RayCuts& cuts) : Rays(rays), Cuts(cuts) {}

  bool inHalfSpaces(int u, int v, int slice) const;
  bool inRegions(int u, int v, int slice) const;

private:
  int region(int axis, double position) const;

  const ImageRays Rays;
  const RayCuts Cuts;
};

/**
 * The samples of a ray that count, from the viewer.
 */
template <class T>
struct CutRay
{
  struct Part
  {
    T value;
    int number; // of the sample's slice: the slices that half-spaces leave, from 0 at the viewer
  };
  std::vector<Part> samples; // without NaN
  int slices = 0;            // that half-spaces leave
  double leastWeight = 1.0;  // of the samples
};

/**
 * The viewer is on the side of the lowest slices or, `reversed`, of the highest.
 */
template <class T>
CutRay<T> cutRay(
  std::vector<Sample<T>> samples, const RayCutter& cutter, int u, int v, bool reversed)
{
  if (reversed)
  {
    std::reverse(samples.begin(), samples.end());
  }
  CutRay<T> ray;
  int slice = -1;
  for (const Sample<T>& sample : samples)
  {
    if (cutter.inHalfSpaces(u, v, sample.slice))
    {
      ray.slices += sample.slice != slice;
      slice = sample.slice;
      const bool isNaN = sample.value != sample.value;
      if (!isNaN && cutter.inRegions(u, v, slice))
      {
        ray.samples.push_back({ sample.value, ray.slices - 1 });
        ray.leastWeight = std::min(ray.leastWeight, sample.weight);
      }
    }
  }
  return ray;
}

/**
 * What a pixel may be; nothing where there is no sample.
 */
template <class T>
struct Outcome
{
  bool hit;
  T value;
};

template <class T>
using Outcomes = std::vector<Outcome<T>>;

template <class T>
Outcomes<T> largest(const CutRay<T>& ray)
{
  Outcome<T> result = { false, T() };
  for (const auto& sample : ray.samples)
  {
    result.value = !result.hit || sample.value > result.value ? sample.value : result.value;
    result.hit = true;
  }
  return { result };
}

template <class T>
Outcomes<T> smallest(const CutRay<T>& ray)
{
  Outcome<T> result = { false, T() };
  for (const auto& sample : ray.samples)
  {
    result.value = !result.hit || sample.value < result.value ? sample.value : result.value;
    result.hit = true;
  }
  return { result };
}

/**
 * The maximum of the visible samples of each pixel.
 */
template <class T>
Image<T> maximumOf(const RaySamples<T>& samples, const ImageRays& rays, const RayCuts& cuts)
{
  const RayCutter cutter(rays, cuts);
  Image<T> image(rays.width(), rays.height());
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (const auto& part : cutRay(samples[image.index(u, v)], cutter, u, v, false).samples)
      {
        image.raise(u, v, part.value);
      }
    }
  }
  return image;
}

/**
 * The first local maximum at or above the threshold: once the running maximum has reached the
 * threshold, the first sample below it, or the end of the ray, ends the search. So a ray that never
 * reaches the threshold has its maximum.
 *
 * Where samples are off by up to the error, so is their running maximum, and a difference of two of
 * them by twice as much.
 */
template <class T>
Outcomes<T> firstLocalMaximum(const CutRay<T>& ray, double threshold, double error)
{
  Outcomes<T> outcomes;
  T running = T();
  bool begun = false;
  bool mayBeBelow = true;    // the running maximum may not have reached the threshold yet
  bool mayBeReached = false; // it may have
  for (const auto& sample : ray.samples)
  {
    // Compared without the error first, since sums of integers and doubles are rounded.
    const bool below = begun && sample.value < running;
    const double difference =
      begun ? static_cast<double>(sample.value) - static_cast<double>(running) : 0.0;
    const bool mayEnd = below || (begun && difference < 2.0 * error);
    const bool mustEnd = below && (error == 0.0 || difference < -2.0 * error);
    if (mayBeReached && mayEnd)
    {
      outcomes.push_back({ true, running });
      mayBeReached = !mustEnd;
    }
    running = begun ? std::max(running, sample.value) : sample.value;
    begun = true;
    if (mayBeBelow)
    {
      mayBeReached = mayBeReached || static_cast<double>(running) >= threshold - error;
      mayBeBelow = static_cast<double>(running) < threshold + error;
    }
    if (!mayBeBelow && !mayBeReached)
    {
      return outcomes;
    }
  }
  outcomes.push_back({ begun, running });
  return outcomes;
}

/**
 * The arithmetic mean of the samples within [low, high].
 */
Outcomes<double> mean(const CutRay<double>& ray, double low, double high, double error);

/**
 * The largest of base + (sample - base) (ambient + (1 - n / N) changeRate), where the sample's
 * slice is the n-th from the viewer of N.
 */
Outcomes<double> depthShaded(
  const CutRay<double>& ray, double base, double ambient, double changeRate);

/**
 * What DepthShaded takes as its base: the lowest voxel (NaN aside), or 0 where it is not finite.
 */
template <class T>
double lowestVoxel(const Volume<T>& volume)
{
  double lowest = std::numeric_limits<double>::infinity();
  for (T voxel : volume.voxels)
  {
    lowest = static_cast<double>(voxel) < lowest ? static_cast<double>(voxel) : lowest;
  }
  return std::isfinite(lowest) ? lowest : 0.0;
}

template <class T>
CutRay<double> toDouble(const CutRay<T>& ray)
{
  CutRay<double> result;
  for (const auto& sample : ray.samples)
  {
    result.samples.push_back({ static_cast<double>(sample.value), sample.number });
  }
  result.slices = ray.slices;
  result.leastWeight = ray.leastWeight;
  return result;
}

} // namespace reference

#endif
