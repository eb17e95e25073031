// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeStandIn_h
#define VolumeStandIn_h

#include "vtkNew.h"
#include "vtkType.h"

class vtkMatrix4x4;
class vtkRenderer;
class vtkVolume;
class vtkVolumeProperty;

namespace splatting
{
/**
 * What VTK's ray casters are given in place of a volume, because vtkGPUVolumeRayCastMapper knows no
 * gray functions: it puts an RGB function into the property that it is given, which no longer is
 * gray then, for good. The stand-in's property is a copy, in which gray functions are RGB functions
 * of the same values. It is modified only where the original is, so that nothing is prepared anew
 * in vain.
 */
class VolumeStandIn
{
public:
  VolumeStandIn();
  ~VolumeStandIn();

  /// A copy of the volume's property, up to date.
  vtkVolumeProperty* Property(vtkVolume* volume);
  /// A volume with that property, at the same place. It has no mapper.
  vtkVolume* Volume(vtkVolume* volume, vtkRenderer* renderer);

private:
  vtkNew<vtkVolumeProperty> Copy;
  vtkNew<vtkMatrix4x4> Matrix;
  vtkNew<vtkVolume> Prop;
  // What Copy was made of, and when.
  vtkVolumeProperty* Source = nullptr;
  vtkMTimeType SourceTime = 0;
};
}

#endif
