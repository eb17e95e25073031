// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Projection/Piece.h"

#include "Common/Parallel.h"
#include "Volume/VoxelCopies.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

namespace splatting
{
namespace
{
constexpr double Infinite = std::numeric_limits<double>::infinity();

/// The pixels whose rays are in [low, high] at a depth from the reference.
Span pixelsWithin(const AxisRays& rays, int count, double depth, double low, double high)
{
  const auto countBefore = [&](auto isBefore)
  {
    const auto end = std::partition_point(rays.at.begin(), rays.at.begin() + count,
      [&](const double& at) { return isBefore(at + rays.slope[&at - rays.at.data()] * depth); });
    return static_cast<int>(end - rays.at.begin());
  };
  return { countBefore([=](double x) { return x < low; }),
    countBefore([=](double x) { return x <= high; }) };
}

void keepColumns(std::vector<Span>& spans, const Span& columns)
{
  for (Span& span : spans)
  {
    span = common(span, columns);
  }
}

/// Limits a slice to some columns and rows of pixels.
void keepPixels(SliceGeometry& slice, const Span& columns, const Span& rows)
{
  if (common(slice.inner, columns).empty()) // borders are inside
  {
    slice.vBegin = slice.vEnd = slice.innerBegin = slice.innerEnd = 0;
    slice.inner = {};
    slice.lower.clear();
    slice.upper.clear();
    return;
  }
  const int begin = std::clamp(rows.begin, slice.vBegin, slice.vEnd);
  const int end = std::clamp(rows.end, begin, slice.vEnd);
  const int innerBegin = std::clamp(slice.innerBegin, begin, end);
  const int innerEnd = std::clamp(slice.innerEnd, innerBegin, end);
  const auto keep = [](std::vector<Span>& spans, int first, int last)
  {
    spans.erase(spans.begin() + last, spans.end());
    spans.erase(spans.begin(), spans.begin() + first);
  };
  // Lower rows begin at vBegin, upper ones at innerEnd.
  keep(slice.lower, std::min(begin, slice.innerBegin) - slice.vBegin,
    std::min(innerBegin, slice.innerBegin) - slice.vBegin);
  keep(slice.upper, std::max(innerEnd, slice.innerEnd) - slice.innerEnd,
    std::max(end, slice.innerEnd) - slice.innerEnd);
  slice.vBegin = begin;
  slice.vEnd = end;
  slice.innerBegin = innerBegin;
  slice.innerEnd = innerEnd;
  slice.inner = common(slice.inner, columns);
  keepColumns(slice.lower, columns);
  keepColumns(slice.upper, columns);
}

/// The rest of a box without another one, as disjoint boxes.
void subtract(Box box, const Box& other, std::vector<Box>& rest)
{
  for (int a = 0; a < 3; ++a)
  {
    if (other.begin[a] >= box.end[a] || other.end[a] <= box.begin[a])
    {
      rest.push_back(box);
      return;
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    if (box.begin[a] < other.begin[a])
    {
      rest.push_back(box);
      rest.back().end[a] = box.begin[a] = other.begin[a];
    }
    if (box.end[a] > other.end[a])
    {
      rest.push_back(box);
      rest.back().begin[a] = box.end[a] = other.end[a];
    }
  }
}

/// Maps numbers to integers in the same order: inverts all bits of negative ones except the sign.
template <class Key, class T>
Key keyOf(T value)
{
  Key key;
  std::memcpy(&key, &value, sizeof key);
  return key < 0 ? key ^ std::numeric_limits<Key>::max() : key;
}
template <class T, class Key>
T numberOf(Key key)
{
  key = key < 0 ? key ^ std::numeric_limits<Key>::max() : key;
  T value;
  std::memcpy(&value, &key, sizeof key);
  return value;
}

template <class T>
using KeyOf = std::conditional_t<std::numeric_limits<T>::is_integer, T,
  std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>>;

template <class Key>
constexpr Key none(Reduction reduction)
{
  return reduction == Reduction::Minimum ? std::numeric_limits<Key>::max()
                                         : std::numeric_limits<Key>::lowest();
}

template <class T, class F>
void forRows(ShearImage& image, F&& f)
{
  parallelFor(0, image.height, 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        f(v, image.row<T>(v));
      }
    });
}

template <class T>
void encodeType(ShearImage& image, Reduction reduction)
{
  using Key = KeyOf<T>;
  forRows<T>(image,
    [&](int v, T* row)
    {
      for (int u = 0; u < image.width; ++u)
      {
        Key key = none<Key>(reduction);
        if (image.covers(u, v) && row[u] == row[u])
        {
          if constexpr (std::is_same_v<Key, T>)
          {
            key = row[u];
          }
          else
          {
            key = keyOf<Key>(row[u]);
          }
        }
        std::memcpy(row + u, &key, sizeof key);
      }
    });
}

template <class T>
void decodeType(ShearImage& image, Reduction reduction)
{
  using Key = KeyOf<T>;
  if constexpr (!std::is_same_v<Key, T>)
  {
    forRows<T>(image,
      [&](int, T* row)
      {
        for (int u = 0; u < image.width; ++u)
        {
          Key key;
          std::memcpy(&key, row + u, sizeof key);
          row[u] = key != none<Key>(reduction) ? numberOf<T>(key)
            : image.nonFinite                  ? std::numeric_limits<T>::quiet_NaN()
                                               : leastValue<T>();
        }
      });
  }
}
}

Reach reachOf(Quality quality)
{
  switch (quality)
  {
    case Quality::Preview:
      return { 0, 0 };
    case Quality::Standard:
      return { 1, 0 };
    case Quality::High:
      return { 2, 1 };
    default:
      return { 1, 1 };
  }
}

Box interiorOf(const Box& piece, const glm::ivec3& whole, const glm::ivec3& layers)
{
  Box interior = piece;
  for (int a = 0; a < 3; ++a)
  {
    interior.begin[a] += piece.begin[a] > 0 ? layers[a] : 0;
    interior.end[a] -= piece.end[a] < whole[a] ? layers[a] : 0;
  }
  return interior;
}

bool cover(const std::vector<Box>& boxes, const glm::ivec3& whole)
{
  std::vector<Box> rest{ { glm::ivec3(0), whole } }, next;
  for (const Box& box : boxes)
  {
    if (box.empty())
    {
      continue;
    }
    next.clear();
    for (const Box& part : rest)
    {
      subtract(part, box, next);
    }
    rest.swap(next);
  }
  return rest.empty();
}

void keepInterior(const ShearWarp& whole, const ShearWarp& part, Quality quality,
  std::vector<SliceGeometry>& slices)
{
  if (quality == Quality::Preview)
  {
    return;
  }
  const Reach reach = reachOf(quality);
  const glm::ivec3& first = part.first();
  Box interior = interiorOf({ first, first + part.size() }, whole.size(),
    glm::ivec3(reach.across, reach.across, reach.along));
  glm::dvec2 low, high;
  for (int a = 0; a < 2; ++a)
  {
    // Rays outside the whole belong to its outermost voxels.
    low[a] = interior.begin[a] > 0 ? interior.begin[a] - first[a] - 0.5 : -Infinite;
    high[a] = interior.end[a] < whole.size()[a] ? interior.end[a] - first[a] - 0.5 : Infinite;
  }
  for (int k = 0; k < part.size().z; ++k)
  {
    const int slice = first.z + k;
    const double depth = k - part.reference();
    const bool exists = !interior.empty() && slice >= interior.begin.z && slice < interior.end.z;
    const Span columns = pixelsWithin(part.columns(), part.rayCount().x, depth, low.x, high.x);
    const Span rows = pixelsWithin(part.rows(), part.rayCount().y, depth, low.y, high.y);
    keepPixels(slices[k], exists ? columns : Span{}, exists ? rows : Span{});
  }
}

ScalarType encode(ShearImage& image, Reduction reduction)
{
  return dispatch(image.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      encodeType<T>(image, reduction);
      return scalarTypeOf<KeyOf<T>>();
    });
}

void blank(
  const ShearWarp& whole, ScalarType voxels, const ProjectionSettings& settings, ShearImage& image)
{
  const bool computes = computesWith(settings.reduction);
  image.type = settings.quality == Quality::Preview && !computes ? voxels : averageType(voxels);
  image.width = whole.width();
  image.height = whole.height();
  image.bytes.resize(std::size_t(image.width) * image.height * sizeOf(image.type));
  image.spans.assign(image.height, Span{ image.width, 0 });
  image.mask.clear();
  image.winners.assign(settings.recordLocations ? std::size_t(image.width) * image.height : 0, -1);
  image.minima.clear();
  if (settings.reduction == Reduction::Signed)
  {
    image.origin = settings.origin;
    const ShearImage minima = image;
    image.minima.push_back(minima);
  }
}

void decode(ShearImage& image, ScalarType type, Reduction reduction)
{
  image.type = type;
  dispatch(
    type, [&](auto* null) { decodeType<std::remove_pointer_t<decltype(null)>>(image, reduction); });
}

void fillEmpty(ShearImage& image, double low)
{
  const auto fill = [&](auto none)
  {
    using A = decltype(none);
    forRows<A>(
      image, [&](int, A* row) { std::replace(row, row + image.width, none, static_cast<A>(low)); });
  };
  if (!image.nonFinite)
  {
    image.type == ScalarType::Float32 ? fill(leastValue<float>()) : fill(leastValue<double>());
  }
}
}
