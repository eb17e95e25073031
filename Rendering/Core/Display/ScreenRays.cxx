// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/ScreenRays.h"

#include "Display/Outline.h"
#include "Display/Picture.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace splatting
{
namespace
{
/// Values of rows of pixels from segments of their rays, some of which are looked at together.
template <class T>
class RowOfValues
{
public:
  using A = Accumulator<T>;

  RowOfValues(const RayFinder<T>& finder, const Kernels& loops) : Finder(finder), Loops(loops)
  {
    this->Segments.nonFinite = std::is_floating_point_v<T>;
  }

  /// To be called for each row.
  void open(A* values, int count)
  {
    this->Values = values;
    this->Count = count;
    std::fill_n(values, count, Least);
  }

  /// Looks near the winners around one of them, and along the whole ray where that is not enough.
  void find(int pixel, const ScreenPixel& onScreen)
  {
    const Way way = this->Finder.wayOf(onScreen);
    this->Finder.forPartsAtWinners(way, this->adding(pixel));
    if (way.isWhole)
    {
      this->Whole[this->WholeCount++] = { pixel, way };
      if (this->WholeCount == static_cast<int>(this->Whole.size()))
      {
        this->lookAlongWhole();
      }
    }
  }

  /// Pixels without a segment get NaN.
  void finish()
  {
    this->lookAlongWhole();
    this->take();
    std::replace(
      this->Values, this->Values + this->Count, Least, std::numeric_limits<A>::quiet_NaN());
  }

private:
  static constexpr A Least = -std::numeric_limits<A>::infinity();

  /// Adds segments of a pixel's ray.
  auto adding(int pixel)
  {
    return [this, pixel](const FieldRay& ray, int k, const glm::dvec2& depths)
    {
      this->Pixels[this->Segments.count] = pixel;
      this->Finder.add(ray, k, depths, this->Segments);
      if (this->Segments.count == this->Segments.most)
      {
        this->take();
      }
    };
  }

  /// Looks along whole rays, where they can have more than near their winners.
  void lookAlongWhole()
  {
    this->take();
    for (int n = 0; n < this->WholeCount; ++n)
    {
      const auto& [pixel, way] = this->Whole[n];
      this->Finder.forPartsAbove(this->Values[pixel], way, this->adding(pixel));
    }
    this->WholeCount = 0;
  }

  void take()
  {
    this->Finder.findLargest(this->Segments, this->Voxels, this->Loops);
    for (int n = 0; n < this->Segments.count; ++n)
    {
      // Not std::max(), which compilers make a branch of that is often predicted wrongly.
      A& value = this->Values[this->Pixels[n]];
      const A largest = this->Segments.largest[n], before = value;
      value = largest > before ? largest : before;
    }
    this->Segments.count = 0;
  }

  const RayFinder<T>& Finder;
  const Kernels& Loops;
  A* Values = nullptr;
  int Count = 0;
  std::array<std::pair<int, Way>, 64> Whole; // pixels whose whole rays are to be looked along
  int WholeCount = 0;
  FieldSegments<A> Segments{};
  VoxelsOfSegments<T> Voxels{};
  std::array<int, FieldSegments<A>::most> Pixels;
};
}

/// Which pixels have values; their number.
std::size_t ScreenRays::findRows(
  const std::vector<ShearWarp>& geometries, const glm::ivec2& viewport)
{
  Picture place;
  placePicture(geometries, viewport, place);
  this->Images = geometries.size();
  this->Origin = place.origin;
  this->Rows.resize(place.size.y * this->Images);
  std::size_t count = 0;
  for (std::size_t n = 0; n < this->Images; ++n)
  {
    const Outline shown = shownBy(geometries[n]);
    for (int y = 0; y < place.size.y; ++y)
    {
      const glm::dvec3 start(place.origin.x, place.origin.y + static_cast<double>(y), 1.0);
      Row& row = this->Rows[y * this->Images + n];
      row.shown = shown.cut({ 0, place.size.x }, start);
      row.shown.end = std::max(row.shown.begin, row.shown.end);
      row.first = count;
      count += row.shown.end - row.shown.begin;
    }
  }
  return count;
}

void ScreenRays::find(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, const RaySource& source, const glm::ivec2& viewport,
  InstructionSet instructionSet)
{
  const Kernels& kernels = kernelsFor(instructionSet);
  const std::size_t count = this->findRows(geometries, viewport);
  const int rows = static_cast<int>(this->Images ? this->Rows.size() / this->Images : 0);
  this->Values.width = static_cast<int>(count);
  this->Values.height = 1;
  this->Values.spans.assign(1, { 0, this->Values.width });
  this->Values.nonFinite = true;
  dispatch(source.volume.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      this->Values.type = scalarTypeOf<A>();
      this->Values.bytes.resize(count * sizeof(A));
      A* const values = this->Values.template row<A>(0);
      if (!source.volume.voxels)
      {
        std::fill_n(values, count, std::numeric_limits<A>::quiet_NaN());
        return;
      }
      for (std::size_t i = 0; i < this->Images; ++i)
      {
        const RayFinder<T> finder(images[i], geometries[i], source, (*source.cuts)[i]);
        vtkSMPTools::For(0, rows, 4,
          [&](vtkIdType first, vtkIdType last)
          {
            RowOfValues<T> found(finder, kernels);
            for (vtkIdType y = first; y < last; ++y)
            {
              const Row& row = this->Rows[y * this->Images + i];
              const int width = row.shown.end - row.shown.begin;
              found.open(values + row.first, width);
              for (int n = 0; n < width; ++n)
              {
                const glm::ivec2 pixel(row.shown.begin + n, static_cast<int>(y));
                found.find(n, ScreenPixel(geometries[i], this->Origin + pixel));
              }
              found.finish();
            }
          });
      }
    });
}

double ScreenRays::valueAt(std::size_t image, const glm::ivec2& pixel) const
{
  const glm::ivec2 at = pixel - this->Origin;
  const std::size_t row = at.y * this->Images + image;
  if (at.y < 0 || row >= this->Rows.size() || at.x < this->Rows[row].shown.begin ||
    at.x >= this->Rows[row].shown.end)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return this->Values.type == ScalarType::Float32
    ? static_cast<double>(*this->values<float>(image, at.x, at.y))
    : *this->values<double>(image, at.x, at.y);
}
}
