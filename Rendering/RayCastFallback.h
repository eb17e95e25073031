// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef RayCastFallback_h
#define RayCastFallback_h

#include "Warp.h"

#include "vtkNew.h"
#include "vtkType.h"

class vtkFixedPointVolumeRayCastMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
class vtkVolumeProperty;
class vtkWindow;

/**
 * Renders by vtkFixedPointVolumeRayCastMapper what vtkSplattingMIPVolumeMapper does not splat, with
 * the same settings. It works on a stand-in for the volume that the ray caster renders rightly.
 */
class RayCastFallback
{
public:
  RayCastFallback();
  ~RayCastFallback();

  /// Render the image's point scalars as the mapper, the volume's property and its matrix ask.
  void Render(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer,
    vtkVolume* volume);
  /// The picture that Render() would draw: white where it is not transparent. Takes as long.
  void FindMask(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkRenderer* renderer,
    vtkVolume* volume, splatting::Picture& mask);
  void ReleaseGraphicsResources(vtkWindow* window);

private:
  void Update(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image, vtkVolume* volume);
  void UpdateImage(vtkImageData* image);
  void UpdateMatrix(vtkImageData* image, vtkVolume* volume);
  void UpdateProperty(int blendMode, vtkVolumeProperty* property);
  void UpdateSettings(vtkSplattingMIPVolumeMapper* settings, vtkImageData* image);

  vtkNew<vtkFixedPointVolumeRayCastMapper> Mapper;
  vtkNew<vtkImageData> Image;
  vtkNew<vtkMatrix4x4> Matrix;
  vtkNew<vtkVolume> Volume;
  vtkNew<vtkVolumeProperty> Property;
  // What Image and Property were copied from, and when: the ray caster prepares anew what changes.
  vtkImageData* ImageSource = nullptr;
  vtkMTimeType ImageTime = 0;
  vtkVolumeProperty* PropertySource = nullptr;
  vtkMTimeType PropertyTime = 0;
};

#endif
