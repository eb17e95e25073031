// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Raises pixels of a tile, and finds the least values of its patches again. For CellKernels.cxx
 * only.
 */
#ifndef splattingScreenTilePixels_h
#define splattingScreenTilePixels_h

#include "Cells/Kernels/CellLoops.h"
#include "Cells/Kernels/CellRegisters.h"

#include <cstdint>

namespace splatting
{
namespace
{
template <class A>
SPLATTING_INLINE void markChanged(ScreenTile<A>& tile, int x, int y)
{
  const int row = y >> 2;
  tile.changed[row] |= 1u << (x >> 2);
  tile.firstChanged = row < tile.firstChanged ? row : tile.firstChanged;
  tile.lastChanged = row > tile.lastChanged ? row : tile.lastChanged;
}

template <class A, bool Located>
SPLATTING_INLINE void raise(ScreenTile<A>& tile, int x, int y, A value, A depth)
{
  const int at = y * tile.Stride + x;
  A& now = tile.values[at];
  if (value > now)
  {
    const bool bounds = now <= tile.least[(y >> 2) * tile.PatchStride + (x >> 2)];
    now = value;
    if (Located)
    {
      tile.depths[at] = depth;
    }
    if (bounds)
    {
      markChanged(tile, x, y);
    }
  }
  else if (Located && value == now && depth < tile.depths[at])
  {
    tile.depths[at] = depth;
  }
}

template <class A>
void refresh(ScreenTile<A>& tile)
{
  for (int y = tile.firstChanged; y <= tile.lastChanged; ++y)
  {
    for (std::uint32_t patches = tile.changed[y]; patches; patches &= patches - 1)
    {
      const int x = __builtin_ctz(patches);
      const A* const p = tile.values + 4 * y * tile.Stride + 4 * x;
      A least[4];
      for (int u = 0; u < 4; ++u)
      {
        const A *const a = p + u, *const b = a + 2 * tile.Stride;
        const A m = a[0] < a[tile.Stride] ? a[0] : a[tile.Stride];
        const A n = b[0] < b[tile.Stride] ? b[0] : b[tile.Stride];
        least[u] = m < n ? m : n;
      }
      const A m = least[0] < least[1] ? least[0] : least[1];
      const A n = least[2] < least[3] ? least[2] : least[3];
      tile.least[y * tile.PatchStride + x] = m < n ? m : n;
    }
    tile.changed[y] = 0;
  }
  tile.firstChanged = tile.Patches;
  tile.lastChanged = -1;
}
}
}

#endif
