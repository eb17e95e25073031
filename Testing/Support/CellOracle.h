// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    CellOracle.h
 * @brief   slow and obvious exact projections: every cell on a pixel's ray, from the definition
 *
 * The field is interpolated trilinearly between voxel centres. It ends at the outermost centres, or
 * at the outermost voxels' sides where boxes are shown and along axes with one voxel; beyond the
 * centres it is constant. In a cell with a corner that is NaN or infinite each octant has the value
 * of its nearest voxel, or none if that is NaN.
 *
 * Shares no code with the module. R is the type to compute with: double for voxels of up to 16 bits
 * and float, long double for wider ones.
 */
#ifndef reference_CellOracle_h
#define reference_CellOracle_h

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace reference
{
/// What is projected, and what of it is shown. Lengths are in voxels, in index space.
template <class R>
struct CellScene
{
  glm::ivec3 size{ 0 };
  std::vector<R> voxels; ///< x fastest

  double indexToClip[4][4] = {}; ///< column by column
  glm::ivec2 viewport{ 0 };
  bool showsBoxes = false;
  std::vector<glm::dvec4> halfSpaces; ///< dot(h, (x, y, z, 1)) >= 0
  std::array<glm::dvec2, 3> planes{}; ///< of cropping
  std::uint32_t flags = (1u << 27) - 1;
  std::vector<std::array<glm::dvec3, 3>> triangles; ///< of a closed surface
  std::vector<float> depths; ///< of each pixel of the viewport, 0 to 1; 1 ends nothing
};

/// start + t direction; the direction's length is 1.
template <class R>
struct CellRay
{
  R start[3], direction[3];
  R near, far; ///< where the field begins and ends, cut by everything but cropping
};

/// The part of a ray in a cell, or in an octant of a cell that is not interpolated.
template <class R>
struct CellSegment
{
  R from, to;
  glm::ivec3 cell; ///< between voxels cell and cell + 1, which are clamped to the volume
  bool isInterpolated;
  R voxel; ///< of the octant
};

template <class R>
struct CellSample
{
  bool exists = false;
  R value = 0, t = 0;

  /// Keeps the larger one, of equal ones the first.
  void raise(R newValue, R newT)
  {
    if (!this->exists || newValue > this->value)
    {
      *this = { true, newValue, newT };
    }
  }
};

struct CellShading
{
  double lowest, ambient, changeRate;
};

template <class R>
class CellOracle
{
public:
  /// @param shortest  cells and octants that a ray crosses over less are left out
  explicit CellOracle(const CellScene<R>& scene, double shortest = 1e-13)
    : Scene(scene),
      Shortest(shortest)
  {
    this->findBox();
  }

  /**
   * The ray through a pixel's centre, which lies at integers.
   * @param shift  of the ray, in voxels
   */
  CellRay<R> ray(double x, double y, const glm::dvec3& shift = glm::dvec3(0.0)) const;
  /// The ray from one point to another.
  CellRay<R> between(const glm::dvec3& begin, const glm::dvec3& end) const;

  /// The parts of a ray that are shown, from the viewer on.
  std::vector<CellSegment<R>> segments(const CellRay<R>& ray) const;

  /// The largest value of a ray, of minima the least.
  CellSample<R> largest(const CellRay<R>& ray, bool minima = false) const;
  /// The largest of the segments' maxima, each shaded by the place of the segment's middle.
  CellSample<R> shaded(const CellRay<R>& ray, const CellShading& shading) const;
  /// The first local maximum at or above a threshold, else the largest value. Falls of up to
  /// `rounding` are none.
  CellSample<R> local(const CellRay<R>& ray, double threshold, double rounding) const;
  /// A lower bound of largest() (of minima an upper one) for a ray whose place each cell may take
  /// from any of these rays, which are parallel: the largest value that all of them show at the
  /// same t.
  CellSample<R> certain(const std::vector<CellRay<R>>& rays, bool minima) const;

  /// The field where a ray passes, of those segments that lie within `margin` of it: the least and
  /// the largest. False if there is none.
  bool fieldAt(const CellRay<R>& ray, R t, R margin, R& least, R& largest) const;
  /// Where a ray enters the first segment whose corners all have a value.
  bool firstPlateau(const CellRay<R>& ray, R value, R& t) const;

private:
  /// Values and places of a segment's ends and of what extrema lie between.
  struct Course
  {
    int count = 0;
    R values[4], places[4];
  };

  void findBox();
  void cutByPlanes(CellRay<R>& ray) const;
  R voxel(const glm::ivec3& p) const;
  bool isInterpolated(const glm::ivec3& cell) const;
  R interpolate(const CellSegment<R>& segment, const CellRay<R>& ray, R t) const;
  Course course(const CellSegment<R>& segment, const CellRay<R>& ray) const;
  CellSample<R> largestOf(const CellSegment<R>& segment, const CellRay<R>& ray, R sense) const;
  void cutBySurface(CellRay<R>& ray, R begin) const;
  bool isCropped(const R (&p)[3]) const;
  std::vector<std::array<R, 2>> shownParts(const CellRay<R>& ray) const;

  const CellScene<R>& Scene;
  const R Shortest;
  R Low[3], High[3];
};

extern template class CellOracle<double>;
extern template class CellOracle<long double>;
}

#endif
