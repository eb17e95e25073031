// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A render tells its progress and can be aborted wherever it does; what was aborted leaves nothing
// behind, and the next render is right.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <new>
#include <thread>
#include <vector>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

const stage::Vector Up = { 0.0, 1.0, 0.1 };
const stage::Vector Directions[] = { { 0.3, -0.45, 0.8 }, { -0.8, 0.3, 0.45 }, { 0.5, 0.7, -0.1 } };

/// A function that is called with events of an object, while this lives.
class Observer
{
public:
  Observer(vtkObject* object, unsigned long event, const std::function<void(void*)>& function)
    : Object(object),
      Function(function)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(this);
    command->SetCallback([](vtkObject*, unsigned long, void* self, void* data)
      { static_cast<Observer*>(self)->Function(data); });
    this->Tag = object->AddObserver(event, command);
  }
  ~Observer() { this->Object->RemoveObserver(this->Tag); }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

private:
  vtkObject* Object;
  std::function<void(void*)> Function;
  unsigned long Tag;
};

struct Scene
{
  stage::Stage stage{ 120, 110 };
  vtkSmartPointer<vtkImageData> image;
  vtkSmartPointer<Mapper> mapper;

  Scene()
    : image(stage::toImageData(stage::blobsAndTubes({ 90, 80, 70 }, 9))),
      mapper(stage::splatting(image))
  {
    this->stage.show(this->mapper);
    this->stage.look(Directions[0], Up);
  }
};

bool isBlack(const stage::Pixels& pixels)
{
  return std::count(pixels.begin(), pixels.end(), 0) == static_cast<std::ptrdiff_t>(pixels.size());
}

/// The shares that a frame tells, and from which thread.
std::vector<double> progressOf(Scene& scene, reference::Checks& check)
{
  std::vector<double> shares;
  const std::thread::id thread = std::this_thread::get_id();
  const Observer observer(scene.mapper, vtkCommand::VolumeMapperRenderProgressEvent,
    [&](void* share)
    {
      check(std::this_thread::get_id() == thread, "The rendering thread tells the progress.");
      shares.push_back(*static_cast<double*>(share));
    });
  scene.stage.window->Render();
  return shares;
}

void testProgress(Scene& scene, const std::string& what, reference::Checks& check)
{
  int starts = 0, ends = 0;
  const Observer start(
    scene.mapper, vtkCommand::VolumeMapperRenderStartEvent, [&](void*) { ++starts; });
  const Observer end(scene.mapper, vtkCommand::VolumeMapperRenderEndEvent, [&](void*) { ++ends; });
  const std::vector<double> shares = progressOf(scene, check);
  check(shares.size() >= 2 && shares.front() == 0.0 && shares.back() == 1.0 &&
      std::is_sorted(shares.begin(), shares.end()),
    what, ": the progress goes from 0 to 1.");
  check(progressOf(scene, check).empty(), what, ": a frame without projection has no progress.");
  check(starts == 2 && ends == 2, what, ": frames start and end.");
}

/// Aborts at the n-th request for progress. Returns whether there were so many.
bool abortAt(Scene& scene, int n, const std::string& what, reference::Checks& check)
{
  const vtkIdType projections = scene.mapper->GetNumberOfProjections();
  int reports = 0;
  stage::Pixels pixels;
  {
    const Observer observer(scene.mapper, vtkCommand::VolumeMapperRenderProgressEvent,
      [&](void*)
      {
        if (++reports == n)
        {
          scene.stage.window->SetAbortRender(1);
        }
      });
    pixels = scene.stage.pixels();
  }
  if (reports < n)
  {
    return false;
  }
  check(reports == n, what, ": no progress is reported after the abort.");
  check(isBlack(pixels), what, ": an aborted render draws nothing.");
  check(scene.mapper->GetNumberOfProjections() == projections, what, ": it is no projection.");
  check(scene.mapper->GetShearImage() == nullptr, what, ": it leaves no shear image.");
  check(scene.mapper->GetPrincipalAxis() == -1, what, ": it leaves no principal axis.");
  return true;
}

/// The direction alternates, so that every frame has to project.
void testAborts(Scene& scene, const std::string& what, reference::Checks& check)
{
  scene.stage.look(Directions[1], Up);
  scene.stage.pixels();
  scene.stage.look(Directions[0], Up);
  const stage::Pixels expected = scene.stage.pixels();
  check(!isBlack(expected), what, ": there is something to see.");
  int times = 0;
  for (int n = 1; n < 1000; ++n)
  {
    scene.stage.look(Directions[1], Up);
    scene.stage.pixels();
    scene.stage.look(Directions[0], Up);
    if (!abortAt(scene, n, what, check))
    {
      break;
    }
    ++times;
    check(scene.stage.pixels() == expected, what, ": the next render is right.");
  }
  check(times >= 2, what, ": the render could be aborted.");
}

/// Chains are given up, too, and made again.
void testChains(Scene& scene, reference::Checks& check)
{
  for (int acceleration : { Mapper::LINES, Mapper::SORTED_LINES, Mapper::SORTED_VOLUME })
  {
    scene.mapper->SetAcceleration(Mapper::DENSE);
    scene.mapper->SetQualityModeToPreview();
    const stage::Pixels expected = scene.stage.pixels();
    scene.mapper->SetAcceleration(acceleration);
    const std::string what = scene.mapper->GetAccelerationAsString();
    {
      int times = 0;
      const Observer observer(scene.mapper, vtkCommand::ProgressEvent,
        [&](void*)
        {
          // The pipeline tells 0 and 1 when it asks for the input.
          if (scene.mapper->GetProgress() > 0.0 && scene.mapper->GetProgress() < 1.0)
          {
            ++times;
            scene.stage.window->SetAbortRender(1);
          }
        });
      check(isBlack(scene.stage.pixels()), what, ": aborted while chains are made.");
      check(times == 1, what, ": the rest of the chains is not made.");
    }
    check(scene.stage.pixels() == expected, what, ": the next render is right.");
    check(scene.mapper->GetAccelerationUsed() == acceleration, what, ": with all chains.");
  }
  scene.mapper->SetAccelerationToAuto();
}

/// The window asks its observers five times a second at most.
void testAbortCheckEvent(Scene& scene, reference::Checks& check)
{
  scene.mapper->SetQualityModeToStandard();
  const stage::Pixels expected = scene.stage.pixels();
  scene.stage.look(Directions[1], Up);
  scene.stage.pixels();
  scene.stage.look(Directions[0], Up);
  int asked = 0, reports = 0;
  {
    const Observer slow(scene.mapper, vtkCommand::VolumeMapperRenderProgressEvent,
      [&](void*)
      {
        ++reports;
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
      });
    const Observer abort(scene.stage.window, vtkCommand::AbortCheckEvent,
      [&](void*)
      {
        if (++asked >= 2 && reports > 0)
        {
          scene.stage.window->SetAbortRender(1);
        }
      });
    check(isBlack(scene.stage.pixels()), "An observer of AbortCheckEvent aborts.");
  }
  check(asked >= 2 && reports >= 1 && reports <= 2, "The projection asks the window.");
  check(scene.stage.pixels() == expected, "The next render is right.");
}

/// Where pixels are wider than voxels, a frame that does not project can be aborted, too.
void testOverview(Scene& scene, reference::Checks& check)
{
  for (int mode :
    { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, vtkVolumeMapper::AVERAGE_INTENSITY_BLEND })
  {
    const std::string what = "overview, blend mode " + std::to_string(mode);
    scene.mapper->SetBlendMode(mode);
    scene.stage.look(Directions[0], Up, 10.0);
    const stage::Pixels expected = scene.stage.pixels();
    check(!isBlack(expected), what, ": there is something to see.");
    const vtkIdType projections = scene.mapper->GetNumberOfProjections();
    {
      const Observer abort(scene.mapper, vtkCommand::VolumeMapperRenderStartEvent,
        [&](void*) { scene.stage.window->SetAbortRender(1); });
      check(isBlack(scene.stage.pixels()), what, ": an aborted render draws nothing.");
    }
    double position[3];
    check(!scene.mapper->PickWorldPosition(60, 55, position), what, ": nor is it picked.");
    check(scene.stage.pixels() == expected, what, ": the next render is right.");
    check(
      scene.mapper->GetNumberOfProjections() == projections, what, ": all show one projection.");
  }
  scene.mapper->SetBlendModeToMaximumIntensity();
  scene.stage.look(Directions[0], Up);
}

/// What was aborted has not been used.
void testQualityModeUsed(Scene& scene, reference::Checks& check)
{
  scene.mapper->SetQualityModeToPreview();
  scene.stage.pixels();
  check(scene.mapper->GetQualityModeUsed() == Mapper::PREVIEW, "A preview was made.");
  scene.mapper->SetQualityModeToHigh();
  check(abortAt(scene, 1, "quality", check), "There is something to abort.");
  check(scene.mapper->GetQualityModeUsed() == Mapper::PREVIEW, "The preview was the last.");
  scene.stage.pixels();
  check(scene.mapper->GetQualityModeUsed() == Mapper::HIGH, "Now it is the better picture.");
}

/// When memory runs out, the next render is a new attempt.
void testExceptions(Scene& scene, reference::Checks& check)
{
  const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
  const stage::Pixels expected = scene.stage.pixels();
  bool isCaught = false;
  {
    const Observer observer(scene.mapper, vtkCommand::VolumeMapperRenderStartEvent,
      [](void*) { throw std::bad_alloc(); });
    try
    {
      // Without the window, which does not expect exceptions.
      scene.mapper->Render(scene.stage.renderer, scene.stage.volume);
    }
    catch (const std::bad_alloc&)
    {
      isCaught = true;
    }
  }
  check(isCaught, "Exceptions get through.");
  check(scene.stage.pixels() == expected, "After an exception the next render is right.");
  check(errors.texts.empty(), "It says nothing of renders within renders.");
}

/// Rendering from within is refused with a sentence.
void testRendersWithin(Scene& scene, reference::Checks& check)
{
  scene.stage.look(Directions[2], Up);
  const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
  bool isFirst = true;
  {
    const Observer observer(scene.mapper, vtkCommand::VolumeMapperRenderProgressEvent,
      [&](void*)
      {
        if (isFirst)
        {
          isFirst = false;
          scene.mapper->Render(scene.stage.renderer, scene.stage.volume);
        }
      });
    scene.stage.pixels();
  }
  check(errors.texts.size() == 1, "Rendering within a render gives one error.");
  const stage::Pixels picture = scene.stage.pixels();
  Scene fresh;
  fresh.mapper->SetQualityMode(scene.mapper->GetQualityMode());
  fresh.stage.look(Directions[2], Up);
  check(fresh.stage.pixels() == picture, "The render itself is right.");
}
}

//------------------------------------------------------------------------------
int TestAbort(int, char*[])
{
  reference::Checks check;
  Scene scene;
  for (double viewAngle : { 80.0, 0.0 })
  {
    scene.stage.viewAngle = viewAngle;
    scene.stage.look(Directions[0], Up);
    for (int mode = Mapper::PREVIEW; mode <= Mapper::EXACT; ++mode)
    {
      scene.mapper->SetQualityMode(mode);
      const std::string what = scene.mapper->GetQualityModeAsString();
      testProgress(scene, what, check);
      testAborts(scene, what, check);
    }
  }
  scene.mapper->SetBlendModeToAverageIntensity();
  testProgress(scene, "mean", check);
  testAborts(scene, "mean", check);
  scene.mapper->SetBlendModeToMaximumIntensity();
  scene.mapper->SetAccelerationToLines();
  scene.mapper->SetQualityModeToStandard();
  testProgress(scene, "lines", check);
  testAborts(scene, "lines", check);
  // Slices that are transposed in each frame, some at a time.
  scene.mapper->SetAccelerationToDense();
  scene.mapper->SetIndexMemoryBudget(0);
  {
    const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
    scene.stage.look(Directions[1], Up);
    testProgress(scene, "in parts", check);
  }
  scene.mapper->SetIndexMemoryBudget(vtkTypeInt64(1) << 32);
  scene.stage.look(Directions[0], Up);
  testChains(scene, check);
  testAbortCheckEvent(scene, check);
  testOverview(scene, check);
  testQualityModeUsed(scene, check);
  testExceptions(scene, check);
  testRendersWithin(scene, check);
  return check.exitCode();
}
