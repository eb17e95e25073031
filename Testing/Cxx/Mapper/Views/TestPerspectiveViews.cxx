// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Perspective views: changes that keep the eye do not project again, and programs may set explicit
// projection matrices. TestPerspectiveWarp tests the seams between images of several axes.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

constexpr int Width = 210;
constexpr int Height = 190;
const stage::Vector Up = { 0.1, 1.0, 0.05 };

vtkSmartPointer<vtkImageData> blobs()
{
  return stage::toImageData(stage::blobsAndTubes({ 64, 64, 64 }, 45));
}

/// Whether the mapper shows what one does that has not shown anything before.
bool showsAsNew(stage::Stage& stage, Mapper* mapper, const stage::Pixels& pixels)
{
  const auto fresh = stage::splatting(vtkImageData::SafeDownCast(mapper->GetInput()));
  fresh->SetQualityMode(mapper->GetQualityMode());
  fresh->SetBlendMode(mapper->GetBlendMode());
  fresh->SetMaximumType(mapper->GetMaximumType());
  stage.show(fresh);
  const bool same = stage.pixels() == pixels;
  stage.show(mapper);
  return same;
}

/// What leaves the eye where it is and the whole volume in the window leaves the images as they
/// are; what moves the eye does not.
void testReuse(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  stage.show(mapper);
  stage.viewAngle = 50.0;
  const auto counts = [&](int projections, const char* what, auto step)
  {
    stage.look({ 0.7, 0.1, 0.8 }, Up, 1.6);
    camera->SetWindowCenter(0.0, 0.0);
    const stage::Pixels before = stage.pixels();
    const vtkIdType count = mapper->GetNumberOfProjections();
    step();
    stage.renderer->ResetCameraClippingRange();
    const stage::Pixels after = stage.pixels();
    check(mapper->GetNumberOfProjections() - count == projections, what, ": projections, ",
      mapper->GetQualityModeAsString());
    check(before != after, what, ": the picture changes.");
    check(showsAsNew(stage, mapper, after), what, ": the picture is right.");
  };
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    counts(0, "Yaw", [&] { camera->Yaw(3.0); });
    counts(0, "Pitch", [&] { camera->Pitch(-2.0); });
    counts(0, "Roll", [&] { camera->Roll(20.0); });
    counts(0, "Zoom", [&] { camera->Zoom(0.8); });
    counts(0, "Window centre", [&] { camera->SetWindowCenter(0.1, 0.05); });
    counts(0, "Colours", [&] { stage.setGrayRamp(20.0, 200.0); });
    stage.setGrayRamp(0.0, 255.0);
    counts(1, "Azimuth", [&] { camera->Azimuth(1.0); });
    counts(1, "Dolly", [&] { camera->Dolly(1.1); });
    counts(1, "Zoom into a part", [&] { camera->Zoom(3.0); });
    counts(1, "Part in the window", [&] { camera->Yaw(20.0); });
  }
}

bool isBlack(const stage::Pixels& pixels)
{
  return std::all_of(pixels.begin(), pixels.end(), [](unsigned char byte) { return byte == 0; });
}

/// Projections that programs give themselves.
void testExplicitProjection(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  stage.show(mapper);
  stage.viewAngle = 40.0;
  stage.look({ 0.7, 0.3, 0.8 }, Up, 1.1);
  camera->SetWindowCenter(0.3, -0.2);
  const stage::Pixels expected = stage.pixels();
  vtkNew<vtkMatrix4x4> projection;
  projection->DeepCopy(
    camera->GetProjectionTransformMatrix(stage.renderer->GetTiledAspectRatio(), -1.0, 1.0));
  camera->SetExplicitProjectionTransformMatrix(projection);
  camera->UseExplicitProjectionTransformMatrixOn();
  // Neither of these means anything now.
  camera->SetViewAngle(90.0);
  camera->ParallelProjectionOn();
  check(!isBlack(expected) && stage.pixels() == expected, "An explicit perspective is one.");
  camera->UseExplicitProjectionTransformMatrixOff();
  camera->SetWindowCenter(0.0, 0.0);
}
}

//------------------------------------------------------------------------------
int TestPerspectiveViews(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  testReuse(stage, check);
  testExplicitProjection(stage, check);
  return check.exitCode();
}
