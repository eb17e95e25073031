// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "RayIntervals.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Less than the first slice, and more than the last one.
constexpr double Before = -1.0, Beyond = std::numeric_limits<std::int16_t>::max();

/// Near and far depths of a row of pixels, in slices.
struct Depths
{
  std::vector<double> near, far;

  void reset(int width)
  {
    this->near.assign(width, -Infinity);
    this->far.assign(width, Infinity);
  }
  void cut(const glm::dvec4& h, int v)
  {
    const int width = static_cast<int>(this->near.size());
    for (int u = 0; u < width; ++u)
    {
      const double rest = h.x * u + h.y * v + h.w; // rest + h.z * z >= 0
      if (h.z > 0.0)
      {
        this->near[u] = std::max(this->near[u], -rest / h.z);
      }
      else if (h.z < 0.0)
      {
        this->far[u] = std::min(this->far[u], -rest / h.z);
      }
      else if (rest < 0.0)
      {
        this->far[u] = -Infinity;
      }
    }
  }
  void round(std::int16_t* first, std::int16_t* last) const
  {
    constexpr double rounding = 1e-9;
    for (std::size_t u = 0; u < this->near.size(); ++u)
    {
      // Also keeps infinities out of the arithmetic.
      const double near = std::clamp(this->near[u], Before, Beyond);
      const double far = std::clamp(this->far[u], Before, Beyond);
      double low = std::ceil(near - rounding * (1.0 + std::abs(near)));
      double high = std::floor(far + rounding * (1.0 + std::abs(far)));
      if (low > high && near < far)
      {
        low = high = std::floor(0.5 * (near + far) + 0.5);
      }
      first[u] = static_cast<std::int16_t>(low);
      last[u] = static_cast<std::int16_t>(high);
    }
  }
};
}

void RayIntervals::clear()
{
  this->Width = 0;
  this->First.clear();
  this->Last.clear();
}

void RayIntervals::find(const ShearWarp& geometry, const std::vector<glm::dvec4>& halfSpaces)
{
  this->Width = geometry.width();
  const std::size_t pixels = std::size_t(this->Width) * geometry.height();
  this->First.resize(pixels);
  this->Last.resize(pixels);
  vtkSMPTools::For(0, geometry.height(), 16,
    [&](vtkIdType begin, vtkIdType end)
    {
      Depths depths;
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        depths.reset(this->Width);
        for (const glm::dvec4& h : halfSpaces)
        {
          depths.cut(h, v);
        }
        const std::size_t row = std::size_t(v) * this->Width;
        depths.round(&this->First[row], &this->Last[row]);
      }
    });
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
