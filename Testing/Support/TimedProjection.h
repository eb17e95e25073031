// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    TimedProjection.h
 * @brief   the competitors of splatting in comparisons of time: what a good programmer writes in an
 *          afternoon
 *
 * The projections of Projection.h are too slow for that. These compute the same in floating point,
 * for 8-bit volumes, with the rows of the picture shared out among vtkSMPTools' threads, no index,
 * no empty-space skipping and no vector instructions but those that the compiler finds.
 */
#ifndef reference_TimedProjection_h
#define reference_TimedProjection_h

#include "Projection.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace reference
{

using Bytes = Volume<std::uint8_t>;

/**
 * Parallel rays: sample n, any integer, of the ray of pixel (x, y) lies at the index position
 * origin + x perColumn + y perRow + n step.
 */
struct Rays
{
  int width = 0;
  int height = 0;
  glm::dvec3 origin{ 0.0 };
  glm::dvec3 perColumn{ 0.0 };
  glm::dvec3 perRow{ 0.0 };
  glm::dvec3 step{ 0.0 };
};

/**
 * The rays of the shear image with samples at depths that are multiples of the distance, as in
 * pointSampledTrilinear().
 */
Rays shearRays(const std::array<int, 3>& volumeSize, const ShearView& view, double distance);

/**
 * Ray casting: the maximum over the samples inside the volume's box [-1/2, n-1/2]^3. A sample is
 * the voxel that holds it, or interpolated trilinearly, the outermost voxels repeated. The picture
 * takes the size of the rays; its memory is used again.
 */
void castNearest(const Bytes& volume, const Rays& rays, Image<float>& picture);
void castTrilinear(const Bytes& volume, const Rays& rays, Image<float>& picture);

/**
 * Ray casting through every voxel that a ray crosses, by Amanatides and Woo. Differs from
 * exactTraversal() only where rays pass edges closer than rounding errors.
 */
void castThroughVoxels(const Bytes& volume, const Rays& rays, Image<float>& picture);

/**
 * A volume along its principal axis: voxel (i, j, k) at voxels[i + j rowStride + k sliceStride].
 */
struct SliceStack
{
  const std::uint8_t* voxels = nullptr;
  std::ptrdiff_t rowStride = 0;
  std::ptrdiff_t sliceStride = 0;
};

/**
 * A picture of bytes, and of each row the half-open range of pixels that have samples.
 */
struct ByteImage
{
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> value;
  std::vector<std::array<int, 2>> range;
};

/**
 * projectiveShearWarp() with nearest samples: for each slice one shift and one maximum per pixel.
 * Pixels without sample become 0. The image's memory is used again.
 */
void projectSlices(
  const SliceStack& slices, const ShearGrid& grid, const ShearView& view, ByteImage& image);

} // namespace reference

#endif
