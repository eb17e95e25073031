// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The values of a volume at the winners of another volume's projection. For dependent components:
 * colours are taken from the sample with the projected opacity.
 */
#ifndef splattingValuesAtLocations_h
#define splattingValuesAtLocations_h

#include "Common/Parallel.h"
#include "Splat/Sampling/PerspectiveFootprints.h"
#include "Splat/Sampling/Worksheets.h"
#include "Splat/Walks/SliceSampler.h"

namespace splatting
{
/// Voxel (i, j, k) of a volume with axes permuted as in the shear image, for any memory layout.
template <class T>
class PermutedVoxels
{
public:
  PermutedVoxels(const VoxelArray& volume, const ShearWarp& geometry)
    : Voxels(static_cast<const T*>(volume.voxels)),
      Size(geometry.size())
  {
    const std::ptrdiff_t strides[3] = { 1, volume.dimensions.x,
      std::ptrdiff_t(volume.dimensions.x) * volume.dimensions.y };
    for (int a = 0; a < 3; ++a)
    {
      this->Strides[a] = strides[geometry.axes()[a]];
    }
  }
  /// Beyond the volume its outermost voxels are repeated.
  T at(int i, int j, int k) const
  {
    return this->Voxels[std::clamp(i, 0, this->Size.x - 1) * this->Strides[0] +
      std::clamp(j, 0, this->Size.y - 1) * this->Strides[1] +
      std::clamp(k, 0, this->Size.z - 1) * this->Strides[2]];
  }

  /// For voxels inside the volume.
  std::ptrdiff_t place(int i, int j, int k) const
  {
    return i * this->Strides[0] + j * this->Strides[1] + k * this->Strides[2];
  }
  std::ptrdiff_t stride(int axis) const { return this->Strides[axis]; }
  const T* pointer(int i, int j, int k) const { return this->Voxels + this->place(i, j, k); }

private:
  const T* Voxels;
  glm::ivec3 Size;
  std::array<std::ptrdiff_t, 3> Strides;
};

template <class T>
T voxelAtWinner(const PermutedVoxels<T>& voxels, const RayPath& path, int u, int v, int step)
{
  const int t = step % StepsPerSlice;
  return voxels.at(u + path.di[t], v + path.dj[t], step / StepsPerSlice);
}

/// The same for rays with individual paths.
template <class T>
T voxelAtWinner(const PermutedVoxels<T>& voxels, const ShearWarp& geometry, int u, int v, int step)
{
  const int t = step % StepsPerSlice, k = step / StepsPerSlice;
  const RayPath path = geometry.voxelsOnRay(u, v, k);
  return voxels.at(path.di[t], path.dj[t], k);
}

template <class T>
Accumulator<T> averageAtWinner(const PermutedVoxels<T>& voxels,
  const PerspectiveFootprints<Accumulator<T>>& footprints, int u, int v, int k)
{
  double sum = 0.0, weight = 0.0;
  footprints.forVoxels(u, v, k,
    [&](int i, int j, int s, double w)
    {
      const T value = voxels.at(i, j, s);
      if (value == value)
      {
        sum += w * static_cast<double>(value);
        weight += w;
      }
    });
  return static_cast<Accumulator<T>>(sum / weight);
}

/// Excludes NaN, as worksheets do; NaN if all are NaN.
template <class T>
Accumulator<T> averageAtWinner(const PermutedVoxels<T>& voxels,
  const SliceFootprint<Accumulator<T>>& footprint, int u, int v, int k)
{
  double sum = 0.0, weight = 0.0;
  int t = 0;
  for (const Tap& tap : footprint.taps)
  {
    const T value =
      voxels.at(u - footprint.nearest.x + tap.di, v - footprint.nearest.y + tap.dj, k + tap.slice);
    const double w = footprint.weights[t++];
    if (value == value)
    {
      sum += w * static_cast<double>(value);
      weight += w;
    }
  }
  return static_cast<Accumulator<T>>(sum / weight);
}

/// Fills an image with valueAt(voxels, u, v, step) of the other volume, at winners.
template <class T, class F>
void fillAtWinners(const AtWinners& c, const F& valueAt)
{
  using A = Accumulator<T>;
  const PermutedVoxels<T> voxels(c.other, c.geometry);
  ShearImage& image = c.image;
  const auto fill = [&](int v, auto* row)
  {
    using P = std::remove_pointer_t<decltype(row)>;
    const std::int32_t* const winners = &c.projected.winners[std::size_t(v) * image.width];
    for (int u = 0; u < image.width; ++u)
    {
      row[u] = winners[u] < 0 ? P(0) : static_cast<P>(valueAt(voxels, u, v, winners[u]));
    }
  };
  parallelFor(0, image.height, TileHeight,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        image.type == scalarTypeOf<T>() ? fill(v, image.row<T>(v)) : fill(v, image.row<A>(v));
      }
    });
}
}

#endif
