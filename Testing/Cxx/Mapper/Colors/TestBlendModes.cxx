// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MIP's relatives as the mapper offers them: the minimum against VTK's ray caster; which of them
// depend on the side of the view; averages of ranges, and colours beyond the data.
// TestProjectionAndMapper has the pictures of all of them.
#include "ScreenOracle.h"

#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkRenderWindow.h"

#include <algorithm>
#include <iostream>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

constexpr int Width = 231;
constexpr int Height = 208;
const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { -0.8, 0.3, 0.45 }, { 0.2, 0.9, -0.3 }, { 0.3, -0.4, 0.8 },
  { 0.8, 0.2, 0.5 }, { 0.4, -0.9, 0.2 }, { -0.3, -0.4, -0.8 } };

Bytes negative(Bytes volume)
{
  for (std::uint8_t& voxel : volume.voxels)
  {
    voxel = static_cast<std::uint8_t>(255 - voxel);
  }
  return volume;
}

/// In pixels. Half a pixel is the least of the mistakes that are looked for: a picture that is
/// nearer to where it should be than to where such a mistake would put it.
constexpr double MostShift = 0.25;

constexpr int ManyPixels = 200; // that are compared with the voxels near their rays

/// What is dark in the volume is bright in the picture, which therefore is like a MIP of the
/// negative. Previews show structures up to half a voxel off, at the voxels that rays cross.
void testMinimumAgainstRayCaster(stage::Stage& stage, reference::Checks& check)
{
  reference::Random blobs(3);
  const Bytes positive = stage::blobsAndTubes({ 72, 80, 88 }, 60, blobs);
  const Bytes volume = negative(positive);
  const std::array<stage::Envelope, 3> envelopes = { stage::Envelope(positive, Mapper::PREVIEW),
    stage::Envelope(positive, Mapper::STANDARD), stage::Envelope(positive, Mapper::HIGH) };
  const auto image = stage::toImageData(volume);
  stage.setGrayRamp(255.0, 0.0);
  reference::forScenes(stage.viewAngle > 0.0 ? "minimum in perspective" : "minimum", 6,
    [&](int number, reference::Random& random)
    {
      const auto rayCaster = stage::gpuRayCaster(image, 0.2);
      rayCaster->SetBlendModeToMinimumIntensity();
      stage.show(rayCaster);
      stage.look(directions[number], up, 0.85);
      const reference::Image<double> truth = stage.gray();
      stage.volume->SetMapper(nullptr);
      rayCaster->ReleaseGraphicsResources(stage.window);
      const auto mapper = stage::splatting(image);
      mapper->SetBlendModeToMinimumIntensity();
      stage.show(mapper);
      const stage::ScreenRays rays(stage, image);
      for (int mode = 0; mode < 3; ++mode)
      {
        mapper->SetQualityMode(mode);
        const reference::Image<double> picture = stage.gray();
        const stage::Likeness likeness(truth, picture);
        const std::string what = std::string("Minimum, ") + mapper->GetQualityModeAsString();
        std::cout << what << ": " << likeness.text() << std::endl;
        check(!mapper->GetLastRenderUsedRayCasting(), what, ": is splatted.");
        check(mode == Mapper::PREVIEW || likeness.largestShift() <= MostShift, what, ": shift.");
        for (int n = 0; n < ManyPixels; ++n)
        {
          const auto at = stage::somePixel(truth, n % 2 == 0, random);
          const stage::Envelope::Limits limits = envelopes[mode].at(rays, at[0], at[1]);
          const double found = picture.at(at[0], at[1]);
          check(found >= limits.low - stage::GrayTolerance &&
              found <= limits.high + stage::GrayTolerance,
            what, ": what voxels near the ray allow.");
        }
      }
    });
  stage.setGrayRamp(0.0, 255.0);
}

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
  stage.look(directions[2], up);
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
  stage.look(directions[0], up);
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
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testMinimumAgainstRayCaster(stage, check);
  }
  testEmptyRange(stage, check);
  stage.viewAngle = 0.0;
  testReuse(stage, check);
  testEmptyRange(stage, check);
  testShading(stage, check);
  return check.exitCode();
}
