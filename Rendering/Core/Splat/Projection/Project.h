// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From volume to shear image: the worksheet of each slice, and the maximum over them [CS98, section
 * 2].
 */
#ifndef splattingProject_h
#define splattingProject_h

#include "Common/ProgressObserver.h"
#include "Common/ProjectionSettings.h"
#include "Kernels/Kernels.h"
#include "Splat/Projection/ShearImage.h"
#include "Splat/Walks/Cuts.h"
#include "Volume/VolumeIndex.h"

#include <memory>
#include <vector>

namespace splatting
{
class ProjectionMode;

/// A volume whose values are taken at the samples of another one, and their image.
struct AtSamples
{
  VoxelArray volume;
  ShearImage& image;
};

/**
 * Projects volumes into shear images. Holds the threads' work space between frames.
 *
 * The image is divided into bands of rows. One thread walks a band and owns its pixels, so the bits
 * are the same for any number of threads. See BandWalk for the order of slices.
 */
class Projector
{
public:
  Projector();
  ~Projector();

  /**
   * For all modes except Quality::Exact, which CellProjector projects. For Reduction::Signed it
   * projects maxima and minima, see ShearImage::minima.
   *
   * @param first   the first voxel of the index in the volume of geometry and cuts, along the
   *                volume's axes. If the index has a piece of the volume, the image has the samples
   *                that can be computed from the piece alone, see Piece.h, and chains are not used.
   * @param others  volumes of the same type and size, whose values are taken at the image's
   *                samples: in preview voxels, else averages with the same footprints. For whole
   *                volumes and settings with recordLocations; not for Reduction::Signed.
   * @return the acceleration that was used: never Auto, and Dense if there is no memory for another
   *         one. If stopped(), the image is invalid.
   */
  Acceleration project(VolumeIndex& index, const ShearWarp& geometry,
    const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image,
    const glm::ivec3& first = glm::ivec3(0), const std::vector<AtSamples>& others = {});

  /// Sets the spans and the mask of an image of the whole volume, whose pixels were reduced from
  /// pieces.
  void outline(const ShearWarp& geometry, const ProjectionSettings& settings, const Cuts& cuts,
    ShearImage& image);

  /// Sets a function that gets the completed share, 0 to 1, while chains are made.
  void setProgress(const std::function<void(double)>& progress) { this->Progress = progress; }
  /// Sets the function that returns whether to continue, called by the thread that called
  /// project(). While chains are made, its argument is 0.
  void setObserver(const ProgressObserver::Callback& callback)
  {
    this->Observer.setCallback(callback);
  }
  /// Whether the observer stopped the last projection.
  bool stopped() const { return this->Observer.stopped(); }

private:
  Acceleration projectReduction(VolumeIndex& index, const ShearWarp& geometry,
    const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image,
    const glm::ivec3& first);
  void takeAtLocations(const AtSamples& other, const ShearWarp& geometry,
    const ProjectionSettings& settings, const ShearImage& projected);
  void findWhole(const ShearWarp& geometry, const ProjectionSettings& settings);
  const ShearWarp& findPart(const ShearWarp& whole, const glm::ivec3& first,
    const glm::ivec3& dimensions, const Cuts& cuts);
  void countSteps(const ShearWarp& whole, const ShearWarp& geometry,
    const ProjectionSettings& settings, const Cuts& cuts, int width, int height);
  Acceleration possible(Acceleration wanted, VolumeIndex& index, const ProjectionSettings& settings,
    const ShearWarp& geometry, const Cuts& cuts, const LineIndex*& lines);
  ProjectionMode& mode(Quality quality, bool perspective);

  struct Scratch;
  std::unique_ptr<Scratch> Memory;
  std::function<void(double)> Progress;
  ProgressObserver Observer;
};
}

#endif
