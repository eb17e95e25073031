// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Volume to shear image: for each slice its worksheet, and the maximum over them [CS98, section 2].
 */
#ifndef splattingProject_h
#define splattingProject_h

#include "Footprint.h"
#include "Kernels.h"
#include "ShearImage.h"
#include "VolumeIndex.h"

#include <memory>

namespace splatting
{
/// How a slice contributes; see vtkSplattingMIPVolumeMapper::SetQualityMode.
enum class Quality
{
  Preview,
  Standard,
  High
};

struct ProjectionSettings
{
  Quality quality = Quality::High;
  /// Reconstruction kernel of Quality::High.
  Kernel kernel;
  /// 0: weights in closed form; N: from a general table with N x N sub-pixels.
  int footprintSampling = 0;
  InstructionSet instructionSet = bestInstructionSet();
};

/**
 * Projects volumes. Holds the threads' work space between frames.
 *
 * The image is cut into bands of rows, and each band walks all slices that reach it, in storage
 * order, so that every thread streams through the volume and owns its pixels. A worksheet lives for
 * one row of one slice, in registers.
 */
class Projector
{
public:
  Projector();
  ~Projector();

  /**
   * @param halfSpaces  of index space; a slice's sample counts for a pixel if the point where the
   *                    ray crosses the middle of the slice lies in all of them
   */
  void project(VolumeIndex& index, const ShearWarp& geometry, const ProjectionSettings& settings,
    const std::vector<glm::dvec4>& halfSpaces, ShearImage& image);

private:
  struct Scratch;
  std::unique_ptr<Scratch> Memory;
};
}

#endif
