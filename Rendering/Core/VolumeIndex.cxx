// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeIndex.h"

#include "Kernels.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace splatting
{
namespace
{
template <class T>
constexpr T lowest()
{
  return std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity()
                                              : std::numeric_limits<T>::lowest();
}
template <class T>
constexpr T highest()
{
  return std::numeric_limits<T>::has_infinity ? std::numeric_limits<T>::infinity()
                                              : std::numeric_limits<T>::max();
}

/// out[i][z][y] = in[z][y][i] in blocks that fit the first-level cache on both sides.
template <class T>
void transpose(const T* in, T* out, const glm::ivec3& size)
{
  constexpr int block = 64;
  const std::ptrdiff_t nx = size.x, ny = size.y, nz = size.z;
  vtkSMPTools::For(0, nz,
    [=](vtkIdType first, vtkIdType last)
    {
      for (std::ptrdiff_t z = first; z < last; ++z)
      {
        for (std::ptrdiff_t y0 = 0; y0 < ny; y0 += block)
        {
          const std::ptrdiff_t y1 = std::min(y0 + block, ny);
          for (std::ptrdiff_t x0 = 0; x0 < nx; x0 += block)
          {
            const std::ptrdiff_t x1 = std::min(x0 + block, nx);
            for (std::ptrdiff_t x = x0; x < x1; ++x)
            {
              const T* from = in + (z * ny + y0) * nx + x;
              T* to = out + (x * nz + z) * ny;
              for (std::ptrdiff_t y = y0; y < y1; ++y, from += nx)
              {
                to[y] = *from;
              }
            }
          }
        }
      }
    });
}

template <class T>
VolumeIndex::Range rangeOf(const VoxelArray& volume)
{
  struct Part
  {
    T low = highest<T>(), high = lowest<T>();
    bool special = false;
  };
  const std::ptrdiff_t count =
    std::ptrdiff_t(volume.dimensions.x) * volume.dimensions.y * volume.dimensions.z;
  constexpr std::ptrdiff_t chunk = 1 << 16;
  const std::ptrdiff_t chunks = (count + chunk - 1) / chunk;
  std::vector<Part> parts(chunks);
  const T* const voxels = static_cast<const T*>(volume.voxels);
  const VoxelLoops<T>& loops = kernelsFor(bestInstructionSet());
  vtkSMPTools::For(0, chunks,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType c = first; c < last; ++c)
      {
        const std::ptrdiff_t begin = c * chunk;
        loops.range(voxels + begin, std::min(chunk, count - begin), parts[c].low, parts[c].high,
          parts[c].special);
      }
    });
  Part all;
  for (const Part& part : parts)
  {
    all.low = std::min(all.low, part.low);
    all.high = std::max(all.high, part.high);
    all.special = all.special || part.special;
  }
  return { static_cast<double>(all.low), static_cast<double>(all.high), all.special };
}
}

void VolumeIndex::reset(const VoxelArray& volume)
{
  this->Volume = volume;
  this->Copy.reset();
  this->CopySize = 0;
  this->RangeKnown = false;
}

Slices VolumeIndex::slices(int principalAxis)
{
  const std::ptrdiff_t nx = this->Volume.dimensions.x, ny = this->Volume.dimensions.y,
                       nz = this->Volume.dimensions.z;
  if (principalAxis == 2)
  {
    return { this->Volume.voxels, nx, nx * ny };
  }
  if (principalAxis == 1)
  {
    return { this->Volume.voxels, nx * ny, nx };
  }
  if (!this->Copy)
  {
    dispatch(this->Volume.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        const std::size_t bytes = static_cast<std::size_t>(nx * ny * nz) * sizeof(T);
        this->Copy.reset(new unsigned char[bytes]);
        this->CopySize = bytes;
        transpose(static_cast<const T*>(this->Volume.voxels),
          reinterpret_cast<T*>(this->Copy.get()), this->Volume.dimensions);
      });
  }
  return { this->Copy.get(), ny, ny * nz };
}

const VolumeIndex::Range& VolumeIndex::range()
{
  if (!this->RangeKnown)
  {
    this->ValueRange = dispatch(this->Volume.type,
      [this](auto* null) { return rangeOf<std::remove_pointer_t<decltype(null)>>(this->Volume); });
    this->RangeKnown = true;
  }
  return this->ValueRange;
}
}
