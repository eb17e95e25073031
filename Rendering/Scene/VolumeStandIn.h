// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeStandIn_h
#define VolumeStandIn_h

#include "vtkNew.h"
#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkMatrix4x4;
class vtkRenderer;
class vtkVolume;
class vtkVolumeProperty;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * A replacement of a volume for VTK's ray casters. vtkGPUVolumeRayCastMapper replaces gray
 * functions of the property that it renders by RGB functions. The replacement has a copy of the
 * property, in which gray functions are RGB functions of the same values. The copy is modified only
 * if the original is, so that ray casters prepare nothing again.
 */
class VolumeStandIn
{
public:
  VolumeStandIn();
  ~VolumeStandIn();

  /// An updated copy of the volume's property.
  vtkVolumeProperty* Property(vtkVolume* volume);
  /// A volume with this property and the same matrix. It has no mapper.
  vtkVolume* Volume(vtkVolume* volume, vtkRenderer* renderer);

private:
  vtkNew<vtkVolumeProperty> Copy;
  vtkNew<vtkMatrix4x4> Matrix;
  vtkNew<vtkVolume> Prop;
  // The source of Copy, and its time.
  vtkVolumeProperty* Source = nullptr;
  vtkMTimeType SourceTime = 0;
};
}

#endif
