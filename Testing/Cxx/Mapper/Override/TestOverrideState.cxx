// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Resources, events, messages and log of vtkSplattingMIPGPUVolumeRayCastMapper.
#include "Stage.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLogger.h"
#include "vtkRenderer.h"
#include "vtkWeakPointer.h"

#include <sstream>

namespace
{
using Override = vtkSplattingMIPGPUVolumeRayCastMapper;
constexpr int Width = 120;
constexpr int Height = 100;
const stage::Vector oblique = { 0.3, 0.4, -0.8 };
const stage::Vector up = { 0.0, 1.0, 0.1 };

vtkSmartPointer<vtkImageData> blobs()
{
  return stage::toImageData(stage::blobsAndTubes({ 40, 44, 36 }, 15));
}

vtkSmartPointer<Override> projecting(vtkImageData* image)
{
  auto mapper = vtkSmartPointer<Override>::New();
  mapper->SetInputData(image);
  mapper->SetBlendModeToMaximumIntensity();
  return mapper;
}

/// A stage that shows the mapper.
struct Scene : stage::Stage
{
  explicit Scene(vtkVolumeMapper* mapper) : Stage(::Width, ::Height)
  {
    this->show(mapper);
    this->look(oblique, up);
  }
};

/// How the quality adapts to the time for a frame is tested with the splatting mapper itself.
void testAutoAdjust(reference::Checks& check)
{
  const auto mapper = projecting(blobs());
  Scene scene(mapper);
  for (int on : { 0, 1 })
  {
    mapper->SetAutoAdjustSampleDistances(on);
    scene.pixels();
    check(mapper->GetSplattingMapper()->GetAutoAdjustSampleDistances() == on,
      "AutoAdjustSampleDistances ", on, ".");
  }
}

/// Data do not outlive all mappers that show them.
void testFinalInputs(reference::Checks& check)
{
  for (int mode : { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, vtkVolumeMapper::COMPOSITE_BLEND })
  {
    auto image = blobs();
    const vtkWeakPointer<vtkImageData> watched(image.Get());
    auto mapper = projecting(image);
    mapper->SetBlendMode(mode);
    image = nullptr;
    Scene(mapper).pixels();
    check(watched, "Data stay with their mapper.");
    mapper = nullptr;
    check(!watched, "Data go with their mapper.");
  }
}

/// Old data are let go of with the first frame of others, splatted or not.
void testInputs(reference::Checks& check)
{
  for (int mode : { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, vtkVolumeMapper::COMPOSITE_BLEND })
  {
    auto old = blobs(), mask = blobs();
    const vtkWeakPointer<vtkImageData> watched(old.Get()), watchedMask(mask.Get());
    const auto mapper = projecting(old);
    mapper->SetMaskInput(mask);
    mapper->SetMaskTypeToBinary();
    Scene scene(mapper);
    scene.pixels();
    const auto other = stage::toImageData(stage::blobsAndTubes({ 44, 40, 36 }, 9));
    mapper->SetInputData(other);
    mapper->SetBlendMode(mode);
    mapper->SetMaskInput(nullptr);
    old = mask = nullptr;
    scene.pixels();
    check(!watched && !watchedMask, "Data that are no longer shown are freed.");
  }
}

/// What an observer saw of a mapper's events.
struct Events
{
  int starts = 0;
  int ends = 0;
  std::vector<double> progress;

  explicit Events(vtkObject* mapper)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(this);
    command->SetCallback(
      [](vtkObject*, unsigned long event, void* data, void* call)
      {
        auto* const self = static_cast<Events*>(data);
        self->starts += event == vtkCommand::VolumeMapperRenderStartEvent;
        self->ends += event == vtkCommand::VolumeMapperRenderEndEvent;
        if (event == vtkCommand::VolumeMapperRenderProgressEvent)
        {
          self->progress.push_back(*static_cast<double*>(call));
        }
      });
    for (auto event : { vtkCommand::VolumeMapperRenderStartEvent,
           vtkCommand::VolumeMapperRenderEndEvent, vtkCommand::VolumeMapperRenderProgressEvent })
    {
      mapper->AddObserver(event, command);
    }
  }
};

void testEvents(reference::Checks& check)
{
  const auto mapper = projecting(blobs());
  Scene scene(mapper);
  Events events(mapper);
  scene.pixels();
  check(events.starts == 1 && events.ends == 1, "One start and one end.");
  check(mapper->GetTimeToDraw() > 0.0, "It takes time.");
  bool grows = !events.progress.empty() && events.progress.back() <= 1.0;
  for (std::size_t n = 1; n < events.progress.size(); ++n)
  {
    grows = grows && events.progress[n] >= events.progress[n - 1];
  }
  check(grows, "Progress.");
  mapper->SetReportProgress(false);
  events.progress.clear();
  scene.renderer->GetActiveCamera()->Azimuth(2.0);
  scene.pixels();
  check(events.progress.empty() && events.starts == 2, "No progress where none is wanted.");
}

void testMessages(reference::Checks& check)
{
  const auto image = blobs();
  const auto mapper = projecting(image);
  Scene scene(mapper);
  const stage::Pixels good = scene.pixels();
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  mapper->SetFinalColorWindow(0.0f);
  check(scene.pixels() != good && errors.texts.size() == 1 &&
      errors.texts[0].find("FinalColorWindow") != std::string::npos,
    "Errors of the splatting mapper are this one's.");
  mapper->SetFinalColorWindow(1.0f);
  check(scene.pixels() == good && errors.texts.size() == 1, "Mended.");
  mapper->GetSplattingMapper()->SetQualityModeToHigh(); // which can use copies of slices
  const stage::Pixels high = scene.pixels();
  mapper->GetSplattingMapper()->SetIndexMemoryBudget(0);
  image->Modified();
  check(scene.pixels() == high && warnings.texts.size() == 1, "And so are warnings.");
  mapper->CroppingOn();
  mapper->SetCroppingRegionPlanes(5.0, 5.0, 0.0, 10.0, 0.0, 10.0);
  check(scene.pixels() != good && errors.texts.size() == 1,
    "Cropping planes without a volume between them show nothing, silently, as with VTK's own.");
}

/// What the log says to those who ask for it.
void testLog(reference::Checks& check)
{
  std::ostringstream log;
  vtkLogger::AddCallback(
    "test",
    [](void* to, const vtkLogger::Message& message)
    { *static_cast<std::ostringstream*>(to) << message.message << "\n"; },
    &log, vtkLogger::VERBOSITY_1);
  const auto mapper = projecting(blobs());
  Scene scene(mapper);
  scene.pixels();
  const std::string name = vtkLogIdentifier(mapper.Get());
  const std::string splatted = name + " renders by vtkSplattingMIPVolumeMapper.\n";
  check(log.str() == splatted, "The log says who renders.");
  scene.pixels();
  mapper->SetBlendModeToComposite();
  scene.pixels();
  check(log.str() ==
      splatted + name +
        " renders by vtkOpenGLGPUVolumeRayCastMapper, because the blend mode is "
        "neither maximum nor minimum intensity.\n",
    "The log says when that changes, and why.");
  vtkLogger::RemoveCallback("test");
}

void testPrint(reference::Checks& check)
{
  const auto mapper = projecting(blobs());
  std::ostringstream text;
  mapper->Print(text);
  check(text.str().find("LastRenderUsedSplatting: No") != std::string::npos &&
      text.str().find("GlobalOverride: Off") != std::string::npos &&
      text.str().find("QualityMode: exact") != std::string::npos,
    "Print().");
}
}

//------------------------------------------------------------------------------
int TestOverrideState(int, char*[])
{
  reference::Checks check;
  testAutoAdjust(check);
  testFinalInputs(check);
  testInputs(check);
  testEvents(check);
  testMessages(check);
  testLog(check);
  testPrint(check);
  return check.exitCode();
}
