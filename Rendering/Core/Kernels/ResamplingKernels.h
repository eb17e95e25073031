// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The worksheets of perspective images: weights, and rows of pixels from rows of voxels. For
 * Kernels.cxx only, which explains the anonymous namespace.
 */
#ifndef splattingResamplingKernels_h
#define splattingResamplingKernels_h

#include "Kernels/PerspectiveKernels.h"

namespace splatting
{
namespace
{
/// The cosine bell, integrated twice from -infinity.
struct TwiceBell
{
  double radius;
  inline double operator()(double t) const
  {
    const double r = this->radius;
    const double x = t < -r ? -r : t > r ? r : t;
    // 1 + cos(pi x / r) = 2 cos^2 = 2 sin^2 of the complement to pi / 2, at most pi / 2.
    constexpr double halfPi = 1.57079632679489661923;
    const double missing = halfPi * (1.0 - (x < 0.0 ? -x : x) / r);
    const double z = missing * missing;
    // The series of the sine, to 1e-13 at pi / 2.
    double sine = -1.0 / 1307674368000.0;
    sine = sine * z + 1.0 / 6227020800.0;
    sine = sine * z - 1.0 / 39916800.0;
    sine = sine * z + 1.0 / 362880.0;
    sine = sine * z - 1.0 / 5040.0;
    sine = sine * z + 1.0 / 120.0;
    sine = sine * z - 1.0 / 6.0;
    sine = (sine * z + 1.0) * missing;
    constexpr double perPi = 0.31830988618379067154;
    return 0.25 * (x + r) * (x + r) - r * r * perPi * perPi * sine * sine +
      (t > r ? r * (t - r) : 0.0);
  }
};

inline double positive(double x)
{
  return x > 0.0 ? x : 0.0;
}

/// The positions of some pixels relative to the first voxel that they weigh, and the extents of
/// their points along the ray. Returns the distance between neighbouring rays.
template <class A>
inline double placePixels(const AxisWeights<A>& w, std::ptrdiff_t begin, std::ptrdiff_t count,
  double* __restrict place, double* __restrict spread)
{
  // Avoids division by 0. These widen pixels by at most a thousandth of a voxel, and only directly
  // before the eye.
  constexpr double leastPitch = 1e-3, leastSpread = 1e-6;
  const double pitch = w.pitch > leastPitch ? w.pitch : leastPitch;
  for (std::ptrdiff_t x = 0; x < count; ++x)
  {
    const double slope = w.slope[begin + x];
    const double own = (slope < 0.0 ? -slope : slope) * w.thickness;
    spread[x] = own > leastSpread ? own : leastSpread;
    const double at = w.at[begin + x] + slope * w.depth;
    const double reach = 0.5 * (pitch + spread[x]) + w.support;
    // The first voxel whose distance from the pixel is less than `reach`.
    const double first = roundedDown(clamped(at - reach, w.low - 1.0, w.high - 1.0)) + 1.0;
    w.first[begin + x] = static_cast<std::int32_t>(first);
    place[x] = at - first;
  }
  return pitch;
}

/// The weights of PerspectiveFootprints.h.
template <class A>
inline void weighBells(const AxisWeights<A>& w, std::ptrdiff_t n)
{
  const TwiceBell twice{ w.support };
  constexpr std::ptrdiff_t chunk = 64;
  for (std::ptrdiff_t begin = 0; begin < n; begin += chunk)
  {
    const std::ptrdiff_t count = begin + chunk < n ? chunk : n - begin;
    double place[chunk], spread[chunk], sum[chunk], taps[5][chunk];
    const double pitch = placePixels(w, begin, count, place, spread);
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      sum[x] = 0.0;
    }
    for (int t = 0; t < w.taps; ++t)
    {
      for (std::ptrdiff_t x = 0; x < count; ++x)
      {
        const double p = 0.5 * (pitch + spread[x]), m = 0.5 * (pitch - spread[x]);
        const double d = place[x] - t;
        const double weight = twice(d + p) - twice(d + m) - twice(d - m) + twice(d - p);
        taps[t][x] = weight > 0.0 ? weight : 0.0;
        sum[x] += taps[t][x];
      }
    }
    for (int t = 0; t < w.taps; ++t)
    {
      A* const out = w.weights + t * w.stride + begin;
      for (std::ptrdiff_t x = 0; x < count; ++x)
      {
        // Pixels far beside the volume have no weights.
        out[x] = static_cast<A>(sum[x] > 0.0 ? taps[t][x] / sum[x] : 0.0);
      }
    }
  }
}

/// The weight of a box voxel is the share of the pixel's points in it: the difference of the shares
/// below its ends.
template <class A>
inline void weighBoxes(const AxisWeights<A>& w, std::ptrdiff_t n)
{
  constexpr std::ptrdiff_t chunk = 64;
  for (std::ptrdiff_t begin = 0; begin < n; begin += chunk)
  {
    const std::ptrdiff_t count = begin + chunk < n ? chunk : n - begin;
    double place[chunk], spread[chunk], below[chunk];
    const double pitch = placePixels(w, begin, count, place, spread);
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      below[x] = 0.0;
    }
    for (int t = 0; t < w.taps; ++t)
    {
      A* const out = w.weights + t * w.stride + begin;
      const bool isLast = t + 1 == w.taps;
      for (std::ptrdiff_t x = 0; x < count; ++x)
      {
        const double p = 0.5 * (pitch + spread[x]), m = 0.5 * (pitch - spread[x]);
        const double d = t + 0.5 - place[x]; // of the voxel's end
        const double a = positive(d + p), b = positive(d + m), c = positive(d - m),
                     e = positive(d - p);
        // Rounding must not give weight to voxels beyond the pixel's points.
        const double inside = (a * a - b * b - c * c + e * e) / (2.0 * pitch * spread[x]);
        const double share = d < p ? inside : 1.0;
        const double now = isLast ? 1.0 : clamped(share, below[x], 1.0);
        out[x] = static_cast<A>(now - below[x]);
        below[x] = now;
      }
    }
  }
}

/// The same for hats: second differences of the first moments below voxel centres.
template <class A>
inline void weighHats(const AxisWeights<A>& w, std::ptrdiff_t n)
{
  constexpr std::ptrdiff_t chunk = 64;
  for (std::ptrdiff_t begin = 0; begin < n; begin += chunk)
  {
    const std::ptrdiff_t count = begin + chunk < n ? chunk : n - begin;
    double place[chunk], spread[chunk], own[chunk], before[chunk];
    const double pitch = placePixels(w, begin, count, place, spread);
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      own[x] = before[x] = 0.0; // at the first voxel's centre, and before
    }
    for (int t = 0; t < w.taps; ++t)
    {
      A* const out = w.weights + t * w.stride + begin;
      for (std::ptrdiff_t x = 0; x < count; ++x)
      {
        const double p = 0.5 * (pitch + spread[x]), m = 0.5 * (pitch - spread[x]);
        const double d = t + 1.0 - place[x]; // of the next voxel
        const double a = positive(d + p), b = positive(d + m), c = positive(d - m),
                     e = positive(d - p);
        const double sum =
          (a * a * a - b * b * b - c * c * c + e * e * e) / (6.0 * pitch * spread[x]);
        const double next = d < p ? sum : d;
        const double weight = next - own[x] - (own[x] - before[x]);
        // Voxels beyond the pixel's points have no weight.
        out[x] = static_cast<A>(d < p + 2.0 ? positive(weight) : 0.0);
        before[x] = own[x];
        own[x] = next;
      }
    }
  }
}

template <class A>
void axisWeights(const AxisWeights<A>& w, std::ptrdiff_t n)
{
  switch (w.shape)
  {
    case 0:
      weighBoxes(w, n);
      break;
    case 1:
      weighHats(w, n);
      break;
    default:
      weighBells(w, n);
  }
}

/// Selects voxels of the accumulator's type. The general case is not implemented.
template <class A>
struct Resampler
{
  static constexpr int group = 8;
  static constexpr bool picks = false;
};
#if defined(__AVX512F__)
template <>
struct Resampler<float>
{
  static constexpr int group = 16;
  static constexpr bool picks = true;
  static inline Pack<float> pick(const float* voxels, Register lanes)
  {
    return _mm512_permutexvar_ps(lanes, _mm512_loadu_ps(voxels));
  }
};
template <>
struct Resampler<double>
{
  static constexpr int group = 8;
  static constexpr bool picks = true;
  static inline Pack<double> pick(const double* voxels, Register lanes)
  {
    return _mm512_permutexvar_pd(lanes, _mm512_loadu_pd(voxels));
  }
};
#elif defined(__AVX2__)
template <>
struct Resampler<float>
{
  static constexpr int group = 8;
  static constexpr bool picks = true;
  static inline Pack<float> pick(const float* voxels, Register lanes)
  {
    return _mm256_permutevar8x32_ps(_mm256_loadu_ps(voxels), lanes);
  }
};
#endif

#if defined(__AVX2__)
template <class A, int Taps>
inline void resampleRegisters(const Resampling<A>& r, std::ptrdiff_t begin, std::ptrdiff_t end)
{
  // The weights of the register at x are the same for all rows of pixels.
  for (std::ptrdiff_t x = begin; x < end; x += width<A>)
  {
    const Register lanes = loadRegister(static_cast<const LaneOf<A>*>(r.lanes) + x);
    const A* voxels = r.voxels + r.base[x / Resampler<A>::group];
    A* out = r.out + x;
    Pack<A> weights[Taps];
#pragma GCC unroll 5
    for (int t = 0; t < Taps; ++t)
    {
      weights[t] = load<A>(r.weights + t * r.stride + x);
    }
    for (int row = 0; row < r.rows; ++row, voxels += r.voxelStride, out += r.outStride)
    {
      Pack<A> sum{};
#pragma GCC unroll 5
      for (int t = 0; t < Taps; ++t)
      {
        sum += weights[t] * Resampler<A>::pick(voxels + t, lanes);
      }
      store<A>(out, sum);
    }
  }
}
#endif

template <class A>
void resample(const Resampling<A>& r, std::ptrdiff_t begin, std::ptrdiff_t end)
{
#if defined(__AVX2__)
  if constexpr (Resampler<A>::picks)
  {
    static_assert(Resampler<A>::group == width<A>);
    begin = begin / width<A> * width<A>;
    switch (r.taps)
    {
      case 2:
        return resampleRegisters<A, 2>(r, begin, end);
      case 3:
        return resampleRegisters<A, 3>(r, begin, end);
      case 4:
        return resampleRegisters<A, 4>(r, begin, end);
      default:
        return resampleRegisters<A, 5>(r, begin, end);
    }
  }
#endif
  const LaneOf<A>* const lanes = static_cast<const LaneOf<A>*>(r.lanes);
  for (int row = 0; row < r.rows; ++row)
  {
    for (std::ptrdiff_t x = begin; x < end; ++x)
    {
      const A* const voxels =
        r.voxels + row * r.voxelStride + r.base[x / Resampler<A>::group] + lanes[x];
      A sum = 0;
      for (int t = 0; t < r.taps; ++t)
      {
        sum += r.weights[t * r.stride + x] * voxels[t];
      }
      r.out[row * r.outStride + x] = sum;
    }
  }
}

/// Sets pixels to weighted sums of rows; with Raises only where that makes them larger.
template <class A, bool Raises>
struct BlendBlock
{
  A* out;
  const A* const* rows;
  const A* weights;
  int count;

  inline void single(std::ptrdiff_t x) const
  {
    A sum = 0;
    for (int r = 0; r < this->count; ++r)
    {
      sum += this->weights[r] * this->rows[r][x];
    }
    this->out[x] = Raises ? larger(sum, this->out[x]) : sum;
  }
  template <int V>
  inline void run(std::ptrdiff_t x) const
  {
    Pack<A> sum[V];
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      sum[v] = Pack<A>{};
    }
    for (int r = 0; r < this->count; ++r)
    {
      const A* const row = this->rows[r] + x;
      const A weight = this->weights[r];
#pragma GCC unroll 4
      for (int v = 0; v < V; ++v)
      {
        sum[v] += weight * load<A>(row + v * width<A>);
      }
    }
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v)
    {
      A* const at = this->out + x + v * width<A>;
      store<A>(at, Raises ? larger(sum[v], load<A>(at)) : sum[v]);
    }
  }
};

template <bool Raises, class A>
void blend(const A* const* rows, const A* weights, int count, A* out, std::ptrdiff_t n)
{
  const BlendBlock<A, Raises> block{ out, rows, weights, count };
  blocks<A>(n, block, [&](std::ptrdiff_t x) { block.single(x); });
}
}
}

#endif
