// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingShearImage_h
#define splattingShearImage_h

#include "Common/ScalarType.h"
#include "Geometry/ShearWarp.h"

#include <vector>

namespace splatting
{
/// Voxels of one slice that a ray can cross.
constexpr int StepsPerSlice = 3;

/**
 * The projection before the warp.
 */
struct ShearImage
{
  ScalarType type = ScalarType::UInt8;
  int width = 0;
  int height = 0;
  /// width * height scalars of `type`, row after row. The buffer only grows, frames re-use it.
  std::vector<unsigned char> bytes;
  /// Per row, the pixels whose ray crosses the volume; what lies outside has no meaning. Rays that
  /// miss an edge of the volume by no more than they are rounded by can be among them if such rays
  /// beside them hit it.
  std::vector<Span> spans;
  /// If anything cuts the volume, see Cuts: per pixel, whether a sample is left. Else empty.
  std::vector<unsigned char> mask;
  /// If asked for: per pixel the step of the ray that its value comes from, StepsPerSlice * slice,
  /// in preview plus the voxel's number in RayPath; -1 without a sample. Else empty.
  std::vector<std::int32_t> winners;
  bool keepsWinners() const { return !this->winners.empty(); }
  /// NaN pixels have no sample, infinities occur.
  bool nonFinite = false;

  template <class T>
  T* row(int v)
  {
    return reinterpret_cast<T*>(this->bytes.data()) + std::ptrdiff_t(v) * this->width;
  }
  template <class T>
  const T* row(int v) const
  {
    return const_cast<ShearImage*>(this)->row<T>(v);
  }
  /// Whether the pixel's ray crosses the volume.
  bool meetsVolume(int u, int v) const
  {
    return v >= 0 && v < this->height && u >= this->spans[v].begin && u < this->spans[v].end;
  }
  /// Whether it has samples there, NaN aside.
  bool covers(int u, int v) const
  {
    return this->meetsVolume(u, v) &&
      (this->mask.empty() || this->mask[std::ptrdiff_t(v) * this->width + u]);
  }
};
}

#endif
