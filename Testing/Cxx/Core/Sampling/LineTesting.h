// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of chains share: volumes with long chains and short ones, and their chains.
 */
#ifndef LineTesting_h
#define LineTesting_h

#include "CoreTesting.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

namespace linetesting
{
using namespace coretesting;
using splatting::Acceleration;
using splatting::LineEncoding;
using splatting::LineIndex;
using splatting::LineOrder;

inline const Acceleration lineAccelerations[] = { Acceleration::Lines, Acceleration::SortedLines,
  Acceleration::SortedVolume };
inline const LineOrder orders[] = { LineOrder::Lines, LineOrder::SortedLines,
  LineOrder::SortedVolume };

/// A value at a share, out of 255, of the type's range, or of [-1, 1].
template <class T>
T level(int share)
{
  using Limits = std::numeric_limits<T>;
  if constexpr (Limits::is_integer)
  {
    using U = std::make_unsigned_t<T>;
    const U step = static_cast<U>(Limits::max()) - static_cast<U>(Limits::lowest());
    return static_cast<T>(static_cast<U>(Limits::lowest()) + U(step / 255) * U(share));
  }
  else
  {
    return static_cast<T>(share / 127.5 - 1.0);
  }
}

/// Boxes of a few values, and perhaps some noise: long chains, short ones and ties.
template <class T>
reference::Volume<T> boxes(const std::array<int, 3>& size, int levels, reference::Random& random)
{
  const auto anyLevel = [&](reference::Random& from)
  { return level<T>(from.uniform(0, levels - 1) * 255 / levels); };
  reference::Volume<T> volume(size, anyLevel(random));
  for (int n = random.uniform(1, 8); n > 0; --n)
  {
    std::array<int, 3> first, last, p;
    for (int a = 0; a < 3; ++a)
    {
      first[a] = random.uniform(0, size[a] - 1);
      last[a] = random.uniform(first[a], size[a] - 1);
    }
    const T value = anyLevel(random);
    for (p[2] = first[2]; p[2] <= last[2]; ++p[2])
    {
      for (p[1] = first[1]; p[1] <= last[1]; ++p[1])
      {
        for (p[0] = first[0]; p[0] <= last[0]; ++p[0])
        {
          volume.at(p) = value;
        }
      }
    }
  }
  const int noise = std::max(random.uniform(-30, 20), 0);
  reference::Random many = random.fork();
  for (T& voxel : volume.voxels)
  {
    voxel = many.chance(noise / 100.0) ? anyLevel(many) : voxel;
  }
  return volume;
}

/// Some volumes are long enough for runs of equal worksheets.
inline std::array<int, 3> anyLongSize(reference::Random& random)
{
  std::array<int, 3> size = randomSize(random, 12);
  if (random.oneIn(2))
  {
    const int axis = random.uniform(0, 2);
    size[axis] = random.uniform(40, 90);
  }
  return size;
}

template <class T>
reference::Volume<T> anyVolume(reference::Random& random)
{
  const std::array<int, 3> size = anyLongSize(random);
  return random.oneIn(5) ? reference::uniformNoise<T>(size, random)
                         : boxes<T>(size, random.uniform(1, 9), random);
}

template <class T>
LineIndex makeLines(const reference::Volume<T>& volume, const LineEncoding& encoding)
{
  const auto& size = volume.size;
  return LineIndex(splatting::scalarTypeOf<T>(),
    { volume.voxels.data(), size[0], std::ptrdiff_t(size[0]) * size[1] }, toGlm(size), encoding);
}

/// dv(x), in more digits than voxels have.
template <class T>
long double toleranceAt(T x, T high, double levels)
{
  return static_cast<long double>(levels) *
    (static_cast<long double>(high) - static_cast<long double>(x)) / 255;
}
}

#endif
