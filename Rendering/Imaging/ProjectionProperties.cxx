// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProjectionProperties.h"

#include "Geometry/Magnification.h"
#include "vtkSplattingMIPProjection.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
using Names = vtkSplattingMIPProjection;

Reduction reductionOf(const ProjectionProperties& properties)
{
  switch (properties.BlendMode)
  {
    case Names::MINIMUM_INTENSITY_BLEND:
      return Reduction::Minimum;
    case Names::AVERAGE_INTENSITY_BLEND:
      return Reduction::Mean;
    default:
      break;
  }
  switch (properties.MaximumType)
  {
    case Names::DEPTH_SHADED:
      return Reduction::DepthShaded;
    case Names::LOCAL:
      return Reduction::Local;
    default:
      return Reduction::Maximum;
  }
}

}

const char* nameOfQualityMode(int mode)
{
  static const char* const names[] = { "preview", "standard", "high", "exact" };
  return names[mode];
}

const char* nameOfKernel(int kernel)
{
  return kernel == Names::COSINE_BELL ? "cosine bell" : "trilinear";
}

const char* nameOfMaximumType(int type)
{
  static const char* const names[] = { "global", "depth shaded", "local" };
  return names[type];
}

const char* nameOfVectorMode(int mode)
{
  static const char* const names[] = { "disabled", "magnitude", "component" };
  return names[mode - Names::DISABLED];
}

const char* nameOfAcceleration(int acceleration)
{
  static const char* const names[] = { "auto", "dense", "bricks", "lines", "sorted lines",
    "sorted volume" };
  return names[acceleration];
}

const char* faultOf(const ProjectionProperties& properties)
{
  const auto finite = [](const double* values, int count)
  { return std::all_of(values, values + count, [](double x) { return std::isfinite(x); }); };
  const bool isMaximum = properties.BlendMode == Names::MAXIMUM_INTENSITY_BLEND;
  // Above it, differences of shaded floats are infinite.
  constexpr double mostShading = 1e6;
  const struct
  {
    bool holds;
    const char* sentence;
  } problems[] = {
    { properties.Slab && !(properties.SlabThickness > 0.0),
      "The slab is not thicker than 0: give it a SlabThickness in world units." },
    { properties.Slab && !finite(properties.SlabCenter, 3),
      "The slab's centre is not finite: set SlabCenter to a point of the world." },
    { properties.Cropping && !finite(properties.CroppingRegionPlanes, 6),
      "CroppingRegionPlanes are not finite: set them to places along the image's axes." },
    { !std::isfinite(properties.KernelRadius),
      "KernelRadius is not a number: set it to 0.5 to 1.5." },
    { !std::isfinite(properties.LineTolerance),
      "LineTolerance is not a number: set it to 0 to 64." },
    { isMaximum && properties.MaximumType == Names::LOCAL &&
        std::isnan(properties.LocalMaximumThreshold),
      "LocalMaximumThreshold is not a number: set it to the scalar from which on local maxima "
      "count." },
    { isMaximum && properties.MaximumType == Names::DEPTH_SHADED &&
        !(std::abs(properties.DepthShadingAmbient) + std::abs(properties.DepthShadingChangeRate) <=
          mostShading),
      "DepthShadingAmbient and DepthShadingChangeRate must be numbers whose magnitudes sum to no "
      "more than a million." },
    { properties.BlendMode == Names::AVERAGE_INTENSITY_BLEND &&
        !(properties.AverageIPScalarRange[0] <= properties.AverageIPScalarRange[1]),
      "AverageIPScalarRange holds no scalars: its first value must not be above its second." },
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

ProjectionSettings settingsOf(const ProjectionProperties& properties, int mode, const View& view)
{
  ProjectionSettings settings;
  settings.reduction = reductionOf(properties);
  if (mode == Names::EXACT && settings.reduction == Reduction::Mean)
  {
    mode = Names::HIGH;
  }
  if (mode == Names::EXACT && isOverview(view))
  {
    // The field is nowhere larger than at a voxel, and pixels show areas. If pixels are wider than
    // voxels in all directions, one voxel per slice shows all of them.
    mode = Names::PREVIEW;
    settings.meets = isCoarse(view) ? Meets::Nearest : Meets::All;
  }
  settings.quality = static_cast<Quality>(mode);
  switch (settings.reduction)
  {
    case Reduction::DepthShaded:
      settings.ambient = properties.DepthShadingAmbient;
      settings.changeRate = properties.DepthShadingChangeRate;
      break;
    case Reduction::Local:
      settings.threshold = properties.LocalMaximumThreshold;
      break;
    case Reduction::Mean:
      settings.meanLow = properties.AverageIPScalarRange[0];
      settings.meanHigh = properties.AverageIPScalarRange[1];
      break;
    case Reduction::Maximum:
      if (mode == Names::EXACT)
      {
        break;
      }
      settings.acceleration = static_cast<Acceleration>(properties.Acceleration);
      if (properties.Acceleration >= Names::LINES)
      {
        settings.lineTolerance = properties.LineTolerance;
        settings.eliminateInvisible = properties.EliminateInvisible && mode == Names::PREVIEW;
      }
      break;
    case Reduction::Minimum:
      break;
  }
  settings.keepWinners = properties.RecordLocations && settings.reduction != Reduction::Mean;
  if (mode == Names::HIGH && properties.Kernel == Names::COSINE_BELL)
  {
    settings.kernel = { Reconstruction::CosineBell, properties.KernelRadius };
  }
  if (mode == Names::STANDARD || mode == Names::HIGH)
  {
    settings.footprintSampling = properties.FootprintSampling;
  }
  return settings;
}
}
