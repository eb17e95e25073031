// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ShearImageOutput_h
#define ShearImageOutput_h

#include "Splat/Projection/ShearImage.h"

#include "vtkSmartPointer.h"
#include "vtkSplattingMIPNamespace.h"

#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * A shear image in VTK's terms; see vtkSplattingMIPVolumeMapper::GetShearImage(). Its ghost array
 * hides pixels without a sample.
 * @param components  an image of each component, all of one type
 * @param type        this type as a constant of VTK
 */
vtkSmartPointer<vtkImageData> makeShearImage(
  const std::vector<const ShearImage*>& components, const ShearWarp& geometry, int type);
}

#endif
