// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The intervals of rays, for all cuts at either end of a ray.
 */
#ifndef splattingRayIntervals_h
#define splattingRayIntervals_h

#include "Splat/Projection/ProjectionContext.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace splatting
{
class ClosedSurface;
class SceneDepth;

/**
 * The visible slices of each pixel of a shear image, within those that its ray crosses.
 *
 * The sample of a slice is visible if the ray crosses the slice's middle between its near and far
 * depth. If no sample is visible although the interval has a positive length, the slice nearest to
 * the middle of the interval is visible, so that thin parts show one slice. Points within 1e-9
 * voxels (relative to their coordinates) of a cut are inside. If a surface or a depth buffer
 * removes no part of a ray in the volume, the ray has all slices, even if it is cut outside the
 * volume. Rays of perspective images begin at the eye, and have only slices of ShearWarp::slices().
 */
class RayIntervals
{
public:
  /// Removes all cuts.
  void clear();
  bool empty() const { return this->First.empty(); }

  /**
   * Computes the intervals. They are empty() if nothing cuts the volume.
   * @param halfSpaces  of index space, as in View
   * @param surface     the part outside the surface is cut away; find() calls project() of the
   *   surface
   * @param depth       of the scene, ends rays; placed in the same view
   * @param set         of instructions; all give the same bits
   */
  void find(const ShearWarp& geometry, const std::vector<glm::dvec4>& halfSpaces,
    ClosedSurface* surface = nullptr, const SceneDepth* depth = nullptr,
    InstructionSet set = bestInstructionSet());

  /// Sets the intervals to the slices that each pixel's ray crosses, limited to `within` unless
  /// that is empty.
  void findCrossed(const CrossedSlices& crossed, int width, int height, const RayIntervals& within);

  /// Sets the interval of one pixel, in a row whose other pixels have no slices; see
  /// ShearWarp::takePixel().
  void takePixel(const RayIntervals& whole, const glm::ivec2& pixel, int width);

  /// Copies intervals. Slices are counted from `firstSlice`.
  void setShifted(const RayIntervals& other, int firstSlice);

  /// The first and the last slice of each pixel of a row; first > last if there is none.
  const std::int16_t* first(int v) const { return &this->First[std::size_t(v) * this->Width]; }
  const std::int16_t* last(int v) const { return &this->Last[std::size_t(v) * this->Width]; }

  bool operator==(const RayIntervals& other) const
  {
    return this->Width == other.Width && this->First == other.First && this->Last == other.Last;
  }
  bool operator!=(const RayIntervals& other) const { return !(*this == other); }

private:
  int Width = 0;
  std::vector<std::int16_t> First, Last;
};
}

#endif
