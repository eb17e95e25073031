// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Shear image to viewport: the scalar is interpolated, then its colour looked up, if wanted.
 */
#ifndef splattingWarp_h
#define splattingWarp_h

#include "Display/FieldRim.h"
#include "Kernels/Kernels.h"
#include "Projection/ShearImage.h"

#include <glm/vec2.hpp>

#include <functional>
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
 * The part of a viewport that a volume may cover. Rows from bottom to top.
 */
struct Picture
{
  glm::ivec2 origin{ 0 };
  glm::ivec2 size{ 0 };
  std::vector<std::uint32_t> pixels;
};

/**
 * Sets the picture's origin and size.
 * @param images  as ShearWarp::factorise() gives them; without any the picture is empty
 */
void placePicture(
  const std::vector<ShearWarp>& images, const glm::ivec2& viewport, Picture& picture);

/**
 * A pixel of one of a view's shear images; none by default.
 */
struct ShearPixel
{
  int image = -1;
  int u = 0, v = 0;
};

/**
 * For each pixel of a rectangle of the viewport, row by row from the bottom, the shear pixel whose
 * location stands for it: the nearest of those that Warper interpolates its value between, where
 * areas are shown the largest (of minima the least) in the area, or without any the nearest to
 * where the area's value comes from; none where the picture has no sample.
 * @param images     as in Warper::warp()
 * @param hasSample  whether a shear pixel has one; without it, whether it has a winner
 */
void findShearPixels(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& origin,
  const glm::ivec2& size, ShearPixel* out,
  const std::function<bool(const ShearPixel&)>& hasSample = {});

/**
 * Adds a picture of the same size and place, byte by byte, no further than 255.
 */
void addSaturated(const Picture& layer, Picture& sum);

/**
 * Multiplies a picture without transparency by the opacities of another one of the same size and
 * place.
 */
void multiplyByOpacity(const Picture& opacity, Picture& picture);

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
   * @param images      all of one type; those behind the last geometry are left alone
   * @param geometries  as ShearWarp::factorise() gives them
   * @param rim         values of pixels that are not interpolated, found for this view
   */
  void warp(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const ColorTable& table, const glm::ivec2& viewport,
    InstructionSet instructionSet, Picture& picture, const FieldRim& rim = {});

  /// The same of given shear pixels, one for each pixel of the picture.
  void warpPixels(const std::vector<ShearImage>& images, const std::vector<ShearPixel>& shown,
    const ColorTable& table, InstructionSet instructionSet, Picture& picture);

  /**
   * The same as scalars, to a whole viewport's, row after row from the bottom. Pixels that would be
   * transparent are left alone or get the background.
   * @param scalars  of type averageType() of the images' type
   */
  void warpScalars(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const glm::ivec2& viewport, InstructionSet instructionSet,
    double background, void* scalars, const FieldRim& rim = {});

private:
  /// Preview images in the accumulator's type.
  std::vector<std::vector<unsigned char>> Widened;
};
}

#endif
