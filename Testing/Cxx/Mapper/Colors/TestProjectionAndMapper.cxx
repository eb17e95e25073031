// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkSplattingMIPProjection through the camera of a renderer shows what the mapper renders there:
// shear images bit for bit, pictures to half a gray level. Half of the images are skewed.
#include "Stage.h"

#include "vtkSplattingMIPProjection.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace
{
constexpr int Width = 90;
constexpr int Height = 70;

/// Whether pixels with a sample are the same, and the others, too. EXACT has no shear images.
bool sameShearImages(vtkImageData* a, vtkImageData* b)
{
  if (!a && !b)
  {
    return true;
  }
  if (!a || !b || a->GetNumberOfPoints() != b->GetNumberOfPoints() ||
    a->GetScalarType() != b->GetScalarType())
  {
    return false;
  }
  for (vtkIdType p = 0; p < a->GetNumberOfPoints(); ++p)
  {
    const bool hidden = a->GetPointGhostArray()->GetValue(p) != 0;
    if (hidden != (b->GetPointGhostArray()->GetValue(p) != 0) ||
      (!hidden &&
        a->GetPointData()->GetScalars()->GetComponent(p, 0) !=
          b->GetPointData()->GetScalars()->GetComponent(p, 0)))
    {
      return false;
    }
  }
  return true;
}

/// The largest difference in gray levels; the stage shows background as 0.
double largestDifference(stage::Stage& stage, vtkImageData* projection)
{
  const auto gray = stage.gray();
  double largest = 0.0;
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      const double value = projection->GetScalarComponentAsDouble(x, y, 0, 0);
      const double difference = std::abs(value - gray.at(x, y));
      largest = difference <= largest ? largest : difference; // NaN counts
    }
  }
  return largest;
}

/// The same choices, which the mapper has.
void copyChoices(vtkSplattingMIPVolumeMapper* mapper, vtkSplattingMIPProjection* filter)
{
  filter->SetQualityMode(mapper->GetQualityMode());
  filter->SetKernel(mapper->GetKernel());
  filter->SetBlendMode(mapper->GetBlendMode());
  filter->SetMaximumType(mapper->GetMaximumType());
  filter->SetLocalMaximumThreshold(mapper->GetLocalMaximumThreshold());
  filter->SetSignedOrigin(mapper->GetSignedOrigin());
  filter->SetSlab(mapper->GetSlab());
  filter->SetSlabCenter(mapper->GetSlabCenter());
  filter->SetSlabThickness(mapper->GetSlabThickness());
  filter->SetCropping(mapper->GetCropping());
  filter->SetCroppingRegionFlags(mapper->GetCroppingRegionFlags());
  filter->SetCroppingRegionPlanes(mapper->GetCroppingRegionPlanes());
  filter->SetRecordLocations(mapper->GetRecordLocations());
}

/// Voxels are the same, points and depths but for rounding.
bool sameLocations(vtkImageData* a, vtkImageData* b)
{
  int wrong = 0, samples = 0;
  for (vtkIdType pixel = 0; pixel < a->GetNumberOfPoints(); ++pixel)
  {
    for (const char* name : { "Voxel", "Depth", "Position" })
    {
      vtkDataArray *const x = a->GetPointData()->GetArray(name),
                          *const y = b->GetPointData()->GetArray(name);
      if (!x || !y)
      {
        return false;
      }
      for (int c = 0; c < x->GetNumberOfComponents(); ++c)
      {
        const double p = x->GetComponent(pixel, c), q = y->GetComponent(pixel, c);
        wrong += !(std::abs(p - q) <= 1e-4) && !(std::isnan(p) && std::isnan(q));
        samples += !std::isnan(p);
      }
    }
  }
  return wrong == 0 && samples > 0;
}

/// A mode and kernel by number, the rest at random.
void chooseAtRandom(
  vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image, int n, reference::Random& random)
{
  mapper->SetQualityMode(n % 4);
  mapper->SetKernel(n / 3 % 2);
  mapper->SetBlendMode(random.uniform(1, 3));
  stage::chooseSamples(mapper, image, random);
  mapper->SetRecordLocations(mapper->GetBlendMode() != vtkVolumeMapper::AVERAGE_INTENSITY_BLEND);
}

/// The largest difference between pixels; infinite where one image alone has a pixel.
double largestDifference(vtkImageData* a, vtkImageData* b)
{
  double largest = 0.0;
  vtkUnsignedCharArray *const p = a->GetPointGhostArray(), *const q = b->GetPointGhostArray();
  for (vtkIdType n = 0; n < a->GetNumberOfPoints(); ++n)
  {
    const bool isFirst = !p || p->GetValue(n) == 0, isSecond = !q || q->GetValue(n) == 0;
    if (isFirst != isSecond)
    {
      return VTK_DOUBLE_MAX;
    }
    if (isFirst)
    {
      const double difference = std::abs(a->GetPointData()->GetScalars()->GetComponent(n, 0) -
        b->GetPointData()->GetScalars()->GetComponent(n, 0));
      largest = difference <= largest ? largest : difference; // NaN counts
    }
  }
  return largest;
}

/// A depth-shaded maximum without shades is the maximum. Pictures are finite, also where cuts leave
/// a ray nothing of what exact mode sees, and whatever shades would be.
void testWithoutShades(
  vtkSplattingMIPProjection* filter, const std::string& view, reference::Checks& check)
{
  filter->SetMaximumType(vtkSplattingMIPProjection::GLOBAL);
  filter->Update();
  const bool isExact = !filter->GetShearImage();
  const auto result = [&] { return isExact ? filter->GetOutput() : filter->GetShearImage(); };
  vtkNew<vtkImageData> maximum, picture;
  maximum->DeepCopy(result());
  picture->DeepCopy(filter->GetOutput());
  const auto shade = [&](double ambient)
  {
    filter->SetMaximumType(vtkSplattingMIPProjection::DEPTH_SHADED);
    filter->SetDepthShadingAmbient(ambient);
    filter->SetDepthShadingChangeRate(0.0);
    filter->Update();
  };
  shade(1.0);
  // The lowest voxel is subtracted and added again. Exact maxima are off by 10^-6 of the range.
  const double bound = 255.0 * (2.0 * 0x1p-24 + (isExact ? 2e-6 : 0.0));
  check(maximum->GetNumberOfPoints() == result()->GetNumberOfPoints() &&
      largestDifference(maximum, result()) <= bound,
    "without shades it is the maximum", view);
  check(largestDifference(picture, filter->GetOutput()) <= 255.0, "what has no shades", view,
    " is finite");
  shade(-1.0);
  // Bytes times -1 have the lowest one for their maximum, or less where rays see no such voxel.
  check(largestDifference(picture, filter->GetOutput()) <= 2.0 * 255.0,
    "what makes bright samples dark", view, " is finite");
  filter->SetDepthShadingAmbient(0.3);
  filter->SetDepthShadingChangeRate(0.7);
}
}

int TestProjectionAndMapper(int, char*[])
{
  reference::Checks check;
  reference::Random random(11);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 40, 36, 44 }, 12, random));
  coretesting::placeAtRandom(image, random, false);
  const auto mapper = stage::splatting(image);
  mapper->AutoAdjustSampleDistancesOff();
  stage::Stage stage(Width, Height);
  stage.setGrayRamp(0.0, 255.0);
  stage.show(mapper);
  vtkNew<vtkSplattingMIPProjection> filter;
  filter->SetInputData(image);
  filter->SetOutputSize(Width, Height);
  double worst = 0.0;
  reference::forScenes("views", 48,
    [&](int n, reference::Random& own)
    {
      stage.viewAngle = n % 3 == 2 ? 35.0 : 0.0;
      vtkNew<vtkMatrix3x3> skew;
      if (own.oneIn(2))
      {
        skew->SetElement(0, 2, own.uniform(-1.5, 1.5));
        skew->SetElement(1, 2, own.uniform(-0.5, 0.5));
      }
      image->SetDirectionMatrix(skew);
      const stage::Vector direction = { own.uniform(-1.0, 1.0), own.uniform(-1.0, 1.0),
        own.uniform(0.1, 1.0) };
      stage.look(direction, { 0.1, 1.0, 0.2 }, own.uniform(0.6, 1.2));
      chooseAtRandom(mapper, image, n, own);
      copyChoices(mapper, filter);
      filter->SetCamera(stage.renderer->GetActiveCamera());
      filter->Update();
      const double difference = largestDifference(stage, filter->GetOutput());
      worst = std::max(worst, difference);
      const std::string view = " of view " + std::to_string(n) + ", mode " +
        std::to_string(mapper->GetQualityMode()) + ", blend " +
        std::to_string(mapper->GetBlendMode()) + ", type " +
        std::to_string(mapper->GetMaximumType());
      // Half a level, 1/16 of one that the table has, and what places in the picture are rounded
      // by.
      check(difference < 0.6, "pictures", view, " differ by ", difference);
      check(sameShearImages(filter->GetShearImage(), mapper->GetShearImage()), "shear images", view,
        " are the same");
      check(
        !mapper->GetRecordLocations() || sameLocations(filter->GetOutput(), mapper->GetLocations()),
        "locations", view, " are the same");
      if (mapper->GetBlendMode() == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND)
      {
        testWithoutShades(filter, view, check);
      }
    });
  std::cout << "largest difference " << worst << " gray levels\n";
  return check.exitCode();
}
