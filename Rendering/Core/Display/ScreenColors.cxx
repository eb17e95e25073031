// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/ScreenColors.h"

#include "Common/Parallel.h"

#include <cstddef>

namespace splatting
{
namespace
{
/// Calls f(y, values) for each row of scalars of type A.
template <class A, class F>
void forRows(const ScreenScalars& screen, F&& f)
{
  parallelFor(0, screen.size.y, 16,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      std::vector<A> space(screen.size.x);
      for (int y = static_cast<int>(first); y < last; ++y)
      {
        f(y, static_cast<const A*>(screen.valuesOfRow(y, space.data())));
      }
    });
}

template <class A>
void colorRows(const ScreenScalars& screen, const ColorTable& table, const WorksheetLoops<A>& loops,
  Picture& picture)
{
  const auto last = static_cast<std::int32_t>(table.colors.size()) - 1;
  const A low = static_cast<A>(table.low);
  const A scale = static_cast<A>(table.high > table.low ? last / (table.high - table.low) : 0.0);
  forRows<A>(screen,
    [&](int y, const A* values)
    {
      std::uint32_t* const pixels = picture.pixels.data() + std::ptrdiff_t(y) * screen.size.x;
      loops.lookUp(values, low, scale, last, table.colors.data(), pixels, screen.size.x);
    });
}

template <class A>
void copyRows(const ScreenScalars& screen, const glm::ivec2& viewport, A* scalars)
{
  forRows<A>(screen,
    [&](int y, const A* values)
    {
      A* const to = scalars + std::ptrdiff_t(screen.origin.y + y) * viewport.x + screen.origin.x;
      for (int x = 0; x < screen.size.x; ++x)
      {
        to[x] = values[x] == values[x] ? values[x] : to[x];
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
  screen.type == ScalarType::Float32 ? copyRows(screen, viewport, static_cast<float*>(scalars))
                                     : copyRows(screen, viewport, static_cast<double*>(scalars));
}
}
