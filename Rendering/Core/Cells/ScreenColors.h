// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingScreenColors_h
#define splattingScreenColors_h

#include "Cells/ScreenScalars.h"
#include "Display/Picture.h"
#include "Display/Warp.h"

namespace splatting
{
/// Sets the picture's origin and size to the rectangle of the viewport that shows the field. False
/// if the view is invalid.
bool placePicture(const View& view, Picture& picture);

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
