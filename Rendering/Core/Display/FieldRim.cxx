// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/FieldRim.h"

#include "Display/Outline.h"
#include "Display/Picture.h"
#include "Projection/Piece.h"
#include "Sampling/FieldOnRay.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace splatting
{
namespace
{
/// Neighbours are one pixel away at most. In parallel views the length in the field is concave: if
/// it reaches one pixel further, no neighbour's is less than half of another one's.
constexpr double RimWidth = 2.0 + 1e-6;

/// Ways through the field of which a few voxels are all there is.
constexpr double ShortWay = 3.0;

/// The box in which rays see the field: of what an eye is inside of only what lies before it.
Cuboid seenBox(const ShearWarp& geometry)
{
  const Span& slices = geometry.slices();
  Cuboid box = shownBox(geometry);
  box.low.z = std::max(box.low.z, geometry.faces(slices.begin).x);
  box.high.z = std::min(box.high.z, geometry.faces(slices.end - 1).y);
  return box;
}

/// How far a ray is in the field; 0 or less if it misses it.
double wayOf(const ShearWarp& geometry, const FieldRay& ray)
{
  const glm::dvec2 depths = depthsInField(geometry, ray);
  return depths.y - depths.x;
}

/// For each row of an image the pixels that see the field.
std::vector<Span> fieldSpans(const ShearImage& image, const ShearWarp& geometry)
{
  std::vector<Span> spans(geometry.rayCount().y);
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    const auto misses = [&](int u) { return wayOf(geometry, rayOfPixel(geometry, u, v)) <= 0.0; };
    Span& span = spans[v];
    span = common(image.spans[v], { 0, geometry.rayCount().x });
    for (; !span.empty() && misses(span.begin); ++span.begin)
    {
    }
    for (; !span.empty() && misses(span.end - 1); --span.end)
    {
    }
  }
  return spans;
}

/// Finds the maxima along the own rays of one image's pixels.
template <class T>
class RimFinder
{
public:
  using A = Accumulator<T>;

  RimFinder(const ShearImage& image, const ShearWarp& geometry, const FieldRimSource& source,
    const Cuts& cuts)
    : Image(image),
      Geometry(geometry),
      Removed(cuts),
      Seen(fieldSpans(image, geometry)),
      Part(partOf(geometry, source)),
      Interior(interiorOf({ this->Part.first(), this->Part.first() + this->Part.size() },
        geometry.size(), glm::ivec3(reachOf(Quality::Exact).layers()))),
      Selects(cuts.cropping.cuts() || this->Interior.begin != glm::ivec3(0) ||
        this->Interior.end != geometry.size()),
      Voxels(source.volume, this->Part),
      Field(this->Voxels, geometry, this->Part.first())
  {
  }

  /// NaN if the pixel is interpolated.
  A find(const glm::dvec3& homogeneous) const
  {
    const glm::dvec2 pixel = glm::dvec2(homogeneous) / homogeneous.z;
    const FieldRay ray = rayThrough(this->Geometry, pixel);
    const glm::dvec2 depths = depthsInField(this->Geometry, ray);
    Extremum best{ 0.0 };
    if (depths.x < depths.y + Touch && this->isAtRim(pixel, depths.y - depths.x))
    {
      this->takeSlices(pixel, ray, depths, best);
    }
    return best.value > -std::numeric_limits<double>::infinity()
      ? static_cast<A>(best.value)
      : std::numeric_limits<A>::quiet_NaN();
  }

private:
  static ShearWarp partOf(const ShearWarp& geometry, const FieldRimSource& source)
  {
    ShearWarp part;
    geometry.findPart(source.first, source.volume.dimensions, part);
    return part;
  }

  /// Calls f(u, v, weight) for the pixels that one is interpolated between.
  template <class F>
  static void forNeighbours(const glm::dvec2& pixel, F&& f)
  {
    const glm::dvec2 low = glm::floor(pixel), share = pixel - low;
    for (int n = 0; n < 4; ++n)
    {
      const int i = n & 1, j = n >> 1;
      const double weight = (i ? share.x : 1.0 - share.x) * (j ? share.y : 1.0 - share.y);
      if (weight > 0.0)
      {
        f(static_cast<int>(low.x) + i, static_cast<int>(low.y) + j, weight);
      }
    }
  }

  /// @param way  of the pixel's own ray through the field
  bool isAtRim(const glm::dvec2& pixel, double way) const
  {
    bool misses = false;
    forNeighbours(pixel, [&](int u, int v, double) { misses = misses || !this->sees(u, v); });
    if (misses || way >= ShortWay)
    {
      return misses;
    }
    double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
    forNeighbours(pixel,
      [&](int u, int v, double)
      {
        const double neighbour = wayOf(this->Geometry, rayOfPixel(this->Geometry, u, v));
        shortest = std::min(shortest, neighbour);
        longest = std::max(longest, neighbour);
      });
    return shortest < 0.5 * longest;
  }
  bool sees(int u, int v) const
  {
    return v >= 0 && v < static_cast<int>(this->Seen.size()) && u >= this->Seen[v].begin &&
      u < this->Seen[v].end;
  }

  void takeSlices(
    const glm::dvec2& pixel, const FieldRay& ray, glm::dvec2 depths, Extremum& best) const
  {
    if (!(depths.x < depths.y))
    {
      const double middle = 0.5 * (depths.x + depths.y);
      depths = { middle - 0.5 * Touch, middle + 0.5 * Touch };
    }
    const Span slices = this->slicesOf(pixel);
    this->Field.take(
      ray, depths, false,
      [&](int k)
      { return k >= slices.begin && k < slices.end && (!this->Selects || this->counts(ray, k)); },
      best);
  }

  /// Those in the interval of the nearest neighbour that has a sample.
  Span slicesOf(const glm::dvec2& pixel) const
  {
    Span slices = this->Geometry.slices();
    double heaviest = 0.0;
    forNeighbours(pixel,
      [&](int u, int v, double weight)
      {
        if (!this->Removed.intervals.empty() && weight > heaviest && this->Image.covers(u, v))
        {
          heaviest = weight;
          slices = common(this->Geometry.slices(),
            { this->Removed.intervals.first(v)[u], this->Removed.intervals.last(v)[u] + 1 });
        }
      });
    return slices;
  }

  /// Whether cropping shows the sample and, of a piece, whether it is this piece's.
  bool counts(const FieldRay& ray, int k) const
  {
    const glm::dvec2 at(ray(0, k), ray(1, k));
    const glm::ivec3 nearest =
      glm::clamp(glm::ivec3(glm::floor(at + 0.5), k), glm::ivec3(0), this->Geometry.size() - 1);
    for (int a = 0; a < 3; ++a)
    {
      if (nearest[a] < this->Interior.begin[a] || nearest[a] >= this->Interior.end[a])
      {
        return false;
      }
    }
    return !this->Removed.cropping.cuts() || isShown(this->Removed.cropping, this->Geometry, at, k);
  }

  /// Pixels on the outline may miss the field by rounding.
  static constexpr double Touch = 1e-6;

  const ShearImage& Image;
  const ShearWarp& Geometry;
  const Cuts& Removed;
  std::vector<Span> Seen;
  ShearWarp Part;
  Box Interior;
  bool Selects; // whether not all slices of its intervals count
  PermutedVoxels<T> Voxels;
  FieldOnRay<T> Field;
};
}

/// Which pixels have values; their number.
std::size_t FieldRim::findRows(const std::vector<ShearWarp>& geometries, const glm::ivec2& viewport)
{
  Picture place;
  placePicture(geometries, viewport, place);
  this->Images = geometries.size();
  this->Origin = place.origin;
  this->Rows.resize(place.size.y * this->Images);
  for (std::size_t n = 0; n < this->Images; ++n)
  {
    const Outline shown = shownBy(geometries[n]);
    Outline inside = shown;
    inside.add(seenBox(geometries[n]), RimWidth);
    for (int y = 0; y < place.size.y; ++y)
    {
      const glm::dvec3 start(place.origin.x, place.origin.y + static_cast<double>(y), 1.0);
      Row& row = this->Rows[y * this->Images + n];
      row.shown = shown.cut({ 0, place.size.x }, start);
      row.shown.end = std::max(row.shown.begin, row.shown.end);
      row.inside = inside.cut(row.shown, start);
      if (row.inside.empty())
      {
        row.inside = { row.shown.end, row.shown.end };
      }
    }
  }
  std::size_t count = 0;
  for (Row& row : this->Rows)
  {
    row.first = count;
    count += row.count();
  }
  return count;
}

void FieldRim::find(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  const FieldRimSource& source, const glm::ivec2& viewport)
{
  const std::size_t count = this->findRows(geometries, viewport);
  const int rows = static_cast<int>(this->Images ? this->Rows.size() / this->Images : 0);
  this->Values.width = static_cast<int>(count);
  this->Values.height = 1;
  this->Values.spans.assign(1, { 0, this->Values.width });
  this->Values.special = true;
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
      for (std::size_t n = 0; n < this->Images; ++n)
      {
        const RimFinder<T> finder(images[n], geometries[n], source, (*source.cuts)[n]);
        const glm::dmat3& m = geometries[n].screenToShear();
        vtkSMPTools::For(0, rows, 4,
          [&](vtkIdType first, vtkIdType last)
          {
            for (vtkIdType y = first; y < last; ++y)
            {
              const Row& row = this->Rows[y * this->Images + n];
              A* out = values + row.first;
              for (int x = row.shown.begin; x < row.shown.end; ++x)
              {
                x = x == row.inside.begin ? row.inside.end : x;
                if (x < row.shown.end)
                {
                  *out++ = finder.find(m *
                    glm::dvec3(this->Origin.x + x, this->Origin.y + static_cast<double>(y), 1.0));
                }
              }
            }
          });
      }
    });
}
}
