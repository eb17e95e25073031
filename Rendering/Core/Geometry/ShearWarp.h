// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The factorisation of a view into shears of the volume along its principal axes and warps of the
 * shear images [CS98, section 2; Lacroute & Levoy 1994]: for parallel views one shear and an affine
 * warp; for perspective views slices are scaled as well, warps are projective, and where the rays
 * of a view follow different axes each axis has an image of its own.
 */
#ifndef splattingShearWarp_h
#define splattingShearWarp_h

#include "Geometry/RayPath.h"
#include "Geometry/View.h"
#include "Kernels/Kernels.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace splatting
{
/**
 * The rays of the columns (or of the rows) of a shear image, in one coordinate: that of pixel n
 * passes at[n] + slope[n] (z - ShearWarp::reference()) at depth z.
 */
struct AxisRays
{
  std::vector<double> at, slope;

  bool operator==(const AxisRays& other) const
  {
    return this->at == other.at && this->slope == other.slope;
  }
  double steepest = 0.0; ///< in perspective, the largest slope of the whole image, either way
};

/**
 * A convex cone, given by its edges, or polygon, by its corners (x, y, 1), where
 * dot(side, edge) >= 0.
 */
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& edges, const glm::dvec3& side);

/**
 * Geometry of a shear image. The volume is seen with its axes permuted: (i, j) in the slice, k
 * along the principal axis.
 *
 * In parallel views voxel (i, j) of slice k lies at pixel u = i + position(k).x,
 * v = j + position(k).y; the ray of pixel (u, v) passes index (i, j) = (u, v) - position(z) at
 * depth z. The middle of the volume maps to the middle of the image, so that mirrored volumes have
 * mirrored images, and an axis without shear puts pixels on voxel centres. Shears are rounded to
 * multiples of 2^-24: all positions are then exact in double, and equal views cannot differ by
 * rounding. That turns rays by at most 2^-25 and moves no voxel of a 4096-slice volume by more than
 * 1/16000 pixel.
 *
 * In perspective views the image holds rays through the eye that follow the principal axis most, in
 * one of its two directions. Their slopes are equidistant, from -1 to 1, where the images of two
 * axes meet. Pixels are a voxel wide (0.1 % less, and as much as makes their number odd) where
 * the volume is farthest from the eye, and narrower in all other slices, so that no voxel falls
 * between rays. Slopes and what rays pass
 * at the reference depth are rounded, to multiples of 2^-24 and 2^-20, the eye to 2^-10 of a voxel:
 * positions are exact here, too. No ray has slope 0 but for rounding: one that lies within a face
 * between voxels belongs to the higher ones.
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
  explicit ShearWarp(const View& view, Meets meets = Meets::All);

  /**
   * Factorises any view: one image for a parallel view, up to six for a perspective one, those that
   * show some of the volume; none if nothing of it can be seen.
   * @return  false if the view flattens the volume to a line or a point; there are no images then
   */
  static bool factorise(const View& view, std::vector<ShearWarp>& images, Meets meets = Meets::All);

  /**
   * Sets `part` to the geometry of a box of this volume's voxels as a volume by itself: voxels,
   * slices and depths are counted from the box on, pixels and rays are those of this image, and all
   * of the box's positions are exact. The part has no warp of its own.
   * @param first       the box's first voxel and
   * @param dimensions  its voxels, along the axes of the volume
   */
  void findPart(const glm::ivec3& first, const glm::ivec3& dimensions, ShearWarp& part) const;

  bool valid() const { return this->Valid; }
  /// The volume axis along which slices are stacked, 0, 1 or 2.
  int principalAxis() const { return this->Axes[2]; }
  /// The volume axes that i, j and k run along.
  const std::array<int, 3>& axes() const { return this->Axes; }
  /// Voxels along i, j and k.
  const glm::ivec3& size() const { return this->Size; }
  /// Of a part, the voxel (i, j, k) of the whole that is its first one.
  const glm::ivec3& first() const { return this->FirstVoxel; }
  /// See View.
  bool showsBoxes() const { return this->ShowsBoxes; }
  /// Whether the view is an overview, where what the screen's pixels show is sought in all of their
  /// areas.
  bool isOverview() const { return this->Overview; }
  int width() const { return this->ImageSize.x; }
  int height() const { return this->ImageSize.y; }

  /// Columns and rows that are rays of the view. In perspective images there are a few columns
  /// more, to fill registers, whose rays are far beside the volume.
  const glm::ivec2& rayCount() const { return this->RayCount; }

  bool isPerspective() const { return this->Perspective; }
  const AxisRays& columns() const { return this->Columns; }
  const AxisRays& rows() const { return this->Rows; }
  /// The depth at which pixels' rays are at AxisRays::at: the middle of parallel views, in
  /// perspective where the volume is farthest from the eye.
  double reference() const { return this->Reference; }
  /// Voxels from one pixel to the next at that depth.
  double pitch() const { return this->Pitch; }
  /// The geometry of one pixel of the image, as pixel (0, 0); in perspective images
  /// with columns beside it as there are beside other images.
  void takePixel(const glm::ivec2& pixel, ShearWarp& part) const;
  /// Index coordinates where the ray of pixel (u, v) is at depth z.
  glm::dvec2 onRay(int u, int v, double z) const
  {
    const double t = z - this->Reference;
    return { this->Columns.at[u] + this->Columns.slope[u] * t,
      this->Rows.at[v] + this->Rows.slope[v] * t };
  }
  /// The depths at which rays enter and leave slice k: half a slice from its middle, but not behind
  /// the eye.
  glm::dvec2 faces(int k) const
  {
    return glm::clamp(glm::dvec2(k - 0.5, k + 0.5), this->DepthRange.x, this->DepthRange.y);
  }
  /// Where on their way through slice k rays meet voxels: between its faces, or in its middle.
  glm::dvec2 passage(int k) const
  {
    return this->Met == Meets::Nearest ? glm::dvec2(k) : this->faces(k);
  }
  /// The slices whose middle lies before the eye; in parallel views all.
  const Span& slices() const { return this->SlicesSeen; }
  /// Of perspective views, (i, j, k).
  const glm::dvec3& eye() const { return this->Eye; }

  /// Of parallel views: pixels per slice, at most 1 in magnitude.
  const glm::dvec2& shear() const { return this->Shear; }
  /// Of parallel views: voxels from the image's first pixel to voxel (0, 0) of the middle slice.
  const glm::ivec2& margin() const { return this->Margin; }

  /// Of parallel views: where voxel (0, 0) of slice (or depth) z lies in the image.
  glm::dvec2 position(double z) const
  {
    return glm::dvec2(this->Margin) + this->Shear * (z - this->Middle);
  }

  /**
   * Where the image shows a point (i, j, k), in homogeneous pixels: (u w, v w, w). In parallel
   * views w is 1; in perspective ones it is the distance from the eye along the principal axis,
   * negative behind the eye.
   */
  glm::dvec3 pixelOf(const glm::dvec3& point) const;

  /**
   * What the rays of a parallel view meet in slice k. Voxels are boxes; one counts when the ray
   * crosses it over a positive length, so a ray that leaves a voxel through an edge or a corner
   * does not touch the voxels beside it. Rays never run within a face: without shear they pass
   * voxel centres. If rays meet the nearest voxel only, each voxel is met by one ray; a ray that
   * passes between two meets the one that it runs to.
   */
  RayPath rayPath(int k) const;

  /**
   * The voxels that one ray meets in slice k, by ascending depth, in any view: di and dj are
   * indices.
   */
  RayPath voxelsOnRay(int u, int v, int k) const;

  /**
   * The pixels of image row v whose ray crosses a slice along `path`.
   */
  Span coverage(const RayPath& path, int v) const;

  /**
   * A half-space of index space in the pixels of a parallel view: dot(result, (u, v, k, 1)) >= 0.
   */
  glm::dvec4 inPixels(const glm::dvec4& halfSpace) const;

  /**
   * From viewport pixels (centres at integers) to shear pixels, in homogeneous coordinates:
   * (u w, v w, w) = m (x, y, 1). In parallel views w is 1; in perspective ones it is the distance
   * from the eye along the principal axis, in voxels per unit of clip space's w: positive for rays
   * in the image's direction.
   */
  const glm::dmat3& screenToShear() const { return this->ScreenToShear; }
  /// The inverse.
  const glm::dmat3& shearToScreen() const { return this->ShearToScreen; }

  /// Whether the viewer is nearest to the last slice.
  bool reversed() const { return this->Reversed; }

  /// Whether the shear image is the same (the warp may differ, and the viewer's side).
  bool sameShear(const ShearWarp& other) const;

private:
  void chooseAxes(const glm::dvec3& direction);
  void permute(int principalAxis, const glm::ivec3& dimensions);
  void computeWarp(const glm::dvec4& rowX, const glm::dvec4& rowY);
  void setParallelRays();

  /// The rays of a perspective view: through the eye, of viewport pixel (x, y) along
  /// directions (x, y, 1), in index space.
  struct Rays
  {
    glm::dvec3 eye;
    glm::dmat3 directions;
  };
  static bool findRays(const View& view, Rays& rays);
  bool lookAlong(int axis, bool reversed, const View& view, const Rays& rays);
  bool placeRays(const View& view, const glm::dmat3& directions, double farthest);
  bool placeImage(const View& view, const glm::dmat3& directions);
  void setPerspectiveRays(int a, AxisRays& rays) const;
  glm::dmat3 directionToPixel() const;

  bool Valid = false;
  bool ShowsBoxes = false;
  bool Overview = false;
  bool Reversed = false;
  Meets Met = Meets::All;
  std::array<int, 3> Axes{ 0, 1, 2 };
  glm::ivec3 Size{ 0 };
  glm::ivec3 FirstVoxel{ 0 };
  glm::ivec2 ImageSize{ 0 }, RayCount{ 0 };
  glm::dvec2 Shear{ 0.0 };
  glm::ivec2 Margin{ 0 };
  double Middle = 0.0;
  bool Perspective = false;
  glm::dvec3 Eye{ 0.0 };
  std::int64_t Steps = 0;              // of slopes from -1 to 1
  std::array<std::int64_t, 2> First{}; // the steps of pixel (0, 0)
  double Reference = 0.0, Pitch = 1.0;
  glm::dvec2 DepthRange{ 0.0 }; // of the volume, as far as it lies before the eye
  Span SlicesSeen;
  AxisRays Columns, Rows;
  glm::dmat3 ScreenToShear{ 1.0 };
  glm::dmat3 ShearToScreen{ 1.0 };
};
}

#endif
