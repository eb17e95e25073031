// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of volumes with any spacing, origin, extent, direction and prop matrix, in all modes:
// skewed stacks, as light-sheet microscopes record them, mirrored and stretched, without
// resampling.
#include "ScreenOracle.h"

#include "vtkSplattingMIPProjection.h"

#include "vtkMatrix3x3.h"
#include "vtkTransform.h"

#include <iostream>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

/// Of the window for exact mode, whose oracle is slow.
constexpr int Width = 76;
constexpr int Height = 64;
/// A millionth of the range, and as much for rays that are computed otherwise.
constexpr double FilterTolerance = 2.0 * 255.0 / 1e6;
const stage::Vector Up = { 0.1, 1.0, 0.05 };

/// A matrix that displaces slices along x and y, as a tilted light sheet does. Some are mirrored.
void skew(vtkMatrix4x4* matrix, reference::Random& random)
{
  vtkNew<vtkTransform> transform;
  const double angle = random.uniform(0.0, 360.0);
  const double x = random.uniform(-0.5, 0.5), y = random.uniform(-0.5, 0.5);
  transform->RotateWXYZ(angle, x, y, 0.7);
  vtkNew<vtkMatrix4x4> shear;
  shear->SetElement(0, 2, random.uniform(-1.5, 1.5));
  shear->SetElement(1, 2, random.uniform(-0.5, 0.5));
  transform->Concatenate(shear);
  const double mirror = random.sign(), width = random.uniform(1.0, 1.3);
  transform->Scale(mirror * width, 1.0, 1.0);
  matrix->DeepCopy(transform->GetMatrix());
}

/// In the image's direction matrix, or in the prop's. Returns whether the prop has none.
bool skewImageOrProp(stage::Stage& stage, vtkImageData* image, reference::Random& random)
{
  vtkNew<vtkMatrix4x4> matrix;
  skew(matrix, random);
  vtkNew<vtkMatrix3x3> direction;
  const bool skewsImage = random.oneIn(3);
  if (skewsImage)
  {
    for (int n = 0; n < 9; ++n)
    {
      direction->SetElement(n / 3, n % 3, matrix->GetElement(n / 3, n % 3));
    }
    matrix->Identity();
  }
  image->SetDirectionMatrix(direction);
  stage.volume->SetUserMatrix(matrix);
  return skewsImage;
}

/// A view whose centre is moved by a fraction of a pixel.
void lookAtRandom(stage::Stage& stage, double scale, reference::Random& random)
{
  const stage::Vector direction = stage::anyDirection(random);
  stage.look(direction, Up, scale);
  const double x = random.uniform(-0.06, 0.06), y = random.uniform(-0.06, 0.06);
  stage.renderer->GetActiveCamera()->SetWindowCenter(x, y);
}

std::string describe(double found, double low, double high, int x, int y)
{
  return "pixel " + std::to_string(x) + " " + std::to_string(y) + " is " + std::to_string(found) +
    ", not from " + std::to_string(low) + " to " + std::to_string(high) + ".";
}

/// Every pixel of exact mode is the largest value of the skewed field on its ray.
void testExact(stage::Stage& stage, const std::string& series, reference::Checks& check)
{
  int pixels = 0, filtered = 0, uncertain = 0;
  reference::forScenes(series + ", exact", 16,
    [&](int number, reference::Random& random)
    {
      const std::array<int, 3> size = { random.uniform(8, 16), random.uniform(8, 16),
        random.uniform(2, 12) };
      const Bytes volume = reference::uniformNoise<std::uint8_t>(size, number + 1);
      const auto field = reference::cellScene(reference::toDouble(volume));
      const auto image = stage::toImageData(volume);
      coretesting::placeAtRandom(image, random, false);
      const bool isForFilter = skewImageOrProp(stage, image, random);
      const auto mapper = stage::splatting(image);
      stage.show(mapper);
      const double scale = random.uniform(0.2, 0.6);
      lookAtRandom(stage, scale, random);
      const reference::Image<double> picture = stage.gray();
      const stage::ScreenRays rays(stage, image);
      vtkNew<vtkSplattingMIPProjection> filter;
      filter->SetInputData(image);
      filter->SetCamera(stage.renderer->GetActiveCamera());
      filter->SetOutputSize(Width, Height);
      filter->Update();
      for (int y = 0; y < Height && !mapper->GetShearImage(); ++y) // else it is an overview
      {
        for (int x = 0; x < Width; ++x)
        {
          const auto maximum = stage::extremumOnRay(field, rays, x, y);
          const double low = maximum.isHit ? maximum.low - stage::FieldTolerance : 0.0;
          const double high = maximum.isHit ? maximum.high + stage::FieldTolerance : 0.0;
          const double found = picture.at(x, y);
          check(!maximum.isCertain || (found >= low && found <= high), series,
            ", exact: ", describe(found, low, high, x, y));
          const double value = filter->GetOutput()->GetScalarComponentAsDouble(x, y, 0, 0);
          check(!maximum.isCertain || !isForFilter || !maximum.isHit ||
              (value >= maximum.low - FilterTolerance && value <= maximum.high + FilterTolerance),
            series, ", filter: ", describe(value, maximum.low, maximum.high, x, y));
          filtered += isForFilter && maximum.isHit;
          pixels += maximum.isHit;
          uncertain += !maximum.isCertain;
        }
      }
    });
  std::cout << series << ", exact: " << pixels << " pixels, " << filtered << " of the filter, "
            << uncertain << " uncertain" << std::endl;
  check(!reference::onlyScene().empty() || (pixels > 0 && uncertain <= pixels / 100),
    "Most pixels are compared.");
}

/// In the other modes pixels have their definition, in perspective what the voxels near their rays
/// allow.
void testOtherModes(stage::Stage& stage, const std::string& series, reference::Checks& check)
{
  constexpr int somePixels = 12, manyPixels = 200;
  reference::forScenes(series + ", other modes", 12,
    [&](int number, reference::Random& random)
    {
      const Bytes volume = stage::blobsAndTubes({ 40, 36, 34 }, 20, random);
      const auto image = stage::toImageData(volume);
      coretesting::placeAtRandom(image, random, false);
      skewImageOrProp(stage, image, random);
      const auto mapper = stage::splatting(image);
      mapper->SetQualityMode(number % 3);
      stage.show(mapper);
      lookAtRandom(stage, 0.35, random);
      const reference::Image<double> picture = stage.gray();
      const stage::ScreenRays rays(stage, image);
      const stage::Envelope envelope(volume, number % 3);
      const std::string what = series + ", " + mapper->GetQualityModeAsString() + ": ";
      for (int n = 0; n < manyPixels; ++n)
      {
        const auto at = stage::somePixel(picture, n % 2 == 0, random);
        const auto limits = envelope.at(rays, at[0], at[1]);
        const double found = picture.at(at[0], at[1]);
        check(
          found >= limits.low - stage::GrayTolerance && found <= limits.high + stage::GrayTolerance,
          what, describe(found, limits.low, limits.high, at[0], at[1]));
      }
      stage::Definition definition(volume);
      const bool isClear = stage.viewAngle <= 0.0 && definition.look(stage, image, mapper);
      for (int n = 0; isClear && n < somePixels; ++n)
      {
        const auto at = stage::somePixel(picture, n % 2 == 0, random);
        const auto expected = definition.pixel(at[0], at[1]);
        const double found = picture.at(at[0], at[1]);
        check(!expected.isCertain || std::abs(found - expected.value) <= stage::GrayTolerance, what,
          describe(found, expected.value, expected.value, at[0], at[1]));
      }
    });
}
}

int TestSkew(int, char*[])
{
  reference::Checks check;
  stage::Stage small(Width, Height), large(130, 110);
  for (double angle : { 0.0, 40.0 })
  {
    small.viewAngle = large.viewAngle = angle;
    const std::string series = angle > 0.0 ? "perspective" : "parallel";
    testExact(small, series, check);
    testOtherModes(large, series, check);
  }
  return check.exitCode();
}
