// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The ends of chains: at other values, or at the limit of the tolerance.
 */
#ifndef splattingLineEncoder_h
#define splattingLineEncoder_h

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace splatting
{
/// The values that a chain may have instead of a voxel's value; see LineEncoding.
template <class T>
class Tolerance
{
public:
  /// @param high  the largest voxel
  Tolerance(double levels, T high) : Levels(std::clamp(levels, 0.0, 255.0)), High(high) {}

  bool exact() const { return !(this->Levels > 0.0); }

  /// The least and the greatest value that may replace x, within the type's range.
  T least(T x) const
  {
    if constexpr (Whole)
    {
      const Unsigned below = difference(std::numeric_limits<T>::lowest(), x);
      return static_cast<T>(static_cast<Unsigned>(x) - std::min(this->allowed(x), below));
    }
    else
    {
      const T value = static_cast<T>(x - this->allowed(x));
      return double(x) - double(value) > this->allowed(x) ? std::nextafter(value, x) : value;
    }
  }
  T greatest(T x) const
  {
    if constexpr (Whole)
    {
      return static_cast<T>(static_cast<Unsigned>(x) + this->allowed(x));
    }
    else
    {
      const T value = static_cast<T>(x + this->allowed(x));
      return double(value) - double(x) > this->allowed(x) ? std::nextafter(value, x) : value;
    }
  }

  /// The middle of a and b >= a, never above b.
  static T middle(T a, T b)
  {
    if constexpr (Whole)
    {
      return static_cast<T>(static_cast<Unsigned>(a) + difference(a, b) / 2);
    }
    else
    {
      return std::clamp(static_cast<T>(0.5 * a + 0.5 * b), a, b);
    }
  }

private:
  static constexpr bool Whole = std::is_integral_v<T>;
  using Unsigned = std::make_unsigned_t<std::conditional_t<Whole, T, int>>;

  static Unsigned difference(T a, T b)
  {
    return static_cast<Unsigned>(static_cast<Unsigned>(b) - static_cast<Unsigned>(a));
  }

  /// dv(x), or slightly less: integers are rounded down, and three other roundings add less than
  /// the margin. (Integers of up to 32 bits need no margin if the tolerance is a whole number: only
  /// the quotient is rounded, and never up to or past the next integer.) At most high - x.
  std::conditional_t<Whole, Unsigned, double> allowed(T x) const
  {
    if constexpr (Whole)
    {
      constexpr double caution = sizeof(T) < 8 ? 1.0 : 1.0 - 0x1p-50;
      return static_cast<Unsigned>(
        this->Levels * static_cast<double>(difference(x, this->High)) / 255.0 * caution);
    }
    else
    {
      return this->Levels / 255.0 * (double(this->High) - double(x)) * (1.0 - 0x1p-50);
    }
  }

  double Levels;
  T High;
};

template <class T>
bool sameBits(const T& a, const T& b)
{
  return std::memcmp(&a, &b, sizeof(T)) == 0; // distinguishes the signs of zeros
}

/// The end of the chain that starts at `begin` and ends before `end`; sets its value.
template <class T>
int chainEnd(const T* row, int begin, int end, const Tolerance<T>& tolerance, T& value)
{
  int n = begin + 1;
  value = row[begin];
  if (tolerance.exact())
  {
    while (n < end && sameBits(row[n], value))
    {
      ++n;
    }
    return n;
  }
  T low = value, high = value; // of the voxels
  T least = tolerance.least(value), greatest = tolerance.greatest(value);
  for (; n < end; ++n)
  {
    const T nextLeast = std::max(least, tolerance.least(row[n]));
    const T nextGreatest = std::min(greatest, tolerance.greatest(row[n]));
    if (nextLeast > nextGreatest)
    {
      break;
    }
    least = nextLeast;
    greatest = nextGreatest;
    low = std::min(low, row[n]);
    high = std::max(high, row[n]);
  }
  // The interval is never empty, because no least value is above a voxel and no greatest value is
  // below one.
  value = Tolerance<T>::middle(std::max(least, low), std::min(greatest, high));
  return n;
}
}

#endif
