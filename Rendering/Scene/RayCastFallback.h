// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef RayCastFallback_h
#define RayCastFallback_h

#include "Display/Picture.h"
#include "Scene/VolumeStandIn.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

class vtkFixedPointVolumeRayCastMapper;
class vtkGPUVolumeRayCastMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
class vtkWindow;

namespace splatting
{
/**
 * Renders what vtkSplattingMIPVolumeMapper does not splat, with the same settings: by
 * vtkFixedPointVolumeRayCastMapper, on a stand-in for the volume that it renders rightly, or, if it
 * does not have the blend mode, by vtkGPUVolumeRayCastMapper.
 */
class RayCastFallback
{
public:
  /// For images with so many components only: VTK's ray casters keep tables for as many, and write
  /// beyond them where there are more.
  explicit RayCastFallback(int components);
  ~RayCastFallback();

  /// Render the image's point scalars as the mapper, the volume's property and its matrix ask. The
  /// property is only read.
  void Render(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer,
    vtkVolume* volume);
  /// The picture that Render() would draw: white where it is not transparent. Takes as long.
  void FindMask(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer,
    vtkVolume* volume, Picture& mask);
  void ReleaseGraphicsResources(vtkWindow* window);

  /// Whether the mapper for a blend mode is vtkGPUVolumeRayCastMapper, which draws into selections
  /// by itself.
  static bool IsForGpu(int blendMode);

  const int Components;

private:
  void RenderOnGpu(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image,
    vtkRenderer* renderer, vtkVolume* volume);
  void Update(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkVolume* volume);
  void UpdateImage(vtkImageData* image);
  void UpdateMatrix(vtkImageData* image, vtkVolume* volume);
  void UpdateSettings(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image);

  vtkNew<vtkFixedPointVolumeRayCastMapper> Mapper;
  vtkSmartPointer<vtkGPUVolumeRayCastMapper> GpuMapper; // made when first needed
  vtkNew<vtkImageData> Image;
  vtkNew<vtkMatrix4x4> Matrix;
  vtkNew<vtkVolume> Volume;
  VolumeStandIn StandIn;
  // What Image was copied from, and when: the ray caster prepares anew what changes.
  vtkImageData* ImageSource = nullptr;
  vtkMTimeType ImageTime = 0;
};
}

#endif
