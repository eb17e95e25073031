// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProjectionChoice.h"

#include "Geometry/Magnification.h"
#include "vtkSplattingMIPProjection.h"

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
using Names = vtkSplattingMIPProjection;

splatting::Reduction reductionOf(const ProjectionChoice& choice)
{
  switch (choice.blendMode)
  {
    case Names::MINIMUM_INTENSITY_BLEND:
      return splatting::Reduction::Minimum;
    case Names::AVERAGE_INTENSITY_BLEND:
      return splatting::Reduction::Mean;
    default:
      break;
  }
  switch (choice.maximumType)
  {
    case Names::DEPTH_SHADED:
      return splatting::Reduction::DepthShaded;
    case Names::LOCAL:
      return splatting::Reduction::Local;
    default:
      return splatting::Reduction::Maximum;
  }
}

int samplingOf(const ProjectionChoice& choice, int mode)
{
  switch (choice.shearImageSampling)
  {
    case Names::SAMPLING_OF_MODE:
      return mode == Names::EXACT ? splatting::ShearWarp::Automatic : 1;
    case Names::AUTOMATIC_SAMPLING:
      return splatting::ShearWarp::Automatic;
    case 3:
      return 2;
    default:
      return choice.shearImageSampling;
  }
}
}

//------------------------------------------------------------------------------
const char* faultOfChoice(const ProjectionChoice& choice)
{
  const auto finite = [](const double* values, int count)
  { return std::all_of(values, values + count, [](double x) { return std::isfinite(x); }); };
  const bool isMaximum = choice.blendMode == Names::MAXIMUM_INTENSITY_BLEND;
  // Beyond that, the differences of shaded floats are no longer finite.
  constexpr double mostShading = 1e6;
  const struct
  {
    bool holds;
    const char* sentence;
  } problems[] = {
    { choice.slab && !(choice.slabThickness > 0.0),
      "The slab is not thicker than 0: give it a SlabThickness in world units." },
    { choice.slab && !finite(choice.slabCenter, 3),
      "The slab's centre is not finite: set SlabCenter to a point of the world." },
    { choice.cropping && !finite(choice.croppingPlanes, 6),
      "CroppingRegionPlanes are not finite: set them to places along the image's axes." },
    { !std::isfinite(choice.kernelRadius), "KernelRadius is not a number: set it to 0.5 to 1.5." },
    { !std::isfinite(choice.lineTolerance), "LineTolerance is not a number: set it to 0 to 64." },
    { isMaximum && choice.maximumType == Names::LOCAL && std::isnan(choice.localMaximumThreshold),
      "LocalMaximumThreshold is not a number: set it to the scalar from which on local maxima "
      "count." },
    { isMaximum && choice.maximumType == Names::DEPTH_SHADED &&
        !(std::abs(choice.depthShadingAmbient) + std::abs(choice.depthShadingChangeRate) <=
          mostShading),
      "DepthShadingAmbient and DepthShadingChangeRate must be numbers whose magnitudes sum to no "
      "more than a million." },
    { choice.blendMode == Names::AVERAGE_INTENSITY_BLEND &&
        !(choice.averageRange[0] <= choice.averageRange[1]),
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

//------------------------------------------------------------------------------
splatting::ProjectionSettings settingsOfChoice(
  const ProjectionChoice& choice, int mode, const splatting::View& view)
{
  splatting::ProjectionSettings settings;
  settings.reduction = reductionOf(choice);
  const bool hasMaxima = settings.reduction != splatting::Reduction::Minimum &&
    settings.reduction != splatting::Reduction::Mean;
  if (mode == Names::EXACT && !hasMaxima)
  {
    mode = Names::HIGH;
  }
  settings.quality = static_cast<splatting::Quality>(mode);
  settings.sampling = samplingOf(choice, mode);
  if (mode == Names::EXACT && splatting::isCoarse(view))
  {
    // Between voxels the field is no larger than at one of them. Where pixels are wider than voxels
    // these are all that can be told apart.
    settings.quality = splatting::Quality::Preview;
    settings.meets = splatting::Meets::Nearest;
    settings.sampling =
      choice.shearImageSampling == Names::SAMPLING_OF_MODE ? 1 : settings.sampling;
  }
  switch (settings.reduction)
  {
    case splatting::Reduction::DepthShaded:
      settings.ambient = choice.depthShadingAmbient;
      settings.changeRate = choice.depthShadingChangeRate;
      break;
    case splatting::Reduction::Local:
      settings.threshold = choice.localMaximumThreshold;
      break;
    case splatting::Reduction::Mean:
      settings.meanLow = choice.averageRange[0];
      settings.meanHigh = choice.averageRange[1];
      break;
    case splatting::Reduction::Maximum:
      settings.acceleration = static_cast<splatting::Acceleration>(choice.acceleration);
      if (mode == Names::EXACT)
      {
        settings.acceleration = std::min(settings.acceleration, splatting::Acceleration::Bricks);
      }
      else if (choice.acceleration >= Names::LINES)
      {
        settings.lineTolerance = choice.lineTolerance;
        settings.eliminateInvisible = choice.eliminateInvisible && mode == Names::PREVIEW;
      }
      break;
    case splatting::Reduction::Minimum:
      break;
  }
  settings.keepWinners = choice.locations && settings.reduction != splatting::Reduction::Mean;
  if (mode == Names::HIGH && choice.kernel == Names::COSINE_BELL)
  {
    settings.kernel = { splatting::Reconstruction::CosineBell, choice.kernelRadius };
  }
  if (mode == Names::STANDARD || mode == Names::HIGH)
  {
    settings.footprintSampling = choice.footprintSampling;
  }
  return settings;
}
}
