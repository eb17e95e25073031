// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    PerspectiveProjection.h
 * @brief   slow and obvious maximum intensity projections along the rays of an eye, the oracle of
 *          the fast ones
 *
 * Computed ray by ray from the definition, as in Projection.h; shares no code with the module.
 */
#ifndef reference_PerspectiveProjection_h
#define reference_PerspectiveProjection_h

#include "Projection.h"

#include <array>
#include <vector>

namespace reference
{

/**
 * The rays of an image. The volume is seen with its axes permuted: i, j and, along the rays, k. In
 * voxels, the ray of pixel p = (u, v) passes
 *   i = at[0][u] + slope[0][u] (z - start),  j = at[1][v] + slope[1][v] (z - start)
 * at depth k = z. For exact traversals the numbers at, slope (depth - start) must be multiples of
 * 2^-34.
 */
struct PerspectiveRays
{
  std::array<int, 3> axes = { 0, 1, 2 }; // the volume's axes i, j and k
  std::array<int, 3> size = { 0, 0, 0 }; // voxels along i, j and k
  std::array<std::vector<double>, 2> at, slope;
  double start = 0.0;
  double pitch = 1.0;    // from one ray to the next at the start
  double eye = -1.0;     // its depth
  bool reversed = false; // the eye looks along falling k

  int width() const { return static_cast<int>(this->at[0].size()); }
  int height() const { return static_cast<int>(this->at[1].size()); }
  double position(int a, int pixel, double z) const
  {
    return this->at[a][pixel] + this->slope[a][pixel] * (z - this->start);
  }
  /// From one ray to the next at some depth.
  double spacing(double z) const
  {
    return this->pitch * std::abs(z - this->eye) / std::abs(this->start - this->eye);
  }
  /// The slices whose middle lies before the eye.
  bool sees(int slice) const { return this->reversed ? slice < this->eye : slice > this->eye; }
  /// The depths between which a slice, or the volume (in slices 0 to n_k - 1), is before the eye.
  std::array<double, 2> faces(int first, int last) const;
};

/**
 * The voxels that the ray of pixel (u, v) crosses, of slices that the eye sees, by ascending depth,
 * as positions in the volume. See traverse() in Traversal.h.
 */
std::vector<std::array<int, 3>> crossedVoxels(const PerspectiveRays& rays, int u, int v);

/**
 * Mode preview: the voxels that rays cross, NaN or not, by ascending depth.
 */
template <class T>
RaySamples<T> voxelSamples(const Volume<T>& volume, const PerspectiveRays& rays)
{
  RaySamples<T> samples;
  for (int v = 0; v < rays.height(); ++v)
  {
    for (int u = 0; u < rays.width(); ++u)
    {
      samples.emplace_back();
      for (const std::array<int, 3>& position : crossedVoxels(rays, u, v))
      {
        samples.back().push_back({ position[rays.axes[2]], volume.at(position), 1.0 });
      }
    }
  }
  return samples;
}

/**
 * The maximum of each pixel's samples. NaN does not count.
 */
template <class T>
Image<T> maximumOf(const RaySamples<T>& samples, int width, int height)
{
  Image<T> image(width, height);
  for (int v = 0; v < height; ++v)
  {
    for (int u = 0; u < width; ++u)
    {
      for (const Sample<T>& sample : samples[image.index(u, v)])
      {
        image.raise(u, v, sample.value);
      }
    }
  }
  return image;
}

/**
 * Mode preview: the maximum of the voxels that each pixel's ray crosses.
 */
template <class T>
Image<T> exactTraversal(const Volume<T>& volume, const PerspectiveRays& rays)
{
  return maximumOf(voxelSamples(volume, rays), rays.width(), rays.height());
}

/**
 * Modes standard and high: how many parts a slice is cut into, the fewest n with A B <= 0.25 n^2, A
 * and B the largest |slope| of columns and rows; but two at least for kernels other than Nearest.
 */
int partsPerSlice(const PerspectiveRays& rays, const Kernel& kernel);

/**
 * Modes standard and high: the averages of all slices of which rays cross a voxel, by ascending
 * depth. Those that have no weight are NaN.
 *
 * The slice is cut into parts of equal thickness t. In each, with middle z, points of the pixel
 * have i = position(0, u, z) + slope t a + spacing(z) b, a and b independent and uniform in
 * [-1/2, 1/2], and j likewise and independently of i. Voxel (i', j', k') weighs the mean of
 * h(z' - k') over the part, times that of h(i - i') and that of h(j - j'), each divided by its sum
 * over all voxels; parts count the same. Borders and NaN as in Projection.h.
 */
RaySamples<double> slabSamples(
  const Volume<double>& volume, const PerspectiveRays& rays, const Kernel& kernel);

/**
 * One of them, of pixel (u, v) and a slice that its ray crosses.
 */
Sample<double> slabSample(const Volume<double>& volume, const PerspectiveRays& rays,
  const Kernel& kernel, int u, int v, int slice);

/**
 * What slabSamples approximates: the averages over all that a pixel sees of a slice, the points
 *   i = position(0, u, z) + spacing(z) b,  j = position(1, v, z) + spacing(z) c
 * with z uniform between the slice's faces, b and c in [-1/2, 1/2]: the integral of weights times
 * voxels divided by that of the weights.
 */
RaySamples<double> frustumSamples(
  const Volume<double>& volume, const PerspectiveRays& rays, const Kernel& kernel);

/**
 * How far slabSamples may be from frustumSamples in a slice, in units of the largest difference of
 * voxels, for kernels that sum to one.
 *
 * Let F, G and Z be the weights of all voxels along i, j and k at one depth, lists that sum to one.
 * What depends on depth is averaged over a part of thickness t <= 1/Q. The exact average is that of
 * F G Z. The other one multiplies averages, in which rays have the spacing w that the middle of the
 * part has.
 *
 * The spacing is s |z - eye|, so it is off by s t / 4 on average over the part. Points of a window
 * move by 1/4 of that on average: weights change by L / 4 of it, summed over all voxels, where L is
 * the sum of |h'| over voxels: at most 2 for the hat, pi for the bell of radius 1. Those of the box
 * change by 1 / w of it, w being the smallest spacing in the part, as one boundary at most lies in
 * a window that is narrower than a voxel.
 *
 * Products of averages: E[FG] - E[F] E[G] is half the mean of (F(a) - F(a')) (G(a) - G(a')) over
 * pairs of depths. Where a window moves by d, weights change by L d; for the box boundaries pass
 * both ends of the window, so L = 2 / w. The mean squared difference of two depths is t^2 / 6. So
 * |E[FG] - E[F] E[G]| <= L^2 A B t^2 / 12, A and B being the slopes: the covariance of i and j that
 * is lost, times L^2. With Z, which changes by L per depth unless h is the box, it is
 * L^2 (A B + A + B) t^2 / 12.
 *
 * Two lists that sum to one differ by 2 at most; what they do to voxels differs by half of the sum
 * of their differences times the largest difference of voxels.
 */
double lostByParts(const PerspectiveRays& rays, const Kernel& kernel, int u, int v, int slice);

} // namespace reference

#endif
