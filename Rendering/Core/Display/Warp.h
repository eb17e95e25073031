// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Shear image to viewport: the scalar is interpolated, then its colour looked up, if wanted.
 */
#ifndef splattingWarp_h
#define splattingWarp_h

#include "Common/ProgressObserver.h"
#include "Display/Picture.h"
#include "Display/ShearPixels.h"
#include "Kernels/Kernels.h"
#include "Projection/ShearImage.h"

#include <glm/vec2.hpp>

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

/**
 * Warps shear images. Holds work space between frames.
 */
class Warper
{
public:
  /**
   * Fills the picture with the shear images of a view as seen in a viewport, each pixel from the
   * image whose axis its ray follows most. The picture ends where the volume's outermost voxel
   * centres are seen (half a voxel further out along axes with one voxel, and along all if the
   * geometry shows boxes); around an eye inside that box it does not end. Pixels beyond and pixels
   * without a sample are transparent.
   *
   * Where the geometries show areas, pixels have the extremum or the average of their areas, see
   * PixelArea.h, and the picture ends where areas no longer meet the volume.
   * @param images      all of one type; those beyond the number of geometries are left alone
   * @param geometries  as ShearWarp::factorise() gives them
   * @return  false if the observer has stopped it; the picture is invalid then
   */
  bool warp(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const ColorTable& table, const glm::ivec2& viewport,
    InstructionSet instructionSet, Picture& picture);

  /// The same of given shear pixels, one for each pixel of the picture.
  void warpPixels(const std::vector<ShearImage>& images, const std::vector<ShearPixel>& shown,
    const ColorTable& table, InstructionSet instructionSet, Picture& picture);

  /**
   * The same as scalars, into those of a whole viewport, row after row from the bottom. Transparent
   * pixels of the picture get the background; those outside the picture are left alone.
   * @param scalars  of type averageType() of the images' type
   */
  bool warpScalars(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const glm::ivec2& viewport, InstructionSet instructionSet,
    double background, void* scalars);

  /// Sets the function that decides whether to go on. It is called by the thread that warps, only
  /// where pixels show areas. Its argument is undefined.
  void setObserver(const ProgressObserver::Callback& callback)
  {
    this->Observer.setCallback(callback);
  }

private:
  ProgressObserver Observer;
  /// Images converted to the accumulator's type, where they are of another or have holes.
  std::vector<std::vector<unsigned char>> Copied;
};
}

#endif
