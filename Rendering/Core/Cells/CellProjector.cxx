// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellProjector.h"

#include "Cells/LocalMaxima.h"
#include "Cells/TileSplatter.h"
#include "Common/Parallel.h"
#include "Display/Picture.h"
#include "Display/SignedMaximum.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <type_traits>

namespace splatting
{
struct CellProjector::Scratch
{
  /// The bricks that tiles see: of each chunk of bricks, for each tile.
  static constexpr int Chunks = 16;
  std::vector<std::vector<std::uint32_t>> seen[Chunks];
  std::vector<int> tiles;         // those with most bricks first
  std::vector<std::size_t> costs; // bricks of each tile
  std::mutex mutex;
  std::vector<std::unique_ptr<ScreenTile<float>>> floats;
  std::vector<std::unique_ptr<ScreenTile<double>>> doubles;

  std::vector<std::unique_ptr<ScreenTile<float>>>& pool(float*) { return this->floats; }
  std::vector<std::unique_ptr<ScreenTile<double>>>& pool(double*) { return this->doubles; }

  /// A tile for one thread.
  template <class A>
  std::unique_ptr<ScreenTile<A>> take()
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    auto& tiles = this->pool(static_cast<A*>(nullptr));
    if (tiles.empty())
    {
      return std::make_unique<ScreenTile<A>>();
    }
    std::unique_ptr<ScreenTile<A>> tile = std::move(tiles.back());
    tiles.pop_back();
    return tile;
  }
  template <class A>
  void giveBack(std::unique_ptr<ScreenTile<A>> tile)
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    this->pool(static_cast<A*>(nullptr)).push_back(std::move(tile));
  }
};

namespace
{
/// Assigns bricks [first, last) of the order to tiles.
template <class T>
void assignBricks(const CellFrame<T>& frame, std::size_t first, std::size_t last,
  std::vector<std::vector<std::uint32_t>>& tiles)
{
  tiles.resize(frame.tileCount());
  for (std::vector<std::uint32_t>& bricks : tiles)
  {
    bricks.clear();
  }
  for (std::size_t n = first; n < last; ++n)
  {
    const std::uint32_t brick = frame.bounds.order[n];
    const CellBox box = frame.boxOfBrick(brick);
    if (!frame.isShown(box))
    {
      continue;
    }
    const ProjectedBox seen(frame.rays, box);
    const PixelRectangle pixels = seen.within(frame.rectangle);
    if (pixels.empty())
    {
      continue;
    }
    const glm::ivec2 from = (pixels.low - frame.rectangle.low) / ScreenTile<float>::Side;
    const glm::ivec2 to = (pixels.high - frame.rectangle.low) / ScreenTile<float>::Side;
    for (int y = from.y; y <= to.y; ++y)
    {
      for (int x = from.x; x <= to.x; ++x)
      {
        const int tile = y * frame.tiles.x + x;
        if (!seen.isNear() || !seen.within(frame.pixelsOf(tile)).empty())
        {
          tiles[tile].push_back(brick);
        }
      }
    }
  }
}
}

CellProjector::CellProjector() : Memory(new Scratch) {}

CellProjector::~CellProjector() = default;

bool CellProjector::place(const View& view, Picture& picture)
{
  PixelRays rays;
  picture.origin = picture.size = glm::ivec2(0);
  if (!rays.find(view))
  {
    return false;
  }
  const CellGrid grid({}, glm::ivec3(0), view.dimensions, view.showsBoxes);
  const PixelRectangle pixels =
    ProjectedBox(rays, CellBox(grid.low, grid.high)).within({ glm::ivec2(0), view.viewport - 1 });
  if (!pixels.empty())
  {
    picture.origin = pixels.low;
    picture.size = pixels.high - pixels.low + 1;
  }
  return true;
}

bool CellProjector::project(CellIndex& index, const View& view, const ProjectionSettings& settings,
  const RayEnds& ends, bool locate, CellScreen& screen)
{
  return this->project(
    index, view, settings, ends, locate, Wanted{ { 0, 0 }, view.viewport, true }, screen);
}

bool CellProjector::project(CellIndex& index, const View& view, const ProjectionSettings& settings,
  const RayEnds& ends, bool locate, const glm::ivec2 (&within)[2], CellScreen& screen)
{
  return this->project(
    index, view, settings, ends, locate, Wanted{ within[0], within[1], true }, screen);
}

bool CellProjector::projectPiece(CellIndex& index, const View& view,
  const ProjectionSettings& settings, const RayEnds& ends, bool locate, CellScreen& screen)
{
  return this->project(
    index, view, settings, ends, locate, Wanted{ { 0, 0 }, view.viewport, false }, screen);
}

void CellProjector::finish(
  const CellIndex& index, const ProjectionSettings& settings, CellScreen& screen)
{
  if (settings.reduction == Reduction::Signed)
  {
    ProjectionSettings part = settings;
    part.reduction = Reduction::Minimum;
    finish(index, part, screen.minima.front());
    part.reduction = Reduction::Maximum;
    finish(index, part, screen);
    takeMinima(screen, settings.origin);
    return;
  }
  dispatch(screen.type,
    [&](auto* null)
    {
      using A = Accumulator<std::remove_pointer_t<decltype(null)>>;
      const ValueScale<A> scale(index.range(), settings.reduction);
      A* const values = screen.row<A>(0);
      parallelFor(0, std::ptrdiff_t(screen.size.x) * screen.size.y, 1 << 14,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end)
        {
          for (std::ptrdiff_t n = begin; n < end; ++n)
          {
            values[n] = scale.voxelOf(values[n]);
          }
        });
    });
}

bool CellProjector::project(CellIndex& index, const View& view, const ProjectionSettings& settings,
  const RayEnds& ends, bool locate, const Wanted& wanted, CellScreen& screen)
{
  this->Observer.start();
  screen.minima.resize(settings.reduction == Reduction::Signed ? 1 : 0);
  if (screen.minima.empty())
  {
    return this->projectReduction(index, view, settings, ends, locate, wanted, screen);
  }
  ProjectionSettings part = settings;
  part.reduction = Reduction::Maximum;
  this->Observer.setStage(0.0, 0.5);
  if (!this->projectReduction(index, view, part, ends, locate, wanted, screen))
  {
    return false;
  }
  part.reduction = Reduction::Minimum;
  this->Observer.setStage(0.5, 1.0);
  if (!this->projectReduction(index, view, part, ends, locate, wanted, screen.minima.front()))
  {
    return false;
  }
  if (wanted.finished)
  {
    takeMinima(screen, settings.origin);
  }
  return true;
}

bool CellProjector::projectReduction(CellIndex& index, const View& view,
  const ProjectionSettings& settings, const RayEnds& ends, bool locate, const Wanted& within,
  CellScreen& screen)
{
  if (!screen.rays.find(view))
  {
    return false;
  }
  const CellGrid& grid = index.grid();
  const PixelRectangle wanted{ glm::max(within.origin, glm::ivec2(0)),
    glm::min(within.origin + within.size, view.viewport) - 1 };
  const CellBox field(grid.low, grid.high);
  const PixelRectangle rectangle = ProjectedBox(screen.rays, field).within(wanted);
  screen.origin = rectangle.low;
  screen.size = rectangle.empty() ? glm::ivec2(0) : rectangle.high - rectangle.low + 1;
  return dispatch(grid.voxels.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      const std::size_t pixels = std::size_t(screen.size.x) * screen.size.y;
      const bool locates = locate || settings.reduction == Reduction::Local;
      screen.type = scalarTypeOf<A>();
      screen.bytes.resize(pixels * sizeof(A));
      screen.depths.resize(locates ? pixels : 0);
      if (pixels == 0)
      {
        return !this->Observer.stopped();
      }
      const CellFrame<T> frame(index, view, settings, ends, locates, rectangle, screen.rays);
      Scratch& memory = *this->Memory;
      const std::size_t bricks = frame.bounds.order.size();
      parallelFor(0, Scratch::Chunks, 1,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end)
        {
          for (std::ptrdiff_t n = begin; n < end; ++n)
          {
            assignBricks(frame, bricks * n / Scratch::Chunks, bricks * (n + 1) / Scratch::Chunks,
              memory.seen[n]);
          }
        });
      memory.tiles.resize(frame.tileCount());
      std::iota(memory.tiles.begin(), memory.tiles.end(), 0);
      memory.costs.clear();
      for (int tile : memory.tiles)
      {
        memory.costs.push_back(
          std::accumulate(std::begin(memory.seen), std::end(memory.seen), std::size_t(0),
            [&](std::size_t sum, const auto& seen) { return sum + seen[tile].size(); }));
      }
      std::sort(memory.tiles.begin(), memory.tiles.end(),
        [&](int a, int b) { return memory.costs[a] > memory.costs[b]; });
      this->Observer.begin(static_cast<int>(memory.tiles.size()));
      parallelFor(0, static_cast<std::ptrdiff_t>(memory.tiles.size()), 1,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end)
        {
          std::unique_ptr<ScreenTile<A>> tile = memory.take<A>();
          TileSplatter<T> splatter(frame, *tile);
          for (std::ptrdiff_t n = begin; n < end && !this->Observer.stopped(); ++n)
          {
            splatter.open(memory.tiles[n]);
            for (const auto& seen : memory.seen)
            {
              if (!splatter.splat(seen[memory.tiles[n]]))
              {
                break;
              }
            }
            splatter.finish(within.finished, screen);
            this->Observer.bandDone();
          }
          memory.giveBack<A>(std::move(tile));
        });
      this->Observer.ask();
      if (settings.reduction == Reduction::Local && !this->Observer.stopped())
      {
        findLocalMaxima<T>(frame, index.range(), settings.threshold, screen);
      }
      return !this->Observer.stopped();
    });
}
}
