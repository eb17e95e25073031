// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    CellBounds.h
 * @brief   bounds of the extremum of a field on a ray whose position has rounding errors
 */
#ifndef reference_CellBounds_h
#define reference_CellBounds_h

#include "CellOracle.h"
#include "Reductions.h"

namespace reference
{
/// Makes a scene of a field, without a view.
CellScene<double> cellScene(const Volume<double>& field, const RayCuts& cuts = {});

struct CellBounds
{
  bool isCertain = true; ///< whether isHit does not depend on rounding
  bool isHit = false;    ///< whether the ray has a sample
  double low = 0.0, high = 0.0;
};

/// Bounds the extremum of the ray between two points.
/// @param beside  the rounding error of the ray's position, in voxels
CellBounds boundsBetween(const CellScene<double>& scene, const glm::dvec3& begin,
  const glm::dvec3& end, bool minima, double beside);
}

#endif
