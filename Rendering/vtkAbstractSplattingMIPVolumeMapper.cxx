// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAbstractSplattingMIPVolumeMapper.h"

#include "MapperProperties.h"
#include "PropertyMethods.h"
#include "vtkSplattingMIPProjection.h"

#include <algorithm>

namespace
{
using Mapper = vtkAbstractSplattingMIPVolumeMapper;
using Filter = vtkSplattingMIPProjection;
constexpr bool same(int mapper, int filter)
{
  return mapper == filter;
}
static_assert(same(Mapper::MAXIMUM_INTENSITY_BLEND, Filter::MAXIMUM_INTENSITY_BLEND) &&
    same(Mapper::MINIMUM_INTENSITY_BLEND, Filter::MINIMUM_INTENSITY_BLEND) &&
    same(Mapper::AVERAGE_INTENSITY_BLEND, Filter::AVERAGE_INTENSITY_BLEND) &&
    same(Mapper::DEPTH_SHADED, Filter::DEPTH_SHADED) && same(Mapper::LOCAL, Filter::LOCAL) &&
    same(Mapper::PREVIEW, Filter::PREVIEW) && same(Mapper::STANDARD, Filter::STANDARD) &&
    same(Mapper::HIGH, Filter::HIGH) && same(Mapper::EXACT, Filter::EXACT) &&
    same(Mapper::COSINE_BELL, Filter::COSINE_BELL) && same(Mapper::LINES, Filter::LINES) &&
    same(Mapper::SORTED_VOLUME, Filter::SORTED_VOLUME) &&
    same(Mapper::MAGNITUDE, Filter::MAGNITUDE) && same(Mapper::COMPONENT, Filter::COMPONENT),
  "The mapper's choices are those of the filter.");
}

//------------------------------------------------------------------------------
vtkAbstractSplattingMIPVolumeMapper::vtkAbstractSplattingMIPVolumeMapper()
  : Properties(new splatting::MapperProperties)
{
  this->BlendMode = MAXIMUM_INTENSITY_BLEND;
}

//------------------------------------------------------------------------------
vtkAbstractSplattingMIPVolumeMapper::~vtkAbstractSplattingMIPVolumeMapper() = default;

//------------------------------------------------------------------------------
splattingProjectionMethods(vtkAbstractSplattingMIPVolumeMapper);
splattingClampMethods(
  vtkAbstractSplattingMIPVolumeMapper, vtkTypeBool, AutoAdjustSampleDistances, 0, 1);
splattingMethods(vtkAbstractSplattingMIPVolumeMapper, float, FinalColorWindow);
splattingMethods(vtkAbstractSplattingMIPVolumeMapper, float, FinalColorLevel);
splattingMethods(vtkAbstractSplattingMIPVolumeMapper, vtkTypeBool, IntermixIntersectingGeometry);
splattingMethods(vtkAbstractSplattingMIPVolumeMapper, bool, CullBelowWindow);
splattingMethods(vtkAbstractSplattingMIPVolumeMapper, bool, DepthCoding);
splattingVector2Methods(vtkAbstractSplattingMIPVolumeMapper, DepthCodingRange);
splattingMethods(vtkAbstractSplattingMIPVolumeMapper, bool, WriteDepth);
splattingClampMethods(vtkAbstractSplattingMIPVolumeMapper, double, WriteDepthOpacity, 0.0, 1.0);
splattingObjectMethods(vtkAbstractSplattingMIPVolumeMapper, vtkImageData, MaskInput);
splattingObjectMethods(vtkAbstractSplattingMIPVolumeMapper, vtkPolyData, BoundingSurface);
splattingObjectMethods(vtkAbstractSplattingMIPVolumeMapper, vtkScalarsToColors, DepthCodingColors);

//------------------------------------------------------------------------------
const splatting::MapperProperties& vtkAbstractSplattingMIPVolumeMapper::ReadProperties()
{
  splatting::MapperProperties& all = *this->Properties;
  all.BlendMode = this->BlendMode;
  std::copy_n(this->AverageIPScalarRange, 2, all.AverageIPScalarRange);
  all.Cropping = this->Cropping != 0;
  std::copy_n(this->CroppingRegionPlanes, 6, all.CroppingRegionPlanes);
  all.CroppingRegionFlags = this->CroppingRegionFlags;
  return all;
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetVectorModeAsString()
{
  return splatting::nameOfVectorMode(this->GetVectorMode());
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetQualityModeAsString()
{
  return splatting::nameOfQualityMode(this->GetQualityMode());
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetKernelAsString()
{
  return splatting::nameOfKernel(this->GetKernel());
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetMaximumTypeAsString()
{
  return splatting::nameOfMaximumType(this->GetMaximumType());
}

//------------------------------------------------------------------------------
const char* vtkAbstractSplattingMIPVolumeMapper::GetAccelerationAsString()
{
  return splatting::nameOfAcceleration(this->GetAcceleration());
}

//------------------------------------------------------------------------------
void vtkAbstractSplattingMIPVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const splatting::PropertyPrinter print{ os, indent };
  this->Properties->visit(print);
  this->Properties->visitIndifferent(print);
  this->Properties->visitObjects(print);
}
