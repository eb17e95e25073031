// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/Footprint.h"

#include "Common/Parallel.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace splatting
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// Gauss-Legendre rules on [-1, 1], the non-negative half.
struct Quadrature
{
  int pairs;   // nodes +-x
  bool centre; // and one at 0, stored first
  std::array<double, 5> x, w;
};
constexpr Quadrature Gauss3{ 1, true, { 0.0, 0.774596669241483377 },
  { 0.888888888888888889, 0.555555555555555556 } };
constexpr Quadrature Gauss10{ 5, false,
  { 0.148874338981631211, 0.433395394129247191, 0.679409568299024406, 0.865063366688984511,
    0.973906528517171720 },
  { 0.295524224714752870, 0.269266719309996355, 0.219086362515982044, 0.149451349150580593,
    0.066671344308688138 } };

/// Calls f(z, weight) for the nodes in [from, to].
template <class F>
void integrate(const Quadrature& rule, double from, double to, F&& f)
{
  const double centre = 0.5 * (from + to), half = 0.5 * (to - from);
  if (rule.centre)
  {
    f(centre, rule.w[0] * half);
  }
  for (int n = rule.centre ? 1 : 0; n < rule.pairs + (rule.centre ? 1 : 0); ++n)
  {
    f(centre - rule.x[n] * half, rule.w[n] * half);
    f(centre + rule.x[n] * half, rule.w[n] * half);
  }
}

const Quadrature& ruleFor(const Kernel& kernel)
{
  return kernel.shape == Reconstruction::CosineBell ? Gauss10 : Gauss3;
}

/// The sorted kinks of a piecewise smooth function of z, with both ends of the range.
class Breaks
{
public:
  Breaks(double from, double to) : From(from), To(to)
  {
    this->Depths[0] = from;
    this->Depths[1] = to;
  }
  void add(double z)
  {
    if (z > this->From && z < this->To)
    {
      this->Depths[this->Count++] = z;
    }
  }
  /// Adds the z where (a - shear z) equals `kink` modulo 1: all voxels of a row have kinks there.
  void addPeriodic(double a, double shear, double kink)
  {
    if (shear == 0.0)
    {
      return;
    }
    const double low = std::min(a - shear * this->From, a - shear * this->To);
    const double high = std::max(a - shear * this->From, a - shear * this->To);
    for (double n = std::ceil(low - kink); n + kink <= high; n += 1.0)
    {
      this->add((a - n - kink) / shear);
    }
  }
  /// Calls f(begin, end) for each interval between kinks.
  template <class F>
  void forIntervals(F&& f)
  {
    std::sort(this->Depths.begin(), this->Depths.begin() + this->Count);
    // Excludes intervals between kinks that coincide within rounding.
    constexpr double least = 1e-14;
    for (int p = 1; p < this->Count; ++p)
    {
      if (this->Depths[p] - this->Depths[p - 1] > least)
      {
        f(this->Depths[p - 1], this->Depths[p]);
      }
    }
  }

private:
  double From, To;
  std::array<double, 32> Depths; // 2 ends, 5 of h, at most 2 for each of 12 periodic ones
  int Count = 2;
};

/// The centre of a single sub-pixel is half-way between two voxels, where the narrowest bells are
/// zero, or nearly.
int leastSampling(const Kernel& kernel)
{
  return kernel.shape == Reconstruction::CosineBell && kernel.radius < 0.501 ? 2 : 1;
}

void normalise(WeightTable& weights)
{
  double sum = 0.0;
  for (const auto& slice : weights)
  {
    for (const auto& line : slice)
    {
      for (double w : line)
      {
        sum += w;
      }
    }
  }
  for (auto& slice : weights)
  {
    for (auto& line : slice)
    {
      for (double& w : line)
      {
        w /= sum;
      }
    }
  }
}

/// H of the five voxels around a pixel, at depth z.
std::array<double, 5> profile(const Kernel& kernel, double fraction, double shear, double z)
{
  std::array<double, 5> values;
  for (int d = -2; d <= 2; ++d)
  {
    values[d + 2] = kernel.overPixel(-d - fraction - shear * z, 1.0);
  }
  return values;
}
}

double Kernel::support() const
{
  switch (this->shape)
  {
    case Reconstruction::Box:
      return 0.5;
    case Reconstruction::Hat:
      return 1.0;
    case Reconstruction::CosineBell:
      break;
  }
  return this->radius;
}

double Kernel::operator()(double t) const
{
  if (this->shape == Reconstruction::Box)
  {
    // Half-open, so that a sub-pixel on a face belongs to one voxel.
    return t >= -0.5 && t < 0.5 ? 1.0 : 0.0;
  }
  t = std::abs(t);
  if (t >= this->support())
  {
    return 0.0;
  }
  return this->shape == Reconstruction::Hat ? 1.0 - t
                                            : 0.5 * (1.0 + std::cos(Pi * t / this->radius));
}

double Kernel::overPixel(double t, double width) const
{
  t = std::abs(t);
  const double half = 0.5 * width, support = this->support();
  if (t >= support + half)
  {
    return 0.0;
  }
  // The integral of h from 0.
  const auto integral = [this, support](double x)
  {
    x = std::clamp(x, -support, support);
    switch (this->shape)
    {
      case Reconstruction::Box:
        return x;
      case Reconstruction::Hat:
        return x - 0.5 * x * std::abs(x);
      case Reconstruction::CosineBell:
        break;
    }
    return 0.5 * (x + this->radius / Pi * std::sin(Pi * x / this->radius));
  };
  return std::max(0.0, (integral(t + half) - integral(t - half)) / width);
}

WeightTable closedFormWeights(
  const Kernel& kernel, const glm::dvec2& shear, const glm::dvec2& fraction)
{
  const double support = kernel.support();
  Breaks breaks(-0.5, 0.5);
  // H has kinks where an end of the pixel coincides with an end of h.
  for (double kink : { support + 0.5, -support - 0.5 })
  {
    breaks.addPeriodic(-fraction.x, shear.x, kink);
    breaks.addPeriodic(-fraction.y, shear.y, kink);
  }
  for (double kink : { 0.0, 1.0 - support, support - 1.0, support, -support })
  {
    breaks.add(kink); // h(z - c)
  }

  WeightTable weights{};
  const auto add = [&](double z, double share)
  {
    const auto x = profile(kernel, fraction.x, shear.x, z);
    const auto y = profile(kernel, fraction.y, shear.y, z);
    for (int c = -1; c <= 1; ++c)
    {
      const double depth = share * kernel(z - c);
      if (depth == 0.0)
      {
        continue;
      }
      for (int j = 0; j < 5; ++j)
      {
        for (int i = 0; i < 5; ++i)
        {
          weights[c + 1][j][i] += depth * (x[i] * y[j]);
        }
      }
    }
  };
  breaks.forIntervals(
    [&](double begin, double end) { integrate(ruleFor(kernel), begin, end, add); });
  normalise(weights);
  return weights;
}

void GeneralTable::set(const Kernel& kernel, const glm::dvec2& shear, int sampling)
{
  sampling = std::max(sampling, leastSampling(kernel));
  if (this->Of == kernel && this->Shear == shear && this->Sampling == sampling)
  {
    return;
  }
  this->Of = kernel;
  this->Shear = shear;
  this->Sampling = sampling;
  // The sheared voxel covers support * (1 + |shear|) on either side: 2 x 2 pixels for a box, 4 x 4
  // for the trilinear kernel [CS98, section 3].
  const double s = kernel.support();
  const double reach = s * (1.0 + std::max(std::abs(shear.x), std::abs(shear.y)));
  this->Voxels = 2 * static_cast<int>(std::ceil(reach));
  const int n = this->Voxels * sampling;
  this->Sampling = 0; // until the table is made, in case of std::bad_alloc
  for (auto& entries : this->Entries)
  {
    entries.resize(static_cast<std::size_t>(n) * n);
  }
  this->Sampling = sampling;
  parallelFor(0, 3 * n, 8,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t row = first; row < last; ++row)
      {
        const int part = static_cast<int>(row / n), y = static_cast<int>(row % n);
        for (int x = 0; x < n; ++x)
        {
          this->Entries[part][static_cast<std::size_t>(y) * n + x] =
            this->entry(kernel, part - 1, { this->place(x), this->place(y) });
        }
      }
    });
}

double GeneralTable::place(int subPixel) const
{
  return (subPixel + 0.5) / this->Sampling - 0.5 * this->Voxels;
}

double GeneralTable::entry(const Kernel& kernel, int part, const glm::dvec2& p) const
{
  // Along the ray through p, within slice -part relative to the voxel's own. The voxel of slice k +
  // c lies in slice k at its own depth z - c.
  const double from = -0.5 - part, to = 0.5 - part;
  const double support = kernel.support();
  Breaks breaks(from, to);
  for (int a = 0; a < 2; ++a)
  {
    if (this->Shear[a] == 0.0)
    {
      continue;
    }
    for (double kink : { -support, 0.0, support })
    {
      breaks.add((p[a] - kink) / this->Shear[a]);
    }
  }
  for (double kink : { -support, 0.0, support })
  {
    breaks.add(kink);
  }
  double sum = 0.0;
  const auto add = [&](double z, double share)
  { sum += share * kernel(z) * kernel(p.x - this->Shear.x * z) * kernel(p.y - this->Shear.y * z); };
  breaks.forIntervals(
    [&](double begin, double end)
    {
      const double z = 0.5 * (begin + end);
      const glm::dvec2 q = glm::abs(p - this->Shear * z);
      if (std::abs(z) <= support && q.x <= support && q.y <= support) // otherwise it is 0
      {
        integrate(ruleFor(kernel), begin, end, add);
      }
    });
  return sum;
}

/// The first sub-pixel of a pixel, without the limits of the table. The pixel is `pixel` voxels
/// from the one nearest to the voxel, which lies at `centre`.
int GeneralTable::firstOf(int pixel, double centre) const
{
  const auto isBefore = [&](int n) { return this->place(n) + centre - pixel < -0.5; };
  const double begin = pixel - 0.5 - centre + 0.5 * this->Voxels;
  int n = static_cast<int>(std::ceil(begin * this->Sampling - 0.5)); // within rounding
  for (; isBefore(n); ++n)
  {
  }
  for (; !isBefore(n - 1); --n)
  {
  }
  return n;
}

WeightTable GeneralTable::weights(const glm::dvec2& fraction) const
{
  WeightTable weights{};
  const int n = this->Voxels * this->Sampling;
  for (int c = -1; c <= 1; ++c)
  {
    // The voxel lies at d + fraction of slice k's frame, and c shears away in its own.
    const glm::dvec2 centre = fraction + double(c) * this->Shear;
    for (int dj = -2; dj <= 2; ++dj)
    {
      const int row = this->firstOf(-dj, centre.y);
      for (int di = -2; di <= 2; ++di)
      {
        const int column = this->firstOf(-di, centre.x);
        double& sum = weights[c + 1][dj + 2][di + 2];
        for (int y = std::max(row, 0); y < std::min(row + this->Sampling, n); ++y)
        {
          const double* const entries = &this->Entries[c + 1][static_cast<std::size_t>(y) * n];
          for (int x = std::max(column, 0); x < std::min(column + this->Sampling, n); ++x)
          {
            sum += entries[x];
          }
        }
      }
    }
  }
  normalise(weights);
  return weights;
}

Taps quantisedTaps(const WeightTable& weights, int bits)
{
  const double one = std::ldexp(1.0, bits);
  Taps taps;
  double sum = 0.0;
  for (int c = -1; c <= 1; ++c)
  {
    for (int dj = -2; dj <= 2; ++dj)
    {
      for (int di = -2; di <= 2; ++di)
      {
        const double weight = std::round(weights[c + 1][dj + 2][di + 2] * one);
        if (weight > 0.0)
        {
          taps.add({ c, di, dj, weight });
          sum += weight;
        }
      }
    }
  }
  const auto largest = std::max_element(
    taps.begin(), taps.end(), [](const Tap& a, const Tap& b) { return a.weight < b.weight; });
  largest->weight += one - sum;
  for (Tap& tap : taps)
  {
    tap.weight /= one;
  }
  return taps;
}
}
