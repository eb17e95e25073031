// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact mode on the screen: the largest value that the ray of a screen pixel finds.
 *
 * A shear image has one ray, or a few, for each voxel, and the screen's rays lie between them. What
 * is interpolated between the values of four rays need not be anything that the field has. But
 * where they have their maxima, the ray between them nearly always has its own. So it looks in the
 * slices of these maxima, and in the slices beside them. At the field's rim, where one of the
 * four rays is in the field for less than half as long as another, and where it does not meet the
 * middle of a maximum's slice, it looks in all slices that can have more.
 */
#ifndef splattingRayFinder_h
#define splattingRayFinder_h

#include "Clipping/Cuts.h"
#include "Clipping/SceneDepth.h"
#include "Kernels/Kernels.h"
#include "Projection/Piece.h"
#include "Projection/ShearImage.h"
#include "Sampling/FieldOnRay.h"
#include "Volume/VolumeIndex.h"

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
  VolumeIndex* index = nullptr;            ///< whose bricks tell which slices can be left out
};

/// A pixel of the screen, and where it lies between a shear image's.
struct ScreenPixel
{
  glm::ivec2 screen;
  glm::ivec2 low;   ///< the first of the four pixels around it
  glm::dvec2 share; ///< of the way to the next column and row

  ScreenPixel(const ShearWarp& geometry, const glm::ivec2& pixel) : screen(pixel)
  {
    const glm::dvec3 homogeneous = geometry.screenToShear() * glm::dvec3(glm::dvec2(pixel), 1.0);
    const glm::dvec2 shear = glm::dvec2(homogeneous) / homogeneous.z;
    for (int a = 0; a < 2; ++a)
    {
      this->low[a] = floorOf(shear[a]);
      this->share[a] = shear[a] - this->low[a];
    }
  }

  /// Calls f(u, v, weight) for the pixels that it is interpolated between.
  template <class F>
  void forNeighbours(F&& f) const
  {
    for (int n = 0; n < 4; ++n)
    {
      const int i = n & 1, j = n >> 1;
      const double weight =
        (i ? this->share.x : 1.0 - this->share.x) * (j ? this->share.y : 1.0 - this->share.y);
      if (weight > 0.0)
      {
        f(this->low.x + i, this->low.y + j, weight);
      }
    }
  }
};

/// The depths at which each column (axis 0) or row (1) of an image's rays is in the field, as far
/// as that side of it is concerned.
std::vector<glm::dvec2> depthsOf(const ShearWarp& geometry, int axis);

/// Where to look along a ray.
struct Way
{
  FieldRay ray;
  glm::dvec2 shown{ 0.0, -1.0 }; ///< where it is in the field and not cut away
  std::array<int, 4> winners;    ///< slices of those of the four rays around it, in order
  int count = 0;
  bool isWhole = false; ///< whether to look along all of it, else near winners

  /// Calls f(depths) from the slice before to the slice behind each winner.
  template <class F>
  void forWinners(F&& f) const
  {
    for (int n = 0; n < this->count;)
    {
      glm::dvec2 some(this->winners[n] - 1, this->winners[n] + 1);
      while (++n < this->count && this->winners[n] - 1 <= some.y)
      {
        some.y = this->winners[n] + 1;
      }
      f(commonDepths(this->shown, some));
    }
  }
};

constexpr int VoxelsOfSegment = 2 * 3 * 3; ///< slices, rows, columns

/// The voxels of segments as FieldSegments has them, but of their own type.
template <class T>
using VoxelsOfSegments = std::array<T, VoxelsOfSegment * FieldSegments<Accumulator<T>>::most>;

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
      Extent(geometry),
      Columns(depthsOf(geometry, 0)),
      Rows(depthsOf(geometry, 1)),
      Part(partOf(geometry, source)),
      First(Part.first()),
      Last(geometry.size() - 1),
      Interior(interiorOf({ this->Part.first(), this->Part.first() + this->Part.size() },
        geometry.size(), glm::ivec3(reachOf(Quality::Exact).layers()))),
      Selects(cuts.cropping.cuts() || this->Interior.begin != glm::ivec3(0) ||
        this->Interior.end != geometry.size()),
      Bricks(source.index ? &source.index->bricks(geometry.principalAxis()) : nullptr),
      Voxels(source.volume, this->Part),
      Field(this->Voxels, geometry, this->Part.first())
  {
    this->findOffsets();
  }

  /// The maximum on a pixel's ray; minus infinity if it meets no sample.
  Extremum find(const ScreenPixel& pixel) const
  {
    Extremum best{ 0.0 };
    const Way way = this->wayOf(pixel);
    const auto take = [&](const glm::dvec2& depths)
    {
      this->Field.take(
        way.ray, depths, false, [&](int k) { return this->isShown(way.ray, k); }, best);
    };
    way.isWhole ? take(way.shown) : way.forWinners(take);
    return best;
  }

  /// Where to look along a pixel's ray.
  Way wayOf(const ScreenPixel& pixel) const
  {
    Way way;
    way.ray = rayBetween(this->Geometry, pixel.low, pixel.share);
    const glm::dvec2 field = this->Extent.depths(way.ray);
    if (!(field.x < field.y + Touch))
    {
      return way;
    }
    glm::dvec2 shown = this->shownDepths(pixel);
    if (this->Scene)
    {
      this->Scene->endRay(
        this->Geometry, pixel.screen, way.ray.at, way.ray.slope, shown.x, shown.y);
    }
    way.shown = commonDepths(field, shown);
    // What is thinner than rounding is looked at as well.
    if (std::abs(way.shown.y - way.shown.x) < Touch)
    {
      way.shown = 0.5 * (way.shown.x + way.shown.y) + glm::dvec2(-0.5, 0.5) * Touch;
    }
    this->findWinners(pixel, way);
    way.isWhole = this->isAtRim(pixel) ||
      std::any_of(way.winners.begin(), way.winners.begin() + way.count,
        [&](int k) { return k < way.shown.x || k > way.shown.y || !this->isShown(way.ray, k); });
    return way;
  }

  /// Calls f(ray, k, depths) for the segments of a ray that are near winners, each between slices k
  /// and k + 1.
  template <class F>
  void forPartsAtWinners(const Way& way, F&& f) const
  {
    way.forWinners([&](const glm::dvec2& depths) { this->forSegments(way.ray, depths, f); });
  }

  /// The same for all its segments that can have more than a value.
  template <class F>
  void forPartsAbove(Accumulator<T> value, const Way& way, F&& f) const
  {
    for (glm::dvec2 some = way.shown; some.x < way.shown.y; some.x = some.y)
    {
      const int layer = floorOf(some.x + BrickDepth) / BrickDepth; // the next one
      some.y = std::min<double>(way.shown.y, layer * BrickDepth);
      if (!this->Bricks || this->boundOf(way.ray, some) > value)
      {
        this->forSegments(way.ray, some, f);
      }
    }
  }

  /// Adds such a segment to those that are looked at together.
  void add(const FieldRay& ray, int k, const glm::dvec2& depths,
    FieldSegments<Accumulator<T>>& segments) const
  {
    const int n = segments.count++;
    for (int a = 0; a < 2; ++a)
    {
      segments.at[a][n] = ray.at[a];
      segments.slope[a][n] = ray.slope[a];
    }
    segments.begin[n] = depths.x;
    segments.end[n] = depths.y;
    segments.first[2][n] = k;
  }

  /// Finds the largest value of each segment.
  /// @param voxels  room for those that the segments need
  void findLargest(FieldSegments<Accumulator<T>>& segments, VoxelsOfSegments<T>& voxels,
    const Kernels& kernels) const
  {
    const WorksheetLoops<Accumulator<T>>& along = kernels;
    const VoxelLoops<T>& widening = kernels;
    constexpr int most = FieldSegments<Accumulator<T>>::most;
    along.placeSegments(segments, this->Geometry.reference(), &this->Last.x);
    this->load(segments, voxels);
    widening.widen(
      voxels.data(), most, segments.voxels[0][0][0], most, 0, segments.count, VoxelsOfSegment, 0);
    along.findLargest(segments);
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
  bool isAtRim(const ScreenPixel& pixel) const
  {
    double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
    pixel.forNeighbours(
      [&](int u, int v, double)
      {
        const double length = this->lengthInField(u, v);
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      });
    return !(shortest > 0.0 && shortest >= 0.5 * longest);
  }
  /// How much of an image's ray is in the field; none if the ray has no pixel.
  double lengthInField(int u, int v) const
  {
    if (!this->Image.meetsVolume(u, v) || u >= static_cast<int>(this->Columns.size()))
    {
      return 0.0;
    }
    const glm::dvec2 depths = commonDepths(this->Columns[u], this->Rows[v]);
    return depths.y - depths.x;
  }

  void findWinners(const ScreenPixel& pixel, Way& way) const
  {
    pixel.forNeighbours(
      [&](int u, int v, double)
      {
        // Beside the image there is none.
        const std::int32_t step = this->Image.meetsVolume(u, v)
          ? this->Image.winners[static_cast<std::size_t>(v) * this->Image.width + u]
          : -1;
        if (step < 0)
        {
          return;
        }
        const int k = step / StepsPerSlice;
        int n = way.count++;
        for (; n > 0 && way.winners[n - 1] > k; --n)
        {
          way.winners[n] = way.winners[n - 1];
        }
        way.winners[n] = k;
      });
  }

  /// Where the ray is cut: as the four rays that have samples are in the mean, where they are cut
  /// at nearly the same depth, else as the nearest of them.
  glm::dvec2 shownDepths(const ScreenPixel& pixel) const
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
    pixel.forNeighbours(
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

  /// Calls f(ray, k, depths) for the segments of a ray between depths.
  template <class F>
  void forSegments(const FieldRay& ray, const glm::dvec2& depths, F&& f) const
  {
    for (int k = floorOf(depths.x); k < depths.y; ++k)
    {
      glm::dvec2 some(std::max<double>(depths.x, k), std::min<double>(depths.y, k + 1));
      if (!this->Selects || this->narrow(ray, k, some))
      {
        f(ray, k, some);
      }
    }
  }

  /// The largest voxel of the bricks that a ray meets between depths; no segment has more.
  T boundOf(const FieldRay& ray, const glm::dvec2& depths) const
  {
    constexpr int widths[3] = { BrickWidth, BrickHeight, BrickDepth };
    glm::ivec3 low, high;
    for (int a = 0; a < 3; ++a)
    {
      const double p = ray(a, depths.x), q = ray(a, depths.y);
      const int last = this->Part.size()[a] - 1;
      low[a] = std::clamp(floorOf(std::min(p, q)) - this->First[a], 0, last) / widths[a];
      high[a] = std::clamp(floorOf(std::max(p, q)) + 1 - this->First[a], 0, last) / widths[a];
    }
    T bound = this->Bricks->template row<T>(low.y, low.z)[low.x];
    for (int k = low.z; k <= high.z; ++k)
    {
      for (int j = low.y; j <= high.y; ++j)
      {
        const T* const row = this->Bricks->template row<T>(j, k);
        bound = std::max(bound, *std::max_element(row + low.x, row + high.x + 1));
      }
    }
    return bound;
  }

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

  /// Fetches the voxels that segments need. A loop of its own, because nothing in it has to be
  /// waited for: the memory that several segments need is fetched at the same time.
  void load(const FieldSegments<Accumulator<T>>& segments, VoxelsOfSegments<T>& voxels) const
  {
    constexpr int most = FieldSegments<Accumulator<T>>::most;
    const T* const origin = this->Voxels.pointer(0, 0, 0);
    for (int n = 0; n < segments.count; ++n)
    {
      const std::ptrdiff_t* places[3];
      for (int a = 0; a < 3; ++a)
      {
        places[a] = this->Offsets[a].data() + (segments.first[a][n] + Beyond);
      }
      T* to = voxels.data() + n;
      for (int z = 0; z < 2; ++z)
      {
        for (int y = 0; y < 3; ++y)
        {
          const T* const row = origin + (places[2][z] + places[1][y]);
          for (int x = 0; x < 3; ++x, to += most)
          {
            *to = row[places[0][x]];
          }
        }
      }
    }
  }

  /// How far voxels lie from the segment's first ones, by their indices along an axis. Beyond the
  /// volume its outermost voxels are repeated. A table, since each segment asks for nine of them.
  void findOffsets()
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Offsets[a].reserve(this->Last[a] + 2 * Beyond + 1);
      for (int n = -Beyond; n <= this->Last[a] + Beyond; ++n)
      {
        this->Offsets[a].push_back(
          (std::clamp(n, 0, this->Last[a]) - this->First[a]) * this->Voxels.stride(a));
      }
    }
  }

  static constexpr int Beyond = FieldSegments<Accumulator<T>>::beyond;
  /// Slices between the depths at which neighbours are cut if it is by the same thing.
  static constexpr double Together = 3.0;
  /// Pixels on the outline may miss the field by rounding.
  static constexpr double Touch = 1e-6;

  const ShearImage& Image;
  const ShearWarp& Geometry;
  const Cuts& Removed;
  const SceneDepth* Scene;
  FieldBox Extent;
  std::vector<glm::dvec2> Columns, Rows; // the depths at which their rays may be in the field
  ShearWarp Part;
  glm::ivec3 First, Last; // voxels, of the part and of the volume
  Box Interior;
  bool Selects; // whether cropping or being a piece leaves out some
  const BrickMaxima* Bricks;
  PermutedVoxels<T> Voxels;
  FieldOnRay<T> Field;
  std::array<std::vector<std::ptrdiff_t>, 3> Offsets;
};
}

#endif
