// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    SlabAverages.h
 * @brief   slow and obvious samples of standard mode (Kernel::Nearest) and high mode (the other
 *          kernels): averages over the part of a slice in the frustum of a pixel
 *
 * Only slices in which the ray of the pixel crosses a voxel (see crossedVoxels) have a sample.
 * Outside the volume the outermost voxels are repeated. NaN voxels are left out of the sums of
 * weighted voxels and of weights. If no weight remains, the sample is NaN.
 */
#ifndef reference_SlabAverages_h
#define reference_SlabAverages_h

#include "Projection.h"

namespace reference
{

/**
 * In perspective: how many parts a slice is cut into, the fewest n with A B <= 0.25 n^2, A
 * and B the largest |slope| of columns and rows; but two at least for kernels other than Nearest.
 */
int partsPerSlice(const ImageRays& rays, const Kernel& kernel);

/**
 * The averages of all slices that rays cross, by ascending depth.
 *
 * For parallel rays they are those of frustumSamples. In perspective the slice is cut into parts of
 * equal thickness t. In each, with middle z, points of the pixel have
 * i = position(0, u, z) + slope t a + spacing(z) b, a and b independent and uniform in
 * [-1/2, 1/2], and j likewise and independently of i. Voxel (i', j', k') weighs the mean of
 * h(z' - k') over the part, times that of h(i - i') and that of h(j - j'), each divided by its sum
 * over all voxels; parts count the same.
 */
RaySamples<double> slabSamples(
  const Volume<double>& volume, const ImageRays& rays, const Kernel& kernel);

/**
 * One of them, of pixel (u, v) and a slice that its ray crosses.
 */
Sample<double> slabSample(const Volume<double>& volume, const ImageRays& rays, const Kernel& kernel,
  int u, int v, int slice);

/**
 * The averages over all that a pixel sees of a slice, the points
 *   i = position(0, u, z) + spacing(z) b,  j = position(1, v, z) + spacing(z) c
 * with z uniform between the slice's faces, b and c in [-1/2, 1/2]: the integral of weights times
 * voxels divided by that of the weights.
 *
 * The integrals are Gauss-Legendre sums of the field itself, between its kinks: of parallel rays
 * the only error for the nearest and the trilinear kernel is rounding. For cosine bells the error
 * is below 1e-13 of the largest voxel.
 */
RaySamples<double> frustumSamples(
  const Volume<double>& volume, const ImageRays& rays, const Kernel& kernel);

/**
 * In perspective: how far slabSamples may be from frustumSamples in a slice, in units of the
 * largest difference of voxels, for kernels that sum to one.
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
double lostByParts(const ImageRays& rays, const Kernel& kernel, int u, int v, int slice);

} // namespace reference

#endif
