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
 * The result of a projection before the warp.
 */
struct ShearImage
{
  ScalarType type = ScalarType::UInt8;
  int width = 0;
  int height = 0;
  /// width * height scalars of `type`, row by row. The buffer only grows, because frames reuse it.
  std::vector<unsigned char> bytes;
  /// For each row the pixels whose ray crosses the volume; others are undefined. Includes rays that
  /// miss an edge of the volume by less than their rounding error if rays beside them hit it.
  std::vector<Span> spans;
  /// With cuts, see Cuts: for each pixel whether a sample is visible. Else empty.
  std::vector<unsigned char> mask;
  /// On request, for each pixel the step of the ray that has its value: StepsPerSlice * slice, in
  /// preview plus the voxel's number in RayPath; -1 without a sample. Else empty.
  std::vector<std::int32_t> winners;
  /// Whether NaN marks pixels without a sample, and infinities are possible.
  bool nonFinite = false;
  /// Of Reduction::Signed, whose maxima are in this image: one image with the minima. Else empty.
  std::vector<ShearImage> minima;
  double origin = 0.0; ///< see ProjectionSettings

  /// The image that has the minima of rays, or the maxima.
  const ShearImage& ofExtremum(bool minimum) const
  {
    return minimum && !this->minima.empty() ? this->minima.front() : *this;
  }

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
  /// Whether the ray has visible samples, except NaN.
  bool covers(int u, int v) const
  {
    return this->meetsVolume(u, v) &&
      (this->mask.empty() || this->mask[std::ptrdiff_t(v) * this->width + u]);
  }
};
}

#endif
