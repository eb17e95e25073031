// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/TileSplatter.h"

#include "Kernels/Compiler.h"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Bricks between two tests of whether the tile is done.
constexpr int ChecksEvery = 64;
/// Directions below this do not change a coordinate within a block.
template <class A>
constexpr double Flat = sizeof(A) == sizeof(float) ? 1e-9 : 1e-13;

/// Planes that are nearer to a box than this may cut it.
constexpr double Touches = 1e-6;

/// Whether b is inside a, not even at a side of it.
bool isWithin(const CellBox& a, const CellBox& b)
{
  return glm::all(glm::lessThan(glm::abs(a.middle - b.middle), a.half - b.half));
}
}

template <class T>
TileSplatter<T>::TileSplatter(const CellFrame<T>& frame, ScreenTile<A>& tile)
  : Frame(frame),
    Tile(tile),
    Loops(frame.kernels)
{
  CellBlock<A>& block = this->Block;
  block.holes = frame.values.scale.holes;
  block.perspective = frame.rays.isPerspective();
  block.located = frame.locates;
  block.tiesFrom = frame.mayBeEmpty ? CellValue<A>::None : std::numeric_limits<A>::denorm_min();
  block.shaded = frame.shades;
  block.ambient = static_cast<A>(frame.ambient);
  block.rate = static_cast<A>(frame.rate);
  const PixelRays& rays = frame.rays;
  for (int a = 0; a < 3; ++a)
  {
    block.alongT[a] = static_cast<A>(rays.toPixel()[a][2]);
    block.startAcross[a] = block.forwardAcross[a] = CellSum<A>(rays.across()[a]);
    block.startUp[a] = block.forwardUp[a] = CellSum<A>(rays.up()[a]);
    block.forward[a] = CellSum<A>(rays.forward()[a]);
    block.flat[a] = std::abs(rays.forward()[a]) < Flat<A>;
    block.inverse[a] = block.flat[a] ? A(0) : static_cast<A>(1.0 / rays.forward()[a]);
  }
  block.bounded = frame.isFinite;
}

template <class T>
void TileSplatter<T>::open(int tile)
{
  const CellFrame<T>& f = this->Frame;
  this->Pixels = f.pixelsOf(tile);
  this->FirstNear = this->FirstFar = Infinity;
  this->LastNear = this->LastFar = -Infinity;
  std::fill_n(this->Tile.values, this->Tile.Size, CellValue<A>::Outside);
  std::fill_n(this->Tile.least, sizeof(this->Tile.least) / sizeof(A), CellValue<A>::Outside);
  for (int y = this->Pixels.low.y; y <= this->Pixels.high.y; ++y)
  {
    this->openRow(y);
  }
  std::fill_n(this->Tile.changed, this->Tile.Patches, ~std::uint32_t(0));
  this->Tile.firstChanged = 0;
  this->Tile.lastChanged = this->Tile.Patches - 1;
  this->Loops.refresh(this->Tile);
  this->SinceCheck = 0;
}

template <class T>
void TileSplatter<T>::openRow(int y)
{
  const CellFrame<T>& f = this->Frame;
  double near[ScreenTile<A>::Side], far[ScreenTile<A>::Side];
  const int count = this->Pixels.high.x - this->Pixels.low.x + 1;
  f.findEnds(this->Pixels.low.x, y, count, near, far);
  const A empty = f.mayBeEmpty ? CellValue<A>::None : f.least;
  const std::ptrdiff_t row = std::ptrdiff_t(y - this->Pixels.low.y) * this->Tile.Stride;
  for (int x = 0; x < count; ++x)
  {
    const bool crosses = far[x] - near[x] > CellProjector::ShortestRay;
    this->Tile.values[row + x] = crosses ? empty : CellValue<A>::Outside;
  }
  for (int x = 0; x < count && f.locates; ++x)
  {
    this->Tile.depths[row + x] =
      f.mayBeEmpty ? std::numeric_limits<A>::infinity() : static_cast<A>(near[x]);
  }
  for (int x = 0; x < count; ++x)
  {
    const A begin = static_cast<A>(near[x]), end = static_cast<A>(far[x]);
    this->Tile.nears[row + x] = begin;
    this->Tile.fars[row + x] = end;
    this->Tile.nearRests[row + x] = static_cast<A>(near[x] - static_cast<double>(begin));
    this->Tile.farRests[row + x] = static_cast<A>(far[x] - static_cast<double>(end));
  }
  for (int x = 0; x < count && f.shades; ++x)
  {
    if (this->Tile.values[row + x] != CellValue<A>::Outside)
    {
      this->FirstNear = std::min(this->FirstNear, near[x]);
      this->LastNear = std::max(this->LastNear, near[x]);
      this->FirstFar = std::min(this->FirstFar, far[x]);
      this->LastFar = std::max(this->LastFar, far[x]);
    }
  }
}

// Of equal samples the nearest is sought among the bricks that reach a pixel's value, too.
template <class T>
bool TileSplatter<T>::reaches(A bound, A least, A factor) const
{
  if (this->Frame.shades)
  {
    bound = this->Frame.isFinite ? bound * factor : CellValue<A>::Highest;
  }
  return bound > least || (this->Frame.locates && bound == least && bound >= this->Block.tiesFrom);
}

// The largest factor by which samples of a box are shaded.
template <class T>
typename TileSplatter<T>::A TileSplatter<T>::mostFactor(const ProjectedBox& seen) const
{
  const CellFrame<T>& f = this->Frame;
  const auto share = [](double t, double near, double far)
  { return far > near ? std::clamp((t - near) / (far - near), 0.0, 1.0) : -1.0; };
  double first = share(seen.t() - seen.reach(), this->LastNear, this->LastFar);
  double last = share(seen.t() + seen.reach(), this->FirstNear, this->FirstFar);
  first = seen.isNear() || first < 0.0 ? 0.0 : first;
  last = seen.isNear() || last < 0.0 ? 1.0 : last;
  const double most = f.ambient + std::max((1.0 - first) * f.rate, (1.0 - last) * f.rate);
  // No less than what rounding makes of it.
  return static_cast<A>(std::max(most + 1e-5 * (std::abs(f.ambient) + std::abs(f.rate)), 0.0));
}

template <class T>
bool TileSplatter<T>::splat(const std::vector<std::uint32_t>& bricks)
{
  // Memory takes longer to fetch a brick's voxels than it takes to splat them.
  constexpr std::size_t ahead = 2;
  std::uint32_t waiting[ahead + 1];
  std::size_t taken = 0, splatted = 0;
  bool isDone = false;
  for (auto brick = bricks.begin(); brick != bricks.end() && !isDone; ++brick)
  {
    isDone = this->isDone(*brick);
    if (!isDone && this->mayRaise(*brick))
    {
      this->prefetch(*brick);
      waiting[taken++ % (ahead + 1)] = *brick;
      if (taken - splatted > ahead)
      {
        this->splatBrick(waiting[splatted++ % (ahead + 1)]);
      }
    }
  }
  while (splatted < taken)
  {
    this->splatBrick(waiting[splatted++ % (ahead + 1)]);
  }
  return !isDone;
}

// Whether no brick from this one on can raise a pixel of the tile; tested now and then.
template <class T>
bool TileSplatter<T>::isDone(std::uint32_t brick)
{
  const CellFrame<T>& f = this->Frame;
  if (!f.isFinite || ++this->SinceCheck < ChecksEvery)
  {
    return false;
  }
  this->SinceCheck = 0;
  // The order of bricks is right to within a thousandth of the range.
  const A bound = boundOf<T>(f.bounds.template brick<T>()[brick], f.values.scale);
  const double rest = 1.0 + 0x1p-9;
  const double factor = f.shades ? std::max({ f.ambient, f.ambient + f.rate, 0.0 }) : 1.0;
  const double range =
    std::abs(static_cast<double>(f.values.scale.factor) * (f.highest - f.lowest));
  const A most =
    static_cast<A>((static_cast<double>(bound) * rest + 0x1p-9 * range) * factor * (1.0 + 1e-5));
  const A least =
    this->Loops.least(this->Tile, 0, ScreenTile<A>::Side - 1, 0, ScreenTile<A>::Side - 1);
  return most < least;
}

template <class T>
bool TileSplatter<T>::mayRaise(std::uint32_t brick) const
{
  const CellFrame<T>& f = this->Frame;
  const A bound = boundOf<T>(f.bounds.template brick<T>()[brick], f.values.scale);
  const CellBox box = f.boxOfBrick(brick);
  const ProjectedBox seen(f.rays, box);
  const PixelRectangle pixels = seen.within(this->Pixels);
  if (pixels.empty())
  {
    return false;
  }
  const glm::ivec2 low = pixels.low - this->Pixels.low, high = pixels.high - this->Pixels.low;
  return this->reaches(bound, this->Loops.least(this->Tile, low.x, high.x, low.y, high.y),
    f.shades ? this->mostFactor(seen) : A(1));
}

template <class T>
void TileSplatter<T>::prefetch(std::uint32_t brick) const
{
  const CellGrid& grid = this->Frame.grid;
  const glm::ivec3& size = grid.voxels.dimensions;
  const glm::ivec3 cell = this->Frame.grid.brickCell(brick);
  const glm::ivec2 x = grid.voxelsOf(0, cell.x, cell.x + BrickCells);
  const glm::ivec2 y = grid.voxelsOf(1, cell.y, cell.y + BrickCells);
  const glm::ivec2 z = grid.voxelsOf(2, cell.z, cell.z + BrickCells);
  for (std::ptrdiff_t k = z.x; k <= z.y; ++k)
  {
    for (std::ptrdiff_t j = y.x; j <= y.y; ++j)
    {
      const T* const row = static_cast<const T*>(grid.voxels.voxels) + (k * size.y + j) * size.x;
      splatting::prefetch(row + x.x);
      splatting::prefetch(row + x.y);
    }
  }
}

template <class T>
void TileSplatter<T>::splatBrick(std::uint32_t brick)
{
  const CellFrame<T>& f = this->Frame;
  // The blocks with the largest voxels first.
  const T* const blocks = f.bounds.template block<T>() + 8 * std::size_t(brick);
  A bounds[8];
  int order[8];
  for (int b = 0; b < 8; ++b)
  {
    bounds[b] = boundOf<T>(blocks[b], f.values.scale);
    int place = b;
    for (; place > 0 && bounds[order[place - 1]] < bounds[b]; --place)
    {
      order[place] = order[place - 1];
    }
    order[place] = b;
  }
  const glm::ivec3 cell = f.grid.brickCell(brick);
  const glm::dvec3 first(cell - f.grid.shift);
  const bool isCut =
    f.cutsAll || this->isCutByHalfSpace(CellBox(first, first + double(BrickCells)));
  for (int b : order)
  {
    this->splatBlock(cell + BlockCells * glm::ivec3(b & 1, b >> 1 & 1, b >> 2), bounds[b], isCut);
  }
}

template <class T>
bool TileSplatter<T>::isCutByHalfSpace(const CellBox& box) const
{
  return std::any_of(this->Frame.halfSpaces.begin(), this->Frame.halfSpaces.end(),
    [&](const glm::dvec4& h) { return rangeOf(h, box).x < Touches * glm::length(glm::dvec3(h)); });
}

template <class T>
void TileSplatter<T>::splatBlock(const glm::ivec3& cell, A bound, bool isCut)
{
  const CellFrame<T>& f = this->Frame;
  if (glm::any(glm::greaterThanEqual(cell, f.grid.end)) ||
    glm::any(glm::lessThanEqual(cell + BlockCells, f.grid.begin)))
  {
    return;
  }
  const CellBox box = f.boxOfCells(cell, BlockCells);
  const ProjectedBox seen(f.rays, box);
  const PixelRectangle pixels = seen.within(this->Pixels);
  if (pixels.empty())
  {
    return;
  }
  CellBlock<A>& block = this->Block;
  const glm::ivec2 low = pixels.low - this->Pixels.low, high = pixels.high - this->Pixels.low;
  block.least = this->Loops.least(this->Tile, low.x, high.x, low.y, high.y);
  block.mostFactor = f.shades ? this->mostFactor(seen) : A(1);
  if (!this->reaches(bound, block.least, block.mostFactor) || (isCut && !f.isShown(box)))
  {
    return;
  }
  block.columns[0] = low.x;
  block.columns[1] = high.x;
  block.rows[0] = low.y;
  block.rows[1] = high.y;
  this->load(cell);
  const glm::dvec3 middle = glm::dvec3(cell - f.grid.shift) + 0.5 * BlockCells;
  this->placeRays(seen, middle);
  block.seen = nullptr;
  if (seen.isNear())
  {
    this->findSeenCells(cell);
    block.seen = this->Seen;
  }
  // Of the block, not of what the volume has of it: the same for all pieces.
  const CellBox whole(middle - 0.5 * BlockCells, middle + 0.5 * BlockCells);
  isCut = seen.isNear() || (isCut && (f.cutsAll || this->isCutByHalfSpace(whole)));
  // Rays begin and end where the field does: cells are too wide for that by rounding.
  isCut = isCut || !isWithin(f.field, whole);
  for (int a = 0; a < 3; ++a)
  {
    block.fieldLow[a] = static_cast<A>(f.grid.low[a] - middle[a]);
    block.fieldHigh[a] = static_cast<A>(f.grid.high[a] - middle[a]);
  }
  for (const CellBox& region : f.regions.boxes)
  {
    if (!overlap(region, box))
    {
      continue;
    }
    block.crops = f.crops && !isWithin(region, whole);
    block.cut = isCut || block.crops;
    for (int a = 0; a < 3; ++a)
    {
      const double low = region.low()[a], high = region.high()[a];
      block.low[a] = static_cast<A>(low > f.grid.low[a] ? low - middle[a] : -BlockCells);
      block.high[a] = static_cast<A>(high < f.grid.high[a] ? high - middle[a] : BlockCells);
    }
    this->Loops.splat(this->Tile, block);
  }
}

// The voxels of a block, and which of its cells there are.
template <class T>
void TileSplatter<T>::load(const glm::ivec3& cell)
{
  const CellGrid& grid = this->Frame.grid;
  const glm::ivec3& size = grid.voxels.dimensions;
  const glm::ivec3 first = cell - grid.shift - grid.first;
  std::ptrdiff_t x[5];
  const T* rows[5][5];
  for (int n = 0; n < 5; ++n)
  {
    x[n] = std::clamp(first.x + n, 0, size.x - 1);
  }
  for (int z = 0; z < 5; ++z)
  {
    const std::ptrdiff_t k = std::clamp(first.z + z, 0, size.z - 1);
    for (int y = 0; y < 5; ++y)
    {
      const std::ptrdiff_t j = std::clamp(first.y + y, 0, size.y - 1);
      rows[z][y] = static_cast<const T*>(grid.voxels.voxels) + (k * size.y + j) * size.x;
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    this->Block.begin[a] = std::max(grid.begin[a] - cell[a], 0);
    this->Block.end[a] = std::min(grid.end[a] - cell[a], BlockCells);
  }
  static_cast<const BlockLoops<T>&>(this->Frame.kernels)
    .load(rows, x, this->Frame.values.scale, this->Block);
}

// The rays of the pixels around one that sees the block's middle, from points beside that on.
template <class T>
void TileSplatter<T>::placeRays(const ProjectedBox& seen, const glm::dvec3& middle)
{
  const PixelRays& rays = this->Frame.rays;
  CellBlock<A>& b = this->Block;
  // Of the block, not of what the volume has of it: the same for all pieces.
  const CellBox box(middle - 0.5 * BlockCells, middle + 0.5 * BlockCells);
  const ProjectedBox whole(rays, box);
  const bool perspective = rays.isPerspective(), near = whole.isNear();
  const glm::ivec2 pixel = near ? this->Frame.viewport / 2 : glm::ivec2(glm::floor(whole.pixel()));
  b.reference = near ? A(0) : static_cast<A>(whole.t());
  const double t = static_cast<double>(b.reference);
  const glm::dvec3 start = rays.point(pixel.x, pixel.y, t) - middle;
  const glm::dvec3 forward = rays.direction(pixel.x, pixel.y);
  b.x = pixel.x - this->Pixels.low.x;
  b.y = pixel.y - this->Pixels.low.y;
  b.middleT = static_cast<A>(whole.t() - t);
  for (int a = 0; a < 3; ++a)
  {
    b.start[a] = CellSum<A>(start[a]);
    if (perspective)
    {
      b.startAcross[a] = CellSum<A>(t * rays.across()[a]);
      b.startUp[a] = CellSum<A>(t * rays.up()[a]);
      b.forward[a] = CellSum<A>(forward[a]);
    }
  }
  if (seen.isNear())
  {
    return; // cells are placed one by one
  }
  const glm::dvec3 q = middle - rays.origin();
  const glm::dmat3& m = rays.toPixel();
  double size[2];
  const auto place = [&](int r, A(&row)[3], A& rest)
  {
    const double share = perspective ? pixel[r] : 0.0;
    const glm::dvec3 line = glm::row(m, r) - share * glm::row(m, 2);
    const double middlePixel = glm::dot(line, q) - (perspective ? 0.0 : pixel[r]);
    size[r] = std::abs(middlePixel);
    for (int a = 0; a < 3; ++a)
    {
      row[a] = static_cast<A>(line[a]);
      size[r] += 0.5 * BlockCells * std::abs(line[a]);
    }
    rest = static_cast<A>(middlePixel);
  };
  place(0, b.across, b.acrossStart);
  place(1, b.up, b.upStart);
  const double least = perspective ? seen.t() - seen.reach() : 1.0;
  b.inverses[0] = static_cast<A>(1.0 / least);
  b.inverses[1] = static_cast<A>(1.0 / (perspective ? seen.t() + seen.reach() : 1.0));
  b.margin = static_cast<A>(2e-3 +
    8.0 * static_cast<double>(std::numeric_limits<A>::epsilon()) *
      (std::max(size[0], size[1]) / least + std::abs(b.x) + std::abs(b.y)));
}

// The pixels of cells near the eye.
template <class T>
void TileSplatter<T>::findSeenCells(const glm::ivec3& cell)
{
  const CellBlock<A>& b = this->Block;
  const PixelRectangle block{ this->Pixels.low + glm::ivec2(b.columns[0], b.rows[0]),
    this->Pixels.low + glm::ivec2(b.columns[1], b.rows[1]) };
  for (int n = 0; n < 64; ++n)
  {
    const glm::dvec3 low(cell + glm::ivec3(n & 3, n >> 2 & 3, n >> 4) - this->Frame.grid.shift);
    const CellBox box(low, low + 1.0);
    const PixelRectangle pixels = ProjectedBox(this->Frame.rays, box).within(block);
    this->Seen[n][0] = pixels.low.x - this->Pixels.low.x;
    this->Seen[n][1] = pixels.high.x - this->Pixels.low.x;
    this->Seen[n][2] = pixels.low.y - this->Pixels.low.y;
    this->Seen[n][3] = pixels.high.y - this->Pixels.low.y;
  }
}

template <class T>
void TileSplatter<T>::finish(bool finished, CellScreen& screen) const
{
  const CellFrame<T>& f = this->Frame;
  constexpr A none = std::numeric_limits<A>::quiet_NaN();
  for (int y = this->Pixels.low.y; y <= this->Pixels.high.y; ++y)
  {
    const std::ptrdiff_t row = std::ptrdiff_t(y - this->Pixels.low.y) * this->Tile.Stride;
    const int left = this->Pixels.low.x - screen.origin.x;
    A* const out = screen.row<A>(y - screen.origin.y) + left;
    float* const depths = f.locates
      ? screen.depths.data() + std::ptrdiff_t(y - screen.origin.y) * screen.size.x + left
      : nullptr;
    for (int x = 0; x <= this->Pixels.high.x - this->Pixels.low.x; ++x)
    {
      const A value = this->Tile.values[row + x];
      const bool isEmpty = value == CellValue<A>::Outside || value == CellValue<A>::None;
      out[x] = finished ? f.values.voxelOf(value) : isEmpty ? none : value;
      if (depths)
      {
        depths[x] = isEmpty ? std::numeric_limits<float>::quiet_NaN()
                            : static_cast<float>(this->Tile.depths[row + x]);
      }
    }
  }
}

#define SPLATTING_INSTANTIATE(T) template class TileSplatter<T>;
SPLATTING_TYPES(SPLATTING_INSTANTIATE)
#undef SPLATTING_INSTANTIATE
}
