// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Window and level of the final colour mean what they mean to VTK's ray casters, and neither they
// nor the property's interpolation type cost a projection.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr int Size = 60;
const stage::Vector Background = { 0.2, 0.5, 0.9 };
const stage::Vector Color = { 0.1, 0.45, 0.8 };

struct FinalColor
{
  float window, level;
};

constexpr FinalColor FinalColors[] = { { 1.0f, 0.5f }, { 0.5f, 0.3f }, { 0.2f, 0.4f },
  { 2.0f, 0.7f }, { -1.0f, 0.5f }, { -0.5f, 0.4f }, { 1000.0f, 0.5f }, { 0.7f, 3.0f } };

/// One colour and opacity all over the volume, before a coloured background.
void setColors(stage::Stage& stage, double opacity)
{
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0.0, Color[0], Color[1], Color[2]);
  color->AddRGBPoint(255.0, Color[0], Color[1], Color[2]);
  vtkNew<vtkPiecewiseFunction> alpha;
  alpha->AddPoint(0.0, opacity);
  alpha->AddPoint(255.0, opacity);
  stage.property->SetColor(color);
  stage.property->SetScalarOpacity(alpha);
}

/// What the class says, without any rounding, from 0 to 255.
double expected(int component, double opacity, const FinalColor& finalColor)
{
  const double straight = (Color[component] - finalColor.level) / finalColor.window + 0.5;
  const double premultiplied = std::clamp(opacity * straight, 0.0, 1.0);
  return 255.0 * std::min(premultiplied + (1.0 - opacity) * Background[component], 1.0);
}

/// The largest difference to what is expected in the middle of the window.
template <class Mapper>
double difference(stage::Stage& stage, Mapper* mapper, double opacity, const FinalColor& finalColor)
{
  mapper->SetFinalColorWindow(finalColor.window);
  mapper->SetFinalColorLevel(finalColor.level);
  stage.show(mapper);
  const stage::Pixels pixels = stage.pixels();
  double largest = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const int value = pixels[3 * (Size / 2 * Size + Size / 2) + c];
    largest = std::max(largest, std::abs(value - expected(c, opacity, finalColor)));
  }
  return largest;
}

/// Ours rounds the colour, the opacity and the blended pixel to 1/255 each, so that it is wrong by
/// up to 1.5. The ray casters keep more bits of the colour, but may cut off where we round, once in
/// the colour and once in the pixel: 2.
void testMeaning(stage::Stage& stage, vtkImageData* image, reference::Checks& check)
{
  const auto mapper = stage::splatting(image);
  const auto fixedPoint = stage::fixedPointRayCaster(image, 1.0);
  const auto gpu = stage::gpuRayCaster(image, 1.0);
  for (double opacity : { 1.0, 0.5, 0.1 })
  {
    setColors(stage, opacity);
    for (const FinalColor& finalColor : FinalColors)
    {
      const std::string what = "window " + std::to_string(finalColor.window) + ", level " +
        std::to_string(finalColor.level) + ", opacity " + std::to_string(opacity);
      const auto isNear = [&](const char* who, double error, double most)
      { check(error <= most, what, ": ", who, " is wrong by ", error); };
      isNear("splatting", difference(stage, mapper.Get(), opacity, finalColor), 1.5);
      isNear("the fixed-point ray caster", difference(stage, fixedPoint.Get(), opacity, finalColor),
        2.0);
      isNear("the GPU ray caster", difference(stage, gpu.Get(), opacity, finalColor), 2.0);
    }
  }
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  mapper->SetBlendModeToComposite();
  setColors(stage, 1.0);
  check(difference(stage, mapper.Get(), 1.0, FinalColors[2]) <= 2.0 &&
      mapper->GetLastRenderUsedRayCasting(),
    "Window and level apply where rays are cast, too.");
}

void testReuse(stage::Stage& stage, vtkVolumeProperty* property, reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 40, 36, 44 }, 9));
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.setGrayRamp(0.0, 255.0);
  stage.look({ 0.3, -0.45, 0.8 }, { 0.0, 1.0, 0.1 });
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    const std::string name = mapper->GetQualityModeAsString();
    const stage::Pixels before = stage.pixels();
    const vtkIdType projections = mapper->GetNumberOfProjections();
    mapper->SetFinalColorWindow(0.5f);
    const stage::Pixels windowed = stage.pixels();
    mapper->SetFinalColorLevel(0.6f);
    const stage::Pixels levelled = stage.pixels();
    check(before != windowed && windowed != levelled, name, ": window and level change it.");
    mapper->SetFinalColorWindow(1.0f);
    mapper->SetFinalColorLevel(0.5f);
    check(stage.pixels() == before, name, ": window and level can be taken back.");
    for (int type :
      { VTK_NEAREST_INTERPOLATION, VTK_CUBIC_INTERPOLATION, VTK_LINEAR_INTERPOLATION })
    {
      property->SetInterpolationType(type);
      check(
        stage.pixels() == before, name, ": the interpolation type does not change the picture.");
    }
    check(mapper->GetNumberOfProjections() == projections, name, ": nothing is projected again.");
  }
}
}

//------------------------------------------------------------------------------
int TestFinalColor(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Size, Size);
  stage.renderer->SetBackground(Background.data());
  const auto image = stage::toImageData(reference::constant<std::uint8_t>({ 40, 40, 40 }, 100));
  for (double viewAngle : { 0.0, 60.0 })
  {
    stage.viewAngle = viewAngle;
    stage.show(stage::splatting(image));
    stage.look({ 0.3, -0.45, 0.8 }, { 0.0, 1.0, 0.1 });
    testMeaning(stage, image, check);
    testReuse(stage, stage.property, check);
  }
  return check.exitCode();
}
