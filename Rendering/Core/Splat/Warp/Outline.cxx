// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Warp/Outline.h"

#include "Display/Picture.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace splatting
{
Cuboid shownBox(const ShearWarp& geometry)
{
  const glm::dvec3 last(geometry.size() - 1);
  const glm::dvec3 thin = geometry.showsBoxes()
    ? glm::dvec3(1.0)
    : glm::dvec3(glm::equal(geometry.size(), glm::ivec3(1)));
  return { -0.5 * thin, last + 0.5 * thin };
}

namespace
{
/// A box whose pixels have samples: those whose rays cross it.
Cuboid sampledBox(const ShearWarp& geometry)
{
  const Span& slices = geometry.slices();
  Cuboid box{ glm::dvec3(-0.5), glm::dvec3(geometry.size()) - 0.5 };
  box.low.z = geometry.faces(slices.begin).x;
  box.high.z = geometry.faces(slices.end - 1).y;
  if (geometry.isPerspective())
  {
    // Rays are rounded by 2^-21 of a voxel, and by 2^-25 for each slice from the farthest one. With
    // twice as much they cross voxels over a positive length.
    const double rounding = 0x1p-20 + 0x1p-24 * geometry.size().z;
    box.low += glm::dvec3(rounding, rounding, 0.0);
    box.high -= glm::dvec3(rounding, rounding, 0.0);
  }
  return box;
}
}

void Outline::add(glm::dvec3 line, double inset)
{
  line.z -= inset * (std::abs(line.x) + std::abs(line.y));
  this->Lines.push_back(line * this->Geometry.screenToShear());
}

void Outline::add(const Cuboid& box, double inset)
{
  // The outline consists of the edges between a visible and a hidden face; from inside there are
  // none.
  for (int edge = 0; edge < 12; ++edge)
  {
    const int a = edge / 4, b = (a + 1) % 3, c = (a + 2) % 3;
    const bool highB = edge & 1, highC = edge & 2;
    if (this->faces(box, b, highB) == this->faces(box, c, highC))
    {
      continue;
    }
    glm::dvec3 corner = box.low;
    corner[b] = highB ? box.high[b] : box.low[b];
    corner[c] = highC ? box.high[c] : box.low[c];
    const glm::dvec3 begin = this->Geometry.pixelOf(corner);
    corner[a] = box.high[a];
    const glm::dvec3 end = this->Geometry.pixelOf(corner);
    const glm::dvec3 middle = this->Geometry.pixelOf(0.5 * (box.low + box.high));
    const glm::dvec3 line = glm::cross(begin, end - begin);
    this->add(glm::dot(line, middle - begin) < 0.0 ? -line : line, inset);
  }
}

void Outline::growOnScreen(double pixels)
{
  for (glm::dvec3& line : this->Lines)
  {
    line.z += pixels * (std::abs(line.x) + std::abs(line.y));
  }
}

Span Outline::cut(Span row, const glm::dvec3& start) const
{
  for (const glm::dvec3& line : this->Lines)
  {
    if (row.empty())
    {
      return {};
    }
    const double at = glm::dot(line, start), low = row.begin, high = row.end;
    if (line.x > 0.0)
    {
      row.begin = static_cast<int>(std::ceil(std::clamp(-at / line.x, low, high)));
    }
    else if (line.x < 0.0)
    {
      row.end = static_cast<int>(std::floor(std::clamp(-at / line.x, low - 1.0, high - 1.0))) + 1;
    }
    else if (at < 0.0)
    {
      return {};
    }
  }
  return row;
}

std::vector<glm::dvec3> Outline::cut(std::vector<glm::dvec3> polygon) const
{
  for (const glm::dvec3& line : this->Lines)
  {
    polygon = clipped(polygon, line);
  }
  return polygon;
}

/// Whether the viewer is on or beyond a face of a box.
bool Outline::faces(const Cuboid& box, int axis, bool high) const
{
  if (this->Geometry.isPerspective())
  {
    const double eye = this->Geometry.eye()[axis];
    return high ? eye >= box.high[axis] : eye <= box.low[axis];
  }
  const glm::dvec3 direction(-this->Geometry.shear(), 1.0);
  return high ? direction[axis] < 0.0 : direction[axis] > 0.0;
}

namespace
{
/// The pixels that show an image of the volume, and some pixels of the image beyond.
Outline shownWith(const ShearWarp& geometry, double beyond)
{
  // Borders on pixel centres must not flicker with rounding errors.
  constexpr double rounding = 1e-8;
  Outline shown(geometry);
  shown.add(shownBox(geometry), -beyond - rounding);
  if (geometry.isPerspective())
  {
    // Limits slopes to 1. Both images have the pixels on their common border.
    const double forwards = geometry.reversed() ? -1.0 : 1.0;
    const glm::dvec3 low = geometry.pixelOf(geometry.eye() + glm::dvec3(-1.0, -1.0, forwards));
    const glm::dvec3 high = geometry.pixelOf(geometry.eye() + glm::dvec3(1.0, 1.0, forwards));
    const double overlap = rounding + 1e-12 * (high.x - low.x);
    shown.add({ 1.0, 0.0, -low.x }, -overlap);
    shown.add({ -1.0, 0.0, high.x }, -overlap);
    shown.add({ 0.0, 1.0, -low.y }, -overlap);
    shown.add({ 0.0, -1.0, high.y }, -overlap);
  }
  return shown;
}
}

Outline shownBy(const ShearWarp& geometry)
{
  return shownWith(geometry, 0.0);
}

Outline metByAreas(const ShearWarp& geometry)
{
  // No voxel is farther than this from the pixel whose ray passes nearest to it.
  Outline met = shownWith(geometry, 0.5);
  met.growOnScreen(0.5);
  return met;
}

Outline withinSamples(const ShearWarp& geometry)
{
  constexpr double rounding = 1e-6;
  Outline inside(geometry);
  inside.add(sampledBox(geometry), 1.0 + rounding); // neighbours are at most one pixel away
  if (geometry.isPerspective())
  {
    inside.add({ 1.0, 0.0, 0.0 }, rounding);
    inside.add({ -1.0, 0.0, geometry.rayCount().x - 1.0 }, rounding);
    inside.add({ 0.0, 1.0, 0.0 }, rounding);
    inside.add({ 0.0, -1.0, geometry.rayCount().y - 1.0 }, rounding);
  }
  return inside;
}

namespace
{
/// Corners of a rectangle of viewport pixels.
struct Rectangle
{
  glm::dvec2 low, high;
};

/// Contains all pixels that show an image, and perhaps some beside them.
Rectangle boundsOf(const ShearWarp& geometry, const glm::dvec2& viewport)
{
  if (!geometry.isPerspective() && !geometry.minifiesAnyAxis())
  {
    // The box is symmetric about the centre of the volume.
    const Cuboid box = shownBox(geometry);
    const glm::dvec3 size = box.high - box.low;
    const glm::dvec2 s = glm::abs(geometry.shear());
    const glm::dvec2 half = 0.5 * (glm::dvec2(size) + s * size.z) / geometry.pitch();
    const glm::dvec3 centre = 0.5 * glm::dvec3(geometry.size() - 1);
    const glm::dmat3& m = geometry.shearToScreen();
    const glm::dvec2 middle(m * geometry.pixelOf(centre));
    const glm::dvec2 reach = glm::dvec2(glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y);
    return { middle - reach, middle + reach };
  }
  const glm::dvec2 last = viewport - 1.0;
  Rectangle bounds{ viewport, glm::dvec2(-2.0) };
  const Outline shown = geometry.minifiesAnyAxis() ? metByAreas(geometry) : shownBy(geometry);
  for (const glm::dvec3& corner :
    shown.cut({ { 0.0, 0.0, 1.0 }, { last.x, 0.0, 1.0 }, { last, 1.0 }, { 0.0, last.y, 1.0 } }))
  {
    bounds.low = glm::min(bounds.low, glm::dvec2(corner));
    bounds.high = glm::max(bounds.high, glm::dvec2(corner));
  }
  return bounds;
}
}

void placePicture(
  const std::vector<ShearWarp>& images, const glm::ivec2& viewport, Picture& picture)
{
  const glm::dvec2 limit(viewport);
  glm::dvec2 low = limit, high(0.0);
  for (const ShearWarp& image : images)
  {
    const Rectangle bounds = boundsOf(image, limit);
    low = glm::min(low, glm::clamp(glm::floor(bounds.low), glm::dvec2(0.0), limit));
    high = glm::max(high, glm::clamp(glm::ceil(bounds.high) + 1.0, glm::dvec2(0.0), limit));
  }
  picture.origin = glm::ivec2(low);
  picture.size = glm::max(glm::ivec2(high) - picture.origin, glm::ivec2(0));
}
}
