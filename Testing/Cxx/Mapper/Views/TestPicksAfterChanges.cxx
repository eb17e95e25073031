// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Between a frame and a pick anything may happen to input and scene. A pick finds what the frame
// has shown as long as its scalars exist and the volume is shown; otherwise it finds nothing and
// leaves its outputs unchanged.
#include "Stage.h"
#include "Volume.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkRTAnalyticSource.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace
{
constexpr int Size = 60;
const std::array<int, 3> Dimensions{ 70, 60, 80 }; // arrays that free() unmaps

struct Pick
{
  int found = 0; // of the three methods
  std::array<double, 3> position{ 1.0, 2.0, 3.0 };
  std::array<int, 3> voxel{ -7, -8, -9 };
  double value = 0.0;

  explicit Pick(vtkSplattingMIPVolumeMapper* mapper)
  {
    this->found += mapper->PickWorldPosition(Size / 2, Size / 2, this->position.data());
    this->found += mapper->PickVoxel(Size / 2, Size / 2, this->voxel.data());
    this->value = mapper->PickValue(Size / 2, Size / 2);
    this->found += !std::isnan(this->value);
  }
  bool isNone() const
  {
    return this->found == 0 && this->position == std::array<double, 3>{ 1.0, 2.0, 3.0 } &&
      this->voxel == std::array<int, 3>{ -7, -8, -9 };
  }
  bool operator==(const Pick& other) const
  {
    return this->found == other.found && this->position == other.position &&
      this->voxel == other.voxel && this->value == other.value;
  }
};

vtkSmartPointer<vtkImageData> noise()
{
  return stage::toImageData(reference::uniformNoise<std::uint8_t>(Dimensions, 5, 10, 250));
}

vtkSmartPointer<vtkRTAnalyticSource> wavelet()
{
  auto source = vtkSmartPointer<vtkRTAnalyticSource>::New();
  source->SetWholeExtent(0, Dimensions[0] - 1, 0, Dimensions[1] - 1, 0, Dimensions[2] - 1);
  return source;
}

/// A window that shows a volume, whose owner is this alone.
struct Scene
{
  Scene(int mode, bool records) : stage(Size, Size), mapper(stage::splatting(noise()))
  {
    this->mapper->SetQualityMode(mode);
    this->mapper->SetRecordLocations(records);
    this->stage.show(this->mapper);
    this->stage.look({ 0.1, 0.2, 1.0 }, { 0.0, 1.0, 0.0 }, 0.7);
  }
  vtkImageData* image()
  {
    return vtkImageData::SafeDownCast(this->mapper->GetInputDataObject(0, 0));
  }
  vtkDataArray* scalars() { return this->image()->GetPointData()->GetScalars(); }

  stage::Stage stage;
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper;
  vtkSmartPointer<vtkObject> kept; // alive as long as the scene
};

enum class Finds
{
  TheSame,
  Nothing,
  Either ///< as memory is reallocated in place or not
};

struct Change
{
  std::string name;
  Finds expected;
  std::function<void(Scene&)> apply;
  std::function<void(Scene&)> prepare = {};
};

void connectWavelet(Scene& scene)
{
  const auto source = wavelet();
  scene.kept = source;
  scene.mapper->SetInputConnection(source->GetOutputPort());
}

void renderWithout(Scene& scene)
{
  scene.stage.volume->VisibilityOff();
  scene.stage.window->Render();
  scene.stage.volume->VisibilityOn();
}

const std::vector<Change>& changes()
{
  static const std::vector<Change> all = {
    { "nothing", Finds::TheSame, [](Scene&) {} },
    { "another input", Finds::Nothing, [](Scene& s) { s.mapper->SetInputData(noise()); } },
    { "another input beside the first", Finds::TheSame,
      [](Scene& s)
      {
        s.kept = s.image();
        s.mapper->SetInputData(noise());
      } },
    { "no input", Finds::Nothing, [](Scene& s) { s.mapper->SetInputConnection(nullptr); } },
    { "Initialize()", Finds::Nothing, [](Scene& s) { s.image()->Initialize(); } },
    { "ReleaseData()", Finds::Nothing, [](Scene& s) { s.image()->ReleaseData(); } },
    { "another scalar type", Finds::Nothing,
      [](Scene& s) { s.image()->AllocateScalars(VTK_SHORT, 1); } },
    { "new scalars of the same type", Finds::Nothing,
      [](Scene& s) { s.image()->AllocateScalars(VTK_UNSIGNED_CHAR, 1); } },
    { "scalars without values", Finds::Nothing, [](Scene& s) { s.scalars()->Initialize(); } },
    { "fewer values", Finds::Nothing, [](Scene& s) { s.scalars()->SetNumberOfTuples(5); } },
    { "modified scalars", Finds::Nothing, [](Scene& s) { s.scalars()->Modified(); } },
    { "Squeeze()", Finds::Either, [](Scene& s) { s.scalars()->Squeeze(); },
      [](Scene& s)
      {
        // The memory is twice what the values need.
        const vtkIdType values = s.scalars()->GetNumberOfTuples();
        s.scalars()->Resize(2 * values);
        s.scalars()->SetNumberOfTuples(values);
      } },
    { "a reallocated array", Finds::Either,
      [](Scene& s) { s.scalars()->Resize(50 * s.scalars()->GetNumberOfTuples()); } },
    { "another spacing", Finds::TheSame, [](Scene& s) { s.image()->SetSpacing(2.0, 3.0, 4.0); } },
    { "a disconnected source", Finds::Nothing,
      [](Scene& s)
      {
        s.mapper->SetInputConnection(nullptr);
        s.kept = nullptr;
      },
      connectWavelet },
    { "an updated source", Finds::Nothing,
      [](Scene& s)
      {
        vtkRTAnalyticSource::SafeDownCast(s.kept)->SetXFreq(3.0);
        vtkRTAnalyticSource::SafeDownCast(s.kept)->Update();
      },
      connectWavelet },
    { "another input after a copied one", Finds::TheSame,
      [](Scene& s) { s.mapper->SetInputData(noise()); },
      [](Scene& s)
      {
        // Two interleaved components.
        s.image()->AllocateScalars(VTK_FLOAT, 2);
        for (vtkIdType n = 0; n < s.scalars()->GetNumberOfTuples(); ++n)
        {
          s.scalars()->SetTuple2(n, double(n % 97), 1.0);
        }
      } },
    { "an invisible volume", Finds::Nothing, [](Scene& s) { s.stage.volume->VisibilityOff(); } },
    { "an invisible volume made visible", Finds::TheSame,
      [](Scene& s)
      {
        s.stage.volume->VisibilityOff();
        s.stage.volume->VisibilityOn();
      } },
    { "a frame without the volume", Finds::Nothing, renderWithout },
    { "a frame without the volume and one with it", Finds::TheSame,
      [](Scene& s)
      {
        renderWithout(s);
        s.stage.window->Render();
      } },
    { "a removed volume", Finds::Nothing,
      [](Scene& s) { s.stage.renderer->RemoveVolume(s.stage.volume); } },
    { "a removed renderer", Finds::Nothing,
      [](Scene& s) { s.stage.window->RemoveRenderer(s.stage.renderer); } },
    { "a frame of a renderer that is removed", Finds::Nothing,
      [](Scene& s)
      {
        s.stage.window->RemoveRenderer(s.stage.renderer);
        s.stage.window->Render();
      } },
    { "a culled volume", Finds::Nothing,
      [](Scene& s)
      {
        vtkCamera* const camera = s.stage.renderer->GetActiveCamera();
        camera->SetFocalPoint(1e4, 1e4, 1e4);
        camera->SetPosition(2e4, 1e4, 1e4);
        s.stage.window->Render();
      } },
    { "another mapper in the frame", Finds::Nothing,
      [](Scene& s)
      {
        s.stage.volume->SetMapper(stage::splatting(noise()));
        s.stage.window->Render();
      } },
  };
  return all;
}

void testChange(const Change& change, int mode, bool records, reference::Checks& check)
{
  Scene scene(mode, records);
  if (change.prepare)
  {
    change.prepare(scene);
  }
  scene.stage.window->Render();
  const Pick before(scene.mapper);
  change.apply(scene);
  const std::string text = " after " + change.name + ", mode " + std::to_string(mode) +
    (records ? " with" : " without") + " recorded locations.";
  check(before.found == 3, "A sample is picked before the change", text);
  const Pick after(scene.mapper);
  const bool isSame = after == before;
  const bool isNone = after.isNone();
  check(change.expected == Finds::TheSame ? isSame
      : change.expected == Finds::Nothing ? isNone
                                          : isSame || isNone,
    "A pick finds what there is", text);
  if (records)
  {
    check((scene.mapper->GetLocations() != nullptr) == isSame,
      "There are locations if there are picks", text);
  }
}

/// What has been rendered goes before the mapper.
void testDeletedScene(reference::Checks& check)
{
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper;
  {
    Scene scene(2, false);
    scene.stage.window->Render();
    mapper = scene.mapper;
    check(Pick(mapper).found == 3, "A sample is picked.");
    scene.stage.volume->SetMapper(nullptr);
  }
  check(Pick(mapper).isNone(), "Nothing is picked once window, renderer and volume are deleted.");
}

/// The mapper goes before what it has been rendered by.
void testDeletedMapper(reference::Checks& check)
{
  Scene scene(2, false);
  scene.stage.window->Render();
  scene.stage.volume->SetMapper(nullptr);
  scene.mapper = nullptr;
  scene.mapper = stage::splatting(noise());
  scene.stage.volume->SetMapper(scene.mapper);
  scene.stage.window->Render();
  check(Pick(scene.mapper).found == 3, "A sample of the second mapper is picked.");
}
}

//------------------------------------------------------------------------------
int TestPicksAfterChanges(int, char*[])
{
  reference::Checks check;
  for (const Change& change : changes())
  {
    for (int mode : { vtkSplattingMIPVolumeMapper::PREVIEW, vtkSplattingMIPVolumeMapper::EXACT })
    {
      testChange(change, mode, false, check);
      testChange(change, mode, true, check);
    }
  }
  testDeletedScene(check);
  testDeletedMapper(check);
  return check.exitCode();
}
