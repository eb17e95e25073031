// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The factorisation of a parallel view into a shear of the volume along its principal axis and an
 * affine warp of the shear image [CS98, section 2; Lacroute & Levoy 1994].
 */
#ifndef splattingShearWarp_h
#define splattingShearWarp_h

#include "Kernels.h"
#include "View.h"

#include <array>
#include <cstddef>
#include <vector>

namespace splatting
{
/**
 * The voxels (u + di, v + dj) that the ray of shear pixel (u, v) crosses in one slice: the same
 * offsets for every pixel, at most three because a ray moves by at most one voxel in each
 * direction.
 */
struct RayPath
{
  int count = 0;
  std::array<int, 3> di{};
  std::array<int, 3> dj{};
};

/**
 * Geometry of the shear image. The volume is seen with its axes permuted: (i, j) in the slice, k
 * along the principal axis. Voxel (i, j) of slice k lies at pixel u = i + position(k).x,
 * v = j + position(k).y; the ray of pixel (u, v) passes index (i, j) = (u, v) - position(z) at
 * depth z.
 *
 * The middle of the volume maps to the middle of the image, so that mirrored volumes have mirrored
 * images, and an axis without shear puts pixels on voxel centres. Shears are rounded to multiples
 * of 2^-24: all positions are then exact in double, and equal views cannot differ by rounding.
 * That turns rays by at most 2^-25 and moves no voxel of a 4096-slice volume by more than 1/16000
 * pixel.
 */
class ShearWarp
{
public:
  /**
   * An identity view of an empty volume.
   */
  ShearWarp() = default;

  /**
   * Factorises a parallel view. valid() is false when the view flattens the volume to a line or a
   * point.
   */
  explicit ShearWarp(const View& view);

  bool valid() const { return this->Valid; }
  /// The volume axis along which slices are stacked, 0, 1 or 2.
  int principalAxis() const { return this->Axes[2]; }
  /// The volume axes that i, j and k run along.
  const std::array<int, 3>& axes() const { return this->Axes; }
  /// Voxels along i, j and k.
  const glm::ivec3& size() const { return this->Size; }
  /// Pixels per slice, at most 1 in magnitude.
  const glm::dvec2& shear() const { return this->Shear; }
  /// Voxel (0, 0) of the middle slice lies at this pixel.
  const glm::ivec2& margin() const { return this->Margin; }
  /// See View.
  bool showsBoxes() const { return this->ShowsBoxes; }
  int width() const { return this->Size.x + 2 * this->Margin.x; }
  int height() const { return this->Size.y + 2 * this->Margin.y; }

  /// Where voxel (0, 0) of slice (or depth) z lies in the image.
  glm::dvec2 position(double z) const
  {
    return glm::dvec2(this->Margin) + this->Shear * (z - this->Middle);
  }

  /**
   * What the rays cross in slice k. Voxels are boxes; one counts when the ray crosses it over a
   * positive length, so a ray that leaves a voxel through an edge or a corner does not touch the
   * voxels beside it. Rays never run within a face: without shear they pass voxel centres.
   */
  RayPath rayPath(int k) const;

  /**
   * The pixels of image row v whose ray crosses slice k along `path`.
   */
  Span coverage(const RayPath& path, int v) const;

  /**
   * A half-space of index space in pixels: dot(result, (u, v, k, 1)) >= 0.
   */
  glm::dvec4 inPixels(const glm::dvec4& halfSpace) const;

  /**
   * From viewport pixels (centres at integers) to shear pixels: u = m[0] x + m[1] y + m[2].
   */
  const glm::dmat3x2& screenToShear() const { return this->ScreenToShear; }
  /// The inverse.
  const glm::dmat3x2& shearToScreen() const { return this->ShearToScreen; }

  /// Whether the viewer is nearest to the last slice.
  bool reversed() const { return this->Reversed; }

  /// Whether the shear image is the same (the warp may differ, and the viewer's side).
  bool sameShear(const ShearWarp& other) const;

private:
  void chooseAxes(const glm::dvec3& direction);
  void computeWarp(const glm::dvec4& rowX, const glm::dvec4& rowY);

  bool Valid = false;
  bool ShowsBoxes = false;
  bool Reversed = false;
  std::array<int, 3> Axes{ 0, 1, 2 };
  glm::ivec3 Size{ 0 };
  glm::dvec2 Shear{ 0.0 };
  glm::ivec2 Margin{ 0 };
  double Middle = 0.0;
  glm::dmat3x2 ScreenToShear{ 1.0 };
  glm::dmat3x2 ShearToScreen{ 1.0 };
};
}

#endif
