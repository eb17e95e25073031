// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Footprints in perspective views, where rays diverge and each pixel has its own weights. A slice
 * is divided into parts of equal thickness. In each part weights are products of a factor for the
 * column, one for the row, and one for all pixels.
 *
 * In a part, the points of a pixel have x = x_ray + slope t a + w b, where t is the part's
 * thickness, w the distance of rays, and a and b are uniform in [-1/2, 1/2]. The weight of a voxel
 * is the mean of its reconstruction kernel over these points. With N, the kernel integrated twice,
 * it is
 *
 *   E[h(x - i)] = (N(d + p) - N(d + m) - N(d - m) + N(d - p)) / (w |slope| t),
 *   d = x_ray - i,   p = (w + |slope| t) / 2,   m = (w - |slope| t) / 2.
 *
 * The common change of x and y along a ray within a part is neglected: a covariance of slope_x
 * slope_y t^2 / 12. The number of parts keeps it at or below 0.021 for all pixels of an image.
 */
#ifndef splattingPerspectiveFootprints_h
#define splattingPerspectiveFootprints_h

#include "Geometry/ShearWarp.h"
#include "Kernels/Kernels.h"
#include "Splat/Sampling/Footprint.h"

#include <array>
#include <cstdint>
#include <vector>

namespace splatting
{
constexpr int MostParts = 3;
constexpr int MostTaps = 5;

/// The number of parts of an image's slices.
int partsOf(const ShearWarp& geometry, const Kernel& kernel);

/**
 * The weights of the columns (or the rows) of an image, for all parts of all slices.
 */
template <class A>
class AxisFootprints
{
public:
  /// @param whole     the image's geometry: weights do not depend on where a part of it begins
  /// @param geometry  of the part that is projected, from which voxels are counted; or the same
  /// @param a         0 for columns, 1 for rows
  void find(const ShearWarp& whole, const ShearWarp& geometry, int a, const Kernel& kernel,
    int parts, const WorksheetLoops<A>& loops);

  /// One part of one slice.
  struct Part
  {
    const std::int32_t* first; ///< the first voxel of each pixel; may lie outside the volume
    /// Tap n of pixel x is weights[n * stride + x]; not negative, with sum 1.
    const A* weights;
    std::ptrdiff_t stride;
    int taps;
    /// The first voxels relative to a group's register: see AxisPicks::Picks.
    const std::int32_t* base;
    const void* lanes;
  };
  Part part(int k, int q) const;

  /// The voxels that some pixels read for part q of the worksheet of slice k, from first to last;
  /// may be outside the volume.
  Span voxels(int k, int q, const Span& pixels) const;
  /// The same for all parts of some slices; slices or pixels may be empty.
  Span voxels(const Span& slices, const Span& pixels) const;

  /// The largest distance outside the volume at which a pixel begins to read.
  static constexpr int Margin = 8;

private:
  void findPart(const ShearWarp& whole, const ShearWarp& geometry, int a, int k, int q,
    const Kernel& kernel, const WorksheetLoops<A>& loops);
  std::size_t at(int k, int q) const
  {
    return std::size_t(k - this->Slices.begin) * this->Parts + q;
  }

  Span Slices;
  int Count = 0, Size = 0, Parts = 1, Group = 1;
  int Room = MostTaps; // for the taps of a part
  std::ptrdiff_t Padded = 0;
  double Steepest = 0.0;
  std::vector<int> Taps;
  std::vector<unsigned char> Ascends; // for each part, whether first voxels ascend with pixels
  std::vector<std::int32_t> First, Bases;
  std::vector<A> Weights;
  std::vector<unsigned char> Lanes;
};

/**
 * The footprints of an image's pixels.
 */
template <class A>
struct PerspectiveFootprints
{
  AxisFootprints<A> columns, rows;
  int parts = 1;
  /// For each slice and part, the weights of slices k - 1, k and k + 1.
  std::vector<std::array<A, 3>> depth;

  /// As AxisFootprints::find().
  void find(const ShearWarp& whole, const ShearWarp& geometry, const Kernel& kernel,
    const Kernels& kernels);
  const std::array<A, 3>& share(int k, int q) const { return this->depth[k * this->parts + q]; }

  /// Calls f(i, j, k, weight) for all voxels of a pixel in the worksheet of slice k; they may lie
  /// outside the volume.
  template <class F>
  void forVoxels(int u, int v, int k, F&& f) const
  {
    for (int q = 0; q < this->parts; ++q)
    {
      const typename AxisFootprints<A>::Part x = this->columns.part(k, q),
                                             y = this->rows.part(k, q);
      for (int c = 0; c < 3; ++c)
      {
        const A share = this->share(k, q)[c];
        for (int j = 0; share != 0 && j < y.taps; ++j)
        {
          for (int i = 0; i < x.taps; ++i)
          {
            f(x.first[u] + i, y.first[v] + j, k + c - 1,
              share * y.weights[j * y.stride + v] * x.weights[i * x.stride + u]);
          }
        }
      }
    }
  }
};
}

#endif
