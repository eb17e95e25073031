// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PixelProjector_h
#define PixelProjector_h

#include "Cells/CellProjector.h"
#include "Display/Locations.h"
#include "Splat/Projection/Project.h"

#include <glm/vec2.hpp>

#include <vector>

namespace splatting
{
/**
 * Finds the samples of single pixels of a projection without recorded locations: it projects the
 * pixels again.
 */
class PixelProjector
{
public:
  /**
   * @param index    of the whole volume
   * @param cells    of the whole volume, which are only updated for exact projections
   * @param located  the projection, not of averages
   * @param pixel    of the viewport
   */
  Locator::Sample Find(
    VolumeIndex& index, CellIndex& cells, const Located& located, const glm::ivec2& pixel);

private:
  Locator::Sample FindInImages(VolumeIndex& index, const Located& located, const glm::ivec2& pixel);
  void Project(VolumeIndex& index, const Located& located, const ShearPixel& pixel);

  splatting::Projector Projector;
  // An image of one pixel.
  std::vector<ShearWarp> Geometries = std::vector<ShearWarp>(1);
  std::vector<ShearImage> Images = std::vector<ShearImage>(1);
  Cuts PixelCuts;
  CellScreen Screen;
};
}

#endif
