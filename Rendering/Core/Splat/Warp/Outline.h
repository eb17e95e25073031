// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The pixels of the screen that show a box, row by row.
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
struct Picture;

/// A box of a volume with its axes permuted.
struct Cuboid
{
  glm::dvec3 low, high;
};

/// The box that the picture shows: the boxes of all voxels, or from voxel centre to voxel centre,
/// with the thickness of a single voxel.
Cuboid shownBox(const ShearWarp& geometry);

/**
 * A convex part of the screen, bounded by the lines (a, b, c) where a x + b y + c = 0.
 */
class Outline
{
public:
  /// Of the screen pixels that an image shows. The geometry must outlive its use.
  explicit Outline(const ShearWarp& geometry) : Geometry(geometry) {}

  /// Limits the outline to pixels of the image where a u + b v + c >= 0, moved inwards by `inset`
  /// along both u and v.
  void add(glm::dvec3 line, double inset);

  /// Limits the outline to the image of a box.
  void add(const Cuboid& box, double inset);

  /// Moves all lines outwards by some pixels of the screen along both x and y.
  void growOnScreen(double pixels);

  /// The numbers x in `row` for which the point start + (x, 0, 0) is inside.
  Span cut(Span row, const glm::dvec3& start) const;

  /// The part of a polygon of pixels (x, y, 1) inside.
  std::vector<glm::dvec3> cut(std::vector<glm::dvec3> polygon) const;

private:
  bool faces(const Cuboid& box, int axis, bool high) const;

  const ShearWarp& Geometry;
  std::vector<glm::dvec3> Lines;
};

/// The pixels of the screen that show an image.
Outline shownBy(const ShearWarp& geometry);

/// The pixels of the screen whose areas overlap an image: all in which a voxel can be visible, and
/// some beside them.
Outline metByAreas(const ShearWarp& geometry);

/// The pixels of the screen whose four neighbours in the image are samples, if it has no holes.
Outline withinSamples(const ShearWarp& geometry);

/**
 * Sets the picture's origin and size.
 * @param images  as ShearWarp::factorise() gives them; without any the picture is empty
 */
void placePicture(
  const std::vector<ShearWarp>& images, const glm::ivec2& viewport, Picture& picture);

/// Of a view: one for each direction of each axis.
inline constexpr std::size_t MostImages = 6;

/// Calls show(n, row) for the pixels of a row that show image n, and skip(row) for the others.
/// `start` is the first pixel. Pixels of image n are within shownOf(n).
template <class ShownOf, class Show, class Skip>
void forSpans(std::size_t count, const glm::dvec3& start, int width, const ShownOf& shownOf,
  const Show& show, const Skip& skip)
{
  // Images share their borders: pixels of two images belong to the one that begins first.
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
