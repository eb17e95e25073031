// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingShearPixels_h
#define splattingShearPixels_h

#include "Display/ScreenScalars.h"
#include "Splat/Projection/Project.h"
#include "Splat/Projection/ShearImage.h"

#include <glm/vec2.hpp>

#include <functional>
#include <vector>

namespace splatting
{
/**
 * A pixel of one of a view's shear images; none by default.
 */
struct ShearPixel
{
  int image = -1;
  int u = 0, v = 0;
  bool minimum = false; ///< whether it shows the minimum of its ray

  /// Its image in a view's images, in Reduction::Signed that of its extremum.
  const ShearImage& of(const std::vector<ShearImage>& images) const
  {
    return images[this->image].ofExtremum(this->minimum);
  }
};

/**
 * For each pixel of a rectangle of the viewport, row by row from the bottom, the shear pixel whose
 * location it shows: the nearest of those that WarpedScalars interpolates its value from. In
 * overviews it is the shear pixel with the largest value (for minima the least) among those nearest
 * to the points that the area reads. None if the picture has no sample. Of images of
 * Reduction::Signed the shear pixels of either extremum are found, see findShown().
 * @param images     as in WarpedScalars::set()
 * @param reduction  of Reduction::Signed Maximum or Minimum
 * @param hasSample  whether a shear pixel has a sample; by default whether it has a winner
 */
void findShearPixels(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& origin,
  const glm::ivec2& size, ShearPixel* out,
  const std::function<bool(const ShearPixel&)>& hasSample = {});

/**
 * The values of the shear pixels whose locations an overview shows, without interpolation.
 */
class ShearPixelScalars : public ScreenScalars
{
public:
  /// Finds the shear pixels of a viewport; see findShearPixels().
  void find(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const glm::ivec2& viewport);
  /// Sets the images whose values are shown, which must exist while rows are read.
  void set(const std::vector<ShearImage>& images);

  const void* valuesOfRow(int y, void* space) const override;

private:
  std::vector<ShearPixel> Shown;
  const std::vector<ShearImage>* Images = nullptr;
};
}

#endif
