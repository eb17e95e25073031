// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/SignedMaximum.h"

#include "Cells/CellScreen.h"

#include <cstddef>
#include <type_traits>

namespace splatting
{
ShearImage shownValues(const ShearImage& image)
{
  ShearImage shown = image;
  shown.winners.clear();
  shown.minima.clear();
  dispatch(image.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      T* const values = shown.row<T>(0);
      const T* const minima = image.minima.front().row<T>(0);
      for (std::size_t n = 0; n < std::size_t(image.width) * image.height; ++n)
      {
        values[n] = showsMinimum(values[n], minima[n], image.origin) ? minima[n] : values[n];
      }
    });
  return shown;
}

void takeMinima(CellScreen& screen, double origin)
{
  const CellScreen& minima = screen.minima.front();
  const auto take = [&](auto* values)
  {
    using A = std::remove_pointer_t<decltype(values)>;
    const A* const least = minima.row<A>(0);
    for (std::size_t n = 0; n < std::size_t(screen.size.x) * screen.size.y; ++n)
    {
      if (showsMinimum(values[n], least[n], origin))
      {
        values[n] = least[n];
        if (!screen.depths.empty())
        {
          screen.depths[n] = minima.depths[n];
        }
      }
    }
  };
  screen.type == ScalarType::Float32 ? take(screen.row<float>(0)) : take(screen.row<double>(0));
}
}
