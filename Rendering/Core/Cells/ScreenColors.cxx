// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/ScreenColors.h"

#include "Cells/BoxProjection.h"
#include "Cells/CellIndex.h"
#include "Common/Parallel.h"

#include <type_traits>

namespace splatting
{
bool placePicture(const View& view, Picture& picture)
{
  PixelRays rays;
  picture.origin = picture.size = glm::ivec2(0);
  if (!rays.find(view))
  {
    return false;
  }
  const CellGrid grid({}, glm::ivec3(0), view.dimensions, view.showsBoxes);
  const CellBox box(grid.low, grid.high);
  const PixelRectangle pixels =
    ProjectedBox(rays, box).within({ glm::ivec2(0), view.viewport - 1 });
  if (!pixels.empty())
  {
    picture.origin = pixels.low;
    picture.size = pixels.high - pixels.low + 1;
  }
  return true;
}

namespace
{
template <class A>
void colorRows(const ScreenScalars& screen, const ColorTable& table, const WorksheetLoops<A>& loops,
  Picture& picture)
{
  const auto last = static_cast<std::int32_t>(table.colors.size()) - 1;
  const A low = static_cast<A>(table.low);
  const A scale = static_cast<A>(table.high > table.low ? last / (table.high - table.low) : 0.0);
  parallelFor(0, screen.size.y, 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (std::ptrdiff_t y = begin; y < end; ++y)
      {
        const A* const values = screen.row<A>(static_cast<int>(y));
        std::uint32_t* const pixels = picture.pixels.data() + y * screen.size.x;
        loops.lookUp(values, low, scale, last, table.colors.data(), pixels, screen.size.x);
        for (int x = 0; x < screen.size.x; ++x)
        {
          pixels[x] = values[x] == values[x] ? pixels[x] : 0;
        }
      }
    });
}
}

void colorScreen(const ScreenScalars& screen, const ColorTable& table,
  InstructionSet instructionSet, Picture& picture)
{
  picture.origin = screen.origin;
  picture.size = screen.size;
  picture.pixels.resize(std::size_t(screen.size.x) * screen.size.y);
  const Kernels& kernels = kernelsFor(instructionSet);
  screen.type == ScalarType::Float32 ? colorRows<float>(screen, table, kernels, picture)
                                     : colorRows<double>(screen, table, kernels, picture);
}

void copyScreen(const ScreenScalars& screen, const glm::ivec2& viewport, void* scalars)
{
  dispatch(screen.type,
    [&](auto* null)
    {
      using A = std::remove_pointer_t<decltype(null)>;
      for (int y = 0; y < screen.size.y; ++y)
      {
        const A* const from = screen.row<A>(y);
        A* const to = static_cast<A*>(scalars) + std::ptrdiff_t(screen.origin.y + y) * viewport.x +
          screen.origin.x;
        for (int x = 0; x < screen.size.x; ++x)
        {
          to[x] = from[x] == from[x] ? from[x] : to[x];
        }
      }
    });
}
}
