// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingView_h
#define splattingView_h

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace splatting
{
/**
 * VTK's cropping: two planes across each axis cut the volume into 27 regions.
 */
struct Cropping
{
  static constexpr std::uint32_t All = (1u << 27) - 1;

  /// The middle region along each axis of index space, both planes included.
  std::array<glm::dvec2, 3> planes{};
  /// Bit i + 3 j + 9 k: whether region (i, j, k) is shown. Region 0 is the lowest along its axis.
  std::uint32_t flags = All;

  bool cuts() const { return this->flags != All; }
  bool operator==(const Cropping& other) const
  {
    return this->flags == other.flags && (!this->cuts() || this->planes == other.planes);
  }
};

/**
 * One volume in one viewport. In index space voxel centres are integers, and the first voxel is (0,
 * 0, 0).
 */
struct View
{
  /// Size of the volume in voxels.
  glm::ivec3 dimensions{ 0 };
  /// Index space to clip space: spacing, origin, direction, prop matrix, view and projection.
  glm::dmat4 indexToClip{ 1.0 };
  /// Size of the viewport in pixels; the clip cube [-1, 1]^2 covers it.
  glm::ivec2 viewport{ 0 };
  /// Whether the picture ends at the outermost voxels' boxes, not at their centres.
  bool showsBoxes = false;
  /// Half-spaces of index space that contain the samples: dot(h, (x, y, z, 1)) >= 0.
  std::vector<glm::dvec4> halfSpaces;
  /// In index space.
  Cropping cropping;

  bool operator==(const View& other) const
  {
    return this->dimensions == other.dimensions && this->indexToClip == other.indexToClip &&
      this->viewport == other.viewport && this->showsBoxes == other.showsBoxes &&
      this->halfSpaces == other.halfSpaces && this->cropping == other.cropping;
  }
};

/**
 * Whether the matrix is finite; that of cameras without extent is not.
 */
inline bool isFinite(const View& view)
{
  for (int c = 0; c < 4; ++c)
  {
    for (int r = 0; r < 4; ++r)
    {
      if (!std::isfinite(view.indexToClip[c][r]))
      {
        return false;
      }
    }
  }
  return true;
}

/**
 * Whether all rays of the view are parallel, from the matrix. Rays whose direction changes by less
 * than 2^-20 over the volume count as parallel. In a volume of 4096 voxels this moves no sample by
 * more than 1/500 voxel.
 */
inline bool isParallel(const View& view)
{
  const glm::dmat4& m = view.indexToClip;
  double variation = 0.0, middle = m[3][3];
  for (int c = 0; c < 3; ++c)
  {
    variation += std::abs(m[c][3]) * view.dimensions[c];
    middle += m[c][3] * 0.5 * (view.dimensions[c] - 1);
  }
  return variation <= 0x1p-20 * std::abs(middle);
}
}

#endif
