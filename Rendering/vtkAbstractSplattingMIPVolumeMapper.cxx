// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAbstractSplattingMIPVolumeMapper.h"

#include "Input/ProjectionProperties.h"

#include "vtkImageData.h"
#include "vtkPolyData.h"
#include "vtkScalarsToColors.h"

using namespace splatting;

VTK_ABI_NAMESPACE_BEGIN
//------------------------------------------------------------------------------
vtkCxxSetObjectMacro(vtkAbstractSplattingMIPVolumeMapper, MaskInput, vtkImageData);
vtkCxxSetObjectMacro(vtkAbstractSplattingMIPVolumeMapper, BoundingSurface, vtkPolyData);
vtkCxxSetObjectMacro(vtkAbstractSplattingMIPVolumeMapper, DepthCodingColors, vtkScalarsToColors);
vtkCxxSetObjectMacro(vtkAbstractSplattingMIPVolumeMapper, LabelInput, vtkImageData);
vtkCxxSetObjectMacro(vtkAbstractSplattingMIPVolumeMapper, LabelColors, vtkScalarsToColors);

//------------------------------------------------------------------------------
vtkAbstractSplattingMIPVolumeMapper::vtkAbstractSplattingMIPVolumeMapper()
{
  this->BlendMode = MAXIMUM_INTENSITY_BLEND;
}

//------------------------------------------------------------------------------
vtkAbstractSplattingMIPVolumeMapper::~vtkAbstractSplattingMIPVolumeMapper()
{
  this->SetMaskInput(nullptr);
  this->SetBoundingSurface(nullptr);
  this->SetDepthCodingColors(nullptr);
  this->SetLabelInput(nullptr);
  this->SetLabelColors(nullptr);
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetVectorModeAsString()
{
  return nameOfVectorMode(this->VectorMode);
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetQualityModeAsString()
{
  return nameOfQualityMode(this->QualityMode);
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetKernelAsString()
{
  return nameOfKernel(this->Kernel);
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetMaximumTypeAsString()
{
  return nameOfMaximumType(this->MaximumType);
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetAccelerationAsString()
{
  return nameOfAcceleration(this->Acceleration);
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetLabelModeAsString()
{
  return this->LabelMode == SAMPLE ? "sample" : "projected";
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetPictureBlendingAsString()
{
  static const char* const names[] = { "over", "add", "maximum" };
  return names[this->PictureBlending];
}

//------------------------------------------------------------------------------
void vtkAbstractSplattingMIPVolumeMapper::PrintPictureSettings(ostream& os, vtkIndent indent)
{
  const auto onOff = [](vtkTypeBool value) { return value ? "On\n" : "Off\n"; };
  os << indent << "VectorMode: " << this->GetVectorModeAsString() << "\n";
  os << indent << "VectorComponent: " << this->VectorComponent << "\n";
  os << indent << "QualityMode: " << this->GetQualityModeAsString() << "\n";
  os << indent << "AutoAdjustSampleDistances: " << onOff(this->AutoAdjustSampleDistances);
  os << indent << "FinalColorWindow: " << this->FinalColorWindow << "\n";
  os << indent << "FinalColorLevel: " << this->FinalColorLevel << "\n";
  os << indent << "Kernel: " << this->GetKernelAsString() << "\n";
  os << indent << "KernelRadius: " << this->KernelRadius << "\n";
  os << indent << "FootprintSampling: " << this->FootprintSampling << "\n";
  os << indent << "MaximumType: " << this->GetMaximumTypeAsString() << "\n";
  os << indent << "DepthShadingAmbient: " << this->DepthShadingAmbient << "\n";
  os << indent << "DepthShadingChangeRate: " << this->DepthShadingChangeRate << "\n";
  os << indent << "LocalMaximumThreshold: " << this->LocalMaximumThreshold << "\n";
  os << indent << "SignedOrigin: " << this->SignedOrigin << "\n";
  os << indent << "Slab: " << onOff(this->Slab);
  os << indent << "SlabThickness: " << this->SlabThickness << "\n";
  os << indent << "SlabCenter: (" << this->SlabCenter[0] << ", " << this->SlabCenter[1] << ", "
     << this->SlabCenter[2] << ")\n";
  os << indent << "IntermixIntersectingGeometry: " << onOff(this->IntermixIntersectingGeometry);
  os << indent << "Acceleration: " << this->GetAccelerationAsString() << "\n";
  os << indent << "LineTolerance: " << this->LineTolerance << "\n";
  os << indent << "CullBelowWindow: " << onOff(this->CullBelowWindow);
  os << indent << "RecordLocations: " << onOff(this->RecordLocations);
  os << indent << "DepthCoding: " << onOff(this->DepthCoding);
  os << indent << "DepthCodingRange: (" << this->DepthCodingRange[0] << ", "
     << this->DepthCodingRange[1] << ")\n";
  os << indent << "WriteDepth: " << onOff(this->WriteDepth);
  os << indent << "WriteDepthOpacity: " << this->WriteDepthOpacity << "\n";
  os << indent << "LabelMode: " << this->GetLabelModeAsString() << "\n";
  os << indent << "PictureBlending: " << this->GetPictureBlendingAsString() << "\n";
}

//------------------------------------------------------------------------------
void vtkAbstractSplattingMIPVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintPictureSettings(os, indent);
  os << indent << "IndexMemoryBudget: " << this->IndexMemoryBudget << "\n";
  os << indent << "MaskInput: " << this->MaskInput << "\n";
  os << indent << "BoundingSurface: " << this->BoundingSurface << "\n";
  os << indent << "DepthCodingColors: " << this->DepthCodingColors << "\n";
  os << indent << "LabelInput: " << this->LabelInput << "\n";
  os << indent << "LabelColors: " << this->LabelColors << "\n";
}
VTK_ABI_NAMESPACE_END
