// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Values of the screen's pixels by area, row by row, for pixels wider than those of the shear
 * images; see PixelArea.h.
 */
#ifndef splattingAreaRows_h
#define splattingAreaRows_h

#include "Display/PixelArea.h"
#include "Display/WarpSource.h"

#include <algorithm>
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

  /// The values of a row's pixels [x, x + n). `start` is the row's first pixel. NaN without a
  /// sample.
  void find(const glm::dvec3& start, int x, int n, A* values) const
  {
    this->Reduced == Reduction::Mean ? this->findAverages(start, x, n, values)
                                     : this->findExtrema(start, x, n, values);
  }

private:
  void findExtrema(const glm::dvec3& start, int x, int n, A* values) const
  {
    const bool least = this->Reduced == Reduction::Minimum;
    std::fill_n(values, n, std::numeric_limits<A>::quiet_NaN());
    for (std::size_t number = 0; number < this->Images.size(); ++number)
    {
      const WarpSource<A>& source = this->Images[number];
      const PixelAreas<A> areas(source.image, source.pixels);
      const Span met = this->Met[number].cut({ x, x + n }, start);
      const Span shown = source.shown.cut({ x, x + n }, start);
      for (int p = met.begin; p < met.end; ++p)
      {
        AreaValue<A> best{ values[p - x] };
        best.take(areas.extremum(areaOf(source.geometry, start.x + p, start.y), least), least);
        if (!best.found() && p >= shown.begin && p < shown.end)
        {
          best.value = source.valueAt(
            source.geometry.screenToShear() * (start + glm::dvec3(double(p), 0.0, 0.0)));
        }
        values[p - x] = best.value;
      }
    }
  }

  void findAverages(const glm::dvec3& start, int x, int n, A* values) const
  {
    for (int p = x; p < x + n; ++p)
    {
      const AreaMean mean = this->averageOf(start, p);
      values[p - x] = mean.weights > 0.0 ? static_cast<A>(mean.sum / mean.weights)
                                         : std::numeric_limits<A>::quiet_NaN();
    }
  }

  /// The average of pixel p of a row. If no point is between samples, as in volumes one voxel
  /// thick, that of the samples.
  AreaMean averageOf(const glm::dvec3& start, int p) const
  {
    AreaMean points, samples;
    for (std::size_t number = 0; number < this->Images.size(); ++number)
    {
      const WarpSource<A>& source = this->Images[number];
      if (!this->Met[number].cut({ p, p + 1 }, start).empty())
      {
        const PixelArea area = areaOf(source.geometry, start.x + p, start.y);
        const PixelAreas<A> areas(source.image, source.pixels);
        areas.addAverage(source.geometry, area, points);
        if (points.weights == 0.0)
        {
          areas.addSamples(area, samples);
        }
      }
    }
    return points.weights > 0.0 ? points : samples;
  }

  const std::vector<WarpSource<A>>& Images;
  Reduction Reduced;
  std::vector<Outline> Met; // of areas, for each image
};
}

#endif
