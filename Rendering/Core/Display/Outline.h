// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which pixels of the screen show a box, row by row.
 */
#ifndef splattingOutline_h
#define splattingOutline_h

#include "Geometry/ShearWarp.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace splatting
{
/// A box of a volume with its axes permuted.
struct Cuboid
{
  glm::dvec3 low, high;
};

/// The box that the picture shows: all of the voxels' boxes, or voxel centre to voxel centre and a
/// single voxel's whole thickness.
Cuboid shownBox(const ShearWarp& geometry);

/**
 * A convex part of the screen, bounded by the lines (a, b, c) where a x + b y + c = 0.
 */
class Outline
{
public:
  /// Of the screen pixels that an image shows. The geometry must outlive its use.
  explicit Outline(const ShearWarp& geometry) : Geometry(geometry) {}

  /// Keeps pixels of the image where a u + b v + c >= 0, off the line by `inset` along both u and
  /// v.
  void add(glm::dvec3 line, double inset);

  /// Keeps what the image shows of a box.
  void add(const Cuboid& box, double inset);

  /// Moves all lines outwards by so many pixels of the screen along both x and y.
  void growOnScreen(double pixels);

  /// The x in `row` for which the point (x, 0, 0) from `start` is inside.
  Span cut(Span row, const glm::dvec3& start) const;

  /// What is inside of a polygon of pixels (x, y, 1).
  std::vector<glm::dvec3> cut(std::vector<glm::dvec3> polygon) const;

private:
  bool faces(const Cuboid& box, int axis, bool high) const;

  const ShearWarp& Geometry;
  std::vector<glm::dvec3> Lines;
};

/// The pixels of the screen that an image shows something in.
Outline shownBy(const ShearWarp& geometry);

/// The pixels of the screen whose areas meet something that an image shows: all in which a voxel
/// can be seen, and some beside them.
Outline metByAreas(const ShearWarp& geometry);

/// The pixels of the screen whose four neighbours in the image are samples, if it has no holes.
Outline withinSamples(const ShearWarp& geometry);

/// Of a view: one for each direction of each axis.
inline constexpr std::size_t MostImages = 6;

/// Calls show(n, row) for the pixels of a row, `start` being the first, that image n shows, and
/// skip(row) for those that none does. What is shown of image n is within shownOf(n).
template <class ShownOf, class Show, class Skip>
void forSpans(std::size_t count, const glm::dvec3& start, int width, const ShownOf& shownOf,
  const Show& show, const Skip& skip)
{
  // Images meet at lines: the one that begins first has the pixels that two show.
  std::array<std::size_t, MostImages> order;
  std::array<Span, MostImages> spans;
  for (std::size_t n = 0; n < count; ++n)
  {
    spans[n] = shownOf(n).cut({ 0, width }, start);
    std::size_t place = n;
    for (; place > 0 && spans[n].begin < spans[order[place - 1]].begin; --place)
    {
      order[place] = order[place - 1];
    }
    order[place] = n;
  }
  int done = 0;
  for (std::size_t n = 0; n < count; ++n)
  {
    const std::size_t which = order[n];
    const Span row{ std::max(spans[which].begin, done), spans[which].end };
    if (!row.empty())
    {
      skip(Span{ done, row.begin });
      show(which, row);
      done = row.end;
    }
  }
  skip(Span{ done, width });
}
}

#endif
