// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What settings mean to a projection: those that have no effect change nothing, and those without
// meaning are refused where they have an effect only.
#include "ProjectionProperties.h"
#include "ProjectionTesting.h"
#include "WideViews.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace
{
using coretesting::Checks;
using namespace splatting;
using Names = vtkSplattingMIPProjection;

bool isRefused(const ProjectionProperties& properties, const std::string& word)
{
  const char* const fault = faultOf(properties);
  return fault && std::string(fault).find(word) != std::string::npos;
}

void testFaults(Checks& check)
{
  check(!faultOf(ProjectionProperties()), "defaults are refused");
  ProjectionProperties properties;
  properties.SlabThickness = -1.0;
  properties.CroppingRegionPlanes[3] = NAN;
  properties.LocalMaximumThreshold = NAN;
  properties.DepthShadingAmbient = INFINITY;
  properties.AverageIPScalarRange[0] = 9.0;
  properties.AverageIPScalarRange[1] = 8.0;
  check(!faultOf(properties), "what has no effect is refused");
  const auto with = [&](auto change)
  {
    ProjectionProperties changed = properties;
    change(changed);
    return changed;
  };
  check(isRefused(with([](auto& c) { c.Slab = true; }), "SlabThickness"), "a thin slab");
  check(isRefused(with([](auto& c) { c.Cropping = true; }), "CroppingRegionPlanes"), "NaN planes");
  check(isRefused(with([](auto& c) { c.MaximumType = Names::LOCAL; }), "LocalMaximumThreshold"),
    "a NaN threshold");
  check(isRefused(with([](auto& c) { c.MaximumType = Names::DEPTH_SHADED; }), "DepthShading"),
    "endless shading");
  check(isRefused(with([](auto& c) { c.BlendMode = Names::AVERAGE_INTENSITY_BLEND; }),
          "AverageIPScalarRange"),
    "an empty range");
}

/// The filter's methods are about its properties, and change its time only where these change.
void testMethods(Checks& check)
{
  vtkNew<vtkSplattingMIPProjection> filter;
  const double planes[6] = { 1.0, 2.0, 3.0, 4.0, 5.0, 6.0 };
  filter->SetCroppingRegionPlanes(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
  filter->SetBlendMode(7);
  filter->SetCropping(1);
  const vtkMTimeType time = filter->GetMTime();
  filter->SetCroppingRegionPlanes(planes);
  filter->SetBlendMode(Names::AVERAGE_INTENSITY_BLEND);
  filter->SetCropping(1);
  check(filter->GetMTime() == time, "what is set again is a change");
  double values[6] = {};
  filter->GetCroppingRegionPlanes(values[0], values[1], values[2], values[3], values[4], values[5]);
  check(std::equal(planes, planes + 6, values) &&
      std::equal(planes, planes + 6, filter->GetCroppingRegionPlanes()),
    "the planes are others");
  check(filter->GetCropping() == 1 && filter->GetBlendMode() == filter->GetBlendModeMaxValue() &&
      filter->GetBlendModeMinValue() == Names::MAXIMUM_INTENSITY_BLEND,
    "the blend mode is not clamped");
  filter->SetAverageIPScalarRange(2.0, 5.0);
  check(filter->GetMTime() > time && filter->GetAverageIPScalarRange()[1] == 5.0,
    "another range is no change");
}

/// In each mode and reduction a setting that has no effect leaves all as it is, and one that has
/// does not.
void testEffects(Checks& check)
{
  for (int mode = Names::PREVIEW; mode <= Names::EXACT; ++mode)
  {
    for (int n = 0; n < 5; ++n)
    {
      ProjectionProperties properties;
      properties.BlendMode = n == 3 ? Names::MINIMUM_INTENSITY_BLEND
        : n == 4                    ? Names::AVERAGE_INTENSITY_BLEND
                                    : Names::MAXIMUM_INTENSITY_BLEND;
      properties.MaximumType = n == 1 ? Names::DEPTH_SHADED : n == 2 ? Names::LOCAL : 0;
      const auto before = settingsOf(properties, mode, coretesting::magnifiedView());
      const auto test = [&](const char* name, bool expected, auto change)
      {
        ProjectionProperties changed = properties;
        change(changed);
        check((settingsOf(changed, mode, coretesting::magnifiedView()) == before) != expected, name,
          " in mode ", mode, ", reduction ", n, expected ? ": has no effect" : ": has an effect");
      };
      // Exact are extrema only; means are those of high mode then.
      const bool isExact = mode == Names::EXACT && n < 4;
      const bool isHigh = mode == Names::HIGH || (mode == Names::EXACT && !isExact);
      test("shading", n == 1, [](auto& c) { c.DepthShadingAmbient = 0.1; });
      test("threshold", n == 2, [](auto& c) { c.LocalMaximumThreshold = 5.0; });
      test("range", n == 4, [](auto& c) { c.AverageIPScalarRange[1] = 7.0; });
      test("acceleration", n == 0 && !isExact, [](auto& c) { c.Acceleration = Names::LINES; });
      test("locations", n != 4, [](auto& c) { c.RecordLocations = true; });
      test("kernel", isHigh, [](auto& c) { c.Kernel = Names::COSINE_BELL; });
      test("radius", false, [](auto& c) { c.KernelRadius = 0.7; });
      test(
        "footprints", isHigh || mode == Names::STANDARD, [](auto& c) { c.FootprintSampling = 5; });
      test("blend mode", true,
        [n](auto& c) {
          c.BlendMode = n == 3 ? Names::AVERAGE_INTENSITY_BLEND : Names::MINIMUM_INTENSITY_BLEND;
        });
    }
  }
}
}

int TestProjectionProperties(int, char*[])
{
  Checks check;
  testFaults(check);
  testMethods(check);
  testEffects(check);
  return check.result();
}
