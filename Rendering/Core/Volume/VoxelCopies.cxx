// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Volume/VoxelCopies.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
/// Calls body(n) for all n below count.
template <class Body>
void forAll(std::ptrdiff_t count, std::ptrdiff_t grain, Body&& body)
{
  parallelFor(0, count, grain,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t n = first; n < last; ++n)
      {
        body(n);
      }
    });
}

constexpr std::ptrdiff_t Grain = 1 << 16; // voxels of a task

template <class T>
double valueOf(const StridedVoxels& from, std::ptrdiff_t n)
{
  return static_cast<double>(static_cast<const T*>(from.voxels)[n * from.stride]);
}

/// The length of the vector of the n-th voxels. Finite for finite voxels, at most the largest
/// number of its type.
template <class T>
Accumulator<T> lengthOf(const std::vector<StridedVoxels>& components, std::ptrdiff_t n)
{
  using A = Accumulator<T>;
  double sum = 0.0;
  for (const StridedVoxels& component : components)
  {
    const double value = valueOf<T>(component, n);
    sum += value * value;
  }
  constexpr double least = 1e-280; // squares of smaller numbers lose digits
  constexpr double most = std::numeric_limits<A>::max();
  double length = std::sqrt(sum);
  if (sum < least || length > most)
  {
    bool isFinite = true;
    length = 0.0;
    for (const StridedVoxels& component : components)
    {
      length = std::hypot(length, valueOf<T>(component, n));
      isFinite = isFinite && std::isfinite(valueOf<T>(component, n));
    }
    length = isFinite ? std::min(length, most) : length;
  }
  return static_cast<A>(length);
}

/// A row of voxels, interpolated from four rows.
template <class T>
struct RowBundle
{
  const T* rows[4];
  double weights[4];
  std::ptrdiff_t stride;

  /// Adds column i of these rows without NaN, and notes the nearest voxel.
  void add(int i, double share, double& sum, double& weight, double& best, double& nearest) const
  {
    for (int r = 0; r < 4; ++r)
    {
      const double w = this->weights[r] * share;
      if (w <= 0.0)
      {
        continue; // zero times infinity is NaN
      }
      const double value = static_cast<double>(this->rows[r][i * this->stride]);
      if (w > best)
      {
        best = w;
        nearest = value;
      }
      if (value == value)
      {
        sum += w * value;
        weight += w;
      }
    }
  }

  template <class A>
  A at(int i, double fraction) const
  {
    double sum = 0.0, weight = 0.0, best = 0.0, nearest = 0.0;
    this->add(i, 1.0 - fraction, sum, weight, best, nearest);
    if (fraction > 0.0)
    {
      this->add(i + 1, fraction, sum, weight, best, nearest);
    }
    const double average = sum / weight; // NaN for infinities of both signs
    return static_cast<A>(nearest == nearest && average == average ? average : nearest);
  }
};

/// The four rows that surround row (y, z) of the copy.
template <class T>
RowBundle<T> bundle(const StridedVoxels& from, const glm::ivec3& size,
  const ResampledAxis (&axes)[3], std::ptrdiff_t y, std::ptrdiff_t z)
{
  const double fy = axes[1].fraction[y], fz = axes[2].fraction[z];
  RowBundle<T> result{ {}, { (1 - fy) * (1 - fz), fy * (1 - fz), (1 - fy) * fz, fy * fz },
    from.stride };
  for (int r = 0; r < 4; ++r)
  {
    // A row without weight need not exist.
    const std::ptrdiff_t j = axes[1].below[y] + (fy > 0.0 ? r & 1 : 0);
    const std::ptrdiff_t k = axes[2].below[z] + (fz > 0.0 ? r >> 1 : 0);
    result.rows[r] = static_cast<const T*>(from.voxels) + (k * size.y + j) * size.x * from.stride;
  }
  return result;
}

/// Calls body(out, y, z) for all rows of the copy.
template <class A, class Body>
void forRows(const ResampledAxis (&axes)[3], A* to, Body&& body)
{
  const std::ptrdiff_t width = axes[0].below.size(), height = axes[1].below.size();
  forAll(height * std::ptrdiff_t(axes[2].below.size()), 16,
    [&](std::ptrdiff_t row) { body(to + row * width, row % height, row / height); });
}
}

void gather(const StridedVoxels& from, std::ptrdiff_t count, void* to)
{
  dispatch(from.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const T* const in = static_cast<const T*>(from.voxels);
      T* const out = static_cast<T*>(to);
      forAll(count, Grain, [=](std::ptrdiff_t n) { out[n] = in[n * from.stride]; });
    });
}

void magnitude(const std::vector<StridedVoxels>& components, std::ptrdiff_t count, void* to)
{
  dispatch(components.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      Accumulator<T>* const out = static_cast<Accumulator<T>*>(to);
      forAll(count, Grain, [&, out](std::ptrdiff_t n) { out[n] = lengthOf<T>(components, n); });
    });
}

void hide(const StridedVoxels& from, const unsigned char* hidden, std::ptrdiff_t count, void* to)
{
  dispatch(from.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      const T* const in = static_cast<const T*>(from.voxels);
      A* const out = static_cast<A*>(to);
      forAll(count, Grain,
        [=](std::ptrdiff_t n)
        {
          out[n] =
            hidden[n] ? std::numeric_limits<A>::quiet_NaN() : static_cast<A>(in[n * from.stride]);
        });
    });
}

void resamplePoints(
  const StridedVoxels& from, const glm::ivec3& size, const ResampledAxis (&axes)[3], void* to)
{
  dispatch(from.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      forRows(axes, static_cast<A*>(to),
        [&](A* out, std::ptrdiff_t y, std::ptrdiff_t z)
        {
          const RowBundle<T> rows = bundle<T>(from, size, axes, y, z);
          for (std::size_t x = 0; x < axes[0].below.size(); ++x)
          {
            out[x] = rows.template at<A>(axes[0].below[x], axes[0].fraction[x]);
          }
        });
    });
}

void resampleCells(
  const StridedVoxels& from, const glm::ivec3& size, const ResampledAxis (&axes)[3], void* to)
{
  dispatch(from.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      forRows(axes, static_cast<T*>(to),
        [&](T* out, std::ptrdiff_t y, std::ptrdiff_t z)
        {
          const std::ptrdiff_t row = std::ptrdiff_t(axes[2].below[z]) * size.y + axes[1].below[y];
          const T* const in = static_cast<const T*>(from.voxels) + row * size.x * from.stride;
          for (std::size_t x = 0; x < axes[0].below.size(); ++x)
          {
            out[x] = in[axes[0].below[x] * from.stride];
          }
        });
    });
}
}
