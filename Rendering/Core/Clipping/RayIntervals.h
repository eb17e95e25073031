// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where rays begin and end: one mechanism for everything that cuts a ray at either end.
 */
#ifndef splattingRayIntervals_h
#define splattingRayIntervals_h

#include "Projection/ProjectionContext.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace splatting
{
class ClosedSurface;
class SceneDepth;

/**
 * For each pixel of a shear image the slices whose samples count, as far as the ray crosses them.
 *
 * A slice's sample counts if the point where the ray crosses the slice's middle is between the
 * ray's near and far depth. Where that leaves none although the ray has a positive length, the
 * slice nearest to the middle of the interval counts: what is thinner than a slice shows one.
 * Points within 1e-9 voxels of what cuts (relative to their coordinates) are inside. Rays that lose
 * nothing to a surface or a depth buffer have all slices, whatever cuts them outside the volume.
 * Rays of perspective images begin at the eye, and only have slices in ShearWarp::slices().
 */
class RayIntervals
{
public:
  /// Nothing cuts.
  void clear();
  bool empty() const { return this->First.empty(); }

  /**
   * Empty if nothing cuts the volume.
   * @param halfSpaces  of index space, as View has them
   * @param surface     what lies outside is cut away; it is projected
   * @param depth       of other things in the scene, which end rays; placed in the same view
   * @param set         of instructions; all give the same
   */
  void find(const ShearWarp& geometry, const std::vector<glm::dvec4>& halfSpaces,
    ClosedSurface* surface = nullptr, const SceneDepth* depth = nullptr,
    InstructionSet set = bestInstructionSet());

  /// Sets these to the slices that each pixel's ray crosses, limited to `within` unless that is
  /// empty.
  void findCrossed(const CrossedSlices& crossed, int width, int height, const RayIntervals& within);

  /// Sets these to the interval of one pixel, in a row of which the others have no slices: see
  /// ShearWarp::takePixel().
  void takePixel(const RayIntervals& whole, const glm::ivec2& pixel, int width);

  /// The same intervals with slices counted from another one.
  void setShifted(const RayIntervals& other, int firstSlice);

  /// For each pixel of a row the first slice and the last one; first > last: none.
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
