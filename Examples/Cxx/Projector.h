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
#include <vector>

/**
 * Settings of a projection except the quality mode.
 */
struct ProjectionSettings
{
  int Kernel = vtkSplattingMIPProjection::TRILINEAR;
  double KernelRadius = 1.0; // voxels
  int BlendMode = vtkSplattingMIPProjection::MAXIMUM_INTENSITY_BLEND;
  bool DepthShading = false;
  bool Signed = false;     // with the blend mode of maxima
  double Origin = 0.0;     // of signed maxima
  double Slab = 0.0;       // thickness in mm, or 0 for no slab
  double SlabOffset = 0.0; // from the volume's centre to the viewer, mm
  bool Cropping = false;
  std::array<double, 6>
    Crop = {}; // from, to along each axis of the volume, mm from its first voxel
};

/**
 * Apply settings to a vtkSplattingMIPProjection or a vtkSplattingMIPVolumeMapper. The centre of the
 * slab is in world coordinates.
 */
template <class Target>
void Apply(
  const ProjectionSettings& settings, const std::array<double, 3>& slabCenter, Target* target)
{
  target->SetKernel(settings.Kernel);
  target->SetKernelRadius(settings.KernelRadius);
  target->SetBlendMode(settings.BlendMode);
  target->SetMaximumType(settings.Signed ? Target::SIGNED
      : settings.DepthShading            ? Target::DEPTH_SHADED
                                         : Target::GLOBAL);
  target->SetSignedOrigin(settings.Origin);
  target->SetSlab(settings.Slab > 0.0);
  target->SetSlabThickness(settings.Slab > 0.0 ? settings.Slab : 1.0);
  target->SetSlabCenter(slabCenter[0], slabCenter[1], slabCenter[2]);
  target->SetCropping(settings.Cropping);
  const auto& crop = settings.Crop;
  target->SetCroppingRegionPlanes(crop[0], crop[1], crop[2], crop[3], crop[4], crop[5]);
}

/**
 * Make an image, without values, whose box contains several: the grid of the first, extended by
 * whole voxels. Throws std::runtime_error if they are too far apart.
 */
vtkSmartPointer<vtkImageData> MakeFrame(const std::vector<vtkImageData*>& images);

/**
 * One view of a volume, or several around the patient's long axis, by vtkSplattingMIPProjection,
 * which needs no display.
 */
class Projector
{
public:
  /**
   * The box of the frame fits into the views.
   */
  Projector(const Volume& volume, vtkImageData* frame, const ProjectionSettings& settings,
    const LookSettings& look, const ViewSettings& view, int views);

  vtkSplattingMIPProjection* GetProjection() { return this->Projection; }

  /**
   * Project the views to bytes, which are indices of the look's palette. The text names the step in
   * the progress line. Throws std::runtime_error if no part of the volume is visible.
   */
  vtkSmartPointer<vtkImageData> Project(const std::string& what);

  /**
   * Get the seconds that the last projection took.
   */
  double GetSeconds() const { return this->Seconds; }

private:
  LookSettings Look;
  vtkNew<vtkSplattingMIPProjection> Projection;
  double Seconds = 0.0;
};

#endif
