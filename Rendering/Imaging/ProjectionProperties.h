// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The properties of vtkSplattingMIPProjection and vtkSplattingMIPVolumeMapper, with the names and
 * values of their setters. A new property needs a member with its default, a line in a visit
 * function, a line in PropertyMethods.h with its range, and its declaration with documentation in
 * the class.
 */
#ifndef ProjectionProperties_h
#define ProjectionProperties_h

#include "Projection/Project.h"

#include "vtkIndent.h"
#include "vtkObjectBase.h"
#include "vtkType.h"

#include <ostream>
#include <type_traits>

namespace splatting
{
/**
 * Properties that the mapper inherits from vtkVolumeMapper.
 */
struct InheritedProperties
{
  int BlendMode = 1;
  double AverageIPScalarRange[2] = { VTK_FLOAT_MIN, VTK_FLOAT_MAX };
  bool Cropping = false;
  double CroppingRegionPlanes[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  int CroppingRegionFlags = 1 << 13; ///< VTK_CROP_SUBVOLUME

  /// Calls visitor(name, value) for each property.
  template <class Visitor>
  void visitInherited(Visitor&& visitor) const
  {
    visitor("BlendMode", this->BlendMode);
    visitor("AverageIPScalarRange", this->AverageIPScalarRange);
    visitor("Cropping", this->Cropping);
    visitor("CroppingRegionPlanes", this->CroppingRegionPlanes);
    visitor("CroppingRegionFlags", this->CroppingRegionFlags);
  }
};

/// Names of enumerators.
const char* nameOfQualityMode(int mode);
const char* nameOfKernel(int kernel);
const char* nameOfMaximumType(int type);
const char* nameOfVectorMode(int mode);
const char* nameOfAcceleration(int acceleration);

/**
 * Properties that mapper and filter share.
 */
struct ProjectionProperties : InheritedProperties
{
  int QualityMode = 3;
  int Kernel = 0;
  double KernelRadius = 1.0;
  int FootprintSampling = 0;
  int MaximumType = 0;
  double DepthShadingAmbient = 0.3;
  double DepthShadingChangeRate = 0.7;
  double LocalMaximumThreshold = 0.0;
  int VectorMode = -1;
  int VectorComponent = 0;
  bool Slab = false;
  double SlabThickness = 10.0;
  double SlabCenter[3] = { 0.0, 0.0, 0.0 };
  int Acceleration = 0;
  double LineTolerance = 0.0;
  bool EliminateInvisible = false;
  bool RecordLocations = false;
  vtkTypeInt64 IndexMemoryBudget = vtkTypeInt64(1) << 32;

  /// Calls visitor(name, value), or visitor(name, value, function that names enumerators), for each
  /// property that can change a picture ...
  template <class Visitor>
  void visit(Visitor&& visitor) const
  {
    visitor("QualityMode", this->QualityMode, nameOfQualityMode);
    visitor("Kernel", this->Kernel, nameOfKernel);
    visitor("KernelRadius", this->KernelRadius);
    visitor("FootprintSampling", this->FootprintSampling);
    visitor("MaximumType", this->MaximumType, nameOfMaximumType);
    visitor("DepthShadingAmbient", this->DepthShadingAmbient);
    visitor("DepthShadingChangeRate", this->DepthShadingChangeRate);
    visitor("LocalMaximumThreshold", this->LocalMaximumThreshold);
    visitor("VectorMode", this->VectorMode, nameOfVectorMode);
    visitor("VectorComponent", this->VectorComponent);
    visitor("Slab", this->Slab);
    visitor("SlabThickness", this->SlabThickness);
    visitor("SlabCenter", this->SlabCenter);
    visitor("Acceleration", this->Acceleration, nameOfAcceleration);
    visitor("LineTolerance", this->LineTolerance);
    visitor("EliminateInvisible", this->EliminateInvisible);
    visitor("RecordLocations", this->RecordLocations);
  }

  /// ... and for each property that cannot, and may therefore differ between processes.
  template <class Visitor>
  void visitIndifferent(Visitor&& visitor) const
  {
    visitor("IndexMemoryBudget", this->IndexMemoryBudget);
  }
};

/**
 * An error message that says which property is invalid and what to do, or nullptr. Properties
 * without effect may have any value.
 */
const char* faultOf(const ProjectionProperties& properties);

/**
 * Converts the properties to settings for the projection of a view in a quality mode. Properties
 * without effect are set to their defaults, so that their changes do not project again.
 */
ProjectionSettings settingsOf(const ProjectionProperties& properties, int mode, const View& view);

/**
 * Prints properties in the format of VTK's classes.
 */
struct PropertyPrinter
{
  std::ostream& os;
  vtkIndent indent;

  template <class T>
  void operator()(const char* name, const T& value) const
  {
    this->os << this->indent << name << ": ";
    if constexpr (std::is_array_v<T>)
    {
      for (std::size_t n = 0; n < std::extent_v<T>; ++n)
      {
        this->os << (n ? ", " : "") << value[n];
      }
    }
    else if constexpr (std::is_same_v<T, bool>)
    {
      this->os << (value ? "On" : "Off");
    }
    else if constexpr (std::is_convertible_v<T, vtkObjectBase*>)
    {
      value ? this->os << value : this->os << "(none)";
    }
    else
    {
      this->os << value;
    }
    this->os << "\n";
  }
  void operator()(const char* name, int value, const char* (*nameOf)(int)) const
  {
    (*this)(name, nameOf(value));
  }
};
}

#endif
