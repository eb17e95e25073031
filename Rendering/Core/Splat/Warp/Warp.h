// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From shear images to the viewport: interpolates scalars.
 */
#ifndef splattingWarp_h
#define splattingWarp_h

#include "Common/ProgressObserver.h"
#include "Display/ScreenScalars.h"
#include "Kernels/Kernels.h"
#include "Splat/Projection/Project.h"
#include "Splat/Projection/ShearImage.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <vector>

namespace splatting
{
/**
 * The scalars of shear images. Each pixel shows the image whose axis its ray follows most. The
 * picture ends at the box of the outermost voxel centres. The box is half a voxel larger on each
 * side along axes with one voxel, and along all axes if the geometry shows boxes. If the eye is
 * inside this box, the picture has no end.
 *
 * In overviews pixels have the extremum or the average of their areas, see PixelArea.h, and the
 * picture ends where areas do not overlap the volume. For Reduction::Signed each pixel shows the
 * one of its maximum and its minimum, both interpolated, that is farther from the images' origin.
 *
 * Holds work space between frames.
 */
class WarpedScalars : public ScreenScalars
{
public:
  /**
   * Sets what is shown, which must exist while rows are read.
   * @param images      all of one type; those beyond the number of geometries are ignored
   * @param geometries  as ShearWarp::factorise() returns them; without any there are no pixels
   */
  void set(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const glm::ivec2& viewport, InstructionSet instructionSet);

  const void* valuesOfRow(int y, void* space) const override;

  /// Sets the function that returns whether to continue. It is called while rows of overviews are
  /// read, by the thread that has called set(). Its argument is undefined.
  void setObserver(const ProgressObserver::Callback& callback)
  {
    this->Observer.setCallback(callback);
  }
  /// Whether the observer has stopped the warp: values are missing.
  bool stopped() const { return this->IsObserved && this->Observer.stopped(); }

  /// Warps rows of pixels of one type.
  class Rows
  {
  public:
    virtual ~Rows() = default;
    /// @param start  the first pixel
    virtual void warp(const glm::dvec3& start, int width, void* values) const = 0;
  };

private:
  mutable ProgressObserver Observer;
  bool IsObserved = false;
  std::unique_ptr<Rows> Source; // if there are pixels
  /// Images converted to the accumulator's type, if they have another type or holes.
  std::vector<std::vector<unsigned char>> Copied;
};
}

#endif
