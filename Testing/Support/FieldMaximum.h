// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    FieldMaximum.h
 * @brief   the maximum of the trilinear field along rays, by brute force
 *
 * The field is sampled at 65 points of each cell that a ray passes, unless no voxel of it is larger
 * than what has been found, and refined where a sample is no less than its neighbours. Between
 * samples a cubic's maximum is missed only if a minimum lies there, too, that differs by no more
 * than 64^-3 of the cubic's leading coefficient. Shares no code with the module.
 */
#ifndef reference_FieldMaximum_h
#define reference_FieldMaximum_h

#include "PerspectiveProjection.h"
#include "Projection.h"
#include "Reductions.h"

namespace reference
{
/**
 * Where the field is known: between the centres of the outermost voxels, or to the ends of their
 * boxes, where it is continued by the outermost voxels' values, as it is along axes that have one
 * voxel only.
 */
enum class FieldDomain
{
  Centres,
  Boxes
};

/**
 * A ray passes (at + slope (z - start)) in the slice at depth z, in index space with the axes
 * permuted: axes[2] is the principal one.
 */
struct FieldRay
{
  std::array<int, 3> axes;
  std::array<double, 2> at;
  std::array<double, 2> slope;
  double start;
};

/// The depths between near and far at which a ray is in the field; far < near if none.
std::array<double, 2> depthsInField(const std::array<int, 3>& volumeSize, const FieldRay& ray,
  FieldDomain domain, double near, double far);

/// The trilinear field at a point (i, j, k) of the volume, outermost voxels repeated.
double fieldAt(const Volume<double>& volume, const std::array<double, 3>& point);

/// The largest value of the field between two depths.
double fieldMaximum(const Volume<double>& volume, const FieldRay& ray, double near, double far);

/// What a ray finds in a field that is cut: a value from `low` to `high`, if it finds one.
struct CutMaximum
{
  bool isCertain = true; ///< whether it finds one is no matter of rounding
  bool isHit = false;
  double low = 0.0, high = 0.0;
};

/// The largest value of the field on those parts of a ray between two depths that lie in all
/// half-spaces and in shown regions. All cuts are certain to 1e-5 slices only.
CutMaximum cutMaximum(const Volume<double>& volume, const FieldRay& ray, FieldDomain domain,
  double near, double far, const RayCuts& cuts);

/// The ray of a pixel of a parallel view.
FieldRay fieldRay(const std::array<int, 3>& volumeSize, const ShearView& view, int u, int v);

/// The ray of a pixel of a perspective view.
FieldRay fieldRay(const PerspectiveRays& rays, int u, int v);
}

#endif
