// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellBounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace reference
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
}

CellScene<double> cellScene(const Volume<double>& field, const RayCuts& cuts)
{
  CellScene<double> scene;
  scene.size = { field.size[0], field.size[1], field.size[2] };
  scene.voxels = field.voxels;
  for (const std::array<double, 4>& h : cuts.halfSpaces)
  {
    scene.halfSpaces.emplace_back(h[0], h[1], h[2], h[3]);
  }
  for (int a = 0; a < 3; ++a)
  {
    scene.planes[a] = { cuts.planes[a][0], cuts.planes[a][1] };
  }
  scene.flags = cuts.regions;
  return scene;
}

CellBounds boundsBetween(const CellScene<double>& scene, const glm::dvec3& begin,
  const glm::dvec3& end, bool minima, double beside)
{
  const CellOracle<double> oracle(scene), coarse(scene, 8.0 * beside);
  const CellRay<double> ray = oracle.between(begin, end);
  std::vector<CellSample<double>> samples{ coarse.largest(ray, minima) };
  // Rays beside the ray, on both sides of any plane.
  for (const glm::dvec3& side : { glm::dvec3(0.0), { 1.0, 1.0, 1.0 }, { 1.0, -1.0, -1.0 },
         { -1.0, 1.0, -1.0 }, { -1.0, -1.0, 1.0 } })
  {
    samples.push_back(
      oracle.largest(oracle.between(begin + beside * side, end + beside * side), minima));
  }
  // Whether a ray that only touches the field has a sample depends on rounding.
  CellBounds bounds{ std::abs(ray.far - ray.near) > 1e-5, samples.front().exists, Infinity,
    -Infinity };
  for (const CellSample<double>& sample : samples)
  {
    bounds.isCertain = bounds.isCertain && sample.exists == bounds.isHit;
    bounds.low = sample.exists ? std::min(bounds.low, sample.value) : bounds.low;
    bounds.high = sample.exists ? std::max(bounds.high, sample.value) : bounds.high;
  }
  return bounds;
}
}
