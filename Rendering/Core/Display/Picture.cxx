// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/Picture.h"

#include "Common/Parallel.h"

#include <algorithm>

namespace splatting
{
void addSaturated(const Picture& layer, Picture& sum)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(layer.pixels.data());
  auto* const to = reinterpret_cast<unsigned char*>(sum.pixels.data());
  parallelFor(0, static_cast<std::ptrdiff_t>(4 * sum.pixels.size()), 1 << 16,
    [=](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t n = first; n < last; ++n)
      {
        to[n] = static_cast<unsigned char>(std::min(to[n] + from[n], 255));
      }
    });
}

void multiplyByOpacity(const Picture& opacity, Picture& picture)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(opacity.pixels.data());
  auto* const to = reinterpret_cast<unsigned char*>(picture.pixels.data());
  parallelFor(0, static_cast<std::ptrdiff_t>(picture.pixels.size()), 1 << 14,
    [=](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t n = 4 * first; n < 4 * last; ++n)
      {
        to[n] = static_cast<unsigned char>((to[n] * from[n | 3] + 127) / 255);
      }
    });
}
}
