// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What VTK's ray casters get in place of a volume: colours of the same values, at the same place,
// modified only where the original is; and the original stays as it is.
#include "CoreTesting.h"
#include "Scene/VolumeStandIn.h"

#include "vtkColorTransferFunction.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

vtkSmartPointer<vtkPiecewiseFunction> anyFunction(reference::Random& random)
{
  auto function = vtkSmartPointer<vtkPiecewiseFunction>::New();
  function->SetClamping(random.uniform(0, 1));
  for (int n = random.uniform(1, 4); n > 0; --n)
  {
    const double x = random.uniform(0.0, 100.0), y = random.uniform(0.0, 1.0);
    const double midpoint = random.uniform(0.1, 0.9), sharpness = random.uniform(0.0, 1.0);
    function->AddPoint(x, y, midpoint, sharpness);
  }
  return function;
}

/// Of each component gray values or colours, as the original has them.
void testColors(
  Checks& check, vtkVolumeProperty* from, vtkVolumeProperty* to, reference::Random& random)
{
  for (int c = 0; c < VTK_MAX_VRCOMP; ++c)
  {
    const double scalar = random.uniform(-10.0, 110.0);
    double expected[3];
    if (from->GetColorChannels(c) == 1)
    {
      std::fill_n(expected, 3, from->GetGrayTransferFunction(c)->GetValue(scalar));
    }
    else
    {
      from->GetRGBTransferFunction(c)->GetColor(scalar, expected);
    }
    check(to->GetColorChannels(c) == 3, "component ", c, " is gray");
    const double* const found = to->GetRGBTransferFunction(c)->GetColor(scalar);
    check(std::equal(expected, expected + 3, found,
            [](double a, double b) { return std::abs(a - b) < 1e-9; }),
      "component ", c, " at ", scalar, " is ", found[0], ", not ", expected[0]);
    check(to->GetScalarOpacity(c)->GetValue(scalar) == from->GetScalarOpacity(c)->GetValue(scalar),
      "component ", c, " has another opacity");
  }
  check(to->GetShade() == from->GetShade() &&
      to->GetIndependentComponents() == from->GetIndependentComponents() &&
      to->GetInterpolationType() == from->GetInterpolationType(),
    "other properties differ");
}

void testScene(Checks& check, reference::Random& random)
{
  vtkNew<vtkVolume> volume;
  vtkNew<vtkRenderer> renderer;
  vtkVolumeProperty* const property = volume->GetProperty();
  property->SetShade(random.uniform(0, 1));
  property->SetIndependentComponents(random.uniform(0, 1));
  property->SetInterpolationType(random.uniform(0, 1));
  for (int c = 0; c < VTK_MAX_VRCOMP; ++c)
  {
    property->SetScalarOpacity(c, anyFunction(random));
    vtkNew<vtkColorTransferFunction> colors;
    const glm::dvec3 rgb = coretesting::anyVector(random, 0.0, 1.0);
    colors->AddRGBPoint(50.0, rgb.x, rgb.y, rgb.z);
    const bool isGray = random.uniform(0, 1);
    isGray ? property->SetColor(c, anyFunction(random)) : property->SetColor(c, colors);
  }
  VolumeStandIn standIn;
  standIn.Property(volume); // functions by default are made by now
  const vtkMTimeType time = property->GetMTime();
  const int channels = property->GetColorChannels(0);
  const vtkMTimeType copied = standIn.Property(volume)->GetMTime();
  testColors(check, property, standIn.Property(volume), random);
  check(property->GetMTime() == time && property->GetColorChannels(0) == channels,
    "the original is modified");
  check(standIn.Property(volume)->GetMTime() == copied, "the copy is modified without need");
  property->GetScalarOpacity(1)->AddPoint(random.uniform(0.0, 100.0), 0.5);
  testColors(check, property, standIn.Property(volume), random);
  const glm::dvec3 place = coretesting::anyVector(random, -9.0, 9.0);
  volume->SetPosition(place.x, place.y, place.z);
  volume->RotateX(random.uniform(0.0, 360.0));
  volume->SetScale(random.uniform(0.5, 2.0));
  vtkVolume* const found = standIn.Volume(volume, renderer);
  check(std::equal(volume->GetMatrix()->GetData(), volume->GetMatrix()->GetData() + 16,
          found->GetMatrix()->GetData()),
    "the stand-in lies elsewhere");
}
}

int TestVolumeStandIn(int, char*[])
{
  Checks check;
  reference::forScenes(
    "properties", 200, [&](int, reference::Random& random) { testScene(check, random); });
  return check.exitCode();
}
