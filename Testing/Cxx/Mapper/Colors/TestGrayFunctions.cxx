// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gray functions stay what they are while other blend modes are ray cast, with the override, too,
// and look as the same values as RGB function. What is not changed is not prepared anew.
#include "Stage.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkContourValues.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <functional>

namespace
{
const int modes[] = { vtkVolumeMapper::COMPOSITE_BLEND, vtkVolumeMapper::MINIMUM_INTENSITY_BLEND,
  vtkVolumeMapper::AVERAGE_INTENSITY_BLEND, vtkVolumeMapper::ADDITIVE_BLEND,
  vtkVolumeMapper::ISOSURFACE_BLEND, vtkVolumeMapper::SLICE_BLEND };

/// Neither black nor the gray ramp to 1024 that VTK takes where there is no function.
vtkNew<vtkPiecewiseFunction> grays(double white)
{
  vtkNew<vtkPiecewiseFunction> function;
  function->AddPoint(0.0, 0.1);
  function->AddPoint(100.0, 0.8, 0.3, 0.2);
  function->AddPoint(white, 1.0);
  return function;
}

vtkNew<vtkColorTransferFunction> sameAsColors(double white)
{
  vtkNew<vtkColorTransferFunction> function;
  function->AddRGBPoint(0.0, 0.1, 0.1, 0.1);
  function->AddRGBPoint(100.0, 0.8, 0.8, 0.8, 0.3, 0.2);
  function->AddRGBPoint(white, 1.0, 1.0, 1.0);
  return function;
}

void prepare(vtkVolumeProperty* property, vtkImageData* image)
{
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(10.0, 0.0);
  opacity->AddPoint(255.0, 0.5);
  property->SetScalarOpacity(opacity);
  property->SetInterpolationTypeToLinear();
  property->GetIsoSurfaceValues()->SetValue(0, 120.0);
  vtkNew<vtkPlane> slice;
  slice->SetOrigin(image->GetCenter());
  slice->SetNormal(0.3, 1.0, -0.2);
  property->SetSliceFunction(slice);
}

using MakeMapper = std::function<vtkSmartPointer<vtkVolumeMapper>(vtkImageData*)>;

vtkSmartPointer<vtkVolumeMapper> makeOverride(vtkImageData* image)
{
  auto mapper = vtkSmartPointer<vtkSplattingMIPGPUVolumeRayCastMapper>::New();
  mapper->SetInputData(image);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetSampleDistance(1.0);
  return mapper;
}

/// A mapper's picture of the volume in a blend mode, as this property has it.
stage::Pixels picture(
  stage::Stage& stage, vtkVolumeMapper* mapper, int mode, vtkVolumeProperty* property)
{
  mapper->SetBlendMode(mode);
  stage.volume->SetProperty(property);
  return stage.pixels();
}

void testMapper(stage::Stage& stage, const MakeMapper& make, reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 48, 40, 44 }, 25));
  vtkNew<vtkVolumeProperty> gray, colored;
  prepare(gray, image);
  prepare(colored, image);
  gray->SetColor(grays(255.0).Get());
  colored->SetColor(sameAsColors(255.0).Get());
  const auto mapper = make(image), other = make(image);
  const std::string name = mapper->GetClassName();
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent),
    others(other, vtkCommand::WarningEvent);
  stage.show(mapper);
  stage.look({ 0.45, -0.5, -0.74 }, { 0.1, 1.0, 0.0 });
  const stage::Pixels maxima =
    picture(stage, mapper, vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, gray);
  std::vector<stage::Pixels> before;
  int changed = 0;
  for (int mode : modes)
  {
    const std::string of = name + ", blend mode " + std::to_string(mode) + ": ";
    const stage::Pixels shown = picture(stage, mapper, mode, gray);
    const vtkMTimeType time = gray->GetMTime();
    before.push_back(shown);
    check(picture(stage, mapper, mode, gray) == shown, of, "the second frame is as the first.");
    check(gray->GetMTime() == time, of, "the second frame changes nothing of the property.");
    check(gray->GetColorChannels(0) == 1, of, "the property is still gray.");
    check(picture(stage, mapper, vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, gray) == maxima, of,
      "maxima are as before.");
    stage.show(other);
    check(picture(stage, other, mode, colored) == shown, of,
      "the picture is that of the same values as RGB function.");
    stage.show(mapper);
  }
  // Changes of the function are seen as those of the RGB function are.
  gray->GetGrayTransferFunction()->AddPoint(0.0, 0.4);
  gray->GetGrayTransferFunction()->AddPoint(100.0, 0.3);
  colored->GetRGBTransferFunction()->AddRGBPoint(0.0, 0.4, 0.4, 0.4);
  colored->GetRGBTransferFunction()->AddRGBPoint(100.0, 0.3, 0.3, 0.3);
  for (std::size_t n = 0; n < before.size(); ++n)
  {
    const std::string of = name + ", blend mode " + std::to_string(modes[n]) + ": ";
    const stage::Pixels shown = picture(stage, mapper, modes[n], gray);
    stage.show(other);
    check(picture(stage, other, modes[n], colored) == shown, of, "a change of grays is seen.");
    stage.show(mapper);
    changed += shown != before[n];
  }
  check(changed >= 3, name, ": the change can be seen."); // not where VTK shows sums as gray
  mapper->ReleaseGraphicsResources(stage.window);
  other->ReleaseGraphicsResources(stage.window);
}
}

//------------------------------------------------------------------------------
int TestGrayFunctions(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(120, 110);
  testMapper(
    stage, [](vtkImageData* image) { return stage::splatting(image); }, check);
  testMapper(stage, makeOverride, check);
  return check.exitCode();
}
