// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The trilinear field along one ray, cell by cell in double precision: the slow path of exact mode,
 * for rays that the kernels do not have.
 */
#ifndef splattingFieldOnRay_h
#define splattingFieldOnRay_h

#include "Sampling/ExactSegments.h"
#include "Sampling/ValuesAtWinners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splatting
{
/// std::floor(), which is a call where the instruction set of the build has none.
inline int floorOf(double x)
{
  const int n = static_cast<int>(x);
  return n - (x < n);
}

/// A ray passes at + slope (z - start) at depth z, in index space with the axes permuted.
struct FieldRay
{
  glm::dvec2 at, slope;
  double start;

  double operator()(int a, double z) const
  {
    return a == 2 ? z : this->at[a] + this->slope[a] * (z - this->start);
  }
};

inline FieldRay rayOfPixel(const ShearWarp& geometry, int u, int v)
{
  const AxisRays &columns = geometry.columns(), &rows = geometry.rows();
  return { { columns.at[u], rows.at[v] }, { columns.slope[u], rows.slope[v] },
    geometry.reference() };
}

/// The ray of a point between four pixels.
/// @param low    the first of them
/// @param share  of the way to the next column and row, 0 to 1
inline FieldRay rayBetween(
  const ShearWarp& geometry, const glm::ivec2& low, const glm::dvec2& share)
{
  FieldRay ray;
  ray.start = geometry.reference();
  for (int a = 0; a < 2; ++a)
  {
    const AxisRays& rays = a == 0 ? geometry.columns() : geometry.rows();
    const int last = geometry.rayCount()[a] - 1;
    // Beyond the image rays go on as between its last two pixels.
    const int n = std::clamp(low[a], 0, std::max(last - 1, 0)), next = std::min(n + 1, last);
    const double way = low[a] - n + share[a];
    ray.at[a] = rays.at[n] + way * (rays.at[next] - rays.at[n]);
    ray.slope[a] = rays.slope[n] + way * (rays.slope[next] - rays.slope[n]);
  }
  return ray;
}

/// Depths that are in both; the second is less if none is.
inline glm::dvec2 commonDepths(const glm::dvec2& a, const glm::dvec2& b)
{
  return { std::max(a.x, b.x), std::min(a.y, b.y) };
}

/// Where rays are in the field, before the eye.
class FieldBox
{
public:
  explicit FieldBox(const ShearWarp& geometry)
    : Start(geometry.reference()),
      Sides{ FieldRange(geometry, 0), FieldRange(geometry, 1) }
  {
    const Span& slices = geometry.slices();
    const FieldRange range(geometry, 2);
    this->Depths = { std::max(range.begin, geometry.faces(slices.begin).x),
      std::min(range.end, geometry.faces(slices.end - 1).y) };
  }

  /// The depths at which a ray is in it as far as one of the ray's coordinates tells; the second is
  /// less if it never is.
  glm::dvec2 depths(int axis, double at, double slope) const
  {
    const FieldRange& sides = this->Sides[axis];
    if (slope == 0.0)
    {
      return sides.begin <= at && at <= sides.end ? this->Depths : glm::dvec2(0.0, -1.0);
    }
    const double p = this->Start + (sides.begin - at) / slope;
    const double q = this->Start + (sides.end - at) / slope;
    return commonDepths(this->Depths, { std::min(p, q), std::max(p, q) });
  }
  glm::dvec2 depths(const FieldRay& ray) const
  {
    return commonDepths(
      this->depths(0, ray.at.x, ray.slope.x), this->depths(1, ray.at.y, ray.slope.y));
  }

private:
  double Start;
  std::array<FieldRange, 2> Sides;
  glm::dvec2 Depths;
};

/// A value that the field has, and where.
struct Extremum
{
  double depth;
  double value = -std::numeric_limits<double>::infinity(); ///< of minima the negative
};

/// What the field of voxels of type T has along rays.
template <class T>
class FieldOnRay
{
public:
  /// @param voxels  of a part of the volume that the geometry sees, or of all of it
  /// @param first   the voxel (i, j, k) that the part begins with
  FieldOnRay(const PermutedVoxels<T>& voxels, const ShearWarp& geometry, const glm::ivec3& first)
    : Voxels(voxels),
      Last(geometry.size() - 1),
      First(first),
      Reversed(geometry.reversed())
  {
  }

  /// Takes what the field has from one depth to another in slices k with counts(k), if it is larger
  /// (or less) than the best; of equal values the nearest to the viewer. What a slice has does not
  /// depend on others.
  template <class Counts>
  void take(const FieldRay& ray, const glm::dvec2& depths, bool least, Counts&& counts,
    Extremum& best) const
  {
    Walk walk{ ray, depths.x, {} };
    for (int a = 0; a < 3; ++a)
    {
      this->enter(a, walk);
    }
    int k = static_cast<int>(std::floor(depths.x + 0.5));
    bool isCounted = counts(k);
    while (walk.depth < depths.y)
    {
      const std::array<Axis, 3>& axes = walk.axes;
      int a = axes[0].exit < axes[1].exit ? 0 : 1;
      a = axes[2].exit < axes[a].exit ? 2 : a;
      const double face = k + 0.5, next = std::min(axes[a].exit, face);
      const double end = std::min(next, depths.y);
      if (walk.depth < end)
      {
        if (isCounted)
        {
          this->takeSegment(walk, end, least, best);
        }
        walk.depth = end;
      }
      if (face <= next)
      {
        isCounted = counts(++k);
      }
      else
      {
        this->leave(a, walk);
      }
    }
  }

private:
  /// One coordinate of the cell that a ray is in.
  struct Axis
  {
    double start, perSlice; ///< where the ray is at the first depth
    double from;            ///< that depth
    int cell, step;
    double exit;                          ///< the depth at which the ray leaves the cell
    std::array<std::ptrdiff_t, 2> voxels; ///< the places of the cell's two rows of voxels
  };
  struct Walk
  {
    const FieldRay& ray;
    double depth;
    std::array<Axis, 3> axes;
  };

  void enter(int a, Walk& walk) const
  {
    Axis& axis = walk.axes[a];
    axis.from = walk.depth;
    axis.start = walk.ray(a, walk.depth);
    axis.perSlice = a == 2 ? 1.0 : walk.ray.slope[a];
    axis.step = axis.perSlice < 0.0 ? -1 : 1;
    axis.cell =
      static_cast<int>(axis.step < 0 ? std::ceil(axis.start) - 1.0 : std::floor(axis.start));
    this->place(a, axis);
  }
  void leave(int a, Walk& walk) const
  {
    walk.axes[a].cell += walk.axes[a].step;
    this->place(a, walk.axes[a]);
  }
  /// Beyond the volume its outermost voxels are repeated.
  void place(int a, Axis& axis) const
  {
    const int face = axis.step < 0 ? axis.cell : axis.cell + 1;
    axis.exit = axis.perSlice == 0.0 ? std::numeric_limits<double>::infinity()
                                     : axis.from + (face - axis.start) / axis.perSlice;
    for (int n = 0; n < 2; ++n)
    {
      glm::ivec3 voxel(0);
      voxel[a] = std::clamp(axis.cell + n, 0, this->Last[a]) - this->First[a];
      axis.voxels[n] = this->Voxels.place(voxel.x, voxel.y, voxel.z);
    }
  }

  /// The part of a ray in one cell.
  void takeSegment(const Walk& walk, double end, bool least, Extremum& best) const
  {
    const std::array<Axis, 3>& axes = walk.axes;
    const T* const voxels = this->Voxels.pointer(0, 0, 0);
    T corners[8];
    for (int n = 0; n < 8; ++n)
    {
      corners[n] =
        voxels[axes[0].voxels[n & 1] + axes[1].voxels[n >> 1 & 1] + axes[2].voxels[n >> 2]];
    }
    T most = corners[0];
    for (int n = 1; n < 8; ++n)
    {
      // What is no number compares with nothing.
      const bool isMore = least ? corners[n] < most : corners[n] > most;
      most = isMore || most != most ? corners[n] : most;
    }
    const double limit = least ? -static_cast<double>(most) : static_cast<double>(most);
    if (!isBetter(limit, best))
    {
      return;
    }
    std::array<double, 8> values;
    double sum = 0.0;
    for (int n = 0; n < 8; ++n)
    {
      values[n] = least ? -static_cast<double>(corners[n]) : static_cast<double>(corners[n]);
      sum += values[n];
    }
    std::isfinite(sum) ? this->takeCubic<false>(walk, end, values, limit, best)
                       : this->takeCubic<true>(walk, end, values, limit, best);
  }

  bool isBetter(double value, const Extremum& best) const
  {
    return this->Reversed ? value >= best.value : value > best.value;
  }

  template <bool NonFinite>
  static double mix(double a, double b, double t)
  {
    if (NonFinite)
    {
      // What does not count may be no number.
      return t <= 0.0 ? a : t >= 1.0 ? b : a + t * (b - a);
    }
    return a + t * (b - a);
  }
  template <bool NonFinite>
  static double valueAt(const glm::dvec3& p, const std::array<double, 8>& c)
  {
    const auto mixed = mix<NonFinite>;
    const double near = mixed(mixed(c[0], c[1], p.x), mixed(c[2], c[3], p.x), p.y);
    const double far = mixed(mixed(c[4], c[5], p.x), mixed(c[6], c[7], p.x), p.y);
    return mixed(near, far, p.z);
  }

  /// Both ends of a cubic and its extrema in between.
  /// @param limit  the largest corner, which rounding must not exceed
  template <bool NonFinite>
  void takeCubic(const Walk& walk, double end, const std::array<double, 8>& corners, double limit,
    Extremum& best) const
  {
    const double begin = walk.depth;
    const auto take = [&](double z, double value)
    {
      value = std::min(value, limit);
      best = this->isBetter(value, best) ? Extremum{ z, value } : best;
    };
    glm::dvec3 from, to; // in the cell
    for (int a = 0; a < 3; ++a)
    {
      from[a] = std::clamp(walk.ray(a, begin) - walk.axes[a].cell, 0.0, 1.0);
      to[a] = std::clamp(walk.ray(a, end) - walk.axes[a].cell, 0.0, 1.0);
    }
    double f[4]; // at equal distances
    for (int n = 0; n < 4; ++n)
    {
      f[n] = valueAt<NonFinite>(n == 3 ? to : from + (to - from) * (n / 3.0), corners);
      // Cells with NaN are left out, faces that they share with others, too.
      if (NonFinite && f[n] != f[n])
      {
        return;
      }
    }
    // c0 + c1 t + c2 t^2 + c3 t^3 for t from 0 to 1.
    const double c1 = -5.5 * f[0] + 9.0 * f[1] - 4.5 * f[2] + f[3];
    const double c2 = 9.0 * f[0] - 22.5 * f[1] + 18.0 * f[2] - 4.5 * f[3];
    const double c3 = -4.5 * f[0] + 13.5 * f[1] - 13.5 * f[2] + 4.5 * f[3];
    take(begin, f[0]);
    // Within there is nothing above the inner coefficients of its Bernstein form.
    const double inner = f[0] + std::max(c1, 2.0 * c1 + c2) / 3.0;
    const double a = 3.0 * c3, root = c2 * c2 - a * c1;
    if (root >= 0.0 && this->isBetter(inner, best) && inner > f[3])
    {
      const double q = -(c2 + (c2 < 0.0 ? -std::sqrt(root) : std::sqrt(root)));
      double t[2] = { a != 0.0 ? q / a : -1.0, q != 0.0 ? c1 / q : -1.0 };
      std::sort(t, t + 2);
      for (double x : t)
      {
        if (x > 0.0 && x < 1.0)
        {
          take(begin + x * (end - begin), f[0] + x * (c1 + x * (c2 + x * c3)));
        }
      }
    }
    take(end, f[3]);
  }

  const PermutedVoxels<T>& Voxels;
  glm::ivec3 Last, First;
  bool Reversed;
};
}

#endif
