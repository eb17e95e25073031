// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Footprints [CS98, section 3]: the weight of each voxel in a pixel of a slice's worksheet.
 *
 * A pixel averages the reconstructed volume over its area and the slice's thickness. With the
 * reconstruction kernel h(x) h(y) h(z) and H = box * h, the voxel of slice k + c at offset (a, b)
 * (pixel minus voxel, in slice k's frame) has the weight
 *
 *   w_c(a, b) = integral over z in [-1/2, 1/2] of h(z - c) H(a - s_x z) H(b - s_y z) dz.
 *
 * In standard mode h is the box: only w_0 is not 0, and H is the hat.
 */
#ifndef splattingFootprint_h
#define splattingFootprint_h

#include <glm/vec2.hpp>

#include <array>
#include <vector>

namespace splatting
{
/// Reconstruction kernels: voxels as boxes (standard mode), trilinear and cosine bell (high mode).
enum class Reconstruction
{
  Box,
  Hat,
  CosineBell
};

/**
 * A reconstruction kernel in one dimension.
 */
struct Kernel
{
  Reconstruction shape = Reconstruction::Hat;
  /// Half-width of the cosine bell in voxels, in [0.5, 1.5]; ignored by the other kernels.
  double radius = 1.0;

  /// Half-width in voxels.
  double support() const;
  /// h(t).
  double operator()(double t) const;
  /// H(t): the average of h over a pixel about t, `width` voxels wide.
  double overPixel(double t, double width) const;

  bool operator==(const Kernel& other) const
  {
    return this->shape == other.shape &&
      (this->shape != Reconstruction::CosineBell || this->radius == other.radius);
  }
};

/**
 * The weights of all voxels around a pixel, [c + 1][dj + 2][di + 2]; non-negative, sum 1. The pixel
 * (u, v) reads voxel (u - nearest.x + di, v - nearest.y + dj) of slice k + c.
 */
using WeightTable = std::array<std::array<std::array<double, 5>, 5>, 3>;

/**
 * Weights in closed form. The integrand is smooth between the kinks of h and H, where
 * Gauss-Legendre quadrature is exact for the polynomial kernels (3 nodes) and accurate to 1e-13 for
 * the cosine bell (10 nodes).
 * @param fraction  the position of the nearest voxel relative to the pixel, in [-1/2, 1/2] voxels
 */
WeightTable closedFormWeights(
  const Kernel& kernel, const glm::dvec2& shear, const glm::dvec2& fraction);

/**
 * The paper's general table: the thickness of the sheared voxel, weighted by h, at the centres of N
 * x N sub-pixels of each pixel. Made once per view; set() does nothing if its arguments are those
 * of the last call. A slice's weights are sums over the sub-pixels in a pixel. Each pixel has a
 * weight, however narrow the kernel.
 */
class GeneralTable
{
public:
  void set(const Kernel& kernel, const glm::dvec2& shear, int sampling);
  WeightTable weights(const glm::dvec2& fraction) const;

private:
  double place(int subPixel) const;
  double entry(const Kernel& kernel, int part, const glm::dvec2& p) const;
  int firstOf(int pixel, double centre) const;

  Kernel Of;
  glm::dvec2 Shear{ 0.0 };
  int Sampling = 0;                           // sub-pixels along the side of a pixel
  int Voxels = 0;                             // the table covers Voxels x Voxels voxels
  std::array<std::vector<double>, 3> Entries; // "up", "middle" and "down" footprint
};

/**
 * One voxel of a footprint with its weight.
 */
struct Tap
{
  int slice; ///< c: -1, 0 or 1
  int di, dj;
  double weight;
};

/**
 * The taps of one footprint, in the order slice, row, column. Stored in place, because a frame
 * makes one for every slice.
 */
class Taps
{
public:
  void add(const Tap& tap) { this->Items[this->Count++] = tap; }
  int size() const { return this->Count; }
  Tap* begin() { return this->Items.data(); }
  Tap* end() { return this->Items.data() + this->Count; }
  const Tap* begin() const { return this->Items.data(); }
  const Tap* end() const { return this->Items.data() + this->Count; }
  const Tap& operator[](int t) const { return this->Items[t]; }

private:
  std::array<Tap, 75> Items;
  int Count = 0;
};

/**
 * The taps with non-zero weight after rounding to multiples of 2^-bits. The rounding error is added
 * to the largest weight, so that the sum is exactly 1.
 */
Taps quantisedTaps(const WeightTable& weights, int bits);
}

#endif
