// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Volume.h
 * @brief   small volumes with known contents: oracle, test data and benchmark input at once
 *
 * All volumes here are deterministic: the same call gives the same voxels on every machine. Random
 * numbers come from splitmix64, as the distributions of the standard library differ between
 * implementations; curves are polynomials, as sin and cos differ in their last bits.
 */
#ifndef reference_Volume_h
#define reference_Volume_h

#include "Random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace reference
{

/**
 * Voxels on a regular grid, x fastest. The centre of voxel (i,j,k) is the index position (i,j,k).
 */
template <class T>
struct Volume
{
  std::array<int, 3> size = { 0, 0, 0 };
  std::vector<T> voxels;

  Volume() = default;
  explicit Volume(const std::array<int, 3>& newSize, T value = T())
    : size(newSize),
      voxels(static_cast<std::size_t>(newSize[0]) * newSize[1] * newSize[2], value)
  {
  }

  std::size_t index(int i, int j, int k) const
  {
    return (static_cast<std::size_t>(k) * this->size[1] + j) * this->size[0] + i;
  }
  T& at(int i, int j, int k) { return this->voxels[this->index(i, j, k)]; }
  const T& at(int i, int j, int k) const { return this->voxels[this->index(i, j, k)]; }
  T& at(const std::array<int, 3>& p) { return this->at(p[0], p[1], p[2]); }
  const T& at(const std::array<int, 3>& p) const { return this->at(p[0], p[1], p[2]); }

  bool contains(const std::array<int, 3>& p) const
  {
    return p[0] >= 0 && p[0] < this->size[0] && p[1] >= 0 && p[1] < this->size[1] && p[2] >= 0 &&
      p[2] < this->size[2];
  }
};

/**
 * Every voxel is independent and uniform in [low, high].
 */
template <class T>
Volume<T> uniformNoise(const std::array<int, 3>& size, Random&& voxels, T low, T high)
{
  Volume<T> volume(size);
  for (T& voxel : volume.voxels)
  {
    voxel = voxels.uniform(low, high);
  }
  return volume;
}

/**
 * As above over the whole range of an integer type, over [-1, 1] for floating types.
 */
template <class T>
Volume<T> uniformNoise(const std::array<int, 3>& size, Random&& voxels)
{
  using Limits = std::numeric_limits<T>;
  return uniformNoise<T>(size, std::move(voxels), Limits::is_integer ? Limits::lowest() : T(-1),
    Limits::is_integer ? Limits::max() : T(1));
}

/// The same, whose voxels are one choice of a scene.
template <class T, class... Limits>
Volume<T> uniformNoise(const std::array<int, 3>& size, Random& scene, Limits... limits)
{
  return uniformNoise<T>(size, scene.fork(), limits...);
}

template <class T>
Volume<T> constant(const std::array<int, 3>& size, T value)
{
  return Volume<T>(size, value);
}

/**
 * Draw the straight line between two voxels, one voxel thick: one voxel per step along its longest
 * axis, nearest to the line (3-D DDA). Ties go up, decided in integers. Both ends are drawn; what
 * is outside the volume is not. Indices must not be negative.
 */
template <class T>
void drawLine(
  Volume<T>& volume, const std::array<int, 3>& from, const std::array<int, 3>& to, T value)
{
  int steps = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    steps = std::max(steps, std::abs(to[axis] - from[axis]));
  }
  for (int step = 0; step <= steps; ++step)
  {
    std::array<int, 3> position;
    for (int axis = 0; axis < 3; ++axis)
    {
      // floor(from + (to - from) * step / steps + 1/2)
      const int twice = 2 * (from[axis] * steps + (to[axis] - from[axis]) * step) + steps;
      position[axis] = twice / (2 * steps);
    }
    if (volume.contains(position))
    {
      volume.at(position) = value;
    }
  }
}

/**
 * The phantom of [CS98, section 5]: 64^3 voxels, background 0, with straight lines of one voxel
 * thickness. The paper does not say which; here: a line along each axis, a line along a face
 * diagonal of each axis pair, the four space diagonals, a fan of 13 oblique lines and a bundle of
 * 6 parallel ones that come as close as 3 voxels.
 */
template <class T>
Volume<T> linePhantom(T value = T(100))
{
  Volume<T> volume({ 64, 64, 64 });
  const auto line = [&](int x0, int y0, int z0, int x1, int y1, int z1) {
    drawLine<T>(volume, { x0, y0, z0 }, { x1, y1, z1 }, value);
  };
  line(4, 10, 56, 59, 10, 56);
  line(10, 4, 50, 10, 59, 50);
  line(54, 8, 4, 54, 8, 59);
  line(6, 6, 58, 57, 57, 58);
  line(6, 5, 6, 57, 5, 57);
  line(58, 6, 6, 58, 57, 57);
  for (int corner = 0; corner < 4; ++corner)
  {
    const int x = (corner & 1) ? 8 : 55;
    const int y = (corner & 2) ? 8 : 55;
    line(x, y, 8, 63 - x, 63 - y, 55);
  }
  for (int ray = 0; ray <= 12; ++ray)
  {
    line(4, 32, 4, 6 + 4 * ray, 60 - 2 * ray, 60);
  }
  for (int parallel = 0; parallel < 6; ++parallel)
  {
    line(12, 20 + 3 * parallel, 40, 60, 27 + 3 * parallel, 61);
  }
  return volume;
}

/**
 * Set every voxel whose centre is within the radius of the centre to at least the value.
 */
inline void drawSphere(Volume<std::uint8_t>& volume, const std::array<double, 3>& centre,
  double radius, std::uint8_t value)
{
  std::array<int, 3> first;
  std::array<int, 3> last;
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = std::max(0, static_cast<int>(std::ceil(centre[axis] - radius)));
    last[axis] =
      std::min(volume.size[axis] - 1, static_cast<int>(std::floor(centre[axis] + radius)));
  }
  for (int k = first[2]; k <= last[2]; ++k)
  {
    for (int j = first[1]; j <= last[1]; ++j)
    {
      const double dz = k - centre[2];
      const double dy = j - centre[1];
      for (int i = first[0]; i <= last[0]; ++i)
      {
        const double dx = i - centre[0];
        if (dx * dx + dy * dy + dz * dz <= radius * radius)
        {
          volume.at(i, j, k) = std::max(volume.at(i, j, k), value);
        }
      }
    }
  }
}

/**
 * A vessel: spheres along a cubic Bezier curve whose control points lie anywhere in the volume, at
 * most about one voxel apart.
 */
inline void drawVessel(Volume<std::uint8_t>& volume, Random& random)
{
  std::array<std::array<double, 3>, 4> control;
  for (auto& point : control)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] = random.uniform(0.0, volume.size[axis] - 1.0);
    }
  }
  const double radius = random.uniform(1.5, 4.0);
  const auto value = random.uniform<std::uint8_t>(150, 250);
  // |p'(t)| <= 3 max |p_{i+1} - p_i|; the largest edge stands for the diagonal's sqrt(3).
  const int steps = 3 * std::max({ volume.size[0], volume.size[1], volume.size[2] });
  for (int step = 0; step <= steps; ++step)
  {
    const double t = static_cast<double>(step) / steps;
    const double s = 1.0 - t;
    std::array<double, 3> centre;
    for (int axis = 0; axis < 3; ++axis)
    {
      centre[axis] = s * s * s * control[0][axis] + 3.0 * s * s * t * control[1][axis] +
        3.0 * s * t * t * control[2][axis] + t * t * t * control[3][axis];
    }
    drawSphere(volume, centre, radius, value);
  }
}

/**
 * The benchmarks' typical volume: n^3 voxels of noise in [0, 60] with 20 curved vessels of radius
 * 1.5 to 4 voxels and values 150 to 250.
 */
inline Volume<std::uint8_t> noiseAndVessels(int n, std::uint64_t seed = 1)
{
  Volume<std::uint8_t> volume({ n, n, n });
  Random random(seed);
  std::uint64_t bits = 0;
  for (std::size_t voxel = 0; voxel < volume.voxels.size(); ++voxel)
  {
    bits = voxel % 8 == 0 ? random.bits() : bits >> 8; // one byte of each random word per voxel
    volume.voxels[voxel] = static_cast<std::uint8_t>(((bits & 0xFF) * 61) >> 8);
  }
  for (int vessel = 0; vessel < 20; ++vessel)
  {
    drawVessel(volume, random);
  }
  return volume;
}

/**
 * One of the 48 symmetries of the axes: axis a of the result is the axis axis[a] of the source,
 * reversed where sign[a] is -1. A direction d becomes d'[a] = sign[a] * d[axis[a]].
 */
struct AxisSymmetry
{
  std::array<int, 3> axis = { 0, 1, 2 };
  std::array<int, 3> sign = { 1, 1, 1 };
};

inline std::vector<AxisSymmetry> allAxisSymmetries()
{
  std::vector<AxisSymmetry> all;
  std::array<int, 3> axis = { 0, 1, 2 };
  do
  {
    for (int mirror = 0; mirror < 8; ++mirror)
    {
      all.push_back(
        { axis, { (mirror & 1) ? -1 : 1, (mirror & 2) ? -1 : 1, (mirror & 4) ? -1 : 1 } });
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return all;
}

/**
 * The volume with its axes permuted and reversed.
 */
template <class T>
Volume<T> transformed(const Volume<T>& source, const AxisSymmetry& symmetry)
{
  std::array<int, 3> size;
  for (int a = 0; a < 3; ++a)
  {
    size[a] = source.size[symmetry.axis[a]];
  }
  Volume<T> result(size);
  std::array<int, 3> p;
  for (p[2] = 0; p[2] < size[2]; ++p[2])
  {
    for (p[1] = 0; p[1] < size[1]; ++p[1])
    {
      for (p[0] = 0; p[0] < size[0]; ++p[0])
      {
        std::array<int, 3> q;
        for (int a = 0; a < 3; ++a)
        {
          q[symmetry.axis[a]] = symmetry.sign[a] > 0 ? p[a] : size[a] - 1 - p[a];
        }
        result.at(p) = source.at(q);
      }
    }
  }
  return result;
}

/**
 * The same voxels as double (64-bit integers above 2^53 are rounded).
 */
template <class T>
Volume<double> toDouble(const Volume<T>& source)
{
  Volume<double> result(source.size);
  std::transform(source.voxels.begin(), source.voxels.end(), result.voxels.begin(),
    [](T value) { return static_cast<double>(value); });
  return result;
}

} // namespace reference

#endif
