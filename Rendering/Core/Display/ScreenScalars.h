// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingScreenScalars_h
#define splattingScreenScalars_h

#include "Common/ScalarType.h"

#include <glm/vec2.hpp>

namespace splatting
{
/**
 * The scalars that the pixels of a viewport show, row by row. Both engines produce them:
 * CellScreen keeps the values of a finished projection, WarpedScalars warps a row of shear images
 * when it is asked for, and ShearPixelScalars takes the values of chosen pixels of shear images.
 * Colours and arrays are made from them.
 */
class ScreenScalars
{
public:
  virtual ~ScreenScalars() = default;

  /// The rectangle of the viewport that the volume may be seen in. Rows from bottom to top.
  glm::ivec2 origin{ 0 }, size{ 0 };
  /// The type of the values, Float32 or Float64: averageType() of the type of the voxels.
  ScalarType type = ScalarType::Float32;

  /**
   * The size.x values of a row of the rectangle; NaN where there is no sample. Threads may ask for
   * rows at the same time.
   * @param space  memory for size.x values, which may be used
   * @return  the values, valid as long as `space` and this object
   */
  virtual const void* valuesOfRow(int y, void* space) const = 0;
};
}

#endif
