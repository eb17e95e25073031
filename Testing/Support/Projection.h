// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Projection.h
 * @brief   slow and obvious maximum intensity projections, the oracle of the fast ones
 *
 * Everything here is computed ray by ray from the definition, without footprints, weight tables or
 * worksheets, and shares no code with the module.
 *
 * Geometry. The principal axis k of a view is one of the volume's axes, its in-slice axes (i,j) are
 * the other two in ascending order. With n_k slices the middle of the volume is kc = (n_k - 1) / 2,
 * and the ray of pixel (u,v) passes the in-slice position
 *   (u - m_x - s_x (z - kc), v - m_y - s_y (z - kc))
 * at depth z; u, v, z and positions are in voxels, a voxel is the box of half-width 1/2 about its
 * integer centre. The margins m = ceil(|s| n_k / 2) + 1 let the shear image, n_i + 2 m_x by
 * n_j + 2 m_y pixels, hold every ray that meets the volume. With S samples along the side of a
 * voxel there are S times as many pixels each way, 1/S voxels wide, and u and v above are pixels
 * divided by S.
 */
#ifndef reference_Projection_h
#define reference_Projection_h

#include "Stretch.h"
#include "Volume.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace reference
{

/**
 * A picture, x fastest. Pixels whose ray has no sample have hit = 0 and the value T().
 */
template <class T>
struct Image
{
  int width = 0;
  int height = 0;
  std::vector<T> value;
  std::vector<unsigned char> hit;

  Image() = default;
  Image(int newWidth, int newHeight)
    : width(newWidth),
      height(newHeight),
      value(static_cast<std::size_t>(newWidth) * newHeight, T()),
      hit(value.size(), 0)
  {
  }

  std::size_t index(int u, int v) const { return static_cast<std::size_t>(v) * this->width + u; }
  T& at(int u, int v) { return this->value[this->index(u, v)]; }
  const T& at(int u, int v) const { return this->value[this->index(u, v)]; }
  bool isHit(int u, int v) const { return this->hit[this->index(u, v)] != 0; }

  /**
   * Raise a pixel to a sample; the first sample counts whatever its value. NaN never counts.
   */
  void raise(int u, int v, T sample)
  {
    const std::size_t pixel = this->index(u, v);
    const bool isNaN = sample != sample;
    if (!isNaN && (!this->hit[pixel] || sample > this->value[pixel]))
    {
      this->value[pixel] = sample;
      this->hit[pixel] = 1;
    }
  }
};

/**
 * A parallel view of a volume. The principal axis is 0, 1 or 2; the shears, in pixels per slice
 * along the image's x and y, are multiples of 2^-24 of magnitude 1 at most.
 */
struct ShearView
{
  int axis = 2;
  double shear[2] = { 0.0, 0.0 };
};

/**
 * Where the shear image of a view of a volume of some size lies.
 */
struct ShearGrid
{
  std::array<int, 3> axes; // the volume's axes i, j and k
  std::array<int, 3> size; // n_i, n_j and n_k
  std::array<int, 2> margin;
  int width;
  int height;
  double middle; // kc
};

/**
 * Throws std::invalid_argument for a view outside its documented range.
 */
ShearGrid makeShearGrid(const std::array<int, 3>& volumeSize, const ShearView& view);

/**
 * The rays of an image, from an eye or parallel. The volume is seen with its axes permuted: i, j
 * and, along the rays, k. In voxels, the ray of pixel p = (u, v) passes
 *   i = at[0][u] + slope[0][u] (z - start),  j = at[1][v] + slope[1][v] (z - start)
 * at depth k = z. For exact traversals the numbers at, slope (depth - start) must be multiples of
 * 2^-34.
 */
struct ImageRays
{
  std::array<int, 3> axes = { 0, 1, 2 }; // the volume's axes i, j and k
  std::array<int, 3> size = { 0, 0, 0 }; // voxels along i, j and k
  std::array<std::vector<double>, 2> at, slope;
  double start = 0.0;
  double pitch = 1.0;    // from one ray to the next at the start
  double eye = -1.0;     // its depth; infinite where rays are parallel
  bool reversed = false; // the eye looks along falling k

  int width() const { return static_cast<int>(this->at[0].size()); }
  int height() const { return static_cast<int>(this->at[1].size()); }
  bool isParallel() const { return std::isinf(this->eye); }
  /// Voxels along the volume's axes.
  glm::ivec3 volumeSize() const
  {
    glm::ivec3 voxels;
    for (int a = 0; a < 3; ++a)
    {
      voxels[this->axes[a]] = this->size[a];
    }
    return voxels;
  }
  double position(int a, int pixel, double z) const
  {
    return this->at[a][pixel] + this->slope[a][pixel] * (z - this->start);
  }
  /// The point of a ray at a depth, in index space.
  glm::dvec3 point(int u, int v, double z) const
  {
    glm::dvec3 point;
    point[this->axes[0]] = this->position(0, u, z);
    point[this->axes[1]] = this->position(1, v, z);
    point[this->axes[2]] = z;
    return point;
  }
  /// The step of a ray to the next slice, in index space.
  glm::dvec3 direction(int u, int v) const
  {
    glm::dvec3 direction;
    direction[this->axes[0]] = this->slope[0][u];
    direction[this->axes[1]] = this->slope[1][v];
    direction[this->axes[2]] = 1.0;
    return direction;
  }
  /// The pixel coordinates of a point, in a parallel view.
  glm::dvec2 pixelOf(const glm::dvec3& point) const
  {
    const double z = point[this->axes[2]];
    return { point[this->axes[0]] - this->position(0, 0, z),
      point[this->axes[1]] - this->position(1, 0, z) };
  }
  /// The depths in front of the eye.
  Stretch<double> beforeEye() const
  {
    Stretch<double> depths;
    (this->reversed ? depths.end : depths.begin) = this->eye;
    return depths;
  }
  /// From one ray to the next at some depth.
  double spacing(double z) const
  {
    return this->isParallel()
      ? this->pitch
      : this->pitch * std::abs(z - this->eye) / std::abs(this->start - this->eye);
  }
  /// The slices whose middle lies before the eye.
  bool sees(int slice) const { return this->reversed ? slice < this->eye : slice > this->eye; }
  /// The depths between which a slice, or the volume (in slices 0 to n_k - 1), is before the eye.
  std::array<double, 2> faces(int first, int last) const;
};

/**
 * The rays of a parallel view from the side of the lowest slices.
 */
ImageRays raysOf(const std::array<int, 3>& volumeSize, const ShearView& view);

/**
 * The voxels that the ray of pixel (u, v) crosses, of slices that the eye sees, by ascending depth,
 * as positions in the volume, by traverse() in Traversal.h. No ray of a parallel view lies within a
 * face: the position along an axis with shear 0 is u - m, an integer, and faces are half-way
 * between integers.
 */
std::vector<std::array<int, 3>> crossedVoxels(const ImageRays& rays, int u, int v);

/**
 * The slices that these are in, ascending.
 */
std::vector<int> crossedSlices(const ImageRays& rays, int u, int v);

/**
 * What a ray meets in a slice. The weight is what remains of the slice's average where NaN voxels
 * are left out: for kernels that sum to one 1 without any NaN and 0 with nothing else.
 */
template <class T>
struct Sample
{
  int slice;
  T value;
  double weight;
};

/**
 * The samples of each pixel's ray by ascending depth, pixels as in Image.
 */
template <class T>
using RaySamples = std::vector<std::vector<Sample<T>>>;

/**
 * Mode preview: the voxels that rays cross, NaN or not, by ascending depth.
 */
template <class T>
RaySamples<T> voxelSamples(const Volume<T>& volume, const ImageRays& rays)
{
  RaySamples<T> samples;
  for (int v = 0; v < rays.height(); ++v)
  {
    for (int u = 0; u < rays.width(); ++u)
    {
      samples.emplace_back();
      for (const std::array<int, 3>& position : crossedVoxels(rays, u, v))
      {
        samples.back().push_back({ position[rays.axes[2]], volume.at(position), 1.0 });
      }
    }
  }
  return samples;
}

/**
 * The maximum of each pixel's samples. NaN does not count.
 */
template <class T>
Image<T> maximumOf(const RaySamples<T>& samples, const ImageRays& rays)
{
  Image<T> image(rays.width(), rays.height());
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (const Sample<T>& sample : samples[image.index(u, v)])
      {
        image.raise(u, v, sample.value);
      }
    }
  }
  return image;
}

/**
 * Mode preview: the maximum of the voxels that each pixel's ray crosses.
 */
template <class T>
Image<T> exactTraversal(const Volume<T>& volume, const ImageRays& rays)
{
  return maximumOf(voxelSamples(volume, rays), rays);
}

/**
 * How the volume is continued between voxel centres: the sum of h(x-i) h(y-j) h(z-k) times voxel
 * (i,j,k), divided by the sum of the weights where they do not sum to one.
 */
struct Kernel
{
  enum Shapes
  {
    Nearest,   // h(t) = 1 for |t| < 1/2: the piecewise constant volume
    Trilinear, // h(t) = 1 - |t| for |t| < 1
    CosineBell // h(t) = (1 + cos(pi t / radius)) / 2 for |t| < radius, radius in [0.5, 1.5]
  };

  Shapes shape = Trilinear;
  double radius = 1.0; // of the cosine bell only

  double support() const;            // h(t) = 0 for |t| >= support
  double operator()(double t) const; // h(t)
};

/**
 * Conventional ray casting: the maximum of the trilinearly interpolated volume at the depths z that
 * are multiples of the distance (in slices, so that 1/n samples every slice centre), wherever the
 * ray is inside the volume's box [-1/2, n-1/2]^3. Borders and NaN as in SlabAverages.h.
 */
Image<double> pointSampledTrilinear(
  const Volume<double>& volume, const ShearView& view, double distance);

/**
 * How projective shear-warp reads a slice at a point: the voxel that holds the point (the one with
 * the higher index where the point lies on a face), or the four nearest, bilinearly.
 */
enum class SliceSampling
{
  Nearest,
  Bilinear
};

/**
 * "Projective shear-warp", what [CS98, section 2] compares itself with: S. Yen, S. Napel and
 * G. Rubin, "Fast Sliding Thin Slab Volume Visualization", 1996. Slices are sheared, voxels are
 * not: "the voxel sampling value is evaluated along the line emitting from the pixel centre", once
 * per slice, where the ray meets the slice's middle. A ray that leaves a voxel sideways before the
 * next slice misses what it enters.
 *
 * The paper's times are for one voxel per sample ("the projection area of one voxel is exactly
 * equal to one"); its Fig. 11 compares in high quality, which wants the bilinear samples of
 * Lacroute and Levoy. Borders and NaN as in SlabAverages.h.
 */
Image<double> projectiveShearWarp(
  const Volume<double>& volume, const ShearView& view, SliceSampling sampling);

/**
 * The same picture as double.
 */
template <class T>
Image<double> toDouble(const Image<T>& source)
{
  Image<double> result(source.width, source.height);
  std::transform(source.value.begin(), source.value.end(), result.value.begin(),
    [](T value) { return static_cast<double>(value); });
  result.hit = source.hit;
  return result;
}

} // namespace reference

#endif
