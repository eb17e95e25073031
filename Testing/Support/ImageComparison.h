// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    ImageComparison.h
 * @brief   how alike two pictures are, and how far one is moved against the other
 *
 * All pixels count, hit or not (those not hit have the value 0). Functions of two pictures throw
 * std::invalid_argument where their sizes differ.
 */
#ifndef reference_ImageComparison_h
#define reference_ImageComparison_h

#include "Projection.h"

namespace reference
{

double mean(const Image<double>& image);

/**
 * Peak signal to noise ratio in dB, 20 log10(range / rms difference); infinity for equal pictures.
 */
double psnr(const Image<double>& a, const Image<double>& b, double range);

/**
 * Mean structural similarity, 1 for equal pictures. Wang, Bovik, Sheikh and Simoncelli, "Image
 * quality assessment: from error visibility to structural similarity", IEEE Trans. Image
 * Processing 13(4), 2004, with their Gaussian window of 11x11 pixels (sigma 1.5), K1 = 0.01 and
 * K2 = 0.03, over all windows inside the picture, which must have 11x11 pixels at least.
 */
double ssim(const Image<double>& a, const Image<double>& b, double range);

/**
 * b(x, y) is about gain * a(x - dx, y - dy) + offset: the content of b lies (dx, dy) pixels towards
 * higher indices. The residual is the rms difference of the smoothed pictures after the fit.
 */
struct Shift
{
  double dx = 0.0;
  double dy = 0.0;
  double gain = 1.0;
  double offset = 0.0;
  double residual = 0.0;
};

/**
 * The least-squares translation, gain and offset between two similar pictures: Gauss-Newton on
 * pictures smoothed by Gaussians of sigma 6, 3 and 2 pixels in turn. Finds shifts up to about 5
 * pixels. A border of 3 sigma and the shift, but at most a quarter of the picture, is ignored. A
 * direction in which the pictures are constant gets the shift 0.
 *
 * Accuracy, on pictures of 64x73 pixels: 0.001 pixel for smooth contents, 0.006 for lines one pixel
 * wide and averaged over pixels, 0.02 if these are noisy (5 % of the peak); 0.01 for a single such
 * line. Lines without antialiasing carry errors of their own, up to 0.1 pixel.
 */
Shift subPixelShift(const Image<double>& a, const Image<double>& b);

} // namespace reference

#endif
