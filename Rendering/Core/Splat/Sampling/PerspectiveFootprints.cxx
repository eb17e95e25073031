// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/PerspectiveFootprints.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
/// Of slopes within a part. Where pixels are about a voxel wide, the neglected covariance of 0.25 /
/// 12 changes weights by less than the general tables of [CS98] with 16 x 16 sub-pixels do.
constexpr double MostProduct = 0.25;

/// The integral of h from -infinity to t.
double integral(const Kernel& kernel, double t)
{
  const double r = kernel.support();
  const double x = std::clamp(t, -r, r);
  switch (kernel.shape)
  {
    case Reconstruction::Box:
      return x + r;
    case Reconstruction::Hat:
      return x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x);
    default:
      constexpr double pi = 3.14159265358979323846;
      return 0.5 * (x + r) + r / (2.0 * pi) * std::sin(pi * x / r);
  }
}

/// The largest number of voxels that a length overlaps.
int tapsOf(double length)
{
  return static_cast<int>(std::ceil(length + 1e-6));
}

/// The depths at which part q of slice k begins and ends.
glm::dvec2 depthsOf(const ShearWarp& geometry, int k, int q, int parts)
{
  const glm::dvec2 faces = geometry.faces(k);
  const double thickness = (faces.y - faces.x) / parts;
  return { faces.x + q * thickness, faces.x + (q + 1) * thickness };
}
}

int partsOf(const ShearWarp& geometry, const Kernel& kernel)
{
  const double product = geometry.columns().steepest * geometry.rows().steepest;
  const int least = kernel.shape == Reconstruction::Box ? 1 : 2;
  return std::clamp(
    static_cast<int>(std::ceil(std::sqrt(product / MostProduct))), least, MostParts);
}

template <class A>
void AxisFootprints<A>::find(const ShearWarp& whole, const ShearWarp& geometry, int a,
  const Kernel& kernel, int parts, const WorksheetLoops<A>& loops)
{
  constexpr int unit = 64;
  this->Slices = geometry.slices();
  this->Count = geometry.rayCount()[a];
  this->Padded = (this->Count + unit - 1) / unit * unit;
  this->Size = geometry.size()[a];
  this->Parts = parts;
  this->Group = loops.group;
  this->Steepest = (a == 0 ? whole.columns() : whole.rows()).steepest;
  const std::size_t all = std::size_t(this->Slices.end - this->Slices.begin) * parts;
  this->Taps.resize(all);
  this->Ascends.resize(all);
  this->First.resize(all * this->Padded);
  this->Room =
    std::min(tapsOf(geometry.pitch() + this->Steepest / parts + 2.0 * kernel.support()), MostTaps);
  this->Weights.resize(all * this->Room * this->Padded);
  this->Bases.resize(all * this->Padded / this->Group);
  this->Lanes.resize(all * this->Padded * sizeof(A));
  parallelFor(this->Slices.begin, this->Slices.end, 8,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (int k = static_cast<int>(begin); k < end; ++k)
      {
        for (int q = 0; q < parts; ++q)
        {
          this->findPart(whole, geometry, a, k, q, kernel, loops);
        }
      }
    });
}

template <class A>
void AxisFootprints<A>::findPart(const ShearWarp& whole, const ShearWarp& geometry, int a, int k,
  int q, const Kernel& kernel, const WorksheetLoops<A>& loops)
{
  const AxisRays& rays = a == 0 ? whole.columns() : whole.rows();
  const int firstVoxel = geometry.first()[a];
  const glm::dvec2 depths = depthsOf(whole, k + geometry.first().z, q, this->Parts);
  const double middle = 0.5 * (depths.x + depths.y);
  const double share = (middle - whole.eye().z) / (whole.reference() - whole.eye().z);
  AxisWeights<A> weights;
  weights.shape = static_cast<int>(kernel.shape);
  weights.support = kernel.support();
  weights.at = rays.at.data();
  weights.slope = rays.slope.data();
  weights.depth = middle - whole.reference();
  weights.thickness = depths.y - depths.x;
  weights.pitch = whole.pitch() * share;
  weights.low = firstVoxel - Margin;
  weights.high = firstVoxel + this->Size + Margin;
  const double reach = weights.pitch + this->Steepest * weights.thickness + 2.0 * weights.support;
  const std::size_t n = this->at(k, q);
  weights.taps = std::min(tapsOf(reach), this->Room);
  weights.first = &this->First[n * this->Padded];
  weights.weights = &this->Weights[n * this->Room * this->Padded];
  weights.stride = this->Padded;
  loops.axisWeights(weights, this->Count);
  for (int p = 0; p < this->Count; ++p)
  {
    weights.first[p] -= firstVoxel;
  }
  this->Taps[n] = weights.taps;
  this->Ascends[n] = std::is_sorted(weights.first, weights.first + this->Count);
  std::fill_n(weights.first + this->Count, this->Padded - this->Count,
    this->Count > 0 ? weights.first[this->Count - 1] : 0);
  for (int t = 0; t < weights.taps; ++t)
  {
    std::fill_n(weights.weights + t * this->Padded + this->Count, this->Padded - this->Count, A(0));
  }
  auto* const lanes = reinterpret_cast<LaneOf<A>*>(this->Lanes.data()) + n * this->Padded;
  for (std::ptrdiff_t g = 0; g < this->Padded / this->Group; ++g)
  {
    const std::int32_t* const own = weights.first + g * this->Group;
    const std::int32_t base = *std::min_element(own, own + this->Group);
    this->Bases[n * this->Padded / this->Group + g] = base;
    for (int p = 0; p < this->Group; ++p)
    {
      lanes[g * this->Group + p] = own[p] - base;
    }
  }
}

template <class A>
typename AxisFootprints<A>::Part AxisFootprints<A>::part(int k, int q) const
{
  const std::size_t n = this->at(k, q);
  return { &this->First[n * this->Padded], &this->Weights[n * this->Room * this->Padded],
    this->Padded, this->Taps[n], &this->Bases[n * this->Padded / this->Group],
    &this->Lanes[n * this->Padded * sizeof(A)] };
}

template <class A>
Span AxisFootprints<A>::voxels(int k, int q, const Span& pixels) const
{
  const std::size_t n = this->at(k, q);
  const std::int32_t* const first = &this->First[n * this->Padded];
  if (this->Ascends[n])
  {
    return { first[pixels.begin], first[pixels.end - 1] + this->Taps[n] };
  }
  // Near the eye the points of pixels spread out as rays diverge. All pixels on one side begin at
  // the same position, and between two voxels rounding decides.
  const auto ends = std::minmax_element(first + pixels.begin, first + pixels.end);
  return { *ends.first, *ends.second + this->Taps[n] };
}

template <class A>
Span AxisFootprints<A>::voxels(const Span& slices, const Span& pixels) const
{
  Span all{ this->Size + Margin, -Margin };
  const Span own{ pixels.begin, std::min(pixels.end, this->Count) };
  for (int k = std::max(slices.begin, this->Slices.begin);
       k < std::min(slices.end, this->Slices.end) && !own.empty(); ++k)
  {
    for (int q = 0; q < this->Parts; ++q)
    {
      const Span some = this->voxels(k, q, own);
      all = { std::min(all.begin, some.begin), std::max(all.end, some.end) };
    }
  }
  return all;
}

template <class A>
void PerspectiveFootprints<A>::find(
  const ShearWarp& whole, const ShearWarp& geometry, const Kernel& kernel, const Kernels& kernels)
{
  this->parts = partsOf(whole, kernel);
  const glm::ivec3& size = geometry.size();
  this->columns.find(whole, geometry, 0, kernel, this->parts, kernels);
  this->rows.find(whole, geometry, 1, kernel, this->parts, kernels);
  this->depth.assign(std::size_t(size.z) * this->parts, {});
  for (int k = geometry.slices().begin; k < geometry.slices().end; ++k)
  {
    for (int q = 0; q < this->parts; ++q)
    {
      const int slice = k + geometry.first().z;
      const glm::dvec2 depths = depthsOf(whole, slice, q, this->parts) - double(slice);
      double shares[3], sum = 0.0;
      for (int c = -1; c <= 1; ++c)
      {
        shares[c + 1] = integral(kernel, depths.y - c) - integral(kernel, depths.x - c);
        sum += shares[c + 1];
      }
      for (int c = 0; c < 3; ++c)
      {
        // Relative to the sum of all parts.
        this->depth[k * this->parts + q][c] = static_cast<A>(shares[c] / (sum * this->parts));
      }
    }
  }
}

template class AxisFootprints<float>;
template class AxisFootprints<double>;
template struct PerspectiveFootprints<float>;
template struct PerspectiveFootprints<double>;
}
