// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Data that all parts of one projection share.
 */
#ifndef splattingProjectionContext_h
#define splattingProjectionContext_h

#include "Geometry/AxisSteps.h"
#include "Kernels/Kernels.h"
#include "Splat/Projection/ShearImage.h"
#include "Volume/VolumeIndex.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace splatting
{
/// One slice in the image.
struct SliceGeometry
{
  RayPath path;             ///< of parallel views
  int vBegin = 0, vEnd = 0; ///< image rows whose rays cross the slice
  int innerBegin = 0,
      innerEnd = 0;               ///< rows whose whole path is in it: all but a few at either end
  Span inner;                     ///< pixels of the slice in these rows
  std::vector<Span> lower, upper; ///< and in each row before and after

  const Span& span(int v) const
  {
    return v < this->innerBegin ? this->lower[v - this->vBegin]
      : v < this->innerEnd      ? this->inner
                                : this->upper[v - this->innerEnd];
  }
};

/// The voxels that rays of a perspective image cross.
struct PerspectiveSteps
{
  AxisSteps columns, rows;

  /// The voxels of one pixel's ray in slice k. Those outside the volume may be reported nearer to
  /// it than they are.
  RayPath path(int u, int v, int k) const;
};

/// @param steps  of perspective images, else ignored
std::vector<SliceGeometry>& findSlices(const ShearWarp& geometry,
  std::vector<SliceGeometry>& slices, const PerspectiveSteps& steps = {});

/// The slices that the rays of a row of pixels cross.
class CrossedSlices
{
public:
  /// The slices must outlive their use.
  void reset(const std::vector<SliceGeometry>& slices, int width);
  /// The first and the last slice of each pixel; first > last if there are none.
  void find(int v, std::int16_t* first, std::int16_t* last) const;

private:
  const std::vector<SliceGeometry>* Slices = nullptr;
  std::vector<std::int16_t> First, Last; // for rows whose paths are in all slices
};

class CutMap;
class ProgressObserver;
struct OutlineSpace;
struct ProjectionSettings;
struct WalkSpace;

/// Sets size and spans of an image and, if samples are cut away, its mask.
void outlineImage(const ShearWarp& geometry, const std::vector<SliceGeometry>& slices,
  const CutMap& cuts, OutlineSpace& space, ShearImage& image);

/// Tiles in a walk, and those that it splatted.
struct TileCount
{
  std::int64_t met = 0;
  std::int64_t splatted = 0;
};

/// One projection of a volume, for any voxel type.
struct ProjectionContext
{
  VolumeIndex& index;
  const ProjectionSettings& settings;
  const ShearWarp& geometry;
  const ShearWarp& whole; // of which `geometry` is a part, or the same
  const Kernels& kernels;
  VolumeIndex::Range range;
  const std::vector<SliceGeometry>& sliceGeometry;
  const PerspectiveSteps& steps;
  const CutMap& cuts;
  double floor; // as in ProjectionSettings
  ShearImage& image;
  WalkSpace& space;
  ProgressObserver& observer;
  /// The kind of walk: all samples, ray by ray; along chains; with bricks; or densely.
  bool byRays;
  const LineIndex* lines;
  const BrickMaxima* bricks;

  Slices slices = {}; // the current ones
  TileCount count = {};

  template <class T>
  const T* voxelRow(int j, int k) const
  {
    return static_cast<const T*>(this->slices.voxels) + j * this->slices.rowStride +
      k * this->slices.sliceStride;
  }

  /// The pixels of row v in [vBegin, vEnd) whose rays cross slice k.
  const Span& pixels(int v, int k) const { return this->sliceGeometry[k].span(v); }
};

/// The distance beyond the volume at which worksheets may read: a footprint and the drift of a
/// slice. Less than a tile.
constexpr int Beside = 4;

/// The voxels that the pixels of a layer read, relative to the pixel.
struct VoxelWindow
{
  int iMin = std::numeric_limits<int>::max(), iMax = std::numeric_limits<int>::lowest();
  int jMin = std::numeric_limits<int>::max(), jMax = std::numeric_limits<int>::lowest();

  void add(int di, int dj)
  {
    this->iMin = std::min(this->iMin, di);
    this->iMax = std::max(this->iMax, di);
    this->jMin = std::min(this->jMin, dj);
    this->jMax = std::max(this->jMax, dj);
  }
};

inline Span slicesOfLayer(int layer, const glm::ivec3& size)
{
  return { layer * BrickDepth, std::min((layer + 1) * BrickDepth, size.z) };
}

/// The slices that rows [v0, v1) cross: a range, because the stack moves in one direction.
inline Span slicesOf(const std::vector<SliceGeometry>& slices, int v0, int v1)
{
  const auto meets = [=](const SliceGeometry& s) { return s.vBegin < v1 && s.vEnd > v0; };
  const auto first = std::find_if(slices.begin(), slices.end(), meets);
  const auto last = std::find_if(slices.rbegin(), slices.rend(), meets).base();
  return { static_cast<int>(first - slices.begin()),
    static_cast<int>(std::max(first, last) - slices.begin()) };
}

inline Span common(const Span& a, const Span& b)
{
  return { std::max(a.begin, b.begin), std::min(a.end, b.end) };
}

/// The largest value of type T not above x, or the least one.
template <class T>
T roundedDown(double x)
{
  if (!(x > static_cast<double>(leastValue<T>())))
  {
    return leastValue<T>();
  }
  if (x >= static_cast<double>(greatestValue<T>()))
  {
    return greatestValue<T>();
  }
  if constexpr (std::numeric_limits<T>::is_integer)
  {
    return static_cast<T>(std::floor(x));
  }
  else
  {
    const T value = static_cast<T>(x);
    return value > x ? std::nextafter(value, leastValue<T>()) : value;
  }
}

/// The initial value of a preview's pixels, not above any voxel.
template <class T>
T previewFloor(const ProjectionContext& context)
{
  if (context.range.nonFinite)
  {
    return leastValue<T>(); // marks pixels without a sample: see dropEmpty()
  }
  // The range's double may differ from a 64-bit integer.
  constexpr bool exact = !std::numeric_limits<T>::is_integer || sizeof(T) < 8;
  const T low = exact ? static_cast<T>(context.range.low) : leastValue<T>();
  return std::max(low, roundedDown<T>(context.floor));
}

/// Initialises rows to "no sample". Pixels that no sample can reach get the greatest value, so that
/// they do not lower a tile's least value. Other pixels get the floor.
template <class P>
void openRows(ShearImage& image, P floor, int v0, int v1)
{
  const P outside = greatestValue<P>();
  for (int v = v0; v < v1; ++v)
  {
    P* const row = image.row<P>(v);
    const Span& span = image.spans[v];
    std::fill(row, row + image.width, outside);
    if (image.mask.empty())
    {
      std::fill(row + span.begin, row + std::max(span.begin, span.end), floor);
      continue;
    }
    const unsigned char* const mask = &image.mask[std::ptrdiff_t(v) * image.width];
    const Span pixels = span; // a copy, because writing pixels might change it
    for (int u = pixels.begin; u < pixels.end; ++u)
    {
      row[u] = mask[u] ? floor : outside;
    }
  }
}

/// With NaN voxels, pixels within the outline may have no sample, too. Infinities mark both kinds
/// during a walk, and become NaN.
template <class P>
void dropEmpty(ShearImage& image, int v0, int v1)
{
  if constexpr (!std::numeric_limits<P>::is_integer)
  {
    P* const row = image.row<P>(v0);
    std::replace_if(
      row, row + std::ptrdiff_t(v1 - v0) * image.width, [](P x) { return std::isinf(x); },
      std::numeric_limits<P>::quiet_NaN());
  }
}

/// Pixels that no ray reaches were marked for the walk. Sets them to "no sample".
template <class P>
void closeRows(ShearImage& image, int v0, int v1)
{
  const P empty = image.nonFinite ? std::numeric_limits<P>::quiet_NaN() : leastValue<P>();
  for (int v = v0; v < v1; ++v)
  {
    P* const row = image.row<P>(v);
    const Span& span = image.spans[v];
    std::fill(row, row + std::min(span.begin, image.width), empty);
    std::fill(row + std::max(span.begin, span.end), row + image.width, empty);
  }
}
}

#endif
