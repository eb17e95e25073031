// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProjectionSettings_h
#define ProjectionSettings_h

#include "vtkSplattingMIPProjection.h"

#include <array>

/**
 * What of a volume is projected, and how, but for the quality mode.
 */
struct ProjectionSettings
{
  int Kernel = vtkSplattingMIPProjection::TRILINEAR;
  double KernelRadius = 1.0; // voxels
  int BlendMode = vtkSplattingMIPProjection::MAXIMUM_INTENSITY_BLEND;
  bool DepthShading = false;
  double Slab = 0.0;       // its thickness in mm, or 0
  double SlabOffset = 0.0; // of its middle from the volume's to the viewer, mm
  bool Cropping = false;
  std::array<double, 6>
    Crop = {}; // from, to along each axis of the volume, mm from its first voxel
};

/**
 * Tell a vtkSplattingMIPProjection, or a vtkSplattingMIPVolumeMapper; the slab's middle is a point
 * of the world.
 */
template <class Target>
void Apply(
  const ProjectionSettings& settings, const std::array<double, 3>& slabCenter, Target* target)
{
  target->SetKernel(settings.Kernel);
  target->SetKernelRadius(settings.KernelRadius);
  target->SetBlendMode(settings.BlendMode);
  target->SetMaximumType(settings.DepthShading ? Target::DEPTH_SHADED : Target::GLOBAL);
  target->SetSlab(settings.Slab > 0.0);
  target->SetSlabThickness(settings.Slab > 0.0 ? settings.Slab : 1.0);
  target->SetSlabCenter(slabCenter[0], slabCenter[1], slabCenter[2]);
  target->SetCropping(settings.Cropping);
  const auto& crop = settings.Crop;
  target->SetCroppingRegionPlanes(crop[0], crop[1], crop[2], crop[3], crop[4], crop[5]);
}

#endif
