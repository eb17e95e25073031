// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Clipping/SceneDepth.h"

#include "Common/Parallel.h"
#include "Geometry/PixelRays.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Rounding = 0x1p-21;
}

float* SceneDepth::allocate(const glm::ivec2& origin, const glm::ivec2& size)
{
  this->clear(); // in case of std::bad_alloc
  this->Samples.resize(std::size_t(std::max(size.x, 0)) * std::max(size.y, 0));
  this->Origin = origin;
  this->Size = size;
  return this->Samples.data();
}

void SceneDepth::place(const View& view)
{
  // w is positive before the eye.
  const glm::dmat4 m = view.indexToClip / (isParallel(view) ? view.indexToClip[3][3] : 1.0);
  this->Viewport = view.viewport;
  this->ClipToIndex = glm::inverse(m);
  this->ClipZ = { m[0][2], m[1][2], m[2][2], m[3][2] };
  this->ClipW = { m[0][3], m[1][3], m[2][3], m[3][3] };
  const glm::dvec3 last(view.dimensions - 1);
  const glm::dvec3 half(0.5);
  for (Body* body : { &this->Shown, &this->Voxels })
  {
    body->fronts.clear();
    body->backs.clear();
    for (const glm::dvec4& h : view.halfSpaces)
    {
      this->addHalfSpace(h, *body);
    }
  }
  this->addBox(-half, last + half, this->Voxels);
  // An axis with one voxel has that voxel's thickness.
  const glm::dvec3 thin =
    view.showsBoxes ? glm::dvec3(1.0) : glm::dvec3(glm::equal(last, glm::dvec3(0.0)));
  this->addBox(-half * thin, last + half * thin, this->Shown);
}

void SceneDepth::addBox(const glm::dvec3& low, const glm::dvec3& high, Body& body) const
{
  for (int a = 0; a < 3; ++a)
  {
    glm::dvec4 plane(0.0, 0.0, 0.0, -low[a]);
    plane[a] = 1.0;
    this->addHalfSpace(plane, body);
    plane = { 0.0, 0.0, 0.0, high[a] };
    plane[a] = -1.0;
    this->addHalfSpace(plane, body);
  }
}

void SceneDepth::addHalfSpace(const glm::dvec4& h, Body& body) const
{
  // Planes are planes in the clip cube, too: dot(plane, (x, y, depth, 1)) >= 0, from -1 to 1.
  const glm::dvec4 plane = h * this->ClipToIndex;
  const glm::dvec4& deeper = this->ClipToIndex[2];
  const double rounding = 1e-12 *
    (glm::length(glm::dvec3(h)) * glm::length(glm::dvec3(deeper)) + std::abs(h.w * deeper.w));
  // Rays along a plane, or from it, neither enter nor leave through it.
  if (!(std::abs(plane.z) > rounding))
  {
    return;
  }
  const glm::dvec2 step = 1.0 / glm::dvec2(this->Viewport);
  const glm::dvec2 slope = -glm::dvec2(plane) / plane.z;
  const double start = 0.5 * (1.0 - plane.w / plane.z + glm::dot(slope, step - 1.0));
  (plane.z > 0.0 ? body.fronts : body.backs).emplace_back(slope * step, start);
}

double SceneDepth::Body::entry(const glm::dvec3& pixel) const
{
  double depth = -Infinity;
  for (const glm::dvec3& front : this->fronts)
  {
    depth = std::max(depth, glm::dot(front, pixel));
  }
  return depth;
}

double SceneDepth::Body::exit(const glm::dvec3& pixel) const
{
  double depth = Infinity;
  for (const glm::dvec3& back : this->backs)
  {
    depth = std::min(depth, glm::dot(back, pixel));
  }
  return depth;
}

float SceneDepth::at(const glm::ivec2& pixel) const
{
  const glm::ivec2 p = pixel - this->Origin;
  return this->Samples[std::size_t(p.y) * this->Size.x + p.x];
}

/// Whether a depth lies inside the volume.
bool SceneDepth::endsRay(const glm::ivec2& pixel, double depth) const
{
  const glm::dvec3 p(pixel, 1.0);
  double entry = this->Shown.entry(p), exit = this->Shown.exit(p);
  if (entry > exit)
  {
    // Outside the picture, for interpolation at its border.
    entry = this->Voxels.entry(p);
    exit = this->Voxels.exit(p);
  }
  return depth > entry + Rounding && depth < exit - Rounding;
}

void SceneDepth::endRay(const ShearWarp& geometry, const glm::ivec2& pixel, const glm::dvec2& at,
  const glm::dvec2& slope, double& near, double& far) const
{
  const double depth = this->at(pixel);
  if (depth >= 1.0 || !this->endsRay(pixel, depth))
  {
    return;
  }
  // The half-space of larger depths, along the ray.
  const std::array<int, 3>& axes = geometry.axes();
  const glm::dvec4 deeper = this->ClipZ - (2.0 * depth - 1.0) * this->ClipW;
  const glm::dvec3 h(deeper[axes[0]], deeper[axes[1]], deeper[axes[2]]);
  const double reference = geometry.reference();
  const double speed = glm::dot(h, glm::dvec3(slope, 1.0));
  const double z = reference - (glm::dot(h, glm::dvec3(at, reference)) + deeper.w) / speed;
  if (speed > 0.0)
  {
    far = std::min(far, z);
  }
  else if (speed < 0.0)
  {
    near = std::max(near, z);
  }
}

void SceneDepth::endRays(
  const ShearWarp& geometry, int u, int v, int count, double* near, double* far) const
{
  if (this->empty())
  {
    return;
  }
  const glm::ivec2 last = this->Origin + this->Size - 1;
  for (int x = 0; x < count; ++x)
  {
    const glm::dvec3 seen = geometry.shearToScreen() * glm::dvec3(u + x, v, 1.0);
    if (!(seen.z > 0.0))
    {
      continue; // behind the viewport's plane
    }
    const glm::ivec2 pixel(glm::clamp(
      glm::floor(glm::dvec2(seen) / seen.z + 0.5), glm::dvec2(this->Origin), glm::dvec2(last)));
    const glm::dvec2 slope(geometry.columns().slope[u + x], geometry.rows().slope[v]);
    this->endRay(
      geometry, pixel, geometry.onRay(u + x, v, geometry.reference()), slope, near[x], far[x]);
  }
}

void SceneDepth::endRays(const PixelRays& rays, int x, int y, int count, double* far) const
{
  const int first = std::max(x, this->Origin.x);
  const int last = std::min(x + count, this->Origin.x + this->Size.x);
  if (this->empty() || y < this->Origin.y || y >= this->Origin.y + this->Size.y)
  {
    return;
  }
  for (int u = first; u < last; ++u)
  {
    const double depth = this->at({ u, y });
    if (depth < 1.0)
    {
      // The half-space of larger depths.
      const glm::dvec4 deeper = this->ClipZ - (2.0 * depth - 1.0) * this->ClipW;
      const double start = glm::dot(deeper, glm::dvec4(rays.start(u, y), 1.0));
      const double speed = glm::dot(glm::dvec3(deeper), rays.direction(u, y));
      far[u - x] = speed > 0.0 ? std::min(far[u - x], -start / speed) : far[u - x];
    }
  }
}

void SceneDepth::hide(Picture& picture) const
{
  const glm::ivec2 begin = glm::max(this->Origin, picture.origin);
  const glm::ivec2 end = glm::min(this->Origin + this->Size, picture.origin + picture.size);
  if (this->empty() || begin.x >= end.x || begin.y >= end.y)
  {
    return;
  }
  parallelFor(begin.y, end.y, 16,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (int y = static_cast<int>(first); y < last; ++y)
      {
        std::uint32_t* const row = picture.pixels.data() +
          std::ptrdiff_t(y - picture.origin.y) * picture.size.x - picture.origin.x;
        for (int x = begin.x; x < end.x; ++x)
        {
          const double depth = this->at({ x, y });
          if (depth < 1.0 && depth <= this->Shown.entry({ x, y, 1.0 }) + Rounding)
          {
            row[x] = 0;
          }
        }
      }
    });
}
}
