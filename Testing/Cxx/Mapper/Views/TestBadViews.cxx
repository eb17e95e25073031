// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mapper refuses invalid cameras and views with one sentence, and works again after they are
// corrected. Volumes smaller than a pixel are valid.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <functional>
#include <utility>

namespace
{
struct Scene
{
  stage::Stage stage{ 160, 150 };
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper =
    stage::splatting(stage::toImageData(stage::blobsAndTubes({ 36, 36, 36 }, 12)));

  Scene()
  {
    this->stage.show(this->mapper);
    this->stage.look({ 0.3, 0.4, -0.8 }, { 0.0, 1.0, 0.0 });
  }
};

/// Cameras with an invalid transformation.
void testCameras(Scene& scene, reference::Checks& check)
{
  const std::pair<const char*, std::function<void(vtkCamera*)>> faults[] = {
    { "without extent", [](vtkCamera* camera) { camera->SetParallelScale(0.0); } },
    { "with an extent that is not a number",
      [](vtkCamera* camera) { camera->SetParallelScale(vtkMath::Nan()); } },
    { "with a view angle that is not a number",
      [](vtkCamera* camera)
      {
        camera->ParallelProjectionOff();
        camera->SetViewAngle(vtkMath::Nan());
      } },
    { "at no place in perspective",
      [](vtkCamera* camera)
      {
        camera->ParallelProjectionOff();
        camera->SetPosition(0.0, vtkMath::Nan(), 0.0);
      } },
    { "at no place", [](vtkCamera* camera) { camera->SetPosition(0.0, vtkMath::Nan(), 0.0); } },
    { "at an infinite place",
      [](vtkCamera* camera) { camera->SetPosition(0.0, vtkMath::Inf(), 0.0); } },
    { "that looks at nothing",
      [](vtkCamera* camera) { camera->SetFocalPoint(vtkMath::Nan(), 0.0, 0.0); } },
    { "with a matrix of its own that is none",
      [](vtkCamera* camera)
      {
        vtkNew<vtkMatrix4x4> matrix;
        matrix->Zero();
        camera->SetExplicitProjectionTransformMatrix(matrix);
        camera->UseExplicitProjectionTransformMatrixOn();
      } },
  };
  vtkCamera* const camera = scene.stage.renderer->GetActiveCamera();
  vtkNew<vtkCamera> good;
  good->DeepCopy(camera);
  const stage::Pixels before = scene.stage.pixels();
  for (const auto& [name, make] : faults)
  {
    const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
    make(camera);
    scene.stage.pixels();
    scene.stage.pixels();
    // The renderer culls the volume.
    scene.mapper->Render(scene.stage.renderer, scene.stage.volume);
    check(errors.texts.size() == 1 && stage::isSentence(errors.texts[0]) &&
        errors.texts[0].find("camera") != std::string::npos,
      "A camera ", name, " gives one sentence, not ", errors.texts.size(), ".");
    camera->UseExplicitProjectionTransformMatrixOff();
    camera->DeepCopy(good);
    check(scene.stage.pixels() == before, "After a camera ", name, " the picture is as before.");
  }
}

/// A volume that is much smaller than a pixel gives no error.
void testSmallVolume(Scene& scene, reference::Checks& check)
{
  vtkCamera* const camera = scene.stage.renderer->GetActiveCamera();
  vtkNew<vtkCamera> before;
  before->DeepCopy(camera);
  camera->Azimuth(35.0);
  camera->Elevation(25.0);
  for (int mode = 0; mode <= vtkSplattingMIPVolumeMapper::EXACT; ++mode)
  {
    const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
    scene.mapper->SetQualityMode(mode);
    camera->SetParallelScale(1e7 * before->GetParallelScale());
    scene.mapper->Render(scene.stage.renderer, scene.stage.volume);
    check(errors.texts.empty() && scene.mapper->GetShearImage() != nullptr, "Mode ", mode,
      ": a small volume gives ", errors.texts.size(), " errors, or no shear image.");
  }
  camera->DeepCopy(before);
}

/// An invalid view beside a valid one gives one error, and another one after it was corrected.
void testOneBadView(Scene& scene, reference::Checks& check)
{
  scene.stage.renderer->SetViewport(0.0, 0.0, 0.5, 1.0);
  vtkNew<vtkRenderer> other;
  other->SetViewport(0.5, 0.0, 1.0, 1.0);
  other->AddVolume(scene.stage.volume);
  vtkCamera* const camera = other->GetActiveCamera();
  camera->DeepCopy(scene.stage.renderer->GetActiveCamera());
  scene.stage.window->AddRenderer(other);
  for (int time = 0; time < 2; ++time)
  {
    const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
    const double scale = camera->GetParallelScale();
    camera->SetParallelScale(0.0);
    for (int frame = 0; frame < 3; ++frame)
    {
      scene.stage.window->Render();
      // The renderer culls the volume.
      scene.mapper->Render(other, scene.stage.volume);
    }
    check(errors.texts.size() == 1 && errors.texts[0].find("camera") != std::string::npos,
      "One bad view of two gives one sentence, not ", errors.texts.size(), ".");
    camera->SetParallelScale(scale);
    scene.stage.window->Render();
  }
  {
    const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
    scene.mapper->SetFinalColorWindow(0.0f);
    scene.stage.window->Render();
    scene.stage.window->Render();
    check(errors.texts.size() == 1, "A fault of both views gives one error.");
    scene.mapper->SetFinalColorWindow(1.0f);
  }
  scene.stage.window->RemoveRenderer(other);
  scene.stage.renderer->SetViewport(0.0, 0.0, 1.0, 1.0);
}
}

//------------------------------------------------------------------------------
int TestBadViews(int, char*[])
{
  reference::Checks check;
  Scene scene;
  testCameras(scene, check);
  testSmallVolume(scene, check);
  testOneBadView(scene, check);
  return check.exitCode();
}
