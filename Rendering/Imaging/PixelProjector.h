// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PixelProjector_h
#define PixelProjector_h

#include "Display/ShearPixels.h"
#include "Projection/Project.h"

#include <vector>

namespace splatting
{
/**
 * Projects single pixels of a view's images again, with their winners, for picks without recorded
 * locations.
 */
class PixelProjector
{
public:
  /// The image of one pixel.
  struct Pixel
  {
    std::vector<ShearWarp> Geometries = std::vector<ShearWarp>(1);
    std::vector<ShearImage> Images = std::vector<ShearImage>(1);
    splatting::Cuts Cuts;
  };

  /**
   * @param index       of the whole volume
   * @param settings    of the images; not for averages
   * @param geometries  of the images, and the cuts of each
   */
  const Pixel& Project(VolumeIndex& index, ProjectionSettings settings, const ShearPixel& pixel,
    const std::vector<ShearWarp>& geometries, const std::vector<Cuts>& cuts);

private:
  splatting::Projector Projector;
  Pixel Alone;
};
}

#endif
