// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact mode on the screen: the largest value that the ray of a screen pixel finds.
 *
 * A shear image has one ray, or a few, for each voxel, and the screen's rays lie between them. What
 * is interpolated between the values of four rays need not be anything that the field has. But
 * where they have their maxima, the ray between them nearly always has its own. So it looks in the
 * slices of these maxima, and in the slices beside them. At the field's rim, where one of the
 * four rays is in the field for less than half as long as another, it looks in all slices.
 */
#ifndef splattingRayFinder_h
#define splattingRayFinder_h

#include "Clipping/Cuts.h"
#include "Clipping/SceneDepth.h"
#include "Kernels/Kernels.h"
#include "Projection/Piece.h"
#include "Projection/ShearImage.h"
#include "Sampling/FieldOnRay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace splatting
{
/// Where rays look.
struct RaySource
{
  VoxelArray volume;                       ///< or a piece of it, or without voxels none of it
  glm::ivec3 first{ 0 };                   ///< the piece's first voxel
  const std::vector<Cuts>* cuts = nullptr; ///< of each image
  const SceneDepth* depth = nullptr;       ///< of what else is in the scene, if there is anything
};

/// A pixel of the screen, and where it lies between a shear image's.
struct ScreenPixel
{
  glm::ivec2 screen;
  glm::dvec2 shear;

  ScreenPixel(const ShearWarp& geometry, const glm::ivec2& pixel) : screen(pixel)
  {
    const glm::dvec3 homogeneous = geometry.screenToShear() * glm::dvec3(glm::dvec2(pixel), 1.0);
    this->shear = glm::dvec2(homogeneous) / homogeneous.z;
  }
};

/// The depths at which each column (axis 0) or row (1) of an image's rays is in the field, as far
/// as that side of it is concerned.
std::vector<glm::dvec2> depthsOf(const ShearWarp& geometry, int axis);

/// Calls f(u, v, weight) for the pixels of an image that a point is interpolated between.
template <class F>
void forWeightedPixels(const glm::dvec2& pixel, F&& f)
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

/**
 * Finds the maxima along the rays of one image's screen pixels.
 *
 * Cropping cuts rays as it does in the image: a slice counts if the ray crosses its middle in a
 * region that is shown. All else cuts them at the depth where it lies, as the four rays tell it.
 */
template <class T>
class RayFinder
{
public:
  /// All must outlive its use.
  /// @param image  with winners, and with the spans and the mask of the whole volume
  RayFinder(
    const ShearImage& image, const ShearWarp& geometry, const RaySource& source, const Cuts& cuts)
    : Image(image),
      Geometry(geometry),
      Removed(cuts),
      Scene(source.depth),
      Columns(depthsOf(geometry, 0)),
      Rows(depthsOf(geometry, 1)),
      Part(partOf(geometry, source)),
      First(Part.first()),
      Last(geometry.size() - 1),
      Interior(interiorOf({ this->Part.first(), this->Part.first() + this->Part.size() },
        geometry.size(), glm::ivec3(reachOf(Quality::Exact).layers()))),
      Selects(cuts.cropping.cuts() || this->Interior.begin != glm::ivec3(0) ||
        this->Interior.end != geometry.size()),
      Voxels(source.volume, this->Part),
      Field(this->Voxels, geometry, this->Part.first())
  {
  }

  /// The maximum on a pixel's ray; minus infinity if it meets no sample.
  Extremum find(const ScreenPixel& pixel) const
  {
    Extremum best{ 0.0 };
    this->forWays(pixel,
      [&](const FieldRay& ray, const glm::dvec2& depths)
      {
        this->Field.take(
          ray, depths, false, [&](int k) { return this->isShown(ray, k); }, best);
      });
    return best;
  }

  /// Calls f(ray, k, depths) for the parts of the same ray, each between slices k and k + 1.
  template <class F>
  void forParts(const ScreenPixel& pixel, F&& f) const
  {
    this->forWays(pixel,
      [&](const FieldRay& ray, const glm::dvec2& depths)
      {
        for (int k = floorOf(depths.x); k < depths.y; ++k)
        {
          glm::dvec2 some(std::max<double>(depths.x, k), std::min<double>(depths.y, k + 1));
          if (!this->Selects || this->narrow(ray, k, some))
          {
            f(ray, k, some);
          }
        }
      });
  }

  /// Adds such a part to those that are looked at together.
  void add(
    const FieldRay& ray, int k, const glm::dvec2& depths, FieldParts<Accumulator<T>>& parts) const
  {
    using A = Accumulator<T>;
    const int n = parts.count++;
    const glm::dvec2 at(ray(0, k), ray(1, k));
    const glm::dvec2 from = depths - double(k);
    const glm::dvec2 low = glm::min(at + from.x * ray.slope, at + from.y * ray.slope);
    const int i = floorOf(low.x), j = floorOf(low.y);
    parts.x[n] = static_cast<A>(at.x - i);
    parts.y[n] = static_cast<A>(at.y - j);
    parts.dx[n] = static_cast<A>(ray.slope.x);
    parts.dy[n] = static_cast<A>(ray.slope.y);
    parts.from[n] = static_cast<A>(from.x);
    parts.to[n] = static_cast<A>(from.y);
    const T* const voxels = this->Voxels.pointer(0, 0, 0);
    const std::array<std::ptrdiff_t, 3> columns{ this->place(0, i), this->place(0, i + 1),
      this->place(0, i + 2) };
    for (int z = 0; z < 2; ++z)
    {
      for (int y = 0; y < 3; ++y)
      {
        const T* const row = voxels + this->place(2, k + z) + this->place(1, j + y);
        for (int x = 0; x < 3; ++x)
        {
          parts.voxels[z][y][x][n] = static_cast<A>(row[columns[x]]);
        }
      }
    }
  }

private:
  static ShearWarp partOf(const ShearWarp& geometry, const RaySource& source)
  {
    ShearWarp part;
    geometry.findPart(source.first, source.volume.dimensions, part);
    return part;
  }

  /// Whether one of the four rays misses the field, or is in it for less than half as long as
  /// another.
  bool isAtRim(const glm::dvec2& pixel) const
  {
    double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
    forWeightedPixels(pixel,
      [&](int u, int v, double)
      {
        const double way = this->wayOf(u, v);
        shortest = std::min(shortest, way);
        longest = std::max(longest, way);
      });
    return !(shortest > 0.0 && shortest >= 0.5 * longest);
  }
  /// How much of an image's ray is in the field; none if the ray has no pixel.
  double wayOf(int u, int v) const
  {
    if (!this->Image.meetsVolume(u, v) || u >= static_cast<int>(this->Columns.size()))
    {
      return 0.0;
    }
    const glm::dvec2 depths = commonDepths(this->Columns[u], this->Rows[v]);
    return depths.y - depths.x;
  }

  /// Calls f(ray, depths) for the parts of the ray that are looked at: from the slice before to the
  /// slice behind the winners of the four rays around it, or all of it at the field's rim and where
  /// it does not meet the middle of a winner's slice, or that is cut away.
  template <class F>
  void forWays(const ScreenPixel& pixel, F&& f) const
  {
    const FieldRay ray = rayThrough(this->Geometry, pixel.shear);
    const glm::dvec2 field = depthsInField(this->Geometry, ray);
    if (!(field.x < field.y + Touch))
    {
      return;
    }
    glm::dvec2 all = this->shownDepths(pixel.shear);
    if (this->Scene)
    {
      this->Scene->endRay(this->Geometry, pixel.screen, ray.at, ray.slope, all.x, all.y);
    }
    all = { std::max(field.x, all.x), std::min(field.y, all.y) };
    // What is thinner than rounding is looked at as well.
    if (std::abs(all.y - all.x) < Touch)
    {
      all = 0.5 * (all.x + all.y) + glm::dvec2(-0.5, 0.5) * Touch;
    }
    const bool isAtRim = this->isAtRim(pixel.shear);
    std::array<int, 4> slices;
    const int count = isAtRim ? 0 : this->findWinners(pixel.shear, slices);
    if (isAtRim ||
      std::any_of(slices.begin(), slices.begin() + count,
        [&](int k) { return k < all.x || k > all.y || !this->isShown(ray, k); }))
    {
      f(ray, all);
      return;
    }
    for (int n = 0; n < count;)
    {
      glm::dvec2 some(slices[n] - 1, slices[n] + 1);
      while (++n < count && slices[n] - 1 <= some.y)
      {
        some.y = slices[n] + 1;
      }
      f(ray, glm::dvec2(std::max(all.x, some.x), std::min(all.y, some.y)));
    }
  }

  /// The slices of the four rays' winners in ascending order, and how many they are.
  int findWinners(const glm::dvec2& pixel, std::array<int, 4>& slices) const
  {
    int count = 0;
    forWeightedPixels(pixel,
      [&](int u, int v, double)
      {
        const std::int32_t step =
          this->Image.winners[static_cast<std::size_t>(v) * this->Image.width + u];
        if (step < 0)
        {
          return;
        }
        const int k = step / StepsPerSlice;
        int n = count++;
        for (; n > 0 && slices[n - 1] > k; --n)
        {
          slices[n] = slices[n - 1];
        }
        slices[n] = k;
      });
    return count;
  }

  /// Where the ray is cut: as the four rays that have samples are in the mean, where they are cut
  /// at nearly the same depth, else as the nearest of them.
  glm::dvec2 shownDepths(const glm::dvec2& pixel) const
  {
    const Span& slices = this->Geometry.slices();
    const glm::dvec2 all(slices.begin - 0.5, slices.end - 0.5);
    const RayIntervals& intervals = this->Removed.intervals;
    if (intervals.empty())
    {
      return all;
    }
    constexpr double infinite = std::numeric_limits<double>::infinity();
    glm::dvec2 shown = all, sum(0.0), least(infinite), most(-infinite);
    double heaviest = 0.0, weights = 0.0;
    forWeightedPixels(pixel,
      [&](int u, int v, double weight)
      {
        if (this->Image.covers(u, v))
        {
          const glm::dvec2 own = intervals.depths(u, v);
          shown = weight > heaviest ? own : shown;
          heaviest = std::max(heaviest, weight);
          least = glm::min(least, own);
          most = glm::max(most, own);
          sum += weight * own;
          weights += weight;
        }
      });
    for (int a = 0; a < 2 && weights > 0.0; ++a)
    {
      shown[a] = most[a] - least[a] <= Together ? sum[a] / weights : shown[a];
    }
    return glm::clamp(shown, all.x, all.y);
  }

  /// Of depths that are at least -1, which is faster than std::floor().
  static int floorOf(double x) { return static_cast<int>(x + 1.0) - 1; }

  /// Whether cropping shows the sample in slice k.
  bool isShown(const FieldRay& ray, int k) const
  {
    return !this->Removed.cropping.cuts() ||
      splatting::isShown(this->Removed.cropping, this->Geometry, { ray(0, k), ray(1, k) }, k);
  }

  /// Narrows depths between slices k and k + 1 to the halves that belong to samples that count.
  /// False if none does, or if it is not for this piece of the volume to look there.
  bool narrow(const FieldRay& ray, int k, glm::dvec2& depths) const
  {
    const glm::ivec3 nearest =
      glm::clamp(glm::ivec3(floorOf(ray(0, k) + 0.5), floorOf(ray(1, k) + 0.5), k), glm::ivec3(0),
        this->Geometry.size() - 1);
    for (int a = 0; a < 3; ++a)
    {
      if (nearest[a] < this->Interior.begin[a] || nearest[a] >= this->Interior.end[a])
      {
        return false;
      }
    }
    depths.x = this->isShown(ray, k) ? depths.x : std::max(depths.x, k + 0.5);
    depths.y = this->isShown(ray, k + 1) ? depths.y : std::min(depths.y, k + 0.5);
    return depths.x < depths.y;
  }

  /// How far the voxels with an index along an axis lie from the part's first ones. Beyond the
  /// volume its outermost voxels are repeated.
  std::ptrdiff_t place(int axis, int index) const
  {
    return (std::clamp(index, 0, this->Last[axis]) - this->First[axis]) * this->Voxels.stride(axis);
  }

  /// Slices between the depths at which neighbours are cut if it is by the same thing.
  static constexpr double Together = 3.0;
  /// Pixels on the outline may miss the field by rounding.
  static constexpr double Touch = 1e-6;

  const ShearImage& Image;
  const ShearWarp& Geometry;
  const Cuts& Removed;
  const SceneDepth* Scene;
  std::vector<glm::dvec2> Columns, Rows; // the depths at which their rays may be in the field
  ShearWarp Part;
  glm::ivec3 First, Last; // voxels, of the part and of the volume
  Box Interior;
  bool Selects; // whether cropping or being a piece leaves out some
  PermutedVoxels<T> Voxels;
  FieldOnRay<T> Field;
};
}

#endif
