// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkSplattingMIPGPUVolumeRayCastMapper beside its pictures: what it keeps from frame to frame and
// what it lets go of, its events and messages, selections, windows and several volumes.
#include "Stage.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLogger.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPropPicker.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
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

void testReuse(reference::Checks& check)
{
  const auto image = blobs();
  const auto mapper = projecting(image);
  vtkSplattingMIPVolumeMapper* const splatting = mapper->GetSplattingMapper();
  Scene scene(mapper);
  const stage::Pixels first = scene.pixels();
  const double indexTime = splatting->GetIndexTime();
  const auto projections = [&]() { return splatting->GetNumberOfProjections(); };
  check(projections() == 1, "One projection.");
  scene.pixels();
  mapper->SetFinalColorWindow(0.7f);
  scene.pixels();
  mapper->SetFinalColorWindow(1.0f);
  mapper->SetSampleDistance(0.3f);
  mapper->SetImageSampleDistance(3.0f);
  mapper->Modified();
  check(scene.pixels() == first && projections() == 1, "Nothing that matters has changed.");
  mapper->SetBlendModeToComposite();
  check(scene.pixels() != first && projections() == 1, "Composite.");
  mapper->SetBlendModeToMaximumIntensity();
  check(scene.pixels() == first && projections() == 1, "The projection outlasts other modes.");
  scene.renderer->GetActiveCamera()->Azimuth(2.0);
  scene.pixels();
  check(projections() == 2, "A turn projects.");
  check(splatting->GetIndexTime() == indexTime, "All with one index.");
  image->Modified();
  scene.pixels();
  check(projections() == 3 && splatting->GetIndexTime() != indexTime, "Changed data.");
}

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

/// Where the picture is transparent nothing is picked, elsewhere the volume.
void testSelection(reference::Checks& check)
{
  const auto mapper = projecting(blobs());
  Scene scene(mapper);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(40.0, 0.0);
  opacity->AddPoint(40.001, 1.0);
  scene.property->SetScalarOpacity(opacity);
  const stage::Pixels picture = scene.pixels();
  vtkNew<vtkPropPicker> picker;
  int hits = 0, misses = 0, wrong = 0;
  for (int y = 5; y < Height; y += 6)
  {
    for (int x = 5; x < Width; x += 6)
    {
      const bool isShown = picture[3 * (std::size_t(y) * Width + x)] > 0;
      const bool isPicked = picker->PickProp(x, y, scene.renderer) != 0;
      hits += isPicked;
      misses += !isPicked;
      wrong += isPicked != isShown;
    }
  }
  check(hits > 10 && misses > 10 && wrong == 0, "The volume is picked where pixels show it: ", hits,
    " hits, ", misses, " misses, ", wrong, " wrong pixels.");
  check(scene.pixels() == picture, "A pick does not change the picture.");
}

/// One mapper for two volumes, in two windows, with changes of the blend mode and a release of the
/// resources in between.
void testWindows(reference::Checks& check)
{
  const auto image = blobs();
  const auto draw = [](vtkVolumeMapper* mapper, stage::Pixels pictures[4])
  {
    Scene left(mapper), right(mapper);
    right.renderer->GetActiveCamera()->Azimuth(40.0);
    vtkNew<vtkVolume> second;
    second->SetMapper(mapper);
    second->SetProperty(right.property);
    second->SetPosition(20.0, 5.0, 3.0);
    right.renderer->AddVolume(second);
    pictures[0] = left.pixels();
    pictures[1] = right.pixels();
    mapper->SetBlendModeToComposite();
    if (Override::SafeDownCast(mapper))
    {
      left.pixels();
    }
    mapper->SetBlendModeToMinimumIntensity();
    left.setGrayRamp(255.0, 0.0);
    pictures[2] = left.pixels();
    mapper->SetBlendModeToMaximumIntensity();
    left.volume->ReleaseGraphicsResources(left.window);
    left.window->Finalize();
    pictures[3] = right.pixels();
  };
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  stage::Pixels expected[4], found[4];
  draw(stage::splatting(image), expected);
  const auto mapper = projecting(image);
  draw(mapper, found);
  for (int n = 0; n < 4; ++n)
  {
    check(found[n] == expected[n], "Windows: picture ", n, ".");
  }
  check(expected[0] != expected[1] && found[3] == found[1], "Windows: as it was.");
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
  testReuse(check);
  testAutoAdjust(check);
  testFinalInputs(check);
  testInputs(check);
  testEvents(check);
  testMessages(check);
  testLog(check);
  testSelection(check);
  testWindows(check);
  testPrint(check);
  return check.exitCode();
}
