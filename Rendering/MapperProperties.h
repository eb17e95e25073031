// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MapperProperties_h
#define MapperProperties_h

#include "ProjectionProperties.h"

#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkScalarsToColors.h"
#include "vtkSmartPointer.h"

class vtkPlaneCollection;
class vtkVolumeProperty;

namespace splatting
{
/**
 * The properties of vtkSplattingMIPVolumeMapper: those shared with the filter, and its own.
 */
struct MapperProperties : ProjectionProperties
{
  bool AutoAdjustSampleDistances = true;
  float FinalColorWindow = 1.0f;
  float FinalColorLevel = 0.5f;
  bool IntermixIntersectingGeometry = true;
  bool CullBelowWindow = false;
  bool DepthCoding = false;
  double DepthCodingRange[2] = { 0.0, 0.0 };
  bool WriteDepth = false;
  double WriteDepthOpacity = 0.5;
  bool DisplayOnRootOnly = false;
  vtkSmartPointer<vtkImageData> MaskInput;
  vtkSmartPointer<vtkPolyData> BoundingSurface;
  vtkSmartPointer<vtkScalarsToColors> DepthCodingColors;
  vtkSmartPointer<vtkMultiProcessController> Controller;

  /// As in ProjectionProperties: the shared properties, then the mapper's own.
  template <class Visitor>
  void visit(Visitor&& visitor) const
  {
    this->ProjectionProperties::visit(visitor);
    visitor("AutoAdjustSampleDistances", this->AutoAdjustSampleDistances);
    visitor("FinalColorWindow", this->FinalColorWindow);
    visitor("FinalColorLevel", this->FinalColorLevel);
    visitor("IntermixIntersectingGeometry", this->IntermixIntersectingGeometry);
    visitor("CullBelowWindow", this->CullBelowWindow);
    visitor("DepthCoding", this->DepthCoding);
    visitor("DepthCodingRange", this->DepthCodingRange);
    visitor("WriteDepth", this->WriteDepth);
    visitor("WriteDepthOpacity", this->WriteDepthOpacity);
  }
  template <class Visitor>
  void visitIndifferent(Visitor&& visitor) const
  {
    this->ProjectionProperties::visitIndifferent(visitor);
    visitor("DisplayOnRootOnly", this->DisplayOnRootOnly);
  }
  /// Calls visitor(name, address) for each property that is an object.
  template <class Visitor>
  void visitObjects(Visitor&& visitor) const
  {
    visitor("MaskInput", this->MaskInput.Get());
    visitor("BoundingSurface", this->BoundingSurface.Get());
    visitor("DepthCodingColors", this->DepthCodingColors.Get());
    visitor("Controller", this->Controller.Get());
  }

  /// Whether a property requires sample positions.
  bool needsLocations() const
  {
    return this->RecordLocations || this->DepthCoding || this->WriteDepth;
  }
};

/// As for ProjectionProperties. Also validates the mapper's clipping planes and, in blend mode
/// SLICE, the property's slice function.
const char* faultOf(
  const MapperProperties& properties, vtkPlaneCollection* planes, vtkVolumeProperty* property);

/// As for ProjectionProperties. Requests locations if a property requires them.
ProjectionSettings settingsOf(const MapperProperties& properties, int mode, const View& view);
}

#endif
