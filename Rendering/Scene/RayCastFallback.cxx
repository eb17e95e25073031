// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/RayCastFallback.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkFixedPointRayCastImage.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
float smallestStep(vtkImageData* image)
{
  const double* const spacing = image->GetSpacing();
  return static_cast<float>(
    std::min({ std::abs(spacing[0]), std::abs(spacing[1]), std::abs(spacing[2]) }));
}

/// Sets properties that both ray casters have, but no common base class.
template <class Mapper>
void copySettings(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, Mapper* mapper)
{
  mapper->SetSampleDistance(smallestStep(image));
  mapper->SetBlendMode(settings->GetBlendMode());
  mapper->SetCropping(settings->GetCropping());
  mapper->SetCroppingRegionFlags(settings->GetCroppingRegionFlags());
  mapper->SetClippingPlanes(settings->GetClippingPlanes());
  mapper->SetFinalColorWindow(settings->GetFinalColorWindow());
  mapper->SetFinalColorLevel(settings->GetFinalColorLevel());
}
}

RayCastFallback::RayCastFallback(int components) : Components(components)
{
  this->Mapper->AutoAdjustSampleDistancesOff();
  this->Mapper->SetInputData(this->Image);
  this->Volume->SetMapper(this->Mapper);
  this->Volume->SetUserMatrix(this->Matrix);
}

RayCastFallback::~RayCastFallback() = default;

void RayCastFallback::Render(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image,
  vtkRenderer* renderer, vtkVolume* volume)
{
  if (IsForGpu(settings->GetBlendMode()))
  {
    this->RenderOnGpu(settings, image, renderer, volume);
    return;
  }
  this->Update(settings, image, volume);
  this->Mapper->Render(renderer, this->Volume);
}

bool RayCastFallback::IsForGpu(int blendMode)
{
  return blendMode != vtkVolumeMapper::COMPOSITE_BLEND;
}

void RayCastFallback::RenderOnGpu(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image,
  vtkRenderer* renderer, vtkVolume* volume)
{
  if (!this->GpuMapper)
  {
    // Not through the object factory, which may create a mapper that passes the volume back.
    this->GpuMapper = vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New();
    this->GpuMapper->AutoAdjustSampleDistancesOff();
  }
  copySettings(settings, image, this->GpuMapper.Get());
  this->GpuMapper->SetCroppingRegionPlanes(settings->GetCroppingRegionPlanes());
  this->GpuMapper->SetInputData(image);
  this->GpuMapper->Render(renderer, this->StandIn.Volume(volume, renderer));
}

void RayCastFallback::FindMask(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image,
  vtkRenderer* renderer, vtkVolume* volume, Picture& mask)
{
  this->Update(settings, image, volume);
  this->Mapper->PerImageInitialization(renderer, this->Volume, 0, nullptr, nullptr, nullptr);
  this->Mapper->PerVolumeInitialization(renderer, this->Volume);
  this->Mapper->PerSubVolumeInitialization(renderer, this->Volume, 0);
  this->Mapper->RenderSubVolume();
  vtkFixedPointRayCastImage* const rays = this->Mapper->GetRayCastImage();
  rays->GetImageOrigin(&mask.origin.x);
  rays->GetImageInUseSize(&mask.size.x);
  mask.pixels.resize(std::size_t(mask.size.x) * mask.size.y);
  constexpr int visible = 32767 / 510 + 1; // of 32767, the least that is shown as 1 of 255
  const int rowLength = rays->GetImageMemorySize()[0];
  for (int y = 0; y < mask.size.y; ++y)
  {
    const unsigned short* const row = rays->GetImage() + 4 * std::size_t(y) * rowLength;
    for (int x = 0; x < mask.size.x; ++x)
    {
      mask.pixels[std::size_t(y) * mask.size.x + x] = row[4 * x + 3] < visible ? 0u : ~0u;
    }
  }
}

void RayCastFallback::Update(
  vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkVolume* volume)
{
  this->UpdateImage(image);
  this->UpdateMatrix(image, volume);
  this->Volume->SetProperty(this->StandIn.Property(volume));
  this->UpdateSettings(settings, image);
}

void RayCastFallback::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Mapper->ReleaseGraphicsResources(window);
  if (this->GpuMapper)
  {
    this->GpuMapper->ReleaseGraphicsResources(window);
  }
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
  // The ray caster ignores direction matrices, so the rotation about the origin is applied to the
  // prop.
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
  this->Matrix->Modified(); // the product bypasses its setters
}

void RayCastFallback::UpdateSettings(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image)
{
  copySettings(settings, image, this->Mapper.Get());
  // The ray caster crops as if the first voxel were at the origin, whatever the extent (VTK 9.1).
  double planes[6];
  for (int plane = 0; plane < 6; ++plane)
  {
    const int axis = plane / 2;
    planes[plane] = settings->GetCroppingRegionPlanes()[plane] -
      image->GetExtent()[2 * axis] * image->GetSpacing()[axis];
  }
  this->Mapper->SetCroppingRegionPlanes(planes);
  this->Mapper->SetIntermixIntersectingGeometry(settings->GetIntermixIntersectingGeometry());
}
}
