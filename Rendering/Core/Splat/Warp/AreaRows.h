// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Computes the values of screen pixels, row by row, where screen pixels are wider than pixels of
 * the shear images. A value is the extremum or the average of the shear images at the points of the
 * pixel; see PixelArea.h.
 */
#ifndef splattingAreaRows_h
#define splattingAreaRows_h

#include "Splat/Warp/PixelArea.h"
#include "Splat/Warp/WarpSource.h"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace splatting
{
/**
 * The areas of pixels in all images of a view that they overlap.
 */
template <class A>
class AreaRows
{
public:
  /// The images must outlive its use.
  AreaRows(const std::vector<WarpSource<A>>& images, Reduction reduction)
    : Images(images),
      Reduced(reduction)
  {
    for (const WarpSource<A>& image : images)
    {
      this->Met.push_back(metByAreas(image.geometry));
    }
  }

  /// The values of a row of pixels. `start` is the first. NaN without a sample.
  void find(const glm::dvec3& start, int width, A* values) const
  {
    std::array<Span, MostImages> met, shown;
    for (std::size_t i = 0; i < this->Images.size(); ++i)
    {
      met[i] = this->Met[i].cut({ 0, width }, start);
      shown[i] = this->Images[i].shown.cut({ 0, width }, start);
    }
    for (int p = 0; p < width; ++p)
    {
      const glm::dvec3 pixel = start + glm::dvec3(double(p), 0.0, 0.0);
      Read read;
      for (std::size_t i = 0; i < this->Images.size(); ++i)
      {
        if (p >= met[i].begin && p < met[i].end)
        {
          this->readArea(this->Images[i], pixel, read);
        }
      }
      A value =
        this->Reduced == Reduction::Mean ? static_cast<A>(read.sum / read.count) : read.extremum;
      // At borders and holes of an image there may be no samples around any point of an area.
      for (std::size_t i = 0; i < this->Images.size() && read.count == 0; ++i)
      {
        const WarpSource<A>& image = this->Images[i];
        if (p >= shown[i].begin && p < shown[i].end)
        {
          value = image.valueAt(image.geometry.screenToShear() * pixel);
          break;
        }
      }
      values[p] = value;
    }
  }

private:
  /// What the points of an area have shown so far.
  struct Read
  {
    A extremum = std::numeric_limits<A>::quiet_NaN();
    double sum = 0.0;
    int count = 0;
  };

  void readArea(const WarpSource<A>& image, const glm::dvec3& pixel, Read& read) const
  {
    const bool least = this->Reduced == Reduction::Minimum;
    areaOf(image.geometry, pixel.x, pixel.y)
      .forPoints(
        [&](double u, double v)
        {
          const A value = interpolatedAt(image.image, image.pixels, u, v);
          if (value == value)
          {
            const bool isBetter = least ? value < read.extremum : value > read.extremum;
            read.extremum = isBetter || read.count == 0 ? value : read.extremum;
            read.sum += value;
            ++read.count;
          }
        });
  }

  const std::vector<WarpSource<A>>& Images;
  Reduction Reduced;
  std::vector<Outline> Met; // of areas, for each image
};
}

#endif
