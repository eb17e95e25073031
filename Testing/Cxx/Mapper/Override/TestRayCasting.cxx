// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What cannot be splatted goes to VTK's ray caster: one warning per reason, and the right picture.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkContourValues.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <iostream>

namespace
{
const stage::Vector oblique = { 0.45, -0.5, -0.74 };
const stage::Vector up = { 0.1, 1.0, 0.0 };

vtkSmartPointer<vtkImageData> blobs()
{
  return stage::toImageData(stage::blobsAndTubes({ 48, 40, 44 }, 25));
}

/// With colours that let the inside be seen.
void look(stage::Stage& stage, bool perspective)
{
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(20.0, 0.0);
  opacity->AddPoint(255.0, 0.4);
  stage.property->SetScalarOpacity(opacity);
  stage.viewAngle = perspective ? 28.0 : 0.0;
  stage.look(oblique, up);
}

bool isBlack(const stage::Pixels& pixels)
{
  return std::all_of(pixels.begin(), pixels.end(), [](unsigned char byte) { return byte == 0; });
}

/// Renders more than once: the warning must come once.
stage::Pixels renderWithOneWarning(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
  const std::string& name, reference::Checks& check)
{
  stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  stage.pixels();
  stage.renderer->GetActiveCamera()->Roll(0.5);
  stage.pixels();
  stage.renderer->GetActiveCamera()->Roll(-0.5);
  stage::Pixels pixels = stage.pixels();
  check(mapper->GetLastRenderUsedRayCasting(), name, ": rays were cast.");
  check(warnings.texts.size() == 1, name, ": one warning.");
  check(!warnings.texts.empty() && warnings.texts[0].find("blend mode") != std::string::npos, name,
    ": the warning says why.");
  return pixels;
}

/// The ray caster ignores direction matrices, so the mapper must not leave them to it.
void testDirection(stage::Stage& stage, bool perspective, reference::Checks& check)
{
  const auto image = blobs();
  image->SetDirectionMatrix(0.0, -0.8, 0.6, 1.0, 0.0, 0.0, 0.0, 0.6, 0.8);
  image->SetOrigin(10.0, 20.0, -5.0);
  image->SetSpacing(1.0, 1.3, 0.8);
  stage.volume->SetOrientation(20.0, 10.0, 0.0);
  const auto mapper = stage::splatting(image);
  mapper->SetBlendModeToComposite();
  stage.show(mapper);
  look(stage, perspective);
  const std::string name = perspective ? "Direction, perspective" : "Direction";
  renderWithOneWarning(stage, mapper, name, check);
  const auto picture = stage.gray();
  const auto rayCaster = stage::gpuRayCaster(image, 0.2);
  rayCaster->SetBlendModeToComposite();
  stage.show(rayCaster);
  const stage::Likeness likeness(stage.gray(), picture);
  std::cout << name << ": " << likeness.text() << std::endl;
  check(likeness.largestShift() < 0.15, "The direction matrix counts.");
  check(likeness.psnr > 35.0, "The picture is like that of the GPU ray caster.");
  stage.show(mapper);
  rayCaster->ReleaseGraphicsResources(stage.window);
  stage.volume->SetOrientation(0.0, 0.0, 0.0);
}

/// The volume may move between frames.
void testMovedVolume(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  mapper->SetBlendModeToComposite();
  stage.show(mapper);
  look(stage, true);
  const stage::Pixels before = renderWithOneWarning(stage, mapper, "Moved volume", check);
  stage.volume->SetPosition(6.0, -3.0, 2.0);
  const stage::Pixels moved = stage.pixels();
  const auto fresh = stage::splatting(blobs());
  fresh->SetBlendModeToComposite();
  stage.show(fresh);
  const stage::Messages warnings(fresh, vtkCommand::WarningEvent);
  const stage::Pixels expected = stage.pixels();
  check(moved == expected && moved != before, "A moved volume is seen where it is.");
  stage.volume->SetPosition(0.0, 0.0, 0.0);
}

void testComposite(stage::Stage& stage, bool perspective, reference::Checks& check)
{
  const auto image = blobs();
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  look(stage, perspective);
  const stage::Pixels before = stage.pixels();
  check(!mapper->GetLastRenderUsedRayCasting(), "Maxima are splatted.");
  mapper->SetBlendModeToComposite();
  const stage::Pixels picture = renderWithOneWarning(stage, mapper, "Composite", check);
  check(!isBlack(picture), "Composite: the picture is not black.");
  const auto rayCaster = stage::fixedPointRayCaster(image, 1.0);
  rayCaster->SetBlendModeToComposite();
  stage.show(rayCaster);
  check(stage.pixels() == picture, "Composite: the picture is that of the ray caster.");
  stage.show(mapper);
  mapper->SetBlendModeToMaximumIntensity();
  check(stage.pixels() == before, "Afterwards maxima are as before.");
  check(!mapper->GetLastRenderUsedRayCasting(), "And splatted.");
}

/// What vtkFixedPointVolumeRayCastMapper would show as something else.
void testBlendModesOfGpu(stage::Stage& stage, reference::Checks& check)
{
  const auto image = blobs();
  vtkNew<vtkPlane> slice;
  slice->SetOrigin(image->GetCenter());
  slice->SetNormal(0.3, 1.0, -0.2);
  stage.property->SetSliceFunction(slice);
  stage.property->GetIsoSurfaceValues()->SetValue(0, 120.0);
  struct Case
  {
    int blendMode;
    bool perspective;
  };
  for (const Case& c :
    { Case{ vtkVolumeMapper::ADDITIVE_BLEND, false }, { vtkVolumeMapper::ISOSURFACE_BLEND, false },
      { vtkVolumeMapper::SLICE_BLEND, true }, { vtkVolumeMapper::ADDITIVE_BLEND, true } })
  {
    const auto mapper = stage::splatting(image);
    const auto rayCaster = stage::gpuRayCaster(image, 1.0);
    mapper->SetBlendMode(c.blendMode);
    rayCaster->SetBlendMode(c.blendMode);
    stage.show(mapper);
    look(stage, c.perspective);
    const std::string name = "Blend mode " + std::to_string(c.blendMode);
    const stage::Pixels picture = renderWithOneWarning(stage, mapper, name, check);
    check(!isBlack(picture), name, ": the picture is not black.");
    stage.show(rayCaster);
    check(stage.pixels() == picture, name, ": the picture is that of the GPU ray caster.");
  }
}

/// Colours that change, and properties that are exchanged for older ones.
void testColors(stage::Stage& stage, reference::Checks& check)
{
  const auto image = blobs();
  const auto mapper = stage::splatting(image);
  mapper->SetBlendModeToComposite();
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  stage.show(mapper);
  const auto pixelsOf = [&](double black, double white)
  {
    stage.setGrayRamp(black, white);
    look(stage, true);
    return stage.pixels();
  };
  const stage::Pixels plain = pixelsOf(0.0, 255.0);
  check(pixelsOf(100.0, 150.0) != plain, "Ray cast with new colours.");
  vtkNew<vtkVolumeProperty> other;
  other->DeepCopy(stage.property);
  pixelsOf(0.0, 255.0);
  stage.volume->SetProperty(other);
  check(stage.pixels() != plain, "Ray cast with another, older property.");
  stage.volume->SetProperty(stage.property);
  check(stage.pixels() == plain, "Ray cast with the first colours again.");
}

}

//------------------------------------------------------------------------------
int TestRayCasting(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(180, 170);
  for (bool perspective : { false, true })
  {
    testDirection(stage, perspective, check);
    testComposite(stage, perspective, check);
  }
  testMovedVolume(stage, check);
  testBlendModesOfGpu(stage, check);
  testColors(stage, check);
  return check.exitCode();
}
