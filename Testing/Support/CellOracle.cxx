// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellOracle.h"

#include "Stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference
{
namespace
{
template <class R>
constexpr R Infinity = std::numeric_limits<R>::infinity();

template <class R>
void cross(const R (&a)[3], const R (&b)[3], R (&c)[3])
{
  for (int n = 0; n < 3; ++n)
  {
    const int p = (n + 1) % 3, q = (n + 2) % 3;
    c[n] = a[p] * b[q] - a[q] * b[p];
  }
}

template <class R>
R dot(const R (&a)[3], const R (&b)[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Cuts a ray to where value + t speed >= 0.
template <class R>
void cut(CellRay<R>& ray, R value, R speed)
{
  Stretch<R> stretch{ ray.near, ray.far };
  stretch.cut(value, speed);
  ray.near = stretch.begin;
  ray.far = stretch.end;
}

/// Between `from` and `to` the places where a coordinate is a multiple of `step`.
template <class R>
void addFaces(const CellRay<R>& ray, int axis, R step, R from, R to, std::vector<R>& places)
{
  const R d = ray.direction[axis];
  const R a = ray.start[axis] + from * d, b = ray.start[axis] + to * d;
  const R first = std::ceil(std::min(a, b) / step), last = std::floor(std::max(a, b) / step);
  for (R n = first; d != 0 && n <= last; n += 1)
  {
    places.push_back(std::min(std::max((n * step - ray.start[axis]) / d, from), to));
  }
}
}

template <class R>
void CellOracle<R>::findBox()
{
  for (int a = 0; a < 3; ++a)
  {
    const R half = this->Scene.showsBoxes || this->Scene.size[a] == 1 ? R(0.5) : R(0);
    this->Low[a] = -half;
    this->High[a] = this->Scene.size[a] - 1 + half;
  }
}

template <class R>
CellRay<R> CellOracle<R>::ray(double x, double y, const glm::dvec3& shift) const
{
  const auto& m = this->Scene.indexToClip;
  R rows[4][3], rests[4];
  for (int r = 0; r < 4; ++r)
  {
    for (int a = 0; a < 3; ++a)
    {
      rows[r][a] = m[a][r];
    }
    rests[r] = m[3][r];
  }
  // A view is parallel if the homogeneous coordinate hardly changes over the volume.
  R change = 0, middle = rests[3];
  for (int a = 0; a < 3; ++a)
  {
    change += std::fabs(rows[3][a]) * this->Scene.size[a];
    middle += rows[3][a] * (this->Scene.size[a] - 1) / 2;
  }
  const bool parallel = change <= R(0x1p-20) * std::fabs(middle);
  if (parallel)
  {
    rows[3][0] = rows[3][1] = rows[3][2] = 0;
    rests[3] = middle;
  }
  // The ray lies in two planes: (row 0 - place row 3) . (p, 1) = 0, the same with row 1.
  const R place[2] = { (R(x) + R(0.5)) * 2 / this->Scene.viewport.x - 1,
    (R(y) + R(0.5)) * 2 / this->Scene.viewport.y - 1 };
  R planes[2][3], plane[2];
  for (int n = 0; n < 2; ++n)
  {
    for (int a = 0; a < 3; ++a)
    {
      planes[n][a] = rows[n][a] - place[n] * rows[3][a];
    }
    plane[n] = rests[n] - place[n] * rests[3];
  }
  CellRay<R> ray;
  cross(planes[0], planes[1], ray.direction);
  const R along = dot(ray.direction, ray.direction);
  const R deeper = parallel ? dot(rows[2], ray.direction) / middle : dot(rows[3], ray.direction);
  // Of the ray's points the one that is nearest to the volume's middle.
  R offsets[2];
  for (int n = 0; n < 2; ++n)
  {
    offsets[n] = plane[n];
    for (int a = 0; a < 3; ++a)
    {
      offsets[n] += planes[n][a] * R(this->Scene.size[a] - 1) / 2;
    }
  }
  R u[3], v[3];
  cross(planes[1], ray.direction, u);
  cross(ray.direction, planes[0], v);
  const R length = std::sqrt(along);
  for (int a = 0; a < 3; ++a)
  {
    ray.start[a] = R(this->Scene.size[a] - 1) / 2 - (offsets[0] * u[a] + offsets[1] * v[a]) / along;
    ray.start[a] += R(shift[a]);
    ray.direction[a] *= (deeper < 0 ? -1 : 1) / length;
    // Rays are along an axis if rounding alone says that they are not.
    ray.direction[a] = std::fabs(ray.direction[a]) < R(1e-15) ? R(0) : ray.direction[a];
  }
  ray.near = -Infinity<R>;
  ray.far = Infinity<R>;
  if (!parallel)
  {
    const R w = dot(rows[3], ray.start) + rests[3];
    ray.near = -w / dot(rows[3], ray.direction);
  }
  const R begin = ray.near;
  this->cutByPlanes(ray);
  if (!this->Scene.depths.empty())
  {
    const std::size_t pixel = std::size_t(y) * this->Scene.viewport.x + std::size_t(x);
    const R depth = this->Scene.depths[pixel];
    if (depth < 1)
    {
      // Shown is what is nearer: z <= (2 depth - 1) w where w is positive.
      const R limit = 2 * depth - 1, sense = parallel && middle < 0 ? -1 : 1;
      cut(ray,
        sense * (limit * (dot(rows[3], ray.start) + rests[3]) - dot(rows[2], ray.start) - rests[2]),
        sense * (limit * dot(rows[3], ray.direction) - dot(rows[2], ray.direction)));
    }
  }
  if (!this->Scene.triangles.empty())
  {
    this->cutBySurface(ray, begin);
  }
  return ray;
}

template <class R>
CellRay<R> CellOracle<R>::between(const glm::dvec3& begin, const glm::dvec3& end) const
{
  CellRay<R> ray;
  ray.near = 0;
  ray.far = glm::length(end - begin);
  for (int a = 0; a < 3; ++a)
  {
    ray.start[a] = begin[a];
    ray.direction[a] = (R(end[a]) - R(begin[a])) / ray.far;
  }
  this->cutByPlanes(ray);
  return ray;
}

template <class R>
void CellOracle<R>::cutByPlanes(CellRay<R>& ray) const
{
  for (int a = 0; a < 3; ++a)
  {
    cut(ray, ray.start[a] - this->Low[a], ray.direction[a]);
    cut(ray, this->High[a] - ray.start[a], -ray.direction[a]);
  }
  for (const glm::dvec4& h : this->Scene.halfSpaces)
  {
    const R normal[3] = { R(h.x), R(h.y), R(h.z) };
    cut(ray, dot(normal, ray.start) + R(h.w), dot(normal, ray.direction));
  }
}

// To the hull of the crossings from `begin` on, or from there if it is inside.
template <class R>
void CellOracle<R>::cutBySurface(CellRay<R>& ray, R begin) const
{
  R first = Infinity<R>, last = -Infinity<R>;
  bool isInside = false;
  for (const std::array<glm::dvec3, 3>& triangle : this->Scene.triangles)
  {
    R edge1[3], edge2[3], s[3];
    for (int a = 0; a < 3; ++a)
    {
      edge1[a] = R(triangle[1][a]) - triangle[0][a];
      edge2[a] = R(triangle[2][a]) - triangle[0][a];
      s[a] = ray.start[a] - triangle[0][a];
    }
    R p[3], q[3];
    cross(ray.direction, edge2, p);
    cross(s, edge1, q);
    const R determinant = dot(edge1, p);
    const R u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant;
    const R t = dot(edge2, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1)
    {
      isInside ^= t > begin; // an odd number of crossings ahead
      first = t > begin ? std::min(first, t) : first;
      last = t > begin ? std::max(last, t) : last;
    }
  }
  first = isInside && std::isfinite(begin) ? begin : first;
  ray.near = std::max(ray.near, first);
  ray.far = std::min(ray.far, last);
}

template <class R>
bool CellOracle<R>::isCropped(const R (&p)[3]) const
{
  int region = 0, step = 1;
  for (int a = 0; a < 3; ++a, step *= 3)
  {
    const glm::dvec2& planes = this->Scene.planes[a];
    region += step * (p[a] < planes.x ? 0 : p[a] <= planes.y ? 1 : 2);
  }
  return !(this->Scene.flags >> region & 1);
}

// Cropping's regions that are neighbours along x are one; at other planes parts end.
template <class R>
std::vector<std::array<R, 2>> CellOracle<R>::shownParts(const CellRay<R>& ray) const
{
  std::vector<std::array<R, 2>> parts;
  if (!(ray.near < ray.far))
  {
    return parts;
  }
  if (this->Scene.flags == (1u << 27) - 1)
  {
    return { { ray.near, ray.far } };
  }
  struct Place
  {
    R t;
    bool alongX;
  };
  std::vector<Place> places{ { ray.near, false }, { ray.far, false } };
  for (int a = 0; a < 3; ++a)
  {
    for (int n = 0; n < 2; ++n)
    {
      const R t = (R(this->Scene.planes[a][n]) - ray.start[a]) / ray.direction[a];
      if (t > ray.near && t < ray.far)
      {
        places.push_back({ t, a == 0 });
      }
    }
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.t < b.t; });
  for (std::size_t n = 0; n + 1 < places.size(); ++n)
  {
    R p[3];
    for (int a = 0; a < 3; ++a)
    {
      p[a] = ray.start[a] + (places[n].t + places[n + 1].t) / 2 * ray.direction[a];
    }
    if (places[n].t < places[n + 1].t && !this->isCropped(p))
    {
      const bool goesOn = !parts.empty() && parts.back()[1] == places[n].t && places[n].alongX;
      goesOn ? void(parts.back()[1] = places[n + 1].t)
             : parts.push_back({ places[n].t, places[n + 1].t });
    }
  }
  return parts;
}

template <class R>
R CellOracle<R>::voxel(const glm::ivec3& p) const
{
  const glm::ivec3& size = this->Scene.size;
  const int x = std::clamp(p.x, 0, size.x - 1), y = std::clamp(p.y, 0, size.y - 1);
  const int z = std::clamp(p.z, 0, size.z - 1);
  return this->Scene.voxels[(std::size_t(z) * size.y + y) * size.x + x];
}

template <class R>
bool CellOracle<R>::isInterpolated(const glm::ivec3& cell) const
{
  bool all = true;
  for (int n = 0; n < 8; ++n)
  {
    all = all && std::isfinite(this->voxel(cell + glm::ivec3(n & 1, n >> 1 & 1, n >> 2)));
  }
  return all;
}

template <class R>
std::vector<CellSegment<R>> CellOracle<R>::segments(const CellRay<R>& ray) const
{
  std::vector<CellSegment<R>> segments;
  std::vector<R> places, halves;
  for (const std::array<R, 2>& part : this->shownParts(ray))
  {
    places.assign({ part[0], part[1] });
    for (int a = 0; a < 3; ++a)
    {
      addFaces<R>(ray, a, R(1), part[0], part[1], places);
    }
    std::sort(places.begin(), places.end());
    for (std::size_t n = 0; n + 1 < places.size(); ++n)
    {
      if (!(places[n + 1] - places[n] > this->Shortest))
      {
        continue;
      }
      CellSegment<R> segment{ places[n], places[n + 1], glm::ivec3(0), true, R(0) };
      const auto at = [&](int a, R t) { return ray.start[a] + t * ray.direction[a]; };
      for (int a = 0; a < 3; ++a)
      {
        const int last = std::max(this->Scene.size[a] - 2, 0);
        const int cell = static_cast<int>(std::floor(at(a, (segment.from + segment.to) / 2)));
        segment.cell[a] = this->Low[a] < 0 ? cell : std::clamp(cell, 0, last);
      }
      segment.isInterpolated = this->isInterpolated(segment.cell);
      if (segment.isInterpolated)
      {
        segments.push_back(segment);
        continue;
      }
      halves.assign({ segment.from, segment.to });
      for (int a = 0; a < 3; ++a)
      {
        addFaces<R>(ray, a, R(0.5), segment.from, segment.to, halves);
      }
      std::sort(halves.begin(), halves.end());
      for (std::size_t h = 0; h + 1 < halves.size(); ++h)
      {
        const R middle = (halves[h] + halves[h + 1]) / 2;
        glm::ivec3 nearest;
        for (int a = 0; a < 3; ++a)
        {
          nearest[a] = static_cast<int>(std::floor(at(a, middle) + R(0.5)));
        }
        const R voxel = this->voxel(nearest);
        if (halves[h + 1] - halves[h] > this->Shortest && voxel == voxel)
        {
          segments.push_back({ halves[h], halves[h + 1], segment.cell, false, voxel });
        }
      }
    }
  }
  return segments;
}

template <class R>
R CellOracle<R>::interpolate(const CellSegment<R>& segment, const CellRay<R>& ray, R t) const
{
  if (!segment.isInterpolated)
  {
    return segment.voxel;
  }
  R share[3];
  for (int a = 0; a < 3; ++a)
  {
    share[a] = ray.start[a] + t * ray.direction[a] - segment.cell[a];
  }
  R value = 0;
  for (int n = 0; n < 8; ++n)
  {
    const glm::ivec3 corner(n & 1, n >> 1 & 1, n >> 2);
    R weight = 1;
    for (int a = 0; a < 3; ++a)
    {
      weight *= corner[a] ? share[a] : 1 - share[a];
    }
    value += weight * this->voxel(segment.cell + corner);
  }
  return value;
}

template <class R>
typename CellOracle<R>::Course CellOracle<R>::course(
  const CellSegment<R>& segment, const CellRay<R>& ray) const
{
  Course course;
  const R length = segment.to - segment.from;
  const auto add = [&](R s)
  {
    const R t = s == 1 ? segment.to : segment.from + s * length;
    course.values[course.count] = this->interpolate(segment, ray, t);
    course.places[course.count++] = t;
  };
  add(0);
  if (segment.isInterpolated)
  {
    // A cubic through four samples; its extrema by the roots of its derivative.
    R f[4];
    for (int n = 0; n < 4; ++n)
    {
      f[n] = this->interpolate(segment, ray, segment.from + length * n / 3);
    }
    const R a = R(9) / 2 * (f[3] - 3 * f[2] + 3 * f[1] - f[0]);
    const R b = R(9) / 2 * (2 * f[0] - 5 * f[1] + 4 * f[2] - f[3]);
    const R c = R(1) / 2 * (-11 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]);
    const R square = b * b - 3 * a * c;
    if (square >= 0)
    {
      const R q = -(b + std::copysign(std::sqrt(square), b));
      R roots[2] = { q / (3 * a), c / q };
      if (roots[1] < roots[0])
      {
        std::swap(roots[0], roots[1]);
      }
      for (const R root : roots)
      {
        if (root > 0 && root < 1)
        {
          add(root);
        }
      }
    }
  }
  add(1);
  return course;
}

template <class R>
CellSample<R> CellOracle<R>::largestOf(
  const CellSegment<R>& segment, const CellRay<R>& ray, R sense) const
{
  const Course course = this->course(segment, ray);
  CellSample<R> sample;
  for (int n = 0; n < course.count; ++n)
  {
    sample.raise(sense * course.values[n], course.places[n]);
  }
  return sample;
}

template <class R>
CellSample<R> CellOracle<R>::largest(const CellRay<R>& ray, bool minima) const
{
  const R sense = minima ? -1 : 1;
  CellSample<R> sample;
  for (const CellSegment<R>& segment : this->segments(ray))
  {
    const CellSample<R> one = this->largestOf(segment, ray, sense);
    sample.raise(one.value, one.t);
  }
  sample.value *= sense;
  return sample;
}

template <class R>
CellSample<R> CellOracle<R>::shaded(const CellRay<R>& ray, const CellShading& shading) const
{
  CellSample<R> sample;
  for (const CellSegment<R>& segment : this->segments(ray))
  {
    const CellSample<R> one = this->largestOf(segment, ray, 1);
    const R share = ((segment.from + segment.to) / 2 - ray.near) / (ray.far - ray.near);
    const R factor = R(shading.ambient) + (1 - share) * R(shading.changeRate);
    const R low = shading.lowest;
    sample.raise(std::isfinite(one.value) ? low + (one.value - low) * factor : one.value, one.t);
  }
  return sample;
}

template <class R>
CellSample<R> CellOracle<R>::local(const CellRay<R>& ray, double threshold, double rounding) const
{
  CellSample<R> top;
  for (const CellSegment<R>& segment : this->segments(ray))
  {
    const Course course = this->course(segment, ray);
    for (int n = 0; n < course.count; ++n)
    {
      if (top.exists && course.values[n] < top.value - R(rounding))
      {
        if (top.value >= threshold)
        {
          return top;
        }
        top.exists = false;
      }
      top.raise(course.values[n], course.places[n]);
    }
  }
  return top.exists && top.value >= threshold ? top : this->largest(ray);
}

template <class R>
CellSample<R> CellOracle<R>::certain(const std::vector<CellRay<R>>& rays, bool minima) const
{
  const R sense = minima ? -1 : 1;
  std::vector<std::vector<CellSegment<R>>> all;
  std::vector<R> places;
  for (const CellRay<R>& ray : rays)
  {
    all.push_back(this->segments(ray));
    for (const CellSegment<R>& segment : all.back())
    {
      places.insert(places.end(), { segment.from, segment.to });
    }
  }
  std::sort(places.begin(), places.end());
  CellSample<R> sample;
  for (std::size_t n = 0; n + 1 < places.size(); ++n)
  {
    const R from = places[n], to = places[n + 1];
    if (!(to - from > this->Shortest))
    {
      continue;
    }
    // What the ray that shows least shows in this part.
    CellSample<R> least{ true, Infinity<R>, from };
    for (std::size_t r = 0; r < rays.size() && least.exists; ++r)
    {
      const auto segment = std::find_if(all[r].begin(), all[r].end(),
        [&](const CellSegment<R>& s) { return s.from <= from && to <= s.to; });
      if (segment == all[r].end())
      {
        least.exists = false;
        continue;
      }
      CellSegment<R> part = *segment;
      part.from = from;
      part.to = to;
      least.value = std::min(least.value, this->largestOf(part, rays[r], sense).value);
    }
    if (least.exists)
    {
      sample.raise(least.value, least.t);
    }
  }
  sample.value *= sense;
  return sample;
}

template <class R>
bool CellOracle<R>::fieldAt(const CellRay<R>& ray, R t, R margin, R& least, R& largest) const
{
  least = Infinity<R>;
  largest = -Infinity<R>;
  for (const CellSegment<R>& segment : this->segments(ray))
  {
    if (t >= segment.from - margin && t <= segment.to + margin)
    {
      const R value =
        this->interpolate(segment, ray, std::min(std::max(t, segment.from), segment.to));
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
  }
  return least <= largest;
}

template <class R>
bool CellOracle<R>::firstPlateau(const CellRay<R>& ray, R value, R& t) const
{
  for (const CellSegment<R>& segment : this->segments(ray))
  {
    bool all = true;
    for (int n = 0; n < 8; ++n)
    {
      all = all && this->voxel(segment.cell + glm::ivec3(n & 1, n >> 1 & 1, n >> 2)) == value;
    }
    if (all || (!segment.isInterpolated && segment.voxel == value))
    {
      t = segment.from;
      return true;
    }
  }
  return false;
}

template class CellOracle<double>;
template class CellOracle<long double>;
}
