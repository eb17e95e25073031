// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "RayIntervals.h"

#include "ClosedSurface.h"
#include "SceneDepth.h"

#include <vtkSMPTools.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Rounding = 1e-9;
/// Less than the first slice, and more than the last one.
constexpr double Before = -1.0, Beyond = std::numeric_limits<std::int16_t>::max();

/// Without a function call on the baseline of x86-64. For doubles far below 2^51.
inline double nearestInteger(double x)
{
  constexpr double unit = 0x1.8p52;
  return (x + unit) - unit;
}

/// Near and far depths of some pixels in a row, in slices.
struct Depths
{
  static constexpr int Most = 256;

  void reset(double low, double high, int count)
  {
    std::fill_n(this->near, count, low);
    std::fill_n(this->far, count, high);
  }

  void cut(const glm::dvec4 h, int u0, int v, int count)
  {
    // h.x u + rest + h.z z >= 0
    const double rest = h.y * v + h.w;
    const double size = glm::length(glm::dvec3(h));
    if (std::abs(h.z) <= 1e-14 * size)
    {
      const double least = -Rounding * (size + std::abs(h.w));
      for (int x = 0; x < count; ++x)
      {
        this->far[x] = h.x * (u0 + x) + rest < least ? -Infinity : this->far[x];
      }
      return;
    }
    const double scale = -1.0 / h.z;
    if (h.z > 0.0)
    {
      for (int x = 0; x < count; ++x)
      {
        this->near[x] = std::max(this->near[x], (h.x * (u0 + x) + rest) * scale);
      }
      return;
    }
    for (int x = 0; x < count; ++x)
    {
      this->far[x] = std::min(this->far[x], (h.x * (u0 + x) + rest) * scale);
    }
  }

  void cut(const double* nearest, const double* farthest, int count)
  {
    for (int x = 0; x < count; ++x)
    {
      this->near[x] = std::max(this->near[x], nearest[x]);
      this->far[x] = std::min(this->far[x], farthest[x]);
    }
  }

  /// The first and last slice of each pixel, first > last if there are none, instead of depths.
  void round(int slices, int count)
  {
    const double end = slices - 1;
    for (int x = 0; x < count; ++x)
    {
      // Also keeps infinities out of the arithmetic.
      const double low = std::min(std::max(this->near[x], Before), Beyond);
      const double high = std::min(std::max(this->far[x], Before), Beyond);
      const double margin = Rounding * (1.0 + std::abs(low));
      // Up and down: with the margins these are no integers.
      const double first = nearestInteger(low - margin + 0.5);
      const double last = nearestInteger(high + Rounding * (1.0 + std::abs(high)) - 0.5);
      const bool isThin = first > last && high - low > margin;
      // Of two slices that are as near, the higher one.
      const double middle = nearestInteger(0.5 * (low + high) + Rounding);
      this->near[x] = std::max(isThin ? middle : first, 0.0);
      this->far[x] = std::min(isThin ? middle : last, end);
    }
  }

  /// Whether any slices are lost.
  bool write(
    int slices, int count, std::int16_t* __restrict first, std::int16_t* __restrict last) const
  {
    int lost = 0;
    for (int x = 0; x < count; ++x)
    {
      const int begin = static_cast<int>(this->near[x]), end = static_cast<int>(this->far[x]);
      first[x] = static_cast<std::int16_t>(begin);
      last[x] = static_cast<std::int16_t>(end);
      lost |= begin | (slices - 1 - end);
    }
    return lost != 0;
  }

  double near[Most], far[Most];
};

/// Where rays enter and leave the voxels' boxes.
class Reach
{
public:
  explicit Reach(const ShearWarp& geometry) : Slices(geometry.size().z)
  {
    for (int a = 0; a < 2; ++a)
    {
      const int axis = geometry.axes()[a];
      glm::dvec4 plane(0.0, 0.0, 0.0, 0.5);
      plane[axis] = 1.0;
      this->Planes[2 * a] = geometry.inPixels(plane);
      plane = { 0.0, 0.0, 0.0, geometry.size()[a] - 0.5 };
      plane[axis] = -1.0;
      this->Planes[2 * a + 1] = geometry.inPixels(plane);
    }
  }

  /// Opens the rays that lose no sample, or have none.
  void openWhole(int u0, int v, int count, Depths& depths) const
  {
    Depths reach;
    this->find(u0, v, count, reach);
    for (int x = 0; x < count; ++x)
    {
      // Voxels that a ray crosses are centred up to half a slice outside its reach.
      const bool whole = (reach.near[x] >= reach.far[x]) |
        ((depths.near[x] <= reach.near[x] - 0.5) & (depths.far[x] >= reach.far[x] + 0.5));
      depths.near[x] = whole ? Before : depths.near[x];
      depths.far[x] = whole ? Beyond : depths.far[x];
    }
  }

private:
  void find(int u0, int v, int count, Depths& depths) const
  {
    depths.reset(-0.5, this->Slices - 0.5, count);
    for (const glm::dvec4& plane : this->Planes)
    {
      depths.cut(plane, u0, v, count);
    }
  }

  int Slices;
  glm::dvec4 Planes[4];
};
}

void RayIntervals::clear()
{
  this->Width = 0;
  this->First.clear();
  this->Last.clear();
}

void RayIntervals::find(const ShearWarp& geometry, const std::vector<glm::dvec4>& halfSpaces,
  const ClosedSurface* surface, const SceneDepth* depth)
{
  if (halfSpaces.empty() && !surface && !depth)
  {
    this->clear();
    return;
  }
  this->Width = geometry.width();
  const std::size_t pixels = std::size_t(this->Width) * geometry.height();
  this->First.resize(pixels);
  this->Last.resize(pixels);
  const Reach reach(geometry);
  const int slices = geometry.size().z;
  std::atomic<bool> isCut(false);
  vtkSMPTools::For(0, geometry.height(), 16,
    [&](vtkIdType begin, vtkIdType end)
    {
      Depths depths;
      bool lost = false;
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        for (int u = 0; u < this->Width; u += Depths::Most)
        {
          const int count = std::min(Depths::Most, this->Width - u);
          depths.reset(Before, Beyond, count);
          for (const glm::dvec4& h : halfSpaces)
          {
            depths.cut(h, u, v, count);
          }
          if (surface)
          {
            depths.cut(surface->near(v) + u, surface->far(v) + u, count);
          }
          if (depth)
          {
            depth->endRays(u, v, count, depths.near, depths.far);
          }
          if (surface || depth)
          {
            // Half-spaces that cut nothing are not there in the first place.
            reach.openWhole(u, v, count, depths);
          }
          const std::size_t first = std::size_t(v) * this->Width + u;
          depths.round(slices, count);
          lost |= depths.write(slices, count, &this->First[first], &this->Last[first]);
        }
      }
      if (lost)
      {
        isCut = true;
      }
    });
  if (!isCut)
  {
    this->clear();
  }
}

void RayIntervals::findCrossed(
  const CrossedSlices& crossed, int width, int height, const RayIntervals& within)
{
  this->Width = width;
  this->First.resize(std::size_t(width) * height);
  this->Last.resize(this->First.size());
  vtkSMPTools::For(0, height, 16,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        std::int16_t* const first = &this->First[std::size_t(v) * width];
        std::int16_t* const last = &this->Last[std::size_t(v) * width];
        crossed.find(v, first, last);
        for (int u = 0; u < width && !within.empty(); ++u)
        {
          first[u] = std::max(first[u], within.first(v)[u]);
          last[u] = std::min(last[u], within.last(v)[u]);
        }
      }
    });
}
}
