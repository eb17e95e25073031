// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MapperSettings.h"

#include "ProjectionChoice.h"
#include "vtkSplattingMIPProjection.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
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
    same(Mapper::AUTOMATIC_SAMPLING, Filter::AUTOMATIC_SAMPLING) &&
    same(Mapper::SAMPLING_OF_MODE, Filter::SAMPLING_OF_MODE) &&
    same(Mapper::COSINE_BELL, Filter::COSINE_BELL) && same(Mapper::LINES, Filter::LINES) &&
    same(Mapper::SORTED_VOLUME, Filter::SORTED_VOLUME) &&
    same(Mapper::MAGNITUDE, Filter::MAGNITUDE) && same(Mapper::COMPONENT, Filter::COMPONENT),
  "The mapper's choices are those of the filter.");

ProjectionChoice choiceOf(Mapper* mapper)
{
  ProjectionChoice choice;
  choice.blendMode = mapper->GetBlendMode();
  choice.maximumType = mapper->GetMaximumType();
  choice.depthShadingAmbient = mapper->GetDepthShadingAmbient();
  choice.depthShadingChangeRate = mapper->GetDepthShadingChangeRate();
  choice.localMaximumThreshold = mapper->GetLocalMaximumThreshold();
  std::copy_n(mapper->GetAverageIPScalarRange(), 2, choice.averageRange);
  choice.kernel = mapper->GetKernel();
  choice.kernelRadius = mapper->GetKernelRadius();
  choice.footprintSampling = mapper->GetFootprintSampling();
  choice.shearImageSampling = mapper->GetShearImageSampling();
  choice.acceleration = mapper->GetAcceleration();
  choice.lineTolerance = mapper->GetLineTolerance();
  choice.eliminateInvisible = mapper->GetEliminateInvisible();
  choice.locations =
    mapper->GetRecordLocations() || mapper->GetDepthCoding() || mapper->GetWriteDepth();
  choice.slab = mapper->GetSlab();
  choice.slabThickness = mapper->GetSlabThickness();
  std::copy_n(mapper->GetSlabCenter(), 3, choice.slabCenter);
  choice.cropping = mapper->GetCropping() != 0;
  std::copy_n(mapper->GetCroppingRegionPlanes(), 6, choice.croppingPlanes);
  return choice;
}

/// What is wrong with clipping planes, or nullptr.
const char* faultOfPlanes(vtkPlaneCollection* planes)
{
  for (int n = 0; planes && n < planes->GetNumberOfItems(); ++n)
  {
    vtkPlane* const plane = planes->GetItem(n);
    const double* const normal = plane->GetNormal();
    const double* const origin = plane->GetOrigin();
    const double length = vtkMath::Norm(normal);
    if (!(length > 0.0) || !std::isfinite(length) || !std::isfinite(vtkMath::Norm(origin)))
    {
      return "A clipping plane has no place: its normal must not be 0, and its numbers finite.";
    }
  }
  return nullptr;
}
}

//------------------------------------------------------------------------------
const char* faultOfSettings(vtkSplattingMIPVolumeMapper* mapper, vtkVolumeProperty* property)
{
  if (const char* const fault = faultOfChoice(choiceOf(mapper)))
  {
    return fault;
  }
  if (mapper->GetBlendMode() == vtkVolumeMapper::SLICE_BLEND && !property->GetSliceFunction())
  {
    return "There is no slice to show: give the vtkVolumeProperty a plane with SetSliceFunction.";
  }
  return faultOfPlanes(mapper->GetClippingPlanes());
}

//------------------------------------------------------------------------------
splatting::ProjectionSettings projectionSettings(
  vtkSplattingMIPVolumeMapper* mapper, int mode, const splatting::View& view)
{
  return settingsOfChoice(choiceOf(mapper), mode, view);
}
}
