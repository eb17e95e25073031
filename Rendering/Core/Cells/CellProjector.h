// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact projections: cells are splatted onto the screen, those with the largest voxels first.
 *
 * A cell lies between eight voxels. In it the volume is interpolated trilinearly, so along a ray it
 * is a cubic, whose maximum has a closed form [Sakas et al. 1995]. A pixel shows the largest of
 * the maxima of the cells that its ray crosses. Their order does not matter.
 */
#ifndef splattingCellProjector_h
#define splattingCellProjector_h

#include "Cells/CellIndex.h"
#include "Cells/CellScreen.h"
#include "Clipping/RayEnds.h"
#include "Common/ProgressObserver.h"
#include "Common/ProjectionSettings.h"
#include "Geometry/View.h"

#include <memory>

namespace splatting
{
struct Picture;

/**
 * Projects volumes by cells. Holds the threads' work space between frames.
 *
 * The screen is divided into tiles. A thread takes a tile at a time and owns its pixels. The value
 * of a cell at a pixel depends on the cell and the pixel alone, and is never above the cell's
 * largest voxel: the same bits for any number of threads, order and instruction set.
 */
class CellProjector
{
public:
  CellProjector();
  ~CellProjector();

  /// A ray has no sample if its part in the field, between its ends, is shorter than this in t.
  static constexpr double ShortestRay = 0x1p-20;

  /// Sets the picture's origin and size to the rectangle of the viewport that shows the volume.
  /// Returns false if the view is invalid.
  static bool place(const View& view, Picture& picture);

  /**
   * Sets the rectangle of the viewport that shows the view's volume, and what its pixels show. For
   * Reduction::Signed it projects maxima and minima, and combines them.
   * @param index     of the volume, or of a piece of it
   * @param settings  quality and acceleration are ignored; not for Reduction::Mean
   * @param locate    whether to find the depths of samples
   * @return  false if the view is invalid or the observer has stopped the projection
   */
  bool project(CellIndex& index, const View& view, const ProjectionSettings& settings,
    const RayEnds& ends, bool locate, CellScreen& screen);
  /// The same for a part of the viewport only.
  /// @param within  the part's origin and size
  bool project(CellIndex& index, const View& view, const ProjectionSettings& settings,
    const RayEnds& ends, bool locate, const glm::ivec2 (&within)[2], CellScreen& screen);

  /**
   * Projects a piece of a volume, which may be empty. Each pixel gets a value, or NaN if it has no
   * sample. To combine the pieces, take the largest value of each pixel, also for minima, and the
   * least depth of the pieces that have this value. Then finish() converts values to scalars. For
   * Reduction::Signed do so with the screen's minima, too. Not for Reduction::Local.
   */
  bool projectPiece(CellIndex& index, const View& view, const ProjectionSettings& settings,
    const RayEnds& ends, bool locate, CellScreen& screen);
  static void finish(
    const CellIndex& index, const ProjectionSettings& settings, CellScreen& screen);

  ProgressObserver& observer() { return this->Observer; }

private:
  /// The pixels that are wanted, and whether their values become scalars.
  struct Wanted
  {
    glm::ivec2 origin, size;
    bool finished;
  };
  bool project(CellIndex& index, const View& view, const ProjectionSettings& settings,
    const RayEnds& ends, bool locate, const Wanted& wanted, CellScreen& screen);

  bool projectReduction(CellIndex& index, const View& view, const ProjectionSettings& settings,
    const RayEnds& ends, bool locate, const Wanted& wanted, CellScreen& screen);

  struct Scratch;
  std::unique_ptr<Scratch> Memory;
  ProgressObserver Observer;
};
}

#endif
