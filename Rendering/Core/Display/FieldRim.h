// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact mode at the field's rim. The warp interpolates between rays. Where these are in the field
 * over very different lengths, or miss it, what lies between them need not be anything that the
 * screen pixel's own ray meets. Such pixels get the maximum along their own ray.
 */
#ifndef splattingFieldRim_h
#define splattingFieldRim_h

#include "Clipping/Cuts.h"
#include "Projection/Project.h"
#include "Projection/ShearImage.h"

#include <cstddef>
#include <vector>

namespace splatting
{
/// What the images of a view were projected from.
struct FieldRimSource
{
  VoxelArray volume;                       ///< or a piece of it, or without voxels none of it
  glm::ivec3 first{ 0 };                   ///< the piece's first voxel
  const std::vector<Cuts>* cuts = nullptr; ///< of each image
};

/// Whether a projection's pixels at the rim get values of their own.
inline bool hasFieldRim(const ProjectionSettings& settings)
{
  return settings.quality == Quality::Exact && settings.reduction == Reduction::Maximum;
}

/**
 * The pixels of a picture that are interpolated between four rays of which one misses the field,
 * and those whose own ray is in it for less than three voxels where one of the four is in it for
 * less than half as long as another; both no further than two pixels of the shear image from its
 * outline. And what their own rays find.
 *
 * Their samples are slices, as in the image: one counts if the pixel's own ray crosses the middle
 * of the slice in a region that cropping shows, and if it is in the interval of the nearest of the
 * four rays. Pixels without a sample are interpolated as all others.
 */
class FieldRim
{
public:
  /// No pixel has a value of its own.
  void clear() { this->Rows.clear(); }

  /// @param images  with the spans and masks of the whole volume
  void find(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    const FieldRimSource& source, const glm::ivec2& viewport);

  /// The values in one row, so that those of several pieces can be reduced.
  ShearImage& values() { return this->Values; }

  /// Of pixel x of the picture's row y, which an image shows; NaN if it is interpolated.
  template <class A>
  A value(std::size_t image, int x, int y) const
  {
    if (this->Rows.empty())
    {
      return std::numeric_limits<A>::quiet_NaN();
    }
    const Row& row = this->Rows[y * this->Images + image];
    if (x >= row.inside.begin && x < row.inside.end)
    {
      return std::numeric_limits<A>::quiet_NaN();
    }
    return this->Values.row<A>(0)[row.first + row.place(x)];
  }

  /// Of a row of an image the pixels that surely are interpolated.
  Span inside(std::size_t image, int y, const Span& row) const
  {
    return this->Rows.empty() ? row : this->Rows[y * this->Images + image].inside;
  }

private:
  /// Of one image.
  struct Row
  {
    Span shown, inside; ///< the latter is in the former, or empty and at its end
    std::size_t first = 0;

    int place(int x) const
    {
      return x < this->inside.begin
        ? x - this->shown.begin
        : x - this->shown.begin - (this->inside.end - this->inside.begin);
    }
    int count() const { return this->place(this->shown.end); }
  };

  std::size_t findRows(const std::vector<ShearWarp>& geometries, const glm::ivec2& viewport);

  std::size_t Images = 0;
  glm::ivec2 Origin{ 0 };
  std::vector<Row> Rows;
  ShearImage Values;
};
}

#endif
