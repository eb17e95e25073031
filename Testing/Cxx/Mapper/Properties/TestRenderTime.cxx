// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where frames take longer than allocated the quality mode steps down, which the mapper tells, and
// comes back. Times are allocated that no frame, or any frame, fits into, so that it does not
// matter how fast the machine is; TestRenderTimes has the times between.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <sstream>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

constexpr int Size = 300; // so that no view is an overview, which is never exact
constexpr double Hasty = 1e9, Patient = 1e-4; // desired updates per second

struct Scene
{
  stage::Stage stage{ Size, Size };
  vtkSmartPointer<vtkImageData> image;
  vtkSmartPointer<Mapper> mapper;

  explicit Scene(double viewAngle)
    : image(stage::toImageData(stage::blobsAndTubes({ 60, 64, 70 }, 9))),
      mapper(stage::splatting(image))
  {
    this->stage.viewAngle = viewAngle;
    this->stage.show(this->mapper);
    this->stage.look({ 0.1, 0.2, 0.9 }, { 0.0, 1.0, 0.0 }, 1.6); // wholly in the window
  }

  /// The next view of a turn, so that it is projected; returns the mode that was used.
  int turn(double rate)
  {
    this->stage.window->SetDesiredUpdateRate(rate);
    this->stage.renderer->GetActiveCamera()->Azimuth(0.5);
    this->stage.renderer->ResetCameraClippingRange();
    this->stage.window->Render();
    return this->mapper->GetQualityModeUsed();
  }

  /// The picture of this view by a mapper that always has this mode.
  stage::Pixels pictureIn(int mode)
  {
    const auto other = stage::splatting(this->image);
    other->AutoAdjustSampleDistancesOff();
    other->SetQualityMode(mode);
    this->stage.show(other);
    const stage::Pixels pixels = this->stage.pixels();
    this->stage.show(this->mapper);
    return pixels;
  }

  /// Whether the last frame is what the mapper says that it is.
  bool isTrue()
  {
    const int mode = this->mapper->GetQualityModeUsed();
    const stage::Pixels pixels = this->stage.pixels();
    return this->mapper->GetQualityModeUsed() == mode && pixels == this->pictureIn(mode);
  }
};

void testStepsDown(Scene& scene, reference::Checks& check)
{
  check(scene.turn(Hasty) == Mapper::EXACT, "The first frame is in the wanted mode.");
  check(scene.turn(Hasty) == Mapper::EXACT, "First frames do not count.");
  check(scene.turn(Hasty) == Mapper::HIGH, "Exact gives way to high.");
  check(scene.isTrue(), "It is high.");
  check(scene.turn(Hasty) == Mapper::STANDARD, "High gives way to standard.");
  check(scene.isTrue(), "It is standard.");
  check(scene.turn(Hasty) == Mapper::PREVIEW, "Standard gives way to preview.");
  check(scene.isTrue(), "It is a preview.");
  check(scene.turn(Hasty) == Mapper::PREVIEW, "Preview stays.");
  std::ostringstream text;
  scene.mapper->Print(text);
  check(text.str().find("QualityMode: exact") != std::string::npos &&
      text.str().find("QualityModeUsed: preview") != std::string::npos,
    "PrintSelf tells both modes.");
  check(scene.mapper->GetTimeToDraw() > 0.0, "The time to draw is known.");
}

void testComesBack(Scene& scene, reference::Checks& check)
{
  const vtkIdType before = scene.mapper->GetNumberOfProjections();
  scene.stage.window->SetDesiredUpdateRate(Patient);
  scene.stage.window->Render();
  check(scene.mapper->GetQualityModeUsed() == Mapper::EXACT &&
      scene.mapper->GetNumberOfProjections() == before + 1,
    "A still frame of the same view is in the wanted mode.");
  check(scene.isTrue(), "It is exact.");
  scene.stage.window->SetDesiredUpdateRate(Hasty);
  scene.stage.setGrayRamp(0.0, 200.0);
  scene.stage.window->Render();
  check(scene.mapper->GetQualityModeUsed() == Mapper::EXACT &&
      scene.mapper->GetNumberOfProjections() == before + 1,
    "A better projection is kept while it shows the view.");
  check(scene.turn(Hasty) == Mapper::PREVIEW, "Frames that re-use a projection are not measured.");
}

void testWishes(Scene& scene, reference::Checks& check)
{
  scene.stage.window->SetDesiredUpdateRate(Patient);
  scene.stage.window->Render();
  scene.mapper->SetQualityModeToStandard();
  scene.stage.window->Render();
  check(scene.mapper->GetQualityModeUsed() == Mapper::STANDARD, "No better than wanted.");
  scene.mapper->AutoAdjustSampleDistancesOff();
  check(scene.turn(Hasty) == Mapper::STANDARD && scene.turn(Hasty) == Mapper::STANDARD,
    "Off: always the wanted mode.");
  scene.mapper->SetQualityModeToExact();
  check(scene.turn(Hasty) == Mapper::EXACT && scene.isTrue(), "Off: exact is exact.");
  scene.mapper->AutoAdjustSampleDistancesOn();
  check(scene.turn(Hasty) == Mapper::PREVIEW, "On again.");
}

void testOthers(Scene& scene, reference::Checks& check)
{
  stage::Stage other(Size, Size);
  other.show(scene.mapper);
  other.look({ 0.2, 0.1, 0.9 }, { 0.0, 1.0, 0.0 });
  other.window->SetDesiredUpdateRate(Hasty);
  other.window->Render();
  check(scene.mapper->GetQualityModeUsed() == Mapper::EXACT, "Another view has its own times.");
  check(scene.turn(Hasty) == Mapper::PREVIEW, "The first view keeps its own.");
  scene.image->Modified();
  check(scene.turn(Hasty) == Mapper::PREVIEW, "Changed data take what the last ones took.");
  scene.image = stage::toImageData(stage::blobsAndTubes({ 50, 54, 60 }, 9));
  scene.mapper->SetInputData(scene.image);
  check(scene.turn(Hasty) == Mapper::EXACT, "Data of another size have other times.");
}
}

//------------------------------------------------------------------------------
int TestRenderTime(int, char*[])
{
  reference::Checks check;
  for (double viewAngle : { 0.0, 70.0 })
  {
    Scene scene(viewAngle);
    testStepsDown(scene, check);
    testComesBack(scene, check);
    testWishes(scene, check);
    testOthers(scene, check);
  }
  return check.exitCode();
}
