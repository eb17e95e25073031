// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingScreenRays_h
#define splattingScreenRays_h

#include "Projection/Project.h"
#include "Projection/RayFinder.h"
#include "Projection/ShearImage.h"

#include <cstddef>
#include <vector>

namespace splatting
{
/**
 * What the pixels of an exact picture show: what their own rays find, see RayFinder. Pixels whose
 * rays find nothing are interpolated as in other modes.
 */
class ScreenRays
{
public:
  /// No pixel has a value of its own.
  void clear() { this->Rows.clear(); }

  /// @param images  with winners, and with the spans and masks of the whole volume
  void find(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    const RaySource& source, const glm::ivec2& viewport, InstructionSet instructionSet);

  /// The values in one row, so that those of several pieces can be reduced.
  ShearImage& values() { return this->Values; }

  /// Whether pixels have values.
  bool empty() const { return this->Rows.empty(); }
  /// Of pixel x of the picture's row y, which an image shows: a pointer to its value, after which
  /// those of the next pixels lie; NaN if it is interpolated.
  template <class A>
  const A* values(std::size_t image, int x, int y) const
  {
    const Row& row = this->Rows[y * this->Images + image];
    return this->Values.row<A>(0) + row.first + (x - row.shown.begin);
  }

  /// Of a pixel of the viewport, in any type; NaN also where the image does not show it.
  double valueAt(std::size_t image, const glm::ivec2& pixel) const;

private:
  /// Of one image.
  struct Row
  {
    Span shown;
    std::size_t first = 0;
  };

  std::size_t findRows(const std::vector<ShearWarp>& geometries, const glm::ivec2& viewport);

  std::size_t Images = 0;
  glm::ivec2 Origin{ 0 };
  std::vector<Row> Rows;
  ShearImage Values;
};
}

#endif
