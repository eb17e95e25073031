// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From shear images to the viewport: interpolates scalars, and looks up their colours on request.
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
   * Fills the picture with the shear images of a view. Each pixel shows the image whose axis its
   * ray follows most. The picture ends at the box of the outermost voxel centres. The box is half a
   * voxel larger on each side along axes with one voxel, and along all axes if the geometry shows
   * boxes. If the eye is inside this box, the picture has no end. Other pixels, and pixels without
   * a sample, are transparent.
   *
   * In overviews pixels have the extremum or the average of their areas, see PixelArea.h, and the
   * picture ends where areas do not overlap the volume. For Reduction::Signed each pixel shows the
   * one of its maximum and its minimum, both interpolated, that is farther from the images' origin.
   * @param images      all of one type; those beyond the number of geometries are ignored
   * @param geometries  as ShearWarp::factorise() returns them
   * @return  false, with an invalid picture, if the observer has stopped it
   */
  bool warp(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const ColorTable& table, const glm::ivec2& viewport,
    InstructionSet instructionSet, Picture& picture);

  /// As warp(), with the shear pixel of each pixel of the picture. Not for Reduction::Signed.
  void warpPixels(const std::vector<ShearImage>& images, const std::vector<ShearPixel>& shown,
    const ColorTable& table, InstructionSet instructionSet, Picture& picture);

  /**
   * As warp(), but writes the scalars of a whole viewport, row by row from the bottom. Transparent
   * pixels of the picture get the background; those outside the picture are unchanged.
   * @param scalars  of type averageType() of the images' type
   */
  bool warpScalars(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const glm::ivec2& viewport, InstructionSet instructionSet,
    double background, void* scalars);

  /// Sets the function that returns whether to continue. It is called by the warping thread, in
  /// overviews only. Its argument is undefined.
  void setObserver(const ProgressObserver::Callback& callback)
  {
    this->Observer.setCallback(callback);
  }

private:
  ProgressObserver Observer;
  /// Images converted to the accumulator's type, if they have another type or holes.
  std::vector<std::vector<unsigned char>> Copied;
};
}

#endif
