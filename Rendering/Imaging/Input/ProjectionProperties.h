// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Converts the properties of vtkSplattingMIPProjection and vtkSplattingMIPVolumeMapper to settings
 * of a projection. The functions read properties through the classes' Get methods.
 */
#ifndef ProjectionProperties_h
#define ProjectionProperties_h

#include "Geometry/Magnification.h"
#include "Splat/Projection/Project.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
/// The names of enumerators, see vtkSplattingMIPChoices.h.
const char* nameOfQualityMode(int mode);
const char* nameOfKernel(int kernel);
const char* nameOfMaximumType(int type);
const char* nameOfVectorMode(int mode);
const char* nameOfAcceleration(int acceleration);

// Internal to each file: the libraries export all names that contain an exported class.
namespace
{
/**
 * Returns an error message that says which property is invalid and what to do, or nullptr.
 * Properties without effect are not checked.
 */
template <class Object>
const char* validate(Object& object)
{
  const auto finite = [](const double* values, int count)
  { return std::all_of(values, values + count, [](double x) { return std::isfinite(x); }); };
  const bool isMaximum = object.GetBlendMode() == Object::MAXIMUM_INTENSITY_BLEND;
  const double* const range = object.GetAverageIPScalarRange();
  // Above it, differences of shaded floats are infinite.
  constexpr double mostShading = 1e6;
  const struct
  {
    bool holds;
    const char* sentence;
  } problems[] = {
    { object.GetSlab() && !(object.GetSlabThickness() > 0.0),
      "The slab is not thicker than 0: give it a SlabThickness in world units." },
    { object.GetSlab() && !finite(object.GetSlabCenter(), 3),
      "The slab's centre is not finite: set SlabCenter to a point of the world." },
    { object.GetCropping() && !finite(object.GetCroppingRegionPlanes(), 6),
      "CroppingRegionPlanes are not finite: set them to places along the image's axes." },
    { !std::isfinite(object.GetKernelRadius()),
      "KernelRadius is not a number: choose a value from 0.5 to 1.5." },
    { !std::isfinite(object.GetLineTolerance()),
      "LineTolerance is not a number: choose a value from 0 to 64." },
    { isMaximum && object.GetMaximumType() == Object::LOCAL &&
        std::isnan(object.GetLocalMaximumThreshold()),
      "LocalMaximumThreshold is not a number: set it to the least scalar of local maxima." },
    { isMaximum && object.GetMaximumType() == Object::SIGNED &&
        !std::isfinite(object.GetSignedOrigin()),
      "SignedOrigin is not finite: set it to the scalar that distances are measured from." },
    { isMaximum && object.GetMaximumType() == Object::DEPTH_SHADED &&
        !(std::abs(object.GetDepthShadingAmbient()) +
            std::abs(object.GetDepthShadingChangeRate()) <=
          mostShading),
      "DepthShadingAmbient and DepthShadingChangeRate must be numbers whose magnitudes sum to no "
      "more than a million." },
    { object.GetBlendMode() == Object::AVERAGE_INTENSITY_BLEND && !(range[0] <= range[1]),
      "AverageIPScalarRange is empty: its first value must not be above its second." },
  };
  for (const auto& problem : problems)
  {
    if (problem.holds)
    {
      return problem.sentence;
    }
  }
  return nullptr;
}

template <class Object>
Reduction reductionOf(Object& object)
{
  if (object.GetBlendMode() == Object::MINIMUM_INTENSITY_BLEND)
  {
    return Reduction::Minimum;
  }
  if (object.GetBlendMode() == Object::AVERAGE_INTENSITY_BLEND)
  {
    return Reduction::Mean;
  }
  return object.GetMaximumType() == Object::DEPTH_SHADED ? Reduction::DepthShaded
    : object.GetMaximumType() == Object::LOCAL           ? Reduction::Local
    : object.GetMaximumType() == Object::SIGNED          ? Reduction::Signed
                                                         : Reduction::Maximum;
}

/**
 * Returns the settings of a projection of a view in a quality mode. Those that have no effect are
 * the defaults, so that changing them does not project again.
 * @param locate  whether sample positions are needed
 */
template <class Object>
ProjectionSettings settingsOf(Object& object, int mode, const View& view, bool locate)
{
  ProjectionSettings settings;
  settings.reduction = reductionOf(object);
  if (mode == Object::EXACT && settings.reduction == Reduction::Mean)
  {
    mode = Object::HIGH;
  }
  if (mode == Object::EXACT && minifiesAnyAxis(view))
  {
    mode = Object::PREVIEW; // the field is nowhere larger than at a voxel, and pixels show areas
  }
  settings.quality = static_cast<Quality>(mode);
  switch (settings.reduction)
  {
    case Reduction::DepthShaded:
      settings.ambient = object.GetDepthShadingAmbient();
      settings.changeRate = object.GetDepthShadingChangeRate();
      break;
    case Reduction::Local:
      settings.threshold = object.GetLocalMaximumThreshold();
      break;
    case Reduction::Mean:
      settings.meanLow = object.GetAverageIPScalarRange()[0];
      settings.meanHigh = object.GetAverageIPScalarRange()[1];
      break;
    case Reduction::Signed:
      settings.origin = object.GetSignedOrigin();
      [[fallthrough]];
    case Reduction::Maximum:
      if (mode == Object::EXACT)
      {
        break;
      }
      settings.acceleration = static_cast<Acceleration>(object.GetAcceleration());
      if (settings.acceleration >= Acceleration::Lines)
      {
        settings.lineTolerance = object.GetLineTolerance();
      }
      break;
    case Reduction::Minimum:
      break;
  }
  settings.recordLocations = locate && settings.reduction != Reduction::Mean;
  if (mode == Object::HIGH && object.GetKernel() == Object::COSINE_BELL)
  {
    settings.kernel = { Reconstruction::CosineBell, object.GetKernelRadius() };
  }
  if (mode == Object::STANDARD || mode == Object::HIGH)
  {
    settings.footprintSampling = object.GetFootprintSampling();
  }
  return settings;
}
}
}

#endif
