// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellFrame.h"

#include "Clipping/SceneDepth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// The value of a floor; 0, the lowest voxel, if there is none above that.
template <class A>
A leastOf(double floor, const ValueScale<A>& values)
{
  const A voxel = static_cast<A>(floor);
  return std::isfinite(voxel) && !values.minima
    ? std::max(std::fma(values.scale.factor, voxel, values.scale.offset), A(0))
    : A(0);
}
}

template <class T>
CellFrame<T>::CellFrame(CellIndex& index, const View& view, const ProjectionSettings& settings,
  const RayEnds& ends, bool locate, const PixelRectangle& pixels, const PixelRays& pixelRays)
  : grid(index.grid()),
    field(grid.low, grid.high),
    bounds(index.bounds(settings.reduction == Reduction::Minimum)),
    rays(pixelRays),
    rectangle(pixels),
    tiles((pixels.high - pixels.low) / ScreenTile<A>::Side + 1),
    viewport(view.viewport),
    kernels(cellKernelsFor(settings.instructionSet)),
    values(index.range(), settings.reduction),
    lowest(-static_cast<double>(values.scale.offset) / static_cast<double>(values.scale.factor)),
    highest(settings.reduction == Reduction::Minimum ? index.range().low : index.range().high),
    halfSpaces(view.halfSpaces),
    regions(view.cropping, grid.low, grid.high),
    crops(view.cropping.cuts()),
    depth(ends.depth),
    least(leastOf<A>(settings.floor, values)),
    locates(locate),
    shades(settings.reduction == Reduction::DepthShaded),
    ambient(settings.ambient),
    rate(settings.changeRate)
{
  if (ends.surface)
  {
    this->surface.find(*ends.surface, pixelRays, pixels.low, pixels.high - pixels.low + 1);
  }
  this->cutsAll = ends.surface || ends.depth;
  const bool canDarken = this->shades && std::min(this->ambient, this->ambient + this->rate) < 0.0;
  this->isFinite = !index.range().hasInfinities();
  this->mayBeEmpty = this->values.scale.holes || this->crops || canDarken;
}

template <class T>
PixelRectangle CellFrame<T>::pixelsOf(int tile) const
{
  const glm::ivec2 low = this->rectangle.low +
    ScreenTile<A>::Side * glm::ivec2(tile % this->tiles.x, tile / this->tiles.x);
  return { low, glm::min(low + ScreenTile<A>::Side - 1, this->rectangle.high) };
}

template <class T>
CellBox CellFrame<T>::boxOfCells(const glm::ivec3& cell, int size) const
{
  const glm::ivec3 from = glm::max(cell, this->grid.begin);
  const glm::ivec3 to = glm::min(cell + size, this->grid.end);
  return { glm::max(glm::dvec3(from - this->grid.shift), this->grid.low),
    glm::min(glm::dvec3(to - this->grid.shift), this->grid.high) };
}

template <class T>
CellBox CellFrame<T>::boxOfBrick(std::uint32_t brick) const
{
  return this->boxOfCells(this->grid.brickCell(brick), BrickCells);
}

template <class T>
bool CellFrame<T>::isShown(const CellBox& box) const
{
  for (const glm::dvec4& h : this->halfSpaces)
  {
    if (rangeOf(h, box).y < 0.0)
    {
      return false;
    }
  }
  return !this->crops ||
    std::any_of(this->regions.boxes.begin(), this->regions.boxes.end(),
      [&](const CellBox& region) { return overlap(region, box); });
}

template <class T>
void CellFrame<T>::findEnds(int x, int y, int count, double* near, double* far) const
{
  const bool perspective = this->rays.isPerspective();
  std::fill_n(near, count, perspective ? 0.0 : -Infinity);
  std::fill_n(far, count, Infinity);
  // From column 0 on: the same bits for any first pixel.
  const glm::dvec3 start = this->rays.start(0, y), forward = this->rays.direction(0, y);
  const glm::dvec3& across = this->rays.across();
  const auto step = [&](double change) { return perspective ? 0.0 : change; };
  const auto turn = [&](double change) { return perspective ? change : 0.0; };
  for (int a = 0; a < 3; ++a)
  {
    this->kernels.within(near, far, x, count, start[a], step(across[a]), forward[a],
      turn(across[a]), this->grid.low[a], this->grid.high[a]);
  }
  for (const glm::dvec4& h : this->halfSpaces)
  {
    const glm::dvec3 normal(h);
    const double change = glm::dot(normal, across);
    this->kernels.before(near, far, x, count, glm::dot(normal, start) + h.w, step(change),
      glm::dot(normal, forward), turn(change));
  }
  if (!this->surface.empty())
  {
    this->surface.cut(x, y, count, near, far);
  }
  if (this->depth)
  {
    this->depth->endRays(this->rays, x, y, count, far);
  }
}

#define SPLATTING_INSTANTIATE(T) template struct CellFrame<T>;
SPLATTING_TYPES(SPLATTING_INSTANTIATE)
#undef SPLATTING_INSTANTIATE
}
