// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the screen's pixels show, row by row, where they are wider than the shear images': see
 * PixelArea.h.
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
 * The areas of pixels in all images of a view that they meet.
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

  /// The values of a row's pixels [x, x + n), `start` being the row's first; NaN where nothing is.
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
      // Of all images the same points, or those of one would count for more.
      glm::ivec2 points(0);
      for (const WarpSource<A>& source : this->Images)
      {
        const PixelArea area = areaOf(source.geometry, start.x + p, start.y);
        points = glm::max(points, pointsOf(source.geometry, area));
      }
      double sum = 0.0;
      int count = 0;
      for (std::size_t number = 0; number < this->Images.size(); ++number)
      {
        const WarpSource<A>& source = this->Images[number];
        if (!this->Met[number].cut({ p, p + 1 }, start).empty())
        {
          PixelAreas<A>(source.image, source.pixels)
            .addAverage(source.geometry, start.x + p, start.y, points, sum, count);
        }
      }
      values[p - x] = count > 0 ? static_cast<A>(sum / count) : std::numeric_limits<A>::quiet_NaN();
    }
  }

  const std::vector<WarpSource<A>>& Images;
  Reduction Reduced;
  std::vector<Outline> Met; // by areas, of each image
};
}

#endif
