// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Other blend modes and maximum types of the mapper: dependence on the side of the view, averages
// of ranges, and colours beyond the range of the data. TestProjectionAndMapper compares their
// pictures.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkImageData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

constexpr int Width = 231;
constexpr int Height = 208;
const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector oblique = { 0.3, -0.4, 0.8 };

/// A view from the opposite side has the same rays: only what depends on the side is projected
/// anew. Blend modes come and go without a trace.
void testReuse(stage::Stage& stage, reference::Checks& check)
{
  const auto image =
    stage::toImageData(reference::uniformNoise<std::uint8_t>({ 13, 11, 16 }, 7, 0, 255));
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToHigh(); // the same at the rim of the field for all of them
  stage.show(mapper);
  const auto projectionsOfTurn = [&]
  {
    stage.look({ 0.25, -0.5, 1.0 }, up);
    stage.window->Render();
    const vtkIdType before = mapper->GetNumberOfProjections();
    stage.look({ -0.25, 0.5, -1.0 }, up);
    stage.window->Render();
    return mapper->GetNumberOfProjections() - before;
  };
  check(projectionsOfTurn() == 0, "The far side's maximum is the same.");
  const stage::Pixels maximum = stage.pixels();
  mapper->SetMaximumTypeToLocal();
  check(projectionsOfTurn() == 1, "The far side has other local maxima.");
  mapper->SetMaximumTypeToDepthShaded();
  check(projectionsOfTurn() == 1, "The far side has other depth shades.");
  check(stage.pixels() != maximum, "Depth shades can be seen.");
  mapper->SetDepthShadingAmbient(1.0);
  mapper->SetDepthShadingChangeRate(0.0);
  check(stage.pixels() == maximum, "Without shades it is the maximum.");
  mapper->SetMaximumTypeToSigned();
  check(projectionsOfTurn() == 0, "The far side's signed maximum is the same.");
  check(stage.pixels() == maximum, "Of scalars that are not negative it is the maximum.");
  mapper->SetSignedOrigin(300.0);
  const stage::Pixels farthest = stage.pixels();
  mapper->SetBlendModeToMinimumIntensity();
  check(stage.pixels() == farthest, "From an origin above all scalars the minimum is farthest.");
  check(projectionsOfTurn() == 0, "The far side's minimum is the same.");
  check(stage.pixels() != maximum, "The minimum is no maximum.");
  mapper->SetBlendModeToAverageIntensity();
  check(projectionsOfTurn() == 0, "The far side's average is the same.");
  mapper->SetBlendModeToMaximumIntensity();
  mapper->SetMaximumTypeToGlobal();
  check(stage.pixels() == maximum, "The maximum is back.");
}

/// Rays without a sample in the range are transparent, and black only if the background is.
void testEmptyRange(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(reference::constant<std::uint8_t>({ 20, 20, 20 }, 100));
  const auto mapper = stage::splatting(image);
  mapper->SetBlendModeToAverageIntensity();
  stage.show(mapper);
  stage.look(oblique, up);
  const auto greatest = [&]
  {
    const stage::Pixels pixels = stage.pixels();
    return *std::max_element(pixels.begin(), pixels.end());
  };
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    mapper->SetAverageIPScalarRange(0.0, 255.0);
    check(greatest() == 100, "The average of a constant volume is that constant.");
    mapper->SetAverageIPScalarRange(100.0, 255.0);
    check(greatest() == 100, "The range includes its lower end.");
    mapper->SetAverageIPScalarRange(0.0, 100.0);
    check(greatest() == 100, "The range includes its upper end.");
    mapper->SetAverageIPScalarRange(0.0, 99.0);
    check(greatest() == 0, "No sample is in the range.");
    mapper->SetAverageIPScalarRange(101.0, 255.0);
    check(greatest() == 0, "No sample is in the range.");
    stage.renderer->SetBackground(0.0, 0.2, 0.0);
    check(greatest() == 51, "Rays without a sample are transparent.");
    stage.renderer->SetBackground(0.0, 0.0, 0.0);
  }
}

/// Shading that lifts samples above the data, or turns them round, shows in the colours.
void testShading(stage::Stage& stage, reference::Checks& check)
{
  Bytes volume = reference::constant<std::uint8_t>({ 12, 11, 10 }, 100);
  volume.voxels.front() = 0;
  const auto mapper = stage::splatting(stage::toImageData(volume));
  mapper->SetMaximumTypeToDepthShaded();
  mapper->SetDepthShadingChangeRate(0.0);
  stage.show(mapper);
  stage.look(oblique, up);
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

//------------------------------------------------------------------------------
int TestBlendModes(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  testReuse(stage, check);
  for (double viewAngle : { 50.0, 0.0 })
  {
    stage.viewAngle = viewAngle;
    testEmptyRange(stage, check);
  }
  testShading(stage, check);
  return check.exitCode();
}
