// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MIP's relatives as the mapper offers them: minimum, average, depth-shaded and local maximum,
// against VTK's ray casters where these mean the same, and against the definition.
#include "MapperOracle.h"

#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkTransform.h"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <limits>

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

/// What is dark in the volume is bright in the picture, which therefore is like a MIP of the
/// negative. Bounds as in TestRegistration, whose volume this is: half a voxel's share of a pixel,
/// and the measured minimum less 1 dB and 0.002.
void testMinimumAgainstRayCaster(stage::Stage& stage, stage::Checks& check)
{
  struct Mode
  {
    int value;
    double shift, psnr, ssim;
  };
  // In perspective voxels near the eye are seen twice as large, in the preview with their edges:
  // 0.20 pixel, 31.7 dB and 0.9762 were measured.
  const bool perspective = stage.viewAngle > 0.0;
  const Mode modes[] = { { Mapper::PREVIEW, perspective ? 0.25 : 0.15, perspective ? 30.7 : 32.1,
                           perspective ? 0.9742 : 0.9787 },
    { Mapper::STANDARD, 0.1, 41.4, 0.993 }, { Mapper::HIGH, 0.1, 38.1, 0.9913 } };
  const auto image = stage::toImageData(negative(stage::blobsAndTubes({ 72, 80, 88 }, 60)));
  stage.setGrayRamp(255.0, 0.0);
  for (const stage::Vector& direction : directions)
  {
    const auto rayCaster = stage::fixedPointRayCaster(image, 0.2);
    rayCaster->SetBlendModeToMinimumIntensity();
    stage.show(rayCaster);
    stage.look(direction, up, 0.85);
    const reference::Image<double> truth = stage.gray();
    const auto mapper = stage::splatting(image);
    mapper->SetBlendModeToMinimumIntensity();
    stage.show(mapper);
    for (const Mode& mode : modes)
    {
      mapper->SetQualityMode(mode.value);
      const stage::Likeness likeness(truth, stage.gray());
      const std::string what = std::string("Minimum, ") + mapper->GetQualityModeAsString();
      std::cout << what << ": " << likeness.text() << std::endl;
      check(!mapper->GetLastRenderUsedRayCasting(), what + ": is splatted.");
      check(likeness.largestShift() <= mode.shift, what + ": shift.");
      check(likeness.psnr >= mode.psnr, what + ": PSNR.");
      check(likeness.ssim >= mode.ssim, what + ": SSIM.");
    }
  }
  stage.setGrayRamp(0.0, 255.0);
}

template <class T>
vtkSmartPointer<vtkImageData> toImage(
  const std::array<int, 3>& size, int type, const std::vector<T>& voxels)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[0], size[1], size[2]);
  image->AllocateScalars(type, 1);
  std::copy(voxels.begin(), voxels.end(), static_cast<T*>(image->GetScalarPointer()));
  return image;
}

std::vector<double> shearImageOf(stage::Stage& stage, Mapper* mapper)
{
  stage.show(mapper);
  stage.window->Render();
  vtkImageData* const shear = mapper->GetShearImage();
  std::vector<double> values;
  for (vtkIdType pixel = 0; pixel < shear->GetNumberOfPoints(); ++pixel)
  {
    const bool hit = shear->GetPointGhostArray()->GetValue(pixel) == 0;
    values.push_back(hit ? shear->GetPointData()->GetScalars()->GetComponent(pixel, 0) : HUGE_VAL);
  }
  return values;
}

/// min v = c - max (c - v), bit for bit: bytes are summed exactly, and rounding of floats does not
/// know signs.
template <class T>
void testMinimumOfNegative(stage::Stage& stage, int type, double c, stage::Checks& check)
{
  const auto noise = reference::uniformNoise<T>({ 23, 19, 21 }, 6);
  std::vector<T> opposite;
  for (T voxel : noise.voxels)
  {
    opposite.push_back(static_cast<T>(c - voxel));
  }
  const auto minimum = stage::splatting(toImage<T>(noise.size, type, noise.voxels));
  const auto maximum = stage::splatting(toImage<T>(noise.size, type, opposite));
  minimum->SetBlendModeToMinimumIntensity();
  for (const stage::Vector& direction : directions)
  {
    for (int mode = 0; mode < 3; ++mode)
    {
      minimum->SetQualityMode(mode);
      maximum->SetQualityMode(mode);
      stage.show(minimum);
      stage.look(direction, up);
      const std::vector<double> found = shearImageOf(stage, minimum);
      const std::vector<double> expected = shearImageOf(stage, maximum);
      // In perspective bytes have weights that are no multiples of 2^-16. Up to 3 parts with 75
      // weights each are added up, in both projections.
      const double rounding = stage.viewAngle > 0.0 ? 2.0 * 226.0 * 255.0 * 0x1p-24 : 0.0;
      const auto isNegative = [=](double low, double high)
      { return std::isinf(low) ? low == high : std::abs(low - (c - high)) <= rounding; };
      check(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), isNegative),
        std::string("The minimum is the negative's maximum, mode ") +
          minimum->GetQualityModeAsString() + ", type " + std::to_string(type) + ".");
    }
  }
}

/**
 * The GPU's ray caster averages over lengths between the outermost voxels' centres, where this
 * averages over all slices whose voxels a ray crosses: one more for a ray through both ends of the
 * stack; for one that leaves sideways with shear s half a voxel, which is 1 / (2 s) slices, and the
 * rest of a slice more. With these views (s from 0.22 to 0.67) that is one to three of the 50 to 90
 * slices of rays that see something. Nothing is near the border, so that both see the same sum, and
 * the ratio of averages is between 1 - 3 / 50 and 1 - 1 / 90.
 *
 * It shows averages of bytes as grays, 255 being white, and asks no colour function.
 */
void testAverageAgainstRayCaster(stage::Stage& stage, stage::Checks& check)
{
  constexpr double least = 1.0 - 3.0 / 50, greatest = 1.0 - 1.0 / 90;
  const auto image = stage::toImageData(stage::blobsAndTubes({ 72, 80, 88 }, 60));
  for (const stage::Vector& direction : directions)
  {
    const auto rayCaster = stage::gpuRayCaster(image, 0.25);
    rayCaster->SetBlendModeToAverageIntensity();
    stage.show(rayCaster);
    stage.look(direction, up, 0.85);
    const reference::Image<double> truth = stage.gray();
    stage.volume->SetMapper(nullptr);
    rayCaster->ReleaseGraphicsResources(stage.window);
    const auto mapper = stage::splatting(image);
    mapper->SetBlendModeToAverageIntensity();
    stage.show(mapper);
    for (int mode : { Mapper::STANDARD, Mapper::HIGH })
    {
      mapper->SetQualityMode(mode);
      const reference::Image<double> picture = stage.gray();
      const stage::Likeness likeness(truth, picture);
      const std::string what = std::string("Average, ") + mapper->GetQualityModeAsString();
      const double ratio = reference::mean(picture) / reference::mean(truth);
      const double largest = *std::max_element(truth.value.begin(), truth.value.end());
      std::cout << what << ": " << likeness.text() << ", ratio " << ratio << ", up to " << largest
                << std::endl;
      check(!mapper->GetLastRenderUsedRayCasting(), what + ": is splatted.");
      check(ratio > least && ratio < greatest, what + ": ratio.");
      // Besides, both round to a gray.
      check(likeness.psnr > 20.0 * std::log10(255.0 / (largest * (1.0 - least) + 1.0)),
        what + ": PSNR.");
      check(likeness.ssim > 0.99, what + ": SSIM.");
      check(likeness.largestShift() < 0.1, what + ": shift.");
    }
  }
}

/// All kinds of projection with all their settings, seen from all sides, with props that mirror.
void testDefinitions(stage::Stage& stage, stage::Checks& check)
{
  reference::Random random(31);
  const Bytes volume = reference::uniformNoise<std::uint8_t>({ 13, 11, 16 }, 5, 20, 240);
  const auto image = stage::toImageData(volume);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToPreview();
  stage.show(mapper);
  for (int turn = 0; turn < 60; ++turn)
  {
    vtkNew<vtkTransform> prop;
    prop->RotateWXYZ(random.uniform(0.0, 360.0), 0.3, 1.0, -0.4);
    prop->Scale(1.0, random.uniform(0.8, 1.2), random.uniform(0, 1) ? 1.0 : -1.0);
    stage.volume->SetUserTransform(prop);
    stage.look(directions[turn % 6], up);
    mapper->SetAverageIPScalarRange(random.uniform(0.0, 120.0), random.uniform(120.0, 300.0));
    mapper->SetDepthShadingAmbient(random.uniform(0.0, 1.0));
    mapper->SetDepthShadingChangeRate(random.uniform(0.0, 1.0));
    mapper->SetLocalMaximumThreshold(random.uniform(0.0, 255.0));
    mapper->SetShearImageSampling(turn % 10 == 9 ? 4 : turn % 5 == 0 ? 2 : 1);
    for (int kind = 0; kind < 5; ++kind)
    {
      kind == 0     ? mapper->SetBlendModeToMinimumIntensity()
        : kind == 1 ? mapper->SetBlendModeToAverageIntensity()
                    : mapper->SetBlendModeToMaximumIntensity();
      mapper->SetMaximumType(std::max(0, kind - 2));
      stage.window->Render();
      const double error = stage::shearImageError(stage, mapper, image, volume);
      check(error <= stage::allowedError(mapper),
        "View " + std::to_string(turn) + ", kind " + std::to_string(kind) + ", axis " +
          std::to_string(mapper->GetPrincipalAxis()) + " has an error of " + std::to_string(error) +
          ".");
    }
  }
  stage.volume->SetUserTransform(nullptr);
}

/// A view from the opposite side has the same rays: only what depends on the side is projected
/// anew. Blend modes come and go without a trace.
void testReuse(stage::Stage& stage, stage::Checks& check)
{
  const auto image =
    stage::toImageData(reference::uniformNoise<std::uint8_t>({ 13, 11, 16 }, 7, 0, 255));
  const auto mapper = stage::splatting(image);
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
  mapper->SetBlendModeToMinimumIntensity();
  check(projectionsOfTurn() == 0, "The far side's minimum is the same.");
  check(stage.pixels() != maximum, "The minimum is no maximum.");
  mapper->SetBlendModeToAverageIntensity();
  check(projectionsOfTurn() == 0, "The far side's average is the same.");
  mapper->SetBlendModeToMaximumIntensity();
  mapper->SetMaximumTypeToGlobal();
  check(stage.pixels() == maximum, "The maximum is back.");
}

/// Rays without a sample in the range are transparent, and black only if the background is.
void testEmptyRange(stage::Stage& stage, stage::Checks& check)
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
    mapper->SetAverageIPScalarRange(101.0, 255.0);
    check(greatest() == 0, "No sample is in the range.");
    stage.renderer->SetBackground(0.0, 0.2, 0.0);
    check(greatest() == 51, "Rays without a sample are transparent.");
    stage.renderer->SetBackground(0.0, 0.0, 0.0);
  }
}
}

//------------------------------------------------------------------------------
int TestBlendModes(int, char*[])
{
  stage::Checks check;
  stage::Stage stage(Width, Height);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testMinimumAgainstRayCaster(stage, check);
    testMinimumOfNegative<std::uint8_t>(stage, VTK_UNSIGNED_CHAR, 255.0, check);
    testMinimumOfNegative<float>(stage, VTK_FLOAT, 0.0, check);
    testAverageAgainstRayCaster(stage, check);
  }
  testEmptyRange(stage, check);
  stage.viewAngle = 0.0;
  testDefinitions(stage, check);
  testReuse(stage, check);
  testEmptyRange(stage, check);
  return check.exitCode();
}
