// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Warp/ShearPixels.h"

#include "Common/Parallel.h"
#include "Display/Picture.h"
#include "Splat/Warp/Outline.h"
#include "Splat/Warp/PixelArea.h"
#include "Splat/Warp/WarpSource.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace splatting
{
namespace
{
/// The nearest of the shear pixels that a point's value is interpolated from.
/// @param nearest  an image and an extremum
ShearPixel nearestPixel(const ShearImage& image, ShearPixel nearest, const glm::dvec3& homogeneous,
  const std::function<bool(const ShearPixel&)>& hasSample)
{
  const glm::dvec2 p = glm::dvec2(homogeneous) / homogeneous.z;
  double lost = 0.0, largest = -1.0;
  forNeighbours(image, p,
    [&](int u, int v, double w)
    {
      const ShearPixel neighbour{ nearest.image, u, v, nearest.minimum };
      const bool has =
        hasSample ? hasSample(neighbour) : image.winners[std::size_t(v) * image.width + u] >= 0;
      if (!has)
      {
        lost += w;
      }
      else if (w > largest)
      {
        largest = w;
        nearest = neighbour;
      }
    });
  return largest < 0.0 || lost > 0.5 ? ShearPixel{} : nearest;
}

/// Where pixels show areas: the best of the samples that are read, or that are nearest to points
/// between samples.
template <class T>
ShearPixel shownOfArea(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, const std::vector<Outline>& met, bool least,
  const glm::dvec3& pixel)
{
  ShearPixel shown;
  T best{};
  for (std::size_t n = 0; n < geometries.size(); ++n)
  {
    if (met[n].cut({ 0, 1 }, pixel).empty())
    {
      continue;
    }
    const ShearImage& image = images[n].ofExtremum(least);
    const T* const pixels = image.row<T>(0);
    areaOf(geometries[n], pixel.x, pixel.y)
      .forPoints(
        [&](double column, double row)
        {
          const auto value = interpolatedAt(image, pixels, column, row);
          if (value != value)
          {
            return;
          }
          const int u = static_cast<int>(std::floor(column + 0.5));
          const int v = static_cast<int>(std::floor(row + 0.5));
          const T sample = image.row<T>(v)[u];
          if (shown.image < 0 || (least ? sample < best : sample > best))
          {
            best = sample;
            shown = { static_cast<int>(n), u, v, least };
          }
        });
  }
  return shown;
}

/// Of pixels that have one.
void findAreaPixels(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  bool least, const glm::ivec2& origin, const glm::ivec2& size, ShearPixel* out)
{
  std::vector<Outline> met;
  for (const ShearWarp& geometry : geometries)
  {
    met.push_back(metByAreas(geometry));
  }
  dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      parallelFor(0, size.y, 16,
        [&](std::ptrdiff_t first, std::ptrdiff_t last)
        {
          for (std::ptrdiff_t n = first * size.x; n < last * size.x; ++n)
          {
            const glm::dvec3 pixel(origin.x + static_cast<double>(n % size.x),
              origin.y + static_cast<double>(n / size.x), 1.0);
            const ShearPixel found = shownOfArea<T>(images, geometries, met, least, pixel);
            out[n] = found.image < 0 ? out[n] : found;
          }
        });
    });
}
}

void findShearPixels(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& origin,
  const glm::ivec2& size, ShearPixel* out, const std::function<bool(const ShearPixel&)>& hasSample)
{
  const bool least = reduction == Reduction::Minimum;
  std::vector<Outline> shown;
  for (const ShearWarp& geometry : geometries)
  {
    shown.push_back(shownBy(geometry));
  }
  parallelFor(0, size.y, 16,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t y = first; y < last; ++y)
      {
        // From the left edge of the viewport, so that rounding selects the same image for a pixel
        // in every rectangle.
        const glm::dvec3 start(0.0, origin.y + static_cast<double>(y), 1.0);
        ShearPixel* const row = out + y * size.x;
        forSpans(
          geometries.size(), start, origin.x + size.x,
          [&](std::size_t n) -> const Outline& { return shown[n]; },
          [&](std::size_t n, const Span& span)
          {
            const glm::dmat3& m = geometries[n].screenToShear();
            for (int x = std::max(span.begin, origin.x); x < span.end; ++x)
            {
              row[x - origin.x] = nearestPixel(images[n].ofExtremum(least),
                { static_cast<int>(n), 0, 0, least }, m * glm::dvec3(x, start.y, 1.0), hasSample);
            }
          },
          [&](const Span& span)
          {
            for (int x = std::max(span.begin, origin.x); x < span.end; ++x)
            {
              row[x - origin.x] = ShearPixel{};
            }
          });
      }
    });
  if (!geometries.empty() && geometries.front().minifiesAnyAxis())
  {
    findAreaPixels(images, geometries, least, origin, size, out);
  }
}

void ShearPixelScalars::find(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& viewport)
{
  Picture place;
  placePicture(geometries, viewport, place);
  this->origin = place.origin;
  this->size = place.size;
  this->Shown.resize(std::size_t(place.size.x) * place.size.y);
  findShearPixels(images, geometries, reduction, place.origin, place.size, this->Shown.data());
}

void ShearPixelScalars::set(const std::vector<ShearImage>& images)
{
  this->type = averageType(images.front().type);
  this->Images = &images;
}

const void* ShearPixelScalars::valuesOfRow(int y, void* space) const
{
  dispatch(this->Images->front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      A* const values = static_cast<A*>(space);
      for (int x = 0; x < this->size.x; ++x)
      {
        const ShearPixel& from = this->Shown[std::ptrdiff_t(y) * this->size.x + x];
        values[x] = from.image < 0
          ? std::numeric_limits<A>::quiet_NaN()
          : static_cast<A>((*this->Images)[from.image].row<T>(from.v)[from.u]);
      }
    });
  return space;
}
}
