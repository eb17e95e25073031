// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Stretch.h
 * @brief   the part of a line that is inside half-spaces and boxes
 */
#ifndef reference_Stretch_h
#define reference_Stretch_h

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace reference
{

/**
 * The part of a line p(t) = from + t direction between two t; empty if the end is before the begin.
 */
template <class R>
struct Stretch
{
  R begin = -std::numeric_limits<R>::infinity();
  R end = std::numeric_limits<R>::infinity();

  R length() const { return this->end - this->begin; }

  /// Keeps the part with value + t speed >= 0.
  void cut(R value, R speed)
  {
    if (speed > 0)
    {
      this->begin = std::max(this->begin, -value / speed);
    }
    else if (speed < 0)
    {
      this->end = std::min(this->end, -value / speed);
    }
    else if (value < 0)
    {
      this->end = -std::numeric_limits<R>::infinity();
    }
  }
  void narrow(const Stretch& other)
  {
    this->begin = std::max(this->begin, other.begin);
    this->end = std::min(this->end, other.end);
  }
};

/**
 * Half-spaces h are the points with dot(h, (x, y, z, 1)) >= 0.
 */
inline Stretch<double> inside(
  const std::vector<glm::dvec4>& halfSpaces, const glm::dvec3& from, const glm::dvec3& direction)
{
  Stretch<double> stretch;
  for (const glm::dvec4& h : halfSpaces)
  {
    stretch.cut(glm::dot(h, glm::dvec4(from, 1.0)), glm::dot(glm::dvec3(h), direction));
  }
  return stretch;
}

inline std::vector<glm::dvec4> halfSpacesOfBox(const glm::dvec3& low, const glm::dvec3& high)
{
  std::vector<glm::dvec4> result;
  for (int a = 0; a < 3; ++a)
  {
    glm::dvec4 h(0.0, 0.0, 0.0, -low[a]);
    h[a] = 1.0;
    result.push_back(h);
    h = { 0.0, 0.0, 0.0, high[a] };
    h[a] = -1.0;
    result.push_back(h);
  }
  return result;
}

/**
 * The box of the centres of a volume's outermost voxels, or of these voxels where it `showsBoxes`
 * and along axes that have one voxel only, grown by a margin.
 */
inline std::vector<glm::dvec4> boxOfVolume(
  const glm::ivec3& size, bool showsBoxes, double margin = 0.0)
{
  glm::dvec3 low, high;
  for (int a = 0; a < 3; ++a)
  {
    low[a] = (showsBoxes || size[a] == 1 ? -0.5 : 0.0) - margin;
    high[a] = size[a] - 1 - low[a];
  }
  return halfSpacesOfBox(low, high);
}

} // namespace reference

#endif
