// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MapperSettings.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace
{
splatting::Reduction reductionOf(vtkSplattingMIPVolumeMapper* mapper)
{
  switch (mapper->GetBlendMode())
  {
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return splatting::Reduction::Minimum;
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      return splatting::Reduction::Mean;
    default:
      break;
  }
  switch (mapper->GetMaximumType())
  {
    case vtkSplattingMIPVolumeMapper::DEPTH_SHADED:
      return splatting::Reduction::DepthShaded;
    case vtkSplattingMIPVolumeMapper::LOCAL:
      return splatting::Reduction::Local;
    default:
      return splatting::Reduction::Maximum;
  }
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
  const auto finite = [](const double* values, int count)
  { return std::all_of(values, values + count, [](double x) { return std::isfinite(x); }); };
  const bool isMaximum = mapper->GetBlendMode() == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND;
  // Beyond that, the differences of shaded floats are no longer finite.
  constexpr double mostShading = 1e6;
  const struct
  {
    bool holds;
    const char* sentence;
  } problems[] = {
    { mapper->GetSlab() && !(mapper->GetSlabThickness() > 0.0),
      "The slab is not thicker than 0: give it a SlabThickness in world units." },
    { mapper->GetSlab() && !finite(mapper->GetSlabCenter(), 3),
      "The slab's centre is not finite: set SlabCenter to a point of the world." },
    { mapper->GetCropping() && !finite(mapper->GetCroppingRegionPlanes(), 6),
      "CroppingRegionPlanes are not finite: set them to places along the image's axes." },
    { !std::isfinite(mapper->GetKernelRadius()),
      "KernelRadius is not a number: set it to 0.5 to 1.5." },
    { !std::isfinite(mapper->GetLineTolerance()),
      "LineTolerance is not a number: set it to 0 to 64." },
    { isMaximum && mapper->GetMaximumType() == vtkSplattingMIPVolumeMapper::LOCAL &&
        std::isnan(mapper->GetLocalMaximumThreshold()),
      "LocalMaximumThreshold is not a number: set it to the scalar from which on local maxima "
      "count." },
    { isMaximum && mapper->GetMaximumType() == vtkSplattingMIPVolumeMapper::DEPTH_SHADED &&
        !(std::abs(mapper->GetDepthShadingAmbient()) +
            std::abs(mapper->GetDepthShadingChangeRate()) <=
          mostShading),
      "DepthShadingAmbient and DepthShadingChangeRate must be numbers whose magnitudes sum to no "
      "more than a million." },
    { mapper->GetBlendMode() == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND &&
        !(mapper->GetAverageIPScalarRange()[0] <= mapper->GetAverageIPScalarRange()[1]),
      "AverageIPScalarRange holds no scalars: its first value must not be above its second." },
    { mapper->GetBlendMode() == vtkVolumeMapper::SLICE_BLEND && !property->GetSliceFunction(),
      "There is no slice to show: give the vtkVolumeProperty a plane with SetSliceFunction." },
  };
  for (const auto& problem : problems)
  {
    if (problem.holds)
    {
      return problem.sentence;
    }
  }
  return faultOfPlanes(mapper->GetClippingPlanes());
}

//------------------------------------------------------------------------------
splatting::ProjectionSettings projectionSettings(vtkSplattingMIPVolumeMapper* mapper, int mode)
{
  // What has no effect stays as it is by default, so that a change of it projects nothing.
  splatting::ProjectionSettings settings;
  settings.quality = static_cast<splatting::Quality>(mode);
  settings.reduction = reductionOf(mapper);
  switch (settings.reduction)
  {
    case splatting::Reduction::DepthShaded:
      settings.ambient = mapper->GetDepthShadingAmbient();
      settings.changeRate = mapper->GetDepthShadingChangeRate();
      break;
    case splatting::Reduction::Local:
      settings.threshold = mapper->GetLocalMaximumThreshold();
      break;
    case splatting::Reduction::Mean:
      settings.meanLow = mapper->GetAverageIPScalarRange()[0];
      settings.meanHigh = mapper->GetAverageIPScalarRange()[1];
      break;
    case splatting::Reduction::Maximum:
      settings.acceleration = static_cast<splatting::Acceleration>(mapper->GetAcceleration());
      if (mapper->GetAcceleration() >= vtkSplattingMIPVolumeMapper::LINES)
      {
        settings.lineTolerance = mapper->GetLineTolerance();
        settings.eliminateInvisible =
          mapper->GetEliminateInvisible() && mode == vtkSplattingMIPVolumeMapper::PREVIEW;
      }
      break;
    case splatting::Reduction::Minimum:
      break;
  }
  settings.keepWinners = settings.reduction != splatting::Reduction::Mean &&
    (mapper->GetRecordLocations() || mapper->GetDepthCoding() || mapper->GetWriteDepth());
  if (mode == vtkSplattingMIPVolumeMapper::HIGH &&
    mapper->GetKernel() == vtkSplattingMIPVolumeMapper::COSINE_BELL)
  {
    settings.kernel = { splatting::Reconstruction::CosineBell, mapper->GetKernelRadius() };
  }
  if (mode != vtkSplattingMIPVolumeMapper::PREVIEW)
  {
    settings.footprintSampling = mapper->GetFootprintSampling();
  }
  return settings;
}
