// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingPicture_h
#define splattingPicture_h

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace splatting
{
/**
 * The part of a viewport that a volume may cover. Rows from bottom to top.
 */
struct Picture
{
  glm::ivec2 origin{ 0 };
  glm::ivec2 size{ 0 };
  std::vector<std::uint32_t> pixels;
};

/**
 * Adds a picture of the same size and position, byte by byte, clamped to 255.
 */
void addSaturated(const Picture& layer, Picture& sum);

/**
 * Multiplies an opaque picture by the opacities of another one of the same size and position.
 */
void multiplyByOpacity(const Picture& opacity, Picture& picture);
}

#endif
