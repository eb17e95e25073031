// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Volume to shear image: for each slice its worksheet, and the maximum over them [CS98, section 2].
 */
#ifndef splattingProject_h
#define splattingProject_h

#include "Clipping/Cuts.h"
#include "Common/ProgressObserver.h"
#include "Kernels/Kernels.h"
#include "Projection/ShearImage.h"
#include "Sampling/Footprint.h"
#include "Volume/VolumeIndex.h"

#include <limits>
#include <memory>

namespace splatting
{
/// How a slice contributes; see vtkSplattingMIPVolumeMapper::SetQualityMode.
enum class Quality
{
  Preview,
  Standard,
  High,
  Exact
};

/// What is left out and in which order the rest is walked; see
/// vtkSplattingMIPVolumeMapper::SetAcceleration.
enum class Acceleration
{
  Auto,
  Dense,
  Bricks,
  Lines,
  SortedLines,
  SortedVolume
};

/// What becomes of the samples along a ray: the worksheets' values of the slices that it crosses,
/// in preview the voxels; see vtkSplattingMIPVolumeMapper::SetMaximumType.
enum class Reduction
{
  Maximum,
  Minimum,
  Mean,
  DepthShaded, ///< the maximum of samples, each shaded by its depth along the ray
  Local        ///< the first local maximum, from the viewer, at or above a threshold
};

/// Whether samples enter arithmetic, so that the image's scalars are of type Accumulator<T>.
inline bool computesWith(Reduction reduction)
{
  return reduction == Reduction::Mean || reduction == Reduction::DepthShaded;
}

/// Whether it matters which end of a ray is nearest to the viewer.
inline bool isOrdered(Reduction reduction)
{
  return reduction == Reduction::DepthShaded || reduction == Reduction::Local;
}

struct ProjectionSettings
{
  Quality quality = Quality::High;
  Reduction reduction = Reduction::Maximum;
  /// Of Reduction::DepthShaded: the n-th of N slices along a ray, n = 0 the nearest to the viewer,
  /// is multiplied by ambient + (1 - n / N) changeRate, relative to the volume's lowest voxel
  /// [Bruckner, Program 4.3].
  double ambient = 0.3;
  double changeRate = 0.7;
  /// Of Reduction::Local.
  double threshold = -std::numeric_limits<double>::infinity();
  /// Of Reduction::Mean: the samples that count.
  double meanLow = -std::numeric_limits<double>::infinity();
  double meanHigh = std::numeric_limits<double>::infinity();
  /// Reconstruction kernel of Quality::High.
  Kernel kernel;
  /// 0: weights in closed form; N: from a general table with N x N sub-pixels.
  int footprintSampling = 0;
  InstructionSet instructionSet = bestInstructionSet();
  /// Reductions other than Maximum are walked densely, as are volumes with infinities, and those
  /// with NaN if winners are kept. Lines and its sorted kin are Bricks where rays are cut, in
  /// perspective and where there are NaN; sorted orders are for Quality::Preview, elsewhere they
  /// are Lines.
  Acceleration acceleration = Acceleration::Auto;
  /// Delta encoding of lines: see LineEncoding. 0 gives the same bits as Dense.
  double lineTolerance = 0.0;
  /// Whether the image tells its winners: of equal samples the nearest to the viewer. Means have
  /// none: not for Reduction::Mean. Lines and its sorted kin are Bricks then.
  bool keepWinners = false;
  /// Which voxels the rays of shear images meet, as ShearWarp::factorise() takes it. Not compared:
  /// images are.
  Meets meets = Meets::All;
  /// Values at or below need not be told apart: the image is the larger of this (in preview rounded
  /// down to the scalar type) and what it would be otherwise.
  double floor = -std::numeric_limits<double>::infinity();

  bool operator==(const ProjectionSettings& other) const
  {
    return this->quality == other.quality && this->reduction == other.reduction &&
      this->ambient == other.ambient && this->changeRate == other.changeRate &&
      this->threshold == other.threshold && this->meanLow == other.meanLow &&
      this->meanHigh == other.meanHigh && this->kernel == other.kernel &&
      this->footprintSampling == other.footprintSampling &&
      this->instructionSet == other.instructionSet && this->acceleration == other.acceleration &&
      this->lineTolerance == other.lineTolerance && this->keepWinners == other.keepWinners &&
      this->floor == other.floor;
  }
};

class ProjectionMode;

/**
 * Projects volumes. Holds the threads' work space between frames.
 *
 * The image is cut into bands of rows, each walked by one thread, which owns its pixels: the same
 * bits for any number of threads. See BandWalk for the order in which a band meets the slices.
 */
class Projector
{
public:
  Projector();
  ~Projector();

  /**
   * For all modes but Quality::Exact, which CellProjector projects.
   *
   * @param first  where the index' voxels begin in the volume that the geometry and the cuts are
   * of, along the volume's axes. If they are a piece of it, the image holds the samples that can be
   * computed from the piece alone: see Piece.h. Chains are not walked.
   * @return what has been used: never Auto, and Dense where there is no memory for what was asked.
   *         If stopped(), the image has no meaning.
   */
  Acceleration project(VolumeIndex& index, const ShearWarp& geometry,
    const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image,
    const glm::ivec3& first = glm::ivec3(0));

  /// The spans and the mask of an image of the whole volume, whose pixels came from pieces.
  void outline(const ShearWarp& geometry, const ProjectionSettings& settings, const Cuts& cuts,
    ShearImage& image);

  /**
   * What another volume has where the last projected image found its winners: in preview the
   * voxels, else the averages by the same footprints.
   *
   * @param other  of the same type and size as the projected volume
   */
  void takeAtWinners(const VoxelArray& other, const ShearWarp& geometry,
    const ProjectionSettings& settings, const ShearImage& projected, ShearImage& image);

  /// Called with the share that is done, 0 to 1, while chains are made.
  void setProgress(const std::function<void(double)>& progress) { this->Progress = progress; }
  /// Asked by the thread that called project() whether to go on; while chains are made, with 0.
  void setObserver(const ProgressObserver::Callback& callback)
  {
    this->Observer.setCallback(callback);
  }
  /// Whether the last projection was given up.
  bool stopped() const { return this->Observer.stopped(); }

private:
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
