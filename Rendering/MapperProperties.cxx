// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MapperProperties.h"

#include "Components/TransferFunctions.h"
#include "Input/ProjectionProperties.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkVolumeProperty.h"

#include <cmath>

namespace splatting
{
namespace
{
/// Returns what is wrong with clipping planes, or nullptr.
const char* validatePlanes(vtkPlaneCollection* planes)
{
  for (int n = 0; planes && n < planes->GetNumberOfItems(); ++n)
  {
    vtkPlane* const plane = planes->GetItem(n);
    const double* const normal = plane->GetNormal();
    const double* const origin = plane->GetOrigin();
    const double length = vtkMath::Norm(normal);
    if (!(length > 0.0) || !std::isfinite(length) || !std::isfinite(vtkMath::Norm(origin)))
    {
      return "A clipping plane is invalid: its normal must not be 0, and its numbers must be "
             "finite.";
    }
  }
  return nullptr;
}
}

const char* validate(vtkSplattingMIPVolumeMapper* mapper, vtkVolumeProperty* property)
{
  if (const char* const fault = validate(*mapper))
  {
    return fault;
  }
  if (!FinalColor{ mapper->GetFinalColorWindow(), mapper->GetFinalColorLevel() }.isValid())
  {
    return "FinalColorWindow and FinalColorLevel are invalid: both must be finite and the window "
           "not 0.";
  }
  if (mapper->GetBlendMode() == vtkVolumeMapper::SLICE_BLEND && !property->GetSliceFunction())
  {
    return "There is no slice to show: give the vtkVolumeProperty a plane with SetSliceFunction.";
  }
  return validatePlanes(mapper->GetClippingPlanes());
}

bool needsLocations(vtkSplattingMIPVolumeMapper* mapper)
{
  return mapper->GetRecordLocations() || mapper->GetDepthCoding() || mapper->GetWriteDepth() ||
    (mapper->GetLabelInput() && mapper->GetLabelMode() == vtkSplattingMIPVolumeMapper::SAMPLE);
}

ProjectionSettings settingsOf(vtkSplattingMIPVolumeMapper* mapper, int mode, const View& view)
{
  return settingsOf(*mapper, mode, view, needsLocations(mapper));
}
}
