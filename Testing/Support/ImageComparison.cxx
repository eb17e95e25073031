// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageComparison.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace reference
{

namespace
{

using Picture = Image<double>;

void requireEqualSizes(const Picture& a, const Picture& b)
{
  if (a.width != b.width || a.height != b.height)
  {
    throw std::invalid_argument("The pictures differ in size.");
  }
}

//------------------------------------------------------------------------------
// Filters

/**
 * 2 radius + 1 weights that sum to one.
 */
std::vector<double> gaussianWindow(double sigma, int radius)
{
  std::vector<double> weights;
  for (int n = -radius; n <= radius; ++n)
  {
    weights.push_back(std::exp(-0.5 * n * n / (sigma * sigma)));
  }
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights)
  {
    weight /= total;
  }
  return weights;
}

double clampedPixel(const Picture& image, int x, int y)
{
  return image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
}

/**
 * Convolution along x (stepX = 1) or y (stepY = 1); beyond the border the outermost pixel repeats.
 */
Picture filterAlong(const Picture& image, const std::vector<double>& weights, int stepX, int stepY)
{
  const int radius = static_cast<int>(weights.size()) / 2;
  Picture result(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
  {
    for (int x = 0; x < image.width; ++x)
    {
      double sum = 0.0;
      for (int n = -radius; n <= radius; ++n)
      {
        sum += weights[n + radius] * clampedPixel(image, x + n * stepX, y + n * stepY);
      }
      result.at(x, y) = sum;
    }
  }
  return result;
}

Picture filter(const Picture& image, const std::vector<double>& weights)
{
  return filterAlong(filterAlong(image, weights, 1, 0), weights, 0, 1);
}

Picture product(const Picture& a, const Picture& b)
{
  Picture result(a.width, a.height);
  std::transform(a.value.begin(), a.value.end(), b.value.begin(), result.value.begin(),
    [](double x, double y) { return x * y; });
  return result;
}

//------------------------------------------------------------------------------
// Resampling

/**
 * The four Catmull-Rom weights at the fraction t in [0, 1) between the two middle pixels, and their
 * derivatives.
 */
struct CubicWeights
{
  double value[4];
  double slope[4];

  explicit CubicWeights(double t)
    : value{ 0.5 * (-t + 2.0 * t * t - t * t * t), 0.5 * (2.0 - 5.0 * t * t + 3.0 * t * t * t),
        0.5 * (t + 4.0 * t * t - 3.0 * t * t * t), 0.5 * (t * t * t - t * t) },
      slope{ 0.5 * (-1.0 + 4.0 * t - 3.0 * t * t), 0.5 * (-10.0 * t + 9.0 * t * t),
        0.5 * (1.0 + 8.0 * t - 9.0 * t * t), 0.5 * (3.0 * t * t - 2.0 * t) }
  {
  }
};

struct Sample
{
  double value = 0.0;
  double gradient[2] = { 0.0, 0.0 };
};

Sample interpolate(const Picture& image, double x, double y)
{
  const double left = std::floor(x);
  const double bottom = std::floor(y);
  const CubicWeights wx(x - left);
  const CubicWeights wy(y - bottom);
  Sample sample;
  for (int j = 0; j < 4; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      const double pixel =
        clampedPixel(image, static_cast<int>(left) + i - 1, static_cast<int>(bottom) + j - 1);
      sample.value += wx.value[i] * wy.value[j] * pixel;
      sample.gradient[0] += wx.slope[i] * wy.value[j] * pixel;
      sample.gradient[1] += wx.value[i] * wy.slope[j] * pixel;
    }
  }
  return sample;
}

//------------------------------------------------------------------------------
// Least squares

/**
 * Four equations A x = r, A symmetric and positive semi-definite.
 */
struct NormalEquations
{
  double a[4][4] = {};
  double r[4] = {};

  void add(const double row[4], double residual)
  {
    for (int m = 0; m < 4; ++m)
    {
      for (int n = 0; n < 4; ++n)
      {
        this->a[m][n] += row[m] * row[n];
      }
      this->r[m] += row[m] * residual;
    }
  }

  /**
   * Gauss-Jordan elimination without exchanges, sound for such matrices. An unknown that the
   * equations before it leave undetermined becomes 0.
   */
  std::array<double, 4> solve() const
  {
    NormalEquations e = *this;
    std::array<double, 4> x = {};
    bool isSolved[4] = {};
    for (int p = 0; p < 4; ++p)
    {
      isSolved[p] = e.a[p][p] > 1e-10 * this->a[p][p];
      for (int m = 0; m < 4 && isSolved[p]; ++m)
      {
        const double factor = m == p ? 0.0 : e.a[m][p] / e.a[p][p];
        for (int n = 0; n < 4; ++n)
        {
          e.a[m][n] -= factor * e.a[p][n];
        }
        e.r[m] -= factor * e.r[p];
      }
    }
    for (int p = 0; p < 4; ++p)
    {
      x[p] = isSolved[p] ? e.r[p] / e.a[p][p] : 0.0;
    }
    return x;
  }
};

/**
 * One Gauss-Newton step. The unknowns are ordered so that an undetermined shift, not the offset or
 * the gain, is dropped.
 */
Shift improved(const Picture& a, const Picture& b, const Shift& shift, int border)
{
  NormalEquations equations;
  double squares = 0.0;
  int count = 0;
  for (int y = border; y < b.height - border; ++y)
  {
    for (int x = border; x < b.width - border; ++x)
    {
      const Sample sample = interpolate(a, x - shift.dx, y - shift.dy);
      const double residual = b.at(x, y) - shift.gain * sample.value - shift.offset;
      const double row[4] = { 1.0, sample.value, -shift.gain * sample.gradient[0],
        -shift.gain * sample.gradient[1] };
      equations.add(row, residual);
      squares += residual * residual;
      ++count;
    }
  }
  const std::array<double, 4> change = equations.solve();
  return { shift.dx + change[2], shift.dy + change[3], shift.gain + change[1],
    shift.offset + change[0], std::sqrt(squares / std::max(count, 1)) };
}

/**
 * Limits how far one iteration may move, as a linear model holds within about the smoothing only.
 */
Shift limited(const Shift& from, Shift to, double step)
{
  to.dx = from.dx + std::clamp(to.dx - from.dx, -step, step);
  to.dy = from.dy + std::clamp(to.dy - from.dy, -step, step);
  return to;
}

Shift refined(const Picture& a, const Picture& b, double sigma, Shift shift)
{
  const std::vector<double> window = gaussianWindow(sigma, static_cast<int>(4.0 * sigma));
  const Picture smoothA = filter(a, window);
  const Picture smoothB = filter(b, window);
  // Neither the pixels compared nor those they are compared with may feel the picture's border.
  const double reach = 3.0 * sigma + std::max(std::abs(shift.dx), std::abs(shift.dy));
  const int border = std::min(static_cast<int>(std::ceil(reach)), std::min(a.width, a.height) / 4);
  for (int iteration = 0; iteration < 30; ++iteration)
  {
    const Shift last = shift;
    shift = limited(last, improved(smoothA, smoothB, last, border), sigma);
    if (std::hypot(shift.dx - last.dx, shift.dy - last.dy) < 1e-6)
    {
      break;
    }
  }
  return shift;
}

} // namespace

//------------------------------------------------------------------------------
double mean(const Image<double>& image)
{
  return std::accumulate(image.value.begin(), image.value.end(), 0.0) /
    static_cast<double>(image.value.size());
}

//------------------------------------------------------------------------------
double psnr(const Image<double>& a, const Image<double>& b, double range)
{
  requireEqualSizes(a, b);
  double squares = 0.0;
  for (std::size_t pixel = 0; pixel < a.value.size(); ++pixel)
  {
    const double difference = a.value[pixel] - b.value[pixel];
    squares += difference * difference;
  }
  const double count = static_cast<double>(a.value.size());
  return squares == 0.0 ? std::numeric_limits<double>::infinity()
                        : 10.0 * std::log10(range * range * count / squares);
}

//------------------------------------------------------------------------------
double ssim(const Image<double>& a, const Image<double>& b, double range)
{
  requireEqualSizes(a, b);
  const int radius = 5;
  if (a.width <= 2 * radius || a.height <= 2 * radius)
  {
    throw std::invalid_argument("SSIM needs pictures of 11x11 pixels at least.");
  }
  const std::vector<double> window = gaussianWindow(1.5, radius);
  const Picture meanA = filter(a, window);
  const Picture meanB = filter(b, window);
  const Picture squareA = filter(product(a, a), window);
  const Picture squareB = filter(product(b, b), window);
  const Picture cross = filter(product(a, b), window);
  const double c1 = 0.01 * 0.01 * range * range;
  const double c2 = 0.03 * 0.03 * range * range;
  double sum = 0.0;
  for (int y = radius; y < a.height - radius; ++y)
  {
    for (int x = radius; x < a.width - radius; ++x)
    {
      const double ma = meanA.at(x, y);
      const double mb = meanB.at(x, y);
      const double variances = squareA.at(x, y) - ma * ma + squareB.at(x, y) - mb * mb;
      const double covariance = cross.at(x, y) - ma * mb;
      sum += (2.0 * ma * mb + c1) * (2.0 * covariance + c2) /
        ((ma * ma + mb * mb + c1) * (variances + c2));
    }
  }
  const double count = static_cast<double>(a.width - 2 * radius) * (a.height - 2 * radius);
  return sum / count;
}

//------------------------------------------------------------------------------
Shift subPixelShift(const Image<double>& a, const Image<double>& b)
{
  requireEqualSizes(a, b);
  Shift shift;
  for (double sigma : { 6.0, 3.0, 2.0 })
  {
    shift = refined(a, b, sigma, shift);
  }
  return shift;
}

} // namespace reference
