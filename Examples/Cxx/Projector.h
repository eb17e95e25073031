// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Projector_h
#define Projector_h

#include "Look.h"
#include "Reading/VolumeReader.h"
#include "View.h"

#include "vtkNew.h"
#include "vtkSplattingMIPProjection.h"

#include <array>
#include <string>

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

/**
 * One view of a volume, or several once round the patient's long axis, by
 * vtkSplattingMIPProjection, which needs no display.
 */
class Projector
{
public:
  Projector(const Volume& volume, const ProjectionSettings& settings, const LookSettings& look,
    const ViewSettings& view, int views);

  vtkSplattingMIPProjection* GetProjection() { return this->Projection; }

  /**
   * Views as bytes, which are places in the look's palette. What says in the progress line what is
   * done. Throws std::runtime_error if nothing of the volume is seen.
   */
  vtkSmartPointer<vtkImageData> Project(const std::string& what);

  /**
   * The seconds that the last Project() took for what it shows.
   */
  double GetSeconds() const { return this->Seconds; }

private:
  LookSettings Look;
  vtkNew<vtkSplattingMIPProjection> Projection;
  double Seconds = 0.0;
};

#endif
