// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "RayCastFallback.h"

#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

RayCastFallback::RayCastFallback()
{
  this->Mapper->AutoAdjustSampleDistancesOff();
  this->Mapper->SetInputData(this->Image);
  this->Volume->SetMapper(this->Mapper);
  this->Volume->SetProperty(this->Property);
  this->Volume->SetUserMatrix(this->Matrix);
}

RayCastFallback::~RayCastFallback() = default;

void RayCastFallback::Render(
  vtkVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer, vtkVolume* volume)
{
  this->UpdateImage(image);
  this->UpdateMatrix(image, volume);
  this->UpdateProperty(settings->GetBlendMode(), volume->GetProperty());
  this->UpdateSettings(settings, image);
  this->Mapper->Render(renderer, this->Volume);
}

void RayCastFallback::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Mapper->ReleaseGraphicsResources(window);
}

void RayCastFallback::UpdateImage(vtkImageData* image)
{
  if (this->ImageSource == image && this->ImageTime == image->GetMTime())
  {
    return;
  }
  this->Image->ShallowCopy(image);
  this->Image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  this->ImageSource = image;
  this->ImageTime = image->GetMTime();
}

void RayCastFallback::UpdateMatrix(vtkImageData* image, vtkVolume* volume)
{
  // The ray caster ignores direction matrices: the turn about the origin goes into the prop.
  const double* const origin = image->GetOrigin();
  vtkNew<vtkMatrix4x4> turn;
  for (int r = 0; r < 3; ++r)
  {
    double moved = origin[r];
    for (int c = 0; c < 3; ++c)
    {
      const double element = image->GetDirectionMatrix()->GetElement(r, c);
      turn->SetElement(r, c, element);
      moved -= element * origin[c];
    }
    turn->SetElement(r, 3, moved);
  }
  vtkMatrix4x4::Multiply4x4(volume->GetMatrix(), turn, this->Matrix);
  this->Matrix->Modified(); // the product is written behind its back
}

void RayCastFallback::UpdateProperty(int blendMode, vtkVolumeProperty* property)
{
  if (this->PropertySource != property || this->PropertyTime != property->GetMTime())
  {
    this->Property->DeepCopy(property);
    this->PropertySource = property;
    this->PropertyTime = property->GetMTime();
  }
  // Its nearest interpolation truncates, which moves a MIP by half a voxel: no mode asks for that.
  this->Property->SetInterpolationType(blendMode == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND
      ? VTK_LINEAR_INTERPOLATION
      : property->GetInterpolationType());
}

void RayCastFallback::UpdateSettings(vtkVolumeMapper* settings, vtkImageData* image)
{
  const double* const spacing = image->GetSpacing();
  this->Mapper->SetSampleDistance(static_cast<float>(
    std::min({ std::abs(spacing[0]), std::abs(spacing[1]), std::abs(spacing[2]) })));
  this->Mapper->SetBlendMode(settings->GetBlendMode());
  this->Mapper->SetCropping(settings->GetCropping());
  this->Mapper->SetCroppingRegionPlanes(settings->GetCroppingRegionPlanes());
  this->Mapper->SetCroppingRegionFlags(settings->GetCroppingRegionFlags());
  this->Mapper->SetClippingPlanes(settings->GetClippingPlanes());
}
