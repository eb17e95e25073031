// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What settings mean to a projection: those that have no effect change nothing, and those without
// meaning are refused where they have an effect only.
#include "Input/ProjectionProperties.h"
#include "ProjectionTesting.h"
#include "WideViews.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace
{
using reference::Checks;
using namespace splatting;
using Filter = vtkSplattingMIPProjection;

template <class Change>
bool isRefused(const std::string& word, Change&& change)
{
  vtkNew<Filter> filter;
  filter->SetSlabThickness(-1.0);
  filter->SetCroppingRegionPlanes(0.0, 1.0, 0.0, NAN, 0.0, 1.0);
  filter->SetLocalMaximumThreshold(NAN);
  filter->SetDepthShadingAmbient(2e6);
  filter->SetSignedOrigin(INFINITY);
  filter->SetAverageIPScalarRange(9.0, 8.0);
  change(filter.Get());
  const char* const fault = validate(*filter);
  return fault && std::string(fault).find(word) != std::string::npos;
}

void testFaults(Checks& check)
{
  vtkNew<Filter> filter;
  check(!validate(*filter), "defaults are refused");
  check(!isRefused("", [](Filter*) {}), "what has no effect is refused");
  check(isRefused("SlabThickness", [](Filter* f) { f->SlabOn(); }), "a thin slab");
  check(isRefused("SlabCenter",
          [](Filter* f)
          {
            f->SlabOn();
            f->SetSlabThickness(1.0);
            f->SetSlabCenter(0.0, NAN, 0.0);
          }),
    "a slab at no place");
  check(isRefused("KernelRadius", [](Filter* f) { f->SetKernelRadius(NAN); }), "a NaN radius");
  check(isRefused("LineTolerance", [](Filter* f) { f->SetLineTolerance(NAN); }), "a NaN tolerance");
  check(isRefused("CroppingRegionPlanes", [](Filter* f) { f->CroppingOn(); }), "NaN planes");
  check(isRefused("LocalMaximumThreshold", [](Filter* f) { f->SetMaximumTypeToLocal(); }),
    "a NaN threshold");
  check(isRefused("DepthShading", [](Filter* f) { f->SetMaximumTypeToDepthShaded(); }),
    "strong shading");
  check(isRefused("SignedOrigin", [](Filter* f) { f->SetMaximumTypeToSigned(); }),
    "an infinite origin");
  check(isRefused("AverageIPScalarRange", [](Filter* f) { f->SetBlendModeToAverageIntensity(); }),
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
  filter->SetBlendMode(Filter::AVERAGE_INTENSITY_BLEND);
  filter->SetCropping(1);
  check(filter->GetMTime() == time, "what is set again is a change");
  double values[6] = {};
  filter->GetCroppingRegionPlanes(values[0], values[1], values[2], values[3], values[4], values[5]);
  check(std::equal(planes, planes + 6, values) &&
      std::equal(planes, planes + 6, filter->GetCroppingRegionPlanes()),
    "the planes are others");
  check(filter->GetCropping() == 1 && filter->GetBlendMode() == filter->GetBlendModeMaxValue() &&
      filter->GetBlendModeMinValue() == Filter::MAXIMUM_INTENSITY_BLEND,
    "the blend mode is not clamped");
  filter->SetAverageIPScalarRange(2.0, 5.0);
  check(filter->GetMTime() > time && filter->GetAverageIPScalarRange()[1] == 5.0,
    "another range is no change");
}

/// In each mode and reduction a setting that has no effect leaves all as it is, and one that has
/// does not.
void testEffects(Checks& check)
{
  for (int mode = Filter::PREVIEW; mode <= Filter::EXACT; ++mode)
  {
    for (int n = 0; n < 6; ++n)
    {
      const auto settings = [&](auto change)
      {
        vtkNew<Filter> filter;
        filter->SetBlendMode(n == 3 ? Filter::MINIMUM_INTENSITY_BLEND
            : n == 4                ? Filter::AVERAGE_INTENSITY_BLEND
                                    : Filter::MAXIMUM_INTENSITY_BLEND);
        filter->SetMaximumType(n == 1 ? Filter::DEPTH_SHADED
            : n == 2                  ? Filter::LOCAL
            : n == 5                  ? Filter::SIGNED
                                      : Filter::GLOBAL);
        change(filter.Get());
        return settingsOf(
          *filter, mode, coretesting::magnifiedView(), filter->GetRecordLocations() != 0);
      };
      const auto before = settings([](Filter*) {});
      const auto test = [&](const char* name, bool expected, auto change)
      {
        check((settings(change) == before) != expected, name, " in mode ", mode, ", reduction ", n,
          expected ? ": has no effect" : ": has an effect");
      };
      // Exact are extrema only; means are those of high mode then.
      const bool isExact = mode == Filter::EXACT && n != 4;
      const bool isHigh = mode == Filter::HIGH || (mode == Filter::EXACT && !isExact);
      test("shading", n == 1, [](Filter* f) { f->SetDepthShadingAmbient(0.1); });
      test("threshold", n == 2, [](Filter* f) { f->SetLocalMaximumThreshold(5.0); });
      test("origin", n == 5, [](Filter* f) { f->SetSignedOrigin(5.0); });
      test("range", n == 4, [](Filter* f) { f->SetAverageIPScalarRange(0.0, 7.0); });
      test("acceleration", (n == 0 || n == 5) && !isExact,
        [](Filter* f) { f->SetAcceleration(Filter::LINES); });
      test("tolerance without chains", false, [](Filter* f) { f->SetLineTolerance(5.0); });
      const auto lines = settings([](Filter* f) { f->SetAcceleration(Filter::LINES); });
      const auto tolerant = settings(
        [](Filter* f)
        {
          f->SetAcceleration(Filter::LINES);
          f->SetLineTolerance(5.0);
        });
      check((lines == tolerant) == (lines == before), "tolerance of chains in mode ", mode,
        ", reduction ", n);
      test("locations", n != 4, [](Filter* f) { f->RecordLocationsOn(); });
      test("kernel", isHigh, [](Filter* f) { f->SetKernel(Filter::COSINE_BELL); });
      test("radius", false, [](Filter* f) { f->SetKernelRadius(0.7); });
      test("footprints", isHigh || mode == Filter::STANDARD,
        [](Filter* f) { f->SetFootprintSampling(5); });
      test("blend mode", true,
        [n](Filter* f) {
          f->SetBlendMode(
            n == 3 ? Filter::AVERAGE_INTENSITY_BLEND : Filter::MINIMUM_INTENSITY_BLEND);
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
  return check.exitCode();
}
