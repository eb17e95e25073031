// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The settings of a projection, for both engines.
 */
#ifndef splattingProjectionSettings_h
#define splattingProjectionSettings_h

#include "Kernels/Kernels.h"
#include "Splat/Sampling/Footprint.h"

#include <limits>

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
  /// infinities, and if locations are recorded. Bricks replace chains where rays are cut, in
  /// perspective and with NaN. Lines replace sorted orders outside Quality::Preview.
  Acceleration acceleration = Acceleration::Auto;
  /// Delta encoding of lines: see LineEncoding. 0 gives the same bits as Dense.
  double lineTolerance = 0.0;
  /// Whether the locations of samples are found: of equal samples the nearest to the viewer. Not
  /// for Reduction::Mean.
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
}

#endif
