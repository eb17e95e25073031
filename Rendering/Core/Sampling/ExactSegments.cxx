// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/ExactSegments.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
/// Adds where x = from + t (to - from) passes n + offset, for any integer n and 0 < t < 1: once at
/// most, as rays move by a voxel or less.
void addCut(double from, double to, double offset, std::vector<double>& cuts)
{
  const double low = std::min(from, to) - offset, high = std::max(from, to) - offset;
  const double n = std::floor(low) + 1.0;
  if (n < high)
  {
    cuts.push_back((n + offset - from) / (to - from));
  }
}

/// The pixels whose point x + pixel lies in [begin, end].
Span pixelsIn(double begin, double end, double x)
{
  return { static_cast<int>(std::ceil(begin - x)), static_cast<int>(std::floor(end - x)) + 1 };
}

/// What the eight voxels of a cell weigh at a point of it.
using Corners = std::array<double, 8>;

Corners cornersAt(double x, double y, double z)
{
  Corners corners;
  for (int n = 0; n < 8; ++n)
  {
    corners[n] = (n & 1 ? x : 1.0 - x) * (n & 2 ? y : 1.0 - y) * (n & 4 ? z : 1.0 - z);
  }
  return corners;
}

/// The coefficients of the field from p to q: its blossom, the coordinates of one point mixed with
/// those of the other in all ways.
std::array<Corners, 4> coefficients(const glm::dvec3& p, const glm::dvec3& q)
{
  std::array<Corners, 4> result{ cornersAt(p.x, p.y, p.z), Corners{}, Corners{},
    cornersAt(q.x, q.y, q.z) };
  for (int a = 0; a < 3; ++a)
  {
    glm::dvec3 one = p, two = q;
    one[a] = q[a];
    two[a] = p[a];
    const Corners first = cornersAt(one.x, one.y, one.z), second = cornersAt(two.x, two.y, two.z);
    for (int n = 0; n < 8; ++n)
    {
      result[1][n] += first[n] / 3.0;
      result[2][n] += second[n] / 3.0;
    }
  }
  return result;
}

template <class A>
BoxSide<A> sideBetween(double from, double to)
{
  const double low = std::min(from, to), high = std::max(from, to), cell = std::floor(low);
  const bool crosses = high > cell + 1.0;
  return { static_cast<int>(cell), static_cast<A>(low - cell),
    static_cast<A>(high - cell - crosses), crosses };
}

template <class A>
ExactSegment<A> segmentBetween(
  const ShearWarp& geometry, int k, const glm::dvec3& from, const glm::dvec3& to)
{
  const glm::dvec3 middle = 0.5 * (from + to), cell = glm::floor(middle);
  ExactSegment<A> segment;
  segment.di = static_cast<int>(cell.x);
  segment.dj = static_cast<int>(cell.y);
  segment.dk = static_cast<int>(cell.z) - k;
  const auto weights = coefficients(glm::clamp(from - cell, glm::dvec3(0.0), glm::dvec3(1.0)),
    glm::clamp(to - cell, glm::dvec3(0.0), glm::dvec3(1.0)));
  for (int b = 0; b < 4; ++b)
  {
    std::transform(weights[b].begin(), weights[b].end(), segment.weights.begin() + 8 * b,
      [](double weight) { return static_cast<A>(weight); });
  }
  // Along one axis the field is a line between two voxels.
  segment.curved = from.x != to.x || from.y != to.y;
  const FieldRange depths(geometry, 2);
  const bool inField = depths.begin <= middle.z && middle.z <= depths.end;
  for (int a = 0; a < 2; ++a)
  {
    const FieldRange range(geometry, a);
    segment.inField[a] = inField ? pixelsIn(range.begin, range.end, middle[a]) : Span{};
    segment.inBoxes[a] = pixelsIn(-0.5, geometry.size()[a] - 0.5, middle[a]);
  }
  return segment;
}
}

template <class A>
void findExactBoxes(
  const ShearWarp& geometry, const ShearWarp& part, std::vector<ExactBox<A>>& boxes)
{
  const glm::ivec3& first = part.first();
  boxes.resize(part.size().z);
  for (int own = 0; own < part.size().z; ++own)
  {
    const int k = own + first.z;
    const glm::dvec2 from = -geometry.position(k - 0.5) - glm::dvec2(first),
                     to = -geometry.position(k + 0.5) - glm::dvec2(first);
    boxes[own] = { sideBetween<A>(from.x, to.x), sideBetween<A>(from.y, to.y) };
  }
}

template <class A>
void findExactPaths(
  const ShearWarp& geometry, const ShearWarp& part, std::vector<ExactPath<A>>& paths)
{
  const glm::ivec3& first = part.first();
  paths.resize(part.size().z);
  std::vector<double> cuts;
  for (int own = 0; own < part.size().z; ++own)
  {
    const int k = own + first.z;
    const glm::dvec3 from(-geometry.position(k - 0.5), k - 0.5);
    const glm::dvec3 to(-geometry.position(k + 0.5), k + 0.5);
    cuts = { 0.0, 0.5, 1.0 };
    for (int a = 0; a < 2; ++a)
    {
      addCut(from[a], to[a], 0.0, cuts);
      if (FieldRange(geometry, a).isExtended)
      {
        addCut(from[a], to[a], 0.5, cuts);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    paths[own].clear();
    for (std::size_t n = 0; n + 1 < cuts.size(); ++n)
    {
      const glm::dvec3 way = to - from;
      paths[own].push_back(
        segmentBetween<A>(geometry, k, from + cuts[n] * way, from + cuts[n + 1] * way));
      paths[own].back().di -= first.x;
      paths[own].back().dj -= first.y;
    }
  }
}

template void findExactBoxes(const ShearWarp&, const ShearWarp&, std::vector<ExactBox<float>>&);
template void findExactBoxes(const ShearWarp&, const ShearWarp&, std::vector<ExactBox<double>>&);

void findFieldSpans(const ShearWarp& geometry, std::vector<Span>& spans)
{
  const FieldRange ranges[3] = { { geometry, 0 }, { geometry, 1 }, { geometry, 2 } };
  const glm::dvec2 slope = -geometry.shear();
  spans.assign(geometry.height(), {});
  for (int v = 0; v < geometry.height(); ++v)
  {
    // The depths at which the row's rays are in the field's rows, then in its columns.
    double near = ranges[2].begin, far = ranges[2].end;
    const double y = v - geometry.position(0.0).y;
    if (slope.y == 0.0)
    {
      far = ranges[1].begin <= y && y <= ranges[1].end ? far : near;
    }
    else
    {
      const double a = (ranges[1].begin - y) / slope.y, b = (ranges[1].end - y) / slope.y;
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    if (!(near < far))
    {
      continue;
    }
    // A ray that only touches the field has no segment in it.
    const double x = -geometry.position(0.0).x;
    const double low = x + std::min(slope.x * near, slope.x * far);
    const double high = x + std::max(slope.x * near, slope.x * far);
    const double begin = ranges[0].begin - high, end = ranges[0].end - low;
    spans[v] = slope.x == 0.0
      ? pixelsIn(ranges[0].begin, ranges[0].end, x)
      : Span{ static_cast<int>(std::floor(begin)) + 1, static_cast<int>(std::ceil(end)) };
    spans[v].begin = std::max(spans[v].begin, 0);
    spans[v].end = std::min(spans[v].end, geometry.width());
  }
}

template void findExactPaths(const ShearWarp&, const ShearWarp&, std::vector<ExactPath<float>>&);
template void findExactPaths(const ShearWarp&, const ShearWarp&, std::vector<ExactPath<double>>&);
}
