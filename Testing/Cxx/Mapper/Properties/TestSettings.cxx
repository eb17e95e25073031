// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Settings without a meaning are told once and projected never; settings without an effect project
// nothing, whatever they are.
#include "ScalarTesting.h"

#include "vtkCommand.h"
#include "vtkPlane.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace scalartesting;

namespace
{
const double NaN = std::nan("");

struct Change
{
  std::string name;
  std::function<void(Mapper*)> set;
};

vtkSmartPointer<Mapper> noiseMapper(stage::Stage& stage)
{
  const Size size{ 12, 11, 10 };
  const auto mapper = stage::splatting(
    plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, size[0] * size[1] * size[2], 1, 9)));
  stage.show(mapper);
  stage.look(directions()[0], { 0.2, 0.9, 0.1 });
  return mapper;
}

/// What has no meaning is told once in three frames that show nothing, and is forgotten once it is
/// mended.
void testMistake(stage::Stage& stage, const Change& change, reference::Checks& check)
{
  const auto mapper = noiseMapper(stage);
  stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  change.set(mapper);
  for (int frame = 0; frame < 3; ++frame)
  {
    stage.window->Render();
  }
  check(errors.texts.size() == 1 && errors.texts[0].find(change.name) != std::string::npos,
    change.name, ": one sentence in three frames.");
  check(mapper->GetNumberOfProjections() == 0, change.name, ": nothing is projected.");
  mapper->SetKernelRadius(1.0);
  mapper->SetLineTolerance(0.0);
  mapper->CroppingOff();
  mapper->SetMaximumTypeToGlobal();
  mapper->SetBlendModeToMaximumIntensity();
  mapper->RemoveAllClippingPlanes();
  stage.window->Render();
  check(errors.texts.size() == 1 && mapper->GetNumberOfProjections() == 1, change.name,
    ": mended, the volume is shown.");
}

void testWithoutMeaning(stage::Stage& stage, reference::Checks& check)
{
  const double planes[6] = { 1.0, NaN, 1.0, 2.0, 1.0, 2.0 };
  vtkNew<vtkPlane> flat, lost;
  flat->SetNormal(0.0, 0.0, 0.0);
  lost->SetOrigin(NaN, 0.0, 0.0);
  const Change changes[] = {
    { "KernelRadius", [](Mapper* m) { m->SetKernelRadius(NaN); } },
    { "LineTolerance", [](Mapper* m) { m->SetLineTolerance(NaN); } },
    { "CroppingRegionPlanes",
      [&](Mapper* m)
      {
        m->CroppingOn();
        m->SetCroppingRegionPlanes(planes);
      } },
    { "LocalMaximumThreshold",
      [](Mapper* m)
      {
        m->SetMaximumTypeToLocal();
        m->SetLocalMaximumThreshold(NaN);
      } },
    { "SignedOrigin",
      [](Mapper* m)
      {
        m->SetMaximumTypeToSigned();
        m->SetSignedOrigin(NaN);
      } },
    { "DepthShadingAmbient",
      [](Mapper* m)
      {
        m->SetMaximumTypeToDepthShaded();
        m->SetDepthShadingAmbient(1e300);
      } },
    { "DepthShadingChangeRate",
      [](Mapper* m)
      {
        m->SetMaximumTypeToDepthShaded();
        m->SetDepthShadingChangeRate(NaN);
      } },
    { "AverageIPScalarRange",
      [](Mapper* m)
      {
        m->SetBlendModeToAverageIntensity();
        m->SetAverageIPScalarRange(2.0, 1.0);
      } },
    { "clipping plane", [&](Mapper* m) { m->AddClippingPlane(flat); } },
    { "clipping plane", [&](Mapper* m) { m->AddClippingPlane(lost); } },
    { "slice", [](Mapper* m) { m->SetBlendModeToSlice(); } },
  };
  for (const Change& change : changes)
  {
    testMistake(stage, change, check);
  }
}

void testWithoutEffect(stage::Stage& stage, reference::Checks& check)
{
  const Change changes[] = {
    { "DepthShadingAmbient", [](Mapper* m) { m->SetDepthShadingAmbient(NaN); } },
    { "DepthShadingChangeRate", [](Mapper* m) { m->SetDepthShadingChangeRate(5.0); } },
    { "LocalMaximumThreshold", [](Mapper* m) { m->SetLocalMaximumThreshold(NaN); } },
    { "SignedOrigin", [](Mapper* m) { m->SetSignedOrigin(NaN); } },
    { "AverageIPScalarRange", [](Mapper* m) { m->SetAverageIPScalarRange(3.0, 2.0); } },
    { "KernelRadius of another kernel", [](Mapper* m) { m->SetKernelRadius(0.7); } },
    { "LineTolerance without chains", [](Mapper* m) { m->SetLineTolerance(5.0); } },
  };
  const auto mapper = noiseMapper(stage);
  const stage::Pixels before = stage.pixels();
  for (const Change& change : changes)
  {
    change.set(mapper);
    check(stage.pixels() == before && mapper->GetNumberOfProjections() == 1, change.name,
      " projects nothing.");
  }
}

/// Shading that lifts samples above the data, or turns them round, shows in the colours.
void testShading(stage::Stage& stage, reference::Checks& check)
{
  const Size size{ 12, 11, 10 };
  const auto scalars = noiseArray(VTK_UNSIGNED_CHAR, size[0] * size[1] * size[2], 1, 9);
  scalars->Fill(100.0);
  scalars->SetComponent(0, 0, 0.0);
  const auto mapper = stage::splatting(plainImage(size, scalars));
  mapper->SetMaximumTypeToDepthShaded();
  mapper->SetDepthShadingChangeRate(0.0);
  stage.show(mapper);
  stage.look(directions()[0], { 0.2, 0.9, 0.1 });
  const auto greatest = [&]
  {
    const stage::Pixels pixels = stage.pixels();
    return static_cast<int>(*std::max_element(pixels.begin(), pixels.end()));
  };
  stage.setGrayRamp(0.0, 255.0);
  mapper->SetDepthShadingAmbient(2.0);
  check(greatest() == 200, "Twice as bright as the data.");
  stage.setGrayRamp(0.0, -200.0);
  mapper->SetDepthShadingAmbient(-1.0);
  check(greatest() >= 127, "As far below 0 as the data are above.");
  stage.setGrayRamp(0.0, 255.0);
}
}

int TestSettings(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(120, 110);
  testWithoutMeaning(stage, check);
  testWithoutEffect(stage, check);
  testShading(stage, check);
  return check.exitCode();
}
