// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Projection/RayIntervals.h"

#include "Clipping/ClosedSurface.h"
#include "Clipping/SceneDepth.h"
#include "Common/Parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Rounding = DepthLimits::Rounding;
constexpr double Beyond = DepthLimits::Beyond;

/// Converts half-spaces for RowDepths::cut() and cutPerspective().
std::vector<glm::dvec4> asSeen(const ShearWarp& geometry, const std::vector<glm::dvec4>& halfSpaces)
{
  const std::array<int, 3>& axes = geometry.axes();
  std::vector<glm::dvec4> result;
  for (const glm::dvec4& h : halfSpaces)
  {
    result.push_back(geometry.isPerspective() ? glm::dvec4(h[axes[0]], h[axes[1]], h[axes[2]], h.w)
                                              : geometry.inPixels(h));
  }
  return result;
}

/// Near and far depths of some pixels in a row, in slices.
struct RowDepths
{
  static constexpr int Most = 256;

  void reset(double low, double high, int count)
  {
    std::fill_n(this->near, count, low);
    std::fill_n(this->far, count, high);
  }

  /// Cuts by a half-space of the pixels of a parallel image.
  void cut(const CutLoops& loops, const glm::dvec4 h, int u0, int v, int count)
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
    const PlaneRow plane{ h.x, rest, -1.0 / h.z, u0 };
    h.z > 0.0 ? loops.beginAtPlane(plane, this->near, count)
              : loops.endAtPlane(plane, this->far, count);
  }

  /// Cuts by a half-space of (i, j, k), for the rays of a perspective image.
  void cutPerspective(const glm::dvec4 h, const ShearWarp& geometry, int u0, int v, int count)
  {
    // (h.x slope + rest) (z - reference) + h.x at + start >= 0
    const double* const at = geometry.columns().at.data() + u0;
    const double* const slope = geometry.columns().slope.data() + u0;
    const double reference = geometry.reference();
    const double rest = h.y * geometry.rows().slope[v] + h.z;
    const double start = h.y * geometry.rows().at[v] + h.z * reference + h.w;
    const double size = glm::length(glm::dvec3(h));
    const double level = 1e-14 * size, least = -Rounding * (size + std::abs(h.w));
    // Most planes bound all rays of a row at the same end; speeds change linearly along the row.
    const int last = std::clamp(geometry.rayCount().x - 1 - u0, 0, count - 1);
    const double speeds[] = { h.x * slope[0] + rest, h.x * slope[last] + rest };
    const bool begins = std::min(speeds[0], speeds[1]) > level;
    if (begins || std::max(speeds[0], speeds[1]) < -level)
    {
      double* const bounds = begins ? this->near : this->far;
      const double sense = begins ? 1.0 : -1.0;
      for (int x = 0; x < count; ++x)
      {
        const double z = reference - (h.x * at[x] + start) / (h.x * slope[x] + rest);
        bounds[x] = sense * std::max(sense * bounds[x], sense * z);
      }
      return;
    }
    for (int x = 0; x < count; ++x)
    {
      const double speed = h.x * slope[x] + rest, value = h.x * at[x] + start;
      const double z = reference - value / speed;
      const double nearer = std::max(this->near[x], z), farther = std::min(this->far[x], z);
      const double outside = value < least ? -Infinity : this->far[x];
      this->near[x] = speed > level ? nearer : this->near[x];
      this->far[x] = speed > level ? this->far[x] : speed < -level ? farther : outside;
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

  double near[Most], far[Most];
};

/// The depths at which rays begin and end, and at which they enter and leave the boxes of the
/// voxels.
class RayExtents
{
public:
  explicit RayExtents(const ShearWarp& geometry)
  {
    if (geometry.isPerspective())
    {
      double& eye = geometry.reversed() ? this->Ends.y : this->Ends.x;
      eye = std::clamp(geometry.eye().z, DepthLimits::Before, Beyond);
    }
  }

  /// Call it before openWhole().
  void findVolume(const ShearWarp& geometry)
  {
    const Span& slices = geometry.slices();
    this->All = { geometry.faces(slices.begin).x, geometry.faces(slices.end - 1).y };
    find(geometry.columns(), geometry.reference(), geometry.size().x, this->Columns);
    find(geometry.rows(), geometry.reference(), geometry.size().y, this->Rows);
  }

  /// The depths between which rays exist.
  const glm::dvec2& ends() const { return this->Ends; }

  /// Opens the rays that lose no sample, or have none.
  void openWhole(int u0, int v, int count, RowDepths& depths) const
  {
    const glm::dvec2 row = { std::max(this->All.x, this->Rows[v].x),
      std::min(this->All.y, this->Rows[v].y) };
    for (int x = 0; x < count; ++x)
    {
      const glm::dvec2& column = this->Columns[u0 + x];
      const double enter = std::max(row.x, column.x), leave = std::min(row.y, column.y);
      // Voxels that a ray crosses have centres up to half a slice outside the ray's extent.
      const bool coversStart = depths.near[x] <= std::max(enter - 0.5, this->Ends.x);
      const bool coversEnd = depths.far[x] >= std::min(leave + 0.5, this->Ends.y);
      const bool whole = (enter >= leave) | (coversStart & coversEnd);
      depths.near[x] = whole ? this->Ends.x : depths.near[x];
      depths.far[x] = whole ? this->Ends.y : depths.far[x];
    }
  }

private:
  /// The depths between which the rays of each column (or row) are in the volume's.
  static void find(const AxisRays& rays, double reference, int size, std::vector<glm::dvec2>& reach)
  {
    reach.resize(rays.at.size());
    for (std::size_t n = 0; n < reach.size(); ++n)
    {
      const double low = -0.5 - rays.at[n], high = size - 0.5 - rays.at[n], slope = rays.slope[n];
      if (std::abs(slope) > 1e-14)
      {
        reach[n] = reference +
          glm::dvec2(std::min(low / slope, high / slope), std::max(low / slope, high / slope));
      }
      else
      {
        const double rounding = Rounding * (1.0 + size);
        reach[n] = { -Infinity, low <= rounding && high >= -rounding ? Infinity : -Infinity };
      }
    }
  }

  glm::dvec2 Ends{ DepthLimits::Before, Beyond }, All{ 0.0 };
  std::vector<glm::dvec2> Columns, Rows;
};
/// All cuts of the rays of an image.
struct Cutting
{
  /// The depths between which some pixels of a row are visible.
  void find(int u, int v, int count, RowDepths& depths) const
  {
    depths.reset(this->extents.ends().x, this->extents.ends().y, count);
    for (const glm::dvec4& h : this->planes)
    {
      if (this->geometry.isPerspective())
      {
        depths.cutPerspective(h, this->geometry, u, v, count);
      }
      else
      {
        depths.cut(this->loops, h, u, v, count);
      }
    }
    if (this->hull)
    {
      depths.cut(this->hull->near(v) + u, this->hull->far(v) + u, count);
    }
    if (this->depth)
    {
      this->depth->endRays(this->geometry, u, v, count, depths.near, depths.far);
    }
    if (this->hull || this->depth)
    {
      // Half-spaces that cut nothing have been removed.
      this->extents.openWhole(u, v, count, depths);
    }
  }

  const ShearWarp& geometry;
  const CutLoops& loops;
  std::vector<glm::dvec4> planes;
  const SurfaceDepths* hull;
  const SceneDepth* depth;
  RayExtents extents;
};
}

void RayIntervals::clear()
{
  this->Width = 0;
  this->First.clear();
  this->Last.clear();
}

void RayIntervals::find(const ShearWarp& geometry, const std::vector<glm::dvec4>& halfSpaces,
  ClosedSurface* surface, const SceneDepth* depth, InstructionSet set)
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
  const CutLoops& loops = kernelsFor(set);
  const Span slices = geometry.slices();
  Cutting cutting{ geometry, loops, asSeen(geometry, halfSpaces),
    surface ? &surface->project(geometry) : nullptr, depth, RayExtents(geometry) };
  if (surface || depth)
  {
    cutting.extents.findVolume(geometry);
  }
  std::atomic<bool> isCut(false);
  parallelFor(0, geometry.height(), 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      RowDepths depths;
      bool lost = false;
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        for (int u = 0; u < this->Width; u += RowDepths::Most)
        {
          const int count = std::min(RowDepths::Most, this->Width - u);
          const std::size_t first = std::size_t(v) * this->Width + u;
          cutting.find(u, v, count, depths);
          lost |= loops.slicesBetween(depths.near, depths.far, slices.begin, slices.end,
            &this->First[first], &this->Last[first], count);
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

void RayIntervals::takePixel(const RayIntervals& whole, const glm::ivec2& pixel, int width)
{
  this->Width = width;
  this->First.assign(width, 1);
  this->Last.assign(width, 0);
  this->First.front() = whole.first(pixel.y)[pixel.x];
  this->Last.front() = whole.last(pixel.y)[pixel.x];
}

void RayIntervals::findCrossed(
  const CrossedSlices& crossed, int width, int height, const RayIntervals& within)
{
  this->Width = width;
  this->First.resize(std::size_t(width) * height);
  this->Last.resize(this->First.size());
  parallelFor(0, height, 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
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

void RayIntervals::setShifted(const RayIntervals& other, int firstSlice)
{
  this->Width = other.Width;
  this->First.resize(other.First.size());
  this->Last.resize(other.Last.size());
  parallelFor(0, static_cast<std::ptrdiff_t>(this->First.size()), 1 << 14,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (std::ptrdiff_t n = begin; n < end; ++n)
      {
        this->First[n] = static_cast<std::int16_t>(other.First[n] - firstSlice);
        this->Last[n] = static_cast<std::int16_t>(other.Last[n] - firstSlice);
      }
    });
}
}
