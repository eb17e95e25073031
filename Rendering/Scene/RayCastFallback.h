// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef RayCastFallback_h
#define RayCastFallback_h

#include "Display/Picture.h"
#include "Scene/VolumeStandIn.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkFixedPointVolumeRayCastMapper;
class vtkGPUVolumeRayCastMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
class vtkWindow;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Renders blend modes that vtkSplattingMIPVolumeMapper does not splat, with the same settings: by
 * vtkFixedPointVolumeRayCastMapper, with a VolumeStandIn, or by vtkGPUVolumeRayCastMapper if the
 * former does not support the blend mode.
 */
class RayCastFallback
{
public:
  /// @param components  the only number of components that it may render, because VTK's ray casters
  ///   write beyond their tables otherwise
  explicit RayCastFallback(int components);
  ~RayCastFallback();

  /// Renders the image's point scalars with the settings of the mapper, the volume's property and
  /// its matrix. The property is not changed.
  void Render(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer,
    vtkVolume* volume);
  /// The picture that Render() would draw: white where it is not transparent. Takes as long as
  /// Render().
  void FindMask(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer,
    vtkVolume* volume, Picture& mask);
  void ReleaseGraphicsResources(vtkWindow* window);

  /// Whether the blend mode needs vtkGPUVolumeRayCastMapper, which draws into selections itself.
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
  // The source of Image and its time, because the ray caster prepares changed images again.
  vtkImageData* ImageSource = nullptr;
  vtkMTimeType ImageTime = 0;
};
}

#endif
