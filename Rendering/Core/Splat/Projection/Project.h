// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From volume to shear image: the worksheet of each slice, and the maximum over them [CS98, section
 * 2].
 */
#ifndef splattingProject_h
#define splattingProject_h

#include "Common/ProgressObserver.h"
#include "Kernels/Kernels.h"
#include "Splat/Projection/ShearImage.h"
#include "Splat/Sampling/Footprint.h"
#include "Splat/Walks/Cuts.h"
#include "Volume/VolumeIndex.h"

#include <limits>
#include <memory>

namespace splatting
{
/// The contribution of a slice; see vtkSplattingMIPVolumeMapper::SetQualityMode().
enum class Quality
{
  Preview,
  Standard,
  High,
  Exact
};

/// Skipped voxels and the order of the others; see vtkSplattingMIPVolumeMapper::SetAcceleration().
enum class Acceleration
{
  Auto,
  Dense,
  Bricks,
  Lines,
  SortedLines,
  SortedVolume
};

/// The reduction of the samples along a ray; see vtkSplattingMIPVolumeMapper::SetMaximumType().
/// Each slice that the ray crosses gives one sample, the value of its worksheet. In preview samples
/// are voxels.
enum class Reduction
{
  Maximum,
  Minimum,
  Mean,
  DepthShaded, ///< the maximum of samples, each multiplied by a factor of its depth
  Local,       ///< the first local maximum, from the viewer, at or above a threshold
  Signed       ///< maximum or minimum, whichever is farther from an origin; if equal the maximum
};

/// Whether samples are used in arithmetic, so that the image's scalars have type Accumulator<T>.
inline bool computesWith(Reduction reduction)
{
  return reduction == Reduction::Mean || reduction == Reduction::DepthShaded;
}

/// Whether the side of the viewer matters.
inline bool isOrdered(Reduction reduction)
{
  return reduction == Reduction::DepthShaded || reduction == Reduction::Local;
}

struct ProjectionSettings
{
  Quality quality = Quality::High;
  Reduction reduction = Reduction::Maximum;
  /// Of Reduction::DepthShaded: sample n of N along a ray, 0 being the nearest to the viewer, is
  /// multiplied by ambient + (1 - n / N) changeRate, relative to the volume's lowest voxel
  /// [Bruckner, Program 4.3].
  double ambient = 0.3;
  double changeRate = 0.7;
  /// Of Reduction::Local.
  double threshold = -std::numeric_limits<double>::infinity();
  /// Of Reduction::Signed.
  double origin = 0.0;
  /// Of Reduction::Mean: the range of samples.
  double meanLow = -std::numeric_limits<double>::infinity();
  double meanHigh = std::numeric_limits<double>::infinity();
  /// Reconstruction kernel of Quality::High.
  Kernel kernel;
  /// 0: weights in closed form; N: from a general table with N x N sub-pixels.
  int footprintSampling = 0;
  InstructionSet instructionSet = bestInstructionSet();
  /// Dense is used for reductions other than Maximum and the maxima of Signed, for volumes with
  /// infinities, and for volumes with NaN if winners are recorded. Bricks replace chains where rays
  /// are cut, in perspective and with NaN. Lines replace sorted orders outside Quality::Preview.
  Acceleration acceleration = Acceleration::Auto;
  /// Delta encoding of lines: see LineEncoding. 0 gives the same bits as Dense.
  double lineTolerance = 0.0;
  /// Whether the image has winners: of equal samples the nearest to the viewer. Not for
  /// Reduction::Mean. Bricks then replace chains.
  bool recordLocations = false;
  /// Pixels are clamped to at least this value (in preview rounded down to the scalar type).
  double floor = -std::numeric_limits<double>::infinity();

  bool operator==(const ProjectionSettings& other) const
  {
    return this->quality == other.quality && this->reduction == other.reduction &&
      this->ambient == other.ambient && this->changeRate == other.changeRate &&
      this->threshold == other.threshold && this->origin == other.origin &&
      this->meanLow == other.meanLow && this->meanHigh == other.meanHigh &&
      this->kernel == other.kernel && this->footprintSampling == other.footprintSampling &&
      this->instructionSet == other.instructionSet && this->acceleration == other.acceleration &&
      this->lineTolerance == other.lineTolerance &&
      this->recordLocations == other.recordLocations && this->floor == other.floor;
  }
};

class ProjectionMode;

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
   * @param first  the first voxel of the index in the volume of geometry and cuts, along the
   *               volume's axes. If the index has a piece of the volume, the image has the samples
   *               that can be computed from the piece alone, see Piece.h, and chains are not used.
   * @return the acceleration that was used: never Auto, and Dense if there is no memory for another
   *         one. If stopped(), the image is invalid.
   */
  Acceleration project(VolumeIndex& index, const ShearWarp& geometry,
    const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image,
    const glm::ivec3& first = glm::ivec3(0));

  /// Sets the spans and the mask of an image of the whole volume, whose pixels were reduced from
  /// pieces.
  void outline(const ShearWarp& geometry, const ProjectionSettings& settings, const Cuts& cuts,
    ShearImage& image);

  /**
   * Takes the values of another volume at the winners of the last projected image: in preview
   * voxels, else averages with the same footprints. Not for Reduction::Signed.
   *
   * @param other  of the same type and size as the projected volume
   */
  void takeAtLocations(const VoxelArray& other, const ShearWarp& geometry,
    const ProjectionSettings& settings, const ShearImage& projected, ShearImage& image);

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
