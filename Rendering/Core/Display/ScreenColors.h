// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingScreenColors_h
#define splattingScreenColors_h

#include "Display/Picture.h"
#include "Display/ScreenScalars.h"
#include "Kernels/Kernels.h"

#include <cstdint>
#include <vector>

namespace splatting
{
/**
 * Premultiplied RGBA colours (bytes in this order in memory) at equal steps over [low, high];
 * values outside take the first or the last.
 */
struct ColorTable
{
  double low = 0.0;
  double high = 0.0;
  std::vector<std::uint32_t> colors;
};

/// Fills the picture with the colours of scalars. Pixels without a sample are transparent.
void colorScreen(const ScreenScalars& screen, const ColorTable& table,
  InstructionSet instructionSet, Picture& picture);

/**
 * Copies scalars into those of a whole viewport, row after row from the bottom. Only pixels with a
 * sample change.
 * @param scalars  of the type of the screen's
 */
void copyScreen(const ScreenScalars& screen, const glm::ivec2& viewport, void* scalars);
}

#endif
