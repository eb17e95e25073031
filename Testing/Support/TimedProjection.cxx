// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TimedProjection.h"

#include <vtkSMPTools.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference
{

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr float NoSample = -1.0f;

glm::ivec3 sizeOf(const Bytes& volume)
{
  return { volume.size[0], volume.size[1], volume.size[2] };
}

/// From a voxel to its neighbours along the axes.
glm::ivec3 stridesOf(const Bytes& volume)
{
  return { 1, volume.size[0], volume.size[0] * volume.size[1] };
}

/**
 * The part of a ray inside the volume's box, in steps.
 */
struct Interval
{
  double begin = -Infinity;
  double end = Infinity;

  Interval(const glm::ivec3& size, const glm::dvec3& start, const glm::dvec3& step)
  {
    for (int a = 0; a < 3; ++a)
    {
      const double low = -0.5 - start[a];
      const double high = size[a] - 0.5 - start[a];
      if (step[a] != 0.0)
      {
        this->begin = std::max(this->begin, std::min(low / step[a], high / step[a]));
        this->end = std::min(this->end, std::max(low / step[a], high / step[a]));
      }
      else if (low > 0.0 || high < 0.0)
      {
        this->end = -Infinity;
      }
    }
  }
};

/**
 * Calls f(start) for every ray and stores what it returns; negative is no sample.
 */
template <class F>
void castRays(const Rays& rays, Image<float>& picture, F f)
{
  picture.width = rays.width;
  picture.height = rays.height;
  picture.value.resize(static_cast<std::size_t>(rays.width) * rays.height);
  picture.hit.resize(picture.value.size());
  vtkSMPTools::For(0, rays.height, 4,
    [&](vtkIdType first, vtkIdType last)
    {
      for (int y = static_cast<int>(first); y < last; ++y)
      {
        const glm::dvec3 row = rays.origin + static_cast<double>(y) * rays.perRow;
        for (int x = 0; x < rays.width; ++x)
        {
          const float value = f(row + static_cast<double>(x) * rays.perColumn);
          const std::size_t pixel = picture.index(x, y);
          picture.hit[pixel] = value >= 0.0f;
          picture.value[pixel] = std::max(value, 0.0f);
        }
      }
    });
}

/**
 * The largest sample of each ray; sample(position) is called inside the box only.
 */
template <class Sample>
void castSamples(
  const glm::ivec3& size, const Rays& rays, Image<float>& picture, const Sample& sample)
{
  const glm::vec3 step(rays.step);
  castRays(rays, picture,
    [&](const glm::dvec3& start)
    {
      const Interval inside(size, start, rays.step);
      float largest = NoSample;
      if (inside.begin > inside.end)
      {
        return largest;
      }
      const double first = std::ceil(inside.begin);
      const int count = static_cast<int>(std::floor(inside.end) - first) + 1;
      // Counting from the first sample keeps the positions' rounding errors at some 1e-5 voxel.
      const glm::vec3 begin(start + first * rays.step);
      for (int n = 0; n < count; ++n)
      {
        largest = std::max(largest, sample(begin + static_cast<float>(n) * step));
      }
      return largest;
    });
}

class TrilinearSample
{
public:
  explicit TrilinearSample(const Bytes& volume)
    : Voxels(volume.voxels.data()),
      Strides(stridesOf(volume)),
      LastCell(glm::max(sizeOf(volume) - 2, 0)),
      Last(sizeOf(volume) - 1),
      Next(Strides * glm::min(sizeOf(volume) - 1, 1))
  {
  }

  float operator()(const glm::vec3& position) const
  {
    const glm::vec3 p = glm::clamp(position, glm::vec3(0.0f), this->Last);
    const glm::ivec3 cell = glm::min(glm::ivec3(p), this->LastCell);
    const glm::vec3 f = p - glm::vec3(cell);
    const std::uint8_t* c =
      this->Voxels + cell.x + cell.y * this->Strides.y + cell.z * this->Strides.z;
    const float near = this->inSlice(c, f);
    return near + f.z * (this->inSlice(c + this->Next.z, f) - near);
  }

private:
  float inSlice(const std::uint8_t* c, const glm::vec3& f) const
  {
    const float low = this->inRow(c, f);
    return low + f.y * (this->inRow(c + this->Next.y, f) - low);
  }
  float inRow(const std::uint8_t* c, const glm::vec3& f) const
  {
    return c[0] + f.x * (c[this->Next.x] - c[0]);
  }

  const std::uint8_t* const Voxels;
  const glm::ivec3 Strides;
  const glm::ivec3 LastCell;
  const glm::vec3 Last;
  const glm::ivec3 Next; // to the next voxel; 0 along an axis with one voxel
};

/**
 * One ray's way from voxel to voxel.
 */
float largestOnRay(const Bytes& volume, const glm::dvec3& start, const glm::dvec3& step)
{
  const glm::ivec3 size = sizeOf(volume);
  const Interval inside(size, start, step);
  if (inside.begin >= inside.end)
  {
    return NoSample;
  }
  const glm::ivec3 strides = stridesOf(volume);
  const glm::dvec3 entry = start + inside.begin * step;
  glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(entry + 0.5)), glm::ivec3(0), size - 1);
  const std::uint8_t* voxel =
    volume.voxels.data() + cell.x + cell.y * strides.y + cell.z * strides.z;
  int left[3];          // steps along the axis before the ray leaves the volume
  double next[3];       // when the ray meets the next face across the axis
  double between[3];    // time from face to face
  std::ptrdiff_t to[3]; // from a voxel to the next one
  for (int a = 0; a < 3; ++a)
  {
    const bool isUp = step[a] > 0.0;
    left[a] = isUp ? size[a] - 1 - cell[a] : cell[a];
    next[a] = step[a] == 0.0 ? Infinity : (cell[a] + (isUp ? 0.5 : -0.5) - start[a]) / step[a];
    between[a] = std::abs(1.0 / step[a]);
    to[a] = isUp ? strides[a] : -strides[a];
  }
  std::uint8_t largest = *voxel;
  while (true)
  {
    const int xy = next[0] < next[1] ? 0 : 1;
    const int a = next[xy] < next[2] ? xy : 2;
    if (left[a]-- == 0)
    {
      return largest;
    }
    voxel += to[a];
    next[a] += between[a];
    largest = std::max(largest, *voxel);
  }
}

/**
 * Slice k's part of row v of the image, moved by di from pixel to voxel.
 */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target_clones("default", "avx2"))) // splatting has these, too
#endif
void raiseRow(const std::uint8_t* voxels, int count, int di, int v, ByteImage& image)
{
  const int begin = std::max(0, -di);
  const int end = std::min(image.width, count - di);
  std::uint8_t* to = image.value.data() + std::ptrdiff_t(v) * image.width;
  const std::uint8_t* from = voxels + di;
  for (int u = begin; u < end; ++u)
  {
    to[u] = std::max(to[u], from[u]);
  }
  image.range[v] = { std::min(image.range[v][0], begin), std::max(image.range[v][1], end) };
}

} // namespace

//------------------------------------------------------------------------------
Rays shearRays(const std::array<int, 3>& volumeSize, const ShearView& view, double distance)
{
  const ShearGrid grid = makeShearGrid(volumeSize, view);
  Rays rays;
  rays.width = grid.width;
  rays.height = grid.height;
  for (int a = 0; a < 2; ++a)
  {
    rays.origin[grid.axes[a]] = view.shear[a] * grid.middle - grid.margin[a];
    rays.step[grid.axes[a]] = -view.shear[a] * distance;
  }
  rays.perColumn[grid.axes[0]] = 1.0;
  rays.perRow[grid.axes[1]] = 1.0;
  rays.step[grid.axes[2]] = distance;
  return rays;
}

//------------------------------------------------------------------------------
void castNearest(const Bytes& volume, const Rays& rays, Image<float>& picture)
{
  const std::uint8_t* const voxels = volume.voxels.data();
  const glm::ivec3 strides = stridesOf(volume);
  const glm::ivec3 last = sizeOf(volume) - 1;
  castSamples(sizeOf(volume), rays, picture,
    [=](const glm::vec3& position)
    {
      // Positions are not below -1/2 but for rounding, so that truncation is rounding down.
      const glm::ivec3 p = glm::min(glm::ivec3(position + 0.5f), last);
      return static_cast<float>(voxels[p.x + p.y * strides.y + p.z * strides.z]);
    });
}

//------------------------------------------------------------------------------
void castTrilinear(const Bytes& volume, const Rays& rays, Image<float>& picture)
{
  castSamples(sizeOf(volume), rays, picture, TrilinearSample(volume));
}

//------------------------------------------------------------------------------
void castThroughVoxels(const Bytes& volume, const Rays& rays, Image<float>& picture)
{
  castRays(
    rays, picture, [&](const glm::dvec3& start) { return largestOnRay(volume, start, rays.step); });
}

//------------------------------------------------------------------------------
void projectSlices(
  const SliceStack& slices, const ShearGrid& grid, const ShearView& view, ByteImage& image)
{
  image.width = grid.width;
  image.height = grid.height;
  image.value.assign(static_cast<std::size_t>(grid.width) * grid.height, 0);
  image.range.assign(grid.height, { grid.width, 0 });
  // Bands of rows stay in the cache while the slices stream by.
  vtkSMPTools::For(0, grid.height, 16,
    [&](vtkIdType first, vtkIdType last)
    {
      for (int k = 0; k < grid.size[2]; ++k)
      {
        const double z = k - grid.middle;
        const int di = static_cast<int>(std::floor(0.5 - grid.margin[0] - view.shear[0] * z));
        const int dj = static_cast<int>(std::floor(0.5 - grid.margin[1] - view.shear[1] * z));
        const int begin = std::max(static_cast<int>(first), -dj);
        const int end = std::min(static_cast<int>(last), grid.size[1] - dj);
        const std::uint8_t* slice = slices.voxels + k * slices.sliceStride;
        for (int v = begin; v < end; ++v)
        {
          raiseRow(slice + (v + dj) * slices.rowStride, grid.size[0], di, v, image);
        }
      }
    });
}

} // namespace reference
