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

#include "Volume.h"

#include <array>
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
 * The voxels that the ray of pixel (u,v) crosses, in the order of ascending depth, as positions in
 * the volume, by traverse() in Traversal.h. No ray lies within a face: the
 * position along an axis with shear 0 is u - m, an integer, and faces are half-way between
 * integers.
 */
std::vector<std::array<int, 3>> crossedVoxels(
  const std::array<int, 3>& volumeSize, const ShearView& view, int u, int v);

/**
 * Mode preview: the maximum of the voxels that each pixel's ray crosses. NaN voxels do not count.
 */
template <class T>
Image<T> exactTraversal(const Volume<T>& volume, const ShearView& view)
{
  const ShearGrid grid = makeShearGrid(volume.size, view);
  Image<T> image(grid.width, grid.height);
  for (int v = 0; v < grid.height; ++v)
  {
    for (int u = 0; u < grid.width; ++u)
    {
      for (const std::array<int, 3>& position : crossedVoxels(volume.size, view, u, v))
      {
        image.raise(u, v, volume.at(position));
      }
    }
  }
  return image;
}

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
 * Mode preview: the voxels that rays cross, NaN or not.
 */
template <class T>
RaySamples<T> voxelSamples(const Volume<T>& volume, const ShearView& view)
{
  const ShearGrid grid = makeShearGrid(volume.size, view);
  RaySamples<T> rays;
  for (int v = 0; v < grid.height; ++v)
  {
    for (int u = 0; u < grid.width; ++u)
    {
      rays.emplace_back();
      for (const std::array<int, 3>& position : crossedVoxels(volume.size, view, u, v))
      {
        rays.back().push_back({ position[view.axis], volume.at(position), 1.0 });
      }
    }
  }
  return rays;
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
 * Modes standard (Kernel::Nearest) and high (the other kernels): the maximum over slices of the
 * slice's average over the pixel's area and the slice's thickness.
 *
 * The average of slice k is the integral, over all points that a ray through the pixel's area, with
 * u' in [u-1/2, u+1/2] and v' in [v-1/2, v+1/2], passes at z in [k-1/2, k+1/2], of the sum of
 * weights times voxels, divided by the integral of the weights. Only slices take part in which the
 * pixel's own ray crosses a voxel (as in crossedVoxels). Outside the volume the outermost voxels
 * are repeated. NaN voxels are left out of both integrals; a slice where no weight remains gives no
 * sample.
 *
 * The integrals are Gauss-Legendre sums of the field itself, between its kinks: exact but for
 * rounding for the nearest and the trilinear kernel, error below 1e-13 of the largest voxel for
 * cosine bells.
 */
Image<double> slabAverage(
  const Volume<double>& volume, const ShearView& view, const Kernel& kernel);

/**
 * The averages of all slices that rays cross, of which slabAverage takes the maximum. Those that
 * have no weight are NaN.
 */
RaySamples<double> slabSamples(
  const Volume<double>& volume, const ShearView& view, const Kernel& kernel);

/**
 * One of them, of pixel (u, v) and a slice that its ray crosses.
 */
Sample<double> slabSample(const Volume<double>& volume, const ShearView& view, const Kernel& kernel,
  int u, int v, int slice);

/**
 * Conventional ray casting: the maximum of the trilinearly interpolated volume at the depths z that
 * are multiples of the distance (in slices, so that 1/n samples every slice centre), wherever the
 * ray is inside the volume's box [-1/2, n-1/2]^3. Borders and NaN as in slabAverage.
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
 * Lacroute and Levoy. Borders and NaN as in slabAverage.
 */
Image<double> projectiveShearWarp(
  const Volume<double>& volume, const ShearView& view, SliceSampling sampling);

/**
 * The view of transformed(volume, symmetry) along the same rays.
 */
ShearView transformed(const ShearView& view, const AxisSymmetry& symmetry);

/**
 * The picture of transformed(volume, symmetry) in the view transformed(view, symmetry), from the
 * picture of the volume in the view: transposed or mirrored.
 */
template <class T>
Image<T> transformed(const Image<T>& source, const ShearView& view, const AxisSymmetry& symmetry)
{
  const ShearGrid from = makeShearGrid({ 1, 1, 1 }, view);
  const ShearGrid to = makeShearGrid({ 1, 1, 1 }, transformed(view, symmetry));
  const bool transposed = symmetry.axis[to.axes[0]] != from.axes[0];
  Image<T> result(
    transposed ? source.height : source.width, transposed ? source.width : source.height);
  for (int v = 0; v < result.height; ++v)
  {
    for (int u = 0; u < result.width; ++u)
    {
      const int x = symmetry.sign[to.axes[0]] > 0 ? u : result.width - 1 - u;
      const int y = symmetry.sign[to.axes[1]] > 0 ? v : result.height - 1 - v;
      const std::size_t pixel = transposed ? source.index(y, x) : source.index(x, y);
      result.value[result.index(u, v)] = source.value[pixel];
      result.hit[result.index(u, v)] = source.hit[pixel];
    }
  }
  return result;
}

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
