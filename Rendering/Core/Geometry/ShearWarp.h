// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Factorises a view into shears of the volume along its principal axes and warps of the shear
 * images [CS98, section 2; Lacroute & Levoy 1994]. Parallel views have one shear and an affine
 * warp. In perspective views slices are also scaled, warps are projective, and each axis that rays
 * follow has an image of its own.
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
 * The rays of the columns (or rows) of a shear image, in one coordinate: that of pixel n is at[n] +
 * slope[n] (z - ShearWarp::reference()) at depth z.
 */
struct AxisRays
{
  std::vector<double> at, slope;

  bool operator==(const AxisRays& other) const
  {
    return this->at == other.at && this->slope == other.slope;
  }
  double steepest = 0.0; ///< in perspective, the largest magnitude of slopes in the image
};

/**
 * Returns the part of a convex cone or polygon where dot(side, edge) >= 0. A cone is given by its
 * edges, a polygon by its corners (x, y, 1).
 */
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& edges, const glm::dvec3& side);

/**
 * Geometry of a shear image. The axes of the volume are permuted: (i, j) in the slice, k along the
 * principal axis.
 *
 * In parallel views voxel (i, j) of slice k lies at pixel u = i + position(k).x, v = j +
 * position(k).y. The ray of pixel (u, v) passes index (i, j) = (u, v) - position(z) at depth z. The
 * centre of the volume maps to the centre of the image, so mirrored volumes have mirrored images,
 * and an axis without shear has pixels on voxel centres. Shears are rounded to multiples of 2^-24.
 * All positions are then exact in double, and equal views cannot differ by rounding. This rotates
 * rays by at most 2^-25, and moves voxels of a 4096-slice volume by at most 1/16000 pixel.
 *
 * In perspective views the image contains the rays through the eye that follow the principal axis
 * most, in one of its two directions. Their slopes are equidistant and lie between -1 and 1. At -1
 * and 1 the images of two axes meet. Where the volume is farthest from the eye, pixels are 0.1 %
 * narrower than a voxel, and a little less if that makes their number odd. In all other slices they
 * are narrower. So no voxel lies between rays. Slopes are rounded to multiples of 2^-24, positions
 * at the reference depth to 2^-20, and the eye to 2^-10 of a voxel, so all positions are exact. No
 * ray has slope 0, except by rounding. A ray within a face between voxels belongs to the voxels
 * with the higher index.
 */
class ShearWarp
{
public:
  /**
   * An identity view of an empty volume.
   */
  ShearWarp() = default;

  /**
   * Factorises a parallel view. valid() is false if the view maps the volume to a line or a point.
   */
  explicit ShearWarp(const View& view);

  /**
   * Factorises any view: one image for a parallel view, up to six for a perspective one. Images
   * that show nothing of the volume are omitted.
   * @return  false, without images, if the view maps the volume to a line or a point
   */
  static bool factorise(const View& view, std::vector<ShearWarp>& images);

  /**
   * Sets `part` to the geometry of a box of this volume's voxels, as a volume of its own. Voxels,
   * slices and depths are counted from the box. Pixels and rays are those of this image, and all
   * positions are exact. The part has no warp.
   * @param first       the first voxel of the box
   * @param dimensions  the voxels of the box, along the axes of the volume
   */
  void findPart(const glm::ivec3& first, const glm::ivec3& dimensions, ShearWarp& part) const;

  bool valid() const { return this->Valid; }
  /// The volume axis along which slices are stacked, 0, 1 or 2.
  int principalAxis() const { return this->Axes[2]; }
  /// The volume axes of i, j and k.
  const std::array<int, 3>& axes() const { return this->Axes; }
  /// Voxels along i, j and k.
  const glm::ivec3& size() const { return this->Size; }
  /// Of a part: its first voxel (i, j, k) in the whole.
  const glm::ivec3& first() const { return this->FirstVoxel; }
  /// See View.
  bool showsBoxes() const { return this->ShowsBoxes; }
  /// Whether the view is an overview, in which pixels show their areas.
  bool minifiesAnyAxis() const { return this->Overview; }
  int width() const { return this->ImageSize.x; }
  int height() const { return this->ImageSize.y; }

  /// Columns and rows that are rays of the view. Perspective images have a few more columns, to
  /// fill registers, whose rays are far beside the volume.
  const glm::ivec2& rayCount() const { return this->RayCount; }

  bool isPerspective() const { return this->Perspective; }
  const AxisRays& columns() const { return this->Columns; }
  const AxisRays& rows() const { return this->Rows; }
  /// The depth of AxisRays::at: the centre of the volume in parallel views, in perspective where
  /// the volume is farthest from the eye.
  double reference() const { return this->Reference; }
  /// The distance of pixels in voxels at that depth.
  double pitch() const { return this->Pitch; }
  /// The geometry of one pixel of the image, as pixel (0, 0). In perspective the result also has
  /// columns to fill a register, as whole images have; see rayCount().
  void takePixel(const glm::ivec2& pixel, ShearWarp& part) const;
  /// Index coordinates of the ray of pixel (u, v) at depth z.
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
  /// The slices whose centre is in front of the eye; in parallel views all.
  const Span& slices() const { return this->SlicesSeen; }
  /// Of perspective views, (i, j, k).
  const glm::dvec3& eye() const { return this->Eye; }

  /// Of parallel views: pixels per slice, at most 1 in magnitude.
  const glm::dvec2& shear() const { return this->Shear; }
  /// Of parallel views: voxels from the image's first pixel to voxel (0, 0) of the middle slice.
  const glm::ivec2& margin() const { return this->Margin; }

  /// Of parallel views: the position of voxel (0, 0) of slice (or depth) z in the image.
  glm::dvec2 position(double z) const
  {
    return glm::dvec2(this->Margin) + this->Shear * (z - this->Middle);
  }

  /**
   * The homogeneous pixel (u w, v w, w) of a point (i, j, k). In parallel views w is 1. In
   * perspective views it is the distance from the eye along the principal axis, negative behind the
   * eye.
   */
  glm::dvec3 pixelOf(const glm::dvec3& point) const;

  /**
   * The path of the rays of a parallel view in slice k. Voxels are boxes. A voxel is in the path if
   * the ray crosses it over a positive length. A voxel that the ray only touches at an edge or a
   * corner is not in the path. Rays never lie within a face: without shear they pass through voxel
   * centres.
   */
  RayPath rayPath(int k) const;

  /**
   * The voxels of one ray in slice k, by ascending depth, in any view; di and dj are indices.
   */
  RayPath voxelsOnRay(int u, int v, int k) const;

  /**
   * The pixels of image row v whose ray crosses a slice along `path`.
   */
  Span coverage(const RayPath& path, int v) const;

  /**
   * A half-space of index space in the coordinates of a parallel view: dot(result, (u, v, k, 1)) >=
   * 0.
   */
  glm::dvec4 inPixels(const glm::dvec4& halfSpace) const;

  /**
   * From viewport pixels (centres at integers) to homogeneous shear pixels: (u w, v w, w) = m (x,
   * y, 1). In parallel views w is 1. In perspective views it is the distance from the eye along the
   * principal axis, in voxels per unit of clip space's w, positive for rays in the image's
   * direction.
   */
  const glm::dmat3& screenToShear() const { return this->ScreenToShear; }
  /// The inverse.
  const glm::dmat3& shearToScreen() const { return this->ShearToScreen; }

  /// Whether the last slice is nearest to the viewer.
  bool reversed() const { return this->Reversed; }

  /// Whether the shear images are equal. The warps and the viewer's side may differ.
  bool sameShear(const ShearWarp& other) const;

private:
  void chooseAxes(const glm::dvec3& direction);
  void permute(int principalAxis, const glm::ivec3& dimensions);
  void computeWarp(const glm::dvec4& rowX, const glm::dvec4& rowY);
  void setParallelRays();

  /// The rays of a perspective view in index space: through the eye, for viewport pixel (x, y) in
  /// direction directions (x, y, 1).
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
  glm::dvec2 DepthRange{ 0.0 }; // of the volume in front of the eye
  Span SlicesSeen;
  AxisRays Columns, Rows;
  glm::dmat3 ScreenToShear{ 1.0 };
  glm::dmat3 ShearToScreen{ 1.0 };
};
}

#endif
