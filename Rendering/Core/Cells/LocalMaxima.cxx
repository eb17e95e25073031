// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/LocalMaxima.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Follows the field of a ray from the viewer on.
class FirstPeak
{
public:
  /// @param rounding  smaller falls do not end a maximum
  FirstPeak(double threshold, double rounding) : Threshold(threshold), Rounding(rounding) {}

  /// Takes the next value; returns whether the one before it was a local maximum.
  bool take(double value, double t)
  {
    const bool counts = this->Value >= this->Threshold;
    if (counts && value < this->Value - this->Rounding)
    {
      return true;
    }
    if (value > this->Value || !counts)
    {
      this->Value = value;
      this->T = t;
    }
    return false;
  }
  /// At the end of the ray.
  bool ends() const { return this->Value >= this->Threshold; }
  double value() const { return this->Value; }
  double t() const { return this->T; }

private:
  double Threshold, Rounding;
  double Value = -Infinity, T = 0.0;
};

/// The field of one cell along a ray.
class CellField
{
public:
  /// @param place      of the ray at t = 0, from the cell's first corner
  CellField(
    const std::array<double, 8>& corners, const glm::dvec3& place, const glm::dvec3& direction)
    : Corners(corners),
      Place(place),
      Direction(direction)
  {
  }

  /// Gives `peak` the values of the ray's part [from, to], until it is complete.
  bool follow(double from, double to, FirstPeak& peak) const
  {
    return this->isInterpolated() ? this->followField(from, to, peak)
                                  : this->followVoxels(from, to, peak);
  }

private:
  bool isInterpolated() const
  {
    return std::all_of(
      this->Corners.begin(), this->Corners.end(), [](double c) { return std::isfinite(c); });
  }

  bool followField(double from, double to, FirstPeak& peak) const
  {
    const auto& c = this->Corners;
    const glm::dvec3 p = this->Place + from * this->Direction, d = (to - from) * this->Direction;
    const double x = c[1] - c[0], y = c[2] - c[0], z = c[4] - c[0];
    const double xy = c[3] - c[1] - y, xz = c[5] - c[4] - x, yz = c[6] - c[4] - y;
    const double xyz = c[7] - c[5] - c[6] + c[4] - xy;
    const double k0 = c[0] +
      (p.x * x + p.y * y + p.z * z + p.x * p.y * xy + p.x * p.z * xz + p.y * p.z * yz +
        p.x * p.y * p.z * xyz);
    const double k1 = d.x * (x + p.y * xy + p.z * xz + p.y * p.z * xyz) +
      d.y * (y + p.x * xy + p.z * yz + p.x * p.z * xyz) +
      d.z * (z + p.x * xz + p.y * yz + p.x * p.y * xyz);
    const double k2 =
      d.x * d.y * (xy + p.z * xyz) + d.x * d.z * (xz + p.y * xyz) + d.y * d.z * (yz + p.x * xyz);
    const double k3 = d.x * d.y * d.z * xyz;
    const auto at = [&](double s) { return k0 + s * (k1 + s * (k2 + s * k3)); };
    if (peak.take(at(0.0), from))
    {
      return true;
    }
    // Where the slope k1 + 2 k2 s + 3 k3 s^2 is 0, by the formula that does not cancel.
    const double square = k2 * k2 - 3.0 * k1 * k3;
    if (square > 0.0)
    {
      const double q = -(k2 + std::copysign(std::sqrt(square), k2));
      double roots[2] = { q / (3.0 * k3), k1 / q };
      if (!(roots[0] < roots[1]))
      {
        std::swap(roots[0], roots[1]);
      }
      for (const double s : roots)
      {
        if (s > 0.0 && s < 1.0 && peak.take(at(s), from + s * (to - from)))
        {
          return true;
        }
      }
    }
    return peak.take(at(1.0), to);
  }

  bool followVoxels(double from, double to, FirstPeak& peak) const
  {
    // The ray passes from octant to octant where a coordinate is a half.
    double ends[4] = { to, to, to, to };
    for (int a = 0; a < 3; ++a)
    {
      const double t = (0.5 - this->Place[a]) / this->Direction[a];
      ends[a] = t > from && t < to ? t : to;
    }
    std::sort(ends, ends + 3);
    for (const double end : ends)
    {
      if (!(end > from))
      {
        continue;
      }
      const glm::dvec3 p = this->Place + 0.5 * (from + end) * this->Direction;
      const double voxel = this->Corners[(p.x > 0.5) + 2 * (p.y > 0.5) + 4 * (p.z > 0.5)];
      if (voxel == voxel && peak.take(voxel, from))
      {
        return true;
      }
      from = end;
    }
    return false;
  }

  const std::array<double, 8>& Corners;
  glm::dvec3 Place, Direction;
};

/// The walk along one ray. Values are voxels times a power of two, so that squares are finite.
template <class T>
class RayOfCells
{
public:
  RayOfCells(const CellFrame<T>& frame, const glm::dvec3& start, const glm::dvec3& direction,
    double threshold)
    : Frame(frame),
      Start(start + glm::dvec3(frame.grid.shift)), // in cells
      Direction(direction),
      Inverse(1.0 / direction),
      Threshold(threshold),
      Scale(std::abs(static_cast<double>(frame.values.scale.factor)))
  {
  }

  /// Walks along a part of the ray.
  bool follow(double from, double to, FirstPeak& peak) const
  {
    const CellGrid& grid = this->Frame.grid;
    while (from < to)
    {
      const glm::ivec3 cell = glm::clamp(this->cellAt(from), grid.begin, grid.end - 1);
      const glm::ivec3 brick = cell / BrickCells;
      const glm::ivec3 at = brick - grid.firstBrick;
      const std::size_t n = (std::size_t(at.z) * grid.bricks.y + at.y) * grid.bricks.x + at.x;
      const double largest =
        this->Scale * static_cast<double>(this->Frame.bounds.template brick<T>()[n]);
      // Below the threshold there is no local maximum, but one before may end there.
      if (!(largest >= this->Threshold) && !peak.ends())
      {
        from = this->leave(BrickCells * brick, BrickCells, from, to);
        continue;
      }
      const double end = this->leave(cell, 1, from, to);
      std::array<double, 8> corners;
      this->load(cell, corners);
      const CellField field(corners, this->Start - glm::dvec3(cell), this->Direction);
      if (field.follow(from, end, peak))
      {
        return true;
      }
      from = end;
    }
    return false;
  }

private:
  /// Where the ray crosses the last face of a box of cells along an axis.
  double exit(const glm::ivec3& cell, int size, int axis) const
  {
    const int face = cell[axis] + (this->Direction[axis] > 0.0 ? size : 0);
    return (face - this->Start[axis]) * this->Inverse[axis];
  }

  /// The cell that the ray is in from t on. At a face rounding may find the cell before it. The
  /// arithmetic of exit() decides, so that each cell is left once.
  glm::ivec3 cellAt(double t) const
  {
    glm::ivec3 cell(glm::floor(this->Start + t * this->Direction));
    for (int a = 0; a < 3; ++a)
    {
      const int step = this->Direction[a] > 0.0 ? 1 : this->Direction[a] < 0.0 ? -1 : 0;
      cell[a] += this->exit(cell, 1, a) <= t ? step : 0;
    }
    return cell;
  }

  /// Where the ray leaves a box of cells, at `to` at most; always after `from`.
  double leave(const glm::ivec3& cell, int size, double from, double to) const
  {
    double end = to;
    for (int a = 0; a < 3; ++a)
    {
      const double t = this->exit(cell, size, a);
      end = t > from && t < end ? t : end;
    }
    return end;
  }

  void load(const glm::ivec3& cell, std::array<double, 8>& corners) const
  {
    const CellGrid& grid = this->Frame.grid;
    const glm::ivec3& size = grid.voxels.dimensions;
    const glm::ivec3 first = cell - grid.shift - grid.first;
    const T* const voxels = static_cast<const T*>(grid.voxels.voxels);
    for (int n = 0; n < 8; ++n)
    {
      const glm::ivec3 v =
        glm::clamp(first + glm::ivec3(n & 1, n >> 1 & 1, n >> 2), glm::ivec3(0), size - 1);
      const std::ptrdiff_t at = (std::ptrdiff_t(v.z) * size.y + v.y) * size.x + v.x;
      corners[n] = this->Scale * static_cast<double>(voxels[at]);
    }
  }

  const CellFrame<T>& Frame;
  glm::dvec3 Start, Direction, Inverse;
  double Threshold, Scale;
};

/// The first local maximum of a ray, if there is one at or above the threshold.
/// @param start  where the ray's part begins, so that rounding does not grow with the distance of
///               the eye
template <class T>
bool findPeak(const CellFrame<T>& frame, const glm::dvec3& start, const glm::dvec3& direction,
  double length, double threshold, FirstPeak& peak)
{
  const RayOfCells<T> ray(frame, start, direction, threshold);
  // The ray's parts in the regions that are shown, in the order in which it meets them.
  std::array<glm::dvec2, 9> parts;
  int count = 0;
  for (const CellBox& region : frame.regions.boxes)
  {
    double from = 0.0, to = length;
    for (int a = 0; a < 3; ++a)
    {
      frame.kernels.within(
        &from, &to, 0, 1, start[a], 0.0, direction[a], 0.0, region.low()[a], region.high()[a]);
    }
    if (from < to)
    {
      parts[count++] = { from, to };
    }
  }
  std::sort(parts.begin(), parts.begin() + count,
    [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x; });
  for (int n = 0; n < count; ++n)
  {
    if (ray.follow(parts[n].x, parts[n].y, peak))
    {
      return true;
    }
  }
  return peak.ends();
}
}

template <class T>
void findLocalMaxima(
  const CellFrame<T>& frame, const VolumeIndex::Range& range, double threshold, CellScreen& screen)
{
  using A = Accumulator<T>;
  const double scale = std::abs(static_cast<double>(frame.values.scale.factor));
  // More than what the values of two cells differ by at their common face.
  const double magnitude = scale * range.magnitude;
  const double spread = std::min(scale * range.high - scale * range.low, 2.0 * magnitude);
  const double rounding = 0x1p-40 * spread + 0x1p-48 * magnitude;
  parallelFor(0, screen.size.y, 1,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      std::vector<double> near(screen.size.x), far(screen.size.x);
      for (int y = static_cast<int>(begin); y < end; ++y)
      {
        const glm::ivec2 first = screen.origin + glm::ivec2(0, y);
        frame.findEnds(first.x, first.y, screen.size.x, near.data(), far.data());
        A* const values = screen.row<A>(y);
        float* const depths = &screen.depths[std::size_t(y) * screen.size.x];
        for (int x = 0; x < screen.size.x; ++x)
        {
          if (!(static_cast<double>(values[x]) >= threshold))
          {
            continue;
          }
          FirstPeak peak(scale * threshold, rounding);
          if (findPeak(frame, frame.rays.point(first.x + x, first.y, near[x]),
                frame.rays.direction(first.x + x, first.y), far[x] - near[x], scale * threshold,
                peak))
          {
            values[x] = static_cast<A>(peak.value() / scale);
            depths[x] = static_cast<float>(near[x] + peak.t());
          }
        }
      }
    });
}

#define SPLATTING_INSTANTIATE(T)                                                                   \
  template void findLocalMaxima<T>(                                                                \
    const CellFrame<T>&, const VolumeIndex::Range&, double, CellScreen&);
SPLATTING_TYPES(SPLATTING_INSTANTIATE)
#undef SPLATTING_INSTANTIATE
}
