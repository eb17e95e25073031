// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What settings mean to a projection: those that have no effect change nothing, and those without
// meaning are refused where they have an effect only.
#include "ProjectionChoice.h"
#include "ProjectionTesting.h"
#include "WideViews.h"

#include <cmath>
#include <string>

namespace
{
using coretesting::Checks;
using namespace splatting;
using Names = vtkSplattingMIPProjection;

bool isRefused(const ProjectionChoice& choice, const std::string& word)
{
  const char* const fault = faultOfChoice(choice);
  return fault && std::string(fault).find(word) != std::string::npos;
}

void testFaults(Checks& check)
{
  check(!faultOfChoice({}), "defaults are refused");
  ProjectionChoice choice;
  choice.slabThickness = -1.0;
  choice.croppingPlanes[3] = NAN;
  choice.localMaximumThreshold = NAN;
  choice.depthShadingAmbient = INFINITY;
  choice.averageRange[0] = 9.0;
  check(!faultOfChoice(choice), "what has no effect is refused");
  const auto with = [&](auto change)
  {
    ProjectionChoice changed = choice;
    change(changed);
    return changed;
  };
  check(isRefused(with([](auto& c) { c.slab = true; }), "SlabThickness"), "a thin slab");
  check(isRefused(with([](auto& c) { c.cropping = true; }), "CroppingRegionPlanes"), "NaN planes");
  check(isRefused(with([](auto& c) { c.maximumType = Names::LOCAL; }), "LocalMaximumThreshold"),
    "a NaN threshold");
  check(isRefused(with([](auto& c) { c.maximumType = Names::DEPTH_SHADED; }), "DepthShading"),
    "endless shading");
  check(isRefused(with([](auto& c) { c.blendMode = Names::AVERAGE_INTENSITY_BLEND; }),
          "AverageIPScalarRange"),
    "an empty range");
}

/// In each mode and reduction a setting that has no effect leaves all as it is, and one that has
/// does not.
void testEffects(Checks& check)
{
  for (int mode = Names::PREVIEW; mode <= Names::EXACT; ++mode)
  {
    for (int n = 0; n < 5; ++n)
    {
      ProjectionChoice choice;
      choice.blendMode = n == 3 ? Names::MINIMUM_INTENSITY_BLEND
        : n == 4                ? Names::AVERAGE_INTENSITY_BLEND
                                : Names::MAXIMUM_INTENSITY_BLEND;
      choice.maximumType = n == 1 ? Names::DEPTH_SHADED : n == 2 ? Names::LOCAL : 0;
      const auto before = settingsOfChoice(choice, mode, coretesting::magnifiedView());
      const auto test = [&](const char* name, bool expected, auto change)
      {
        ProjectionChoice changed = choice;
        change(changed);
        check((settingsOfChoice(changed, mode, coretesting::magnifiedView()) == before) != expected,
          name, " in mode ", mode, ", reduction ", n,
          expected ? ": has no effect" : ": has an effect");
      };
      // Exact are maxima only; the others are those of high mode then.
      const bool isHigh = mode == Names::HIGH || (mode == Names::EXACT && n > 2);
      test("shading", n == 1, [](auto& c) { c.depthShadingAmbient = 0.1; });
      test("threshold", n == 2, [](auto& c) { c.localMaximumThreshold = 5.0; });
      test("range", n == 4, [](auto& c) { c.averageRange[1] = 7.0; });
      test("acceleration", n == 0, [](auto& c) { c.acceleration = Names::LINES; });
      test("locations", n != 4, [](auto& c) { c.locations = true; });
      test("kernel", isHigh, [](auto& c) { c.kernel = Names::COSINE_BELL; });
      test("radius", false, [](auto& c) { c.kernelRadius = 0.7; });
      test(
        "footprints", isHigh || mode == Names::STANDARD, [](auto& c) { c.footprintSampling = 5; });
      test("blend mode", true,
        [n](auto& c) {
          c.blendMode = n == 3 ? Names::AVERAGE_INTENSITY_BLEND : Names::MINIMUM_INTENSITY_BLEND;
        });
    }
  }
}
}

int TestProjectionChoice(int, char*[])
{
  Checks check;
  testFaults(check);
  testEffects(check);
  ProjectionChoice choice;
  const auto samplingOf = [&choice](int mode)
  { return settingsOfChoice(choice, mode, coretesting::magnifiedView()).sampling; };
  check(samplingOf(Names::HIGH) == 1 && samplingOf(Names::EXACT) == splatting::ShearWarp::Automatic,
    "only exact mode samples as finely as the screen by default");
  for (const int sampling : { 1, 2, 3, 4 })
  {
    choice.shearImageSampling = sampling;
    const int found = samplingOf(Names::EXACT);
    check(found == (sampling == 3 ? 2 : sampling), "a sampling of ", sampling, " is ", found);
  }
  return check.result();
}
