// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random walks over all settings, inputs, cameras and windows. After each step the pictures of
// mapper and filter are equal, bit for bit, to those of a new one in the same state. The
// replacement of VTK's mapper is compared with a new splatting mapper.
#include "WalkSettings.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkFloatArray.h"
#include "vtkImageFlip.h"
#include "vtkPropPicker.h"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <optional>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

using namespace walktesting;

namespace
{
constexpr int StepsPerWalk = 12;

/// What has been set, by the settings' numbers; nothing where the default is left.
using State = std::vector<std::optional<Values>>;

std::string textOf(const std::string& name, const Values& values)
{
  std::ostringstream text;
  text << " " << name << " =";
  for (double value : values)
  {
    text << " " << value;
  }
  return text.str() + ";";
}

/// The settings of a live object, and how they came to be.
template <class Object>
class Walker
{
public:
  explicit Walker(const Settings<Object>& settings) : All(settings), Now(settings.size()) {}

  /// Sets a third of the settings anew, for a start.
  void begin(Object& object, World& world, reference::Random& random)
  {
    for (std::size_t n = 0; n < this->All.size(); ++n)
    {
      if (random.oneIn(3))
      {
        this->set(n, object, world, random);
      }
    }
  }
  /// Sets one anew: another that makes the object work anew would hide whether this one does.
  void change(Object& object, World& world, reference::Random& random)
  {
    this->set(random.uniform<std::size_t>(0, this->All.size() - 1), object, world, random);
  }
  /// Sets all that has been set.
  void setAll(Object& object, World& world) const
  {
    for (std::size_t n = 0; n < this->All.size(); ++n)
    {
      if (this->Now[n])
      {
        this->All[n].set(object, *this->Now[n], world);
      }
    }
  }
  void note(const std::string& step) { this->Steps += " " + step + ";"; }
  /// What has been done since the last call.
  std::string takeSteps()
  {
    std::string steps;
    steps.swap(this->Steps);
    if (!reference::onlyScene().empty())
    {
      std::cout << "then" << steps << std::endl;
    }
    return steps;
  }

private:
  void set(std::size_t n, Object& object, World& world, reference::Random& random)
  {
    this->Now[n] = this->All[n].draw(world, random);
    this->All[n].set(object, *this->Now[n], world);
    this->Steps += textOf(this->All[n].name, *this->Now[n]);
  }

  const Settings<Object>& All;
  State Now;
  std::string Steps;
};

/// Whether all components are equal, or are no numbers.
bool sameArrays(vtkDataArray* a, vtkDataArray* b, vtkUnsignedCharArray* hidden = nullptr)
{
  if (!a || !b || a->GetNumberOfComponents() != b->GetNumberOfComponents() ||
    a->GetNumberOfTuples() != b->GetNumberOfTuples() || a->GetDataType() != b->GetDataType())
  {
    return a == b;
  }
  for (vtkIdType n = 0; n < a->GetNumberOfValues(); ++n)
  {
    const int components = a->GetNumberOfComponents(), c = static_cast<int>(n % components);
    const double x = a->GetComponent(n / components, c), y = b->GetComponent(n / components, c);
    if (x != y && !(std::isnan(x) && std::isnan(y)) &&
      !(hidden && hidden->GetValue(n / components)))
    {
      return false;
    }
  }
  return true;
}

bool samePlaces(vtkImageData* a, vtkImageData* b)
{
  const auto same = [](const auto* x, const auto* y, int n) { return std::equal(x, x + n, y); };
  return same(a->GetExtent(), b->GetExtent(), 6) && same(a->GetOrigin(), b->GetOrigin(), 3) &&
    same(a->GetSpacing(), b->GetSpacing(), 3);
}

bool sameShearImages(vtkImageData* a, vtkImageData* b)
{
  if (!a || !b)
  {
    return a == b;
  }
  return samePlaces(a, b) && sameArrays(a->GetPointGhostArray(), b->GetPointGhostArray()) &&
    sameArrays(
      a->GetPointData()->GetScalars(), b->GetPointData()->GetScalars(), a->GetPointGhostArray());
}

/// Place and all point arrays.
bool sameImages(vtkImageData* a, vtkImageData* b)
{
  if (!a || !b || !samePlaces(a, b) ||
    a->GetPointData()->GetNumberOfArrays() != b->GetPointData()->GetNumberOfArrays())
  {
    return a == b;
  }
  bool same = true;
  for (int n = 0; n < a->GetPointData()->GetNumberOfArrays(); ++n)
  {
    same = same && sameArrays(a->GetPointData()->GetArray(n), b->GetPointData()->GetArray(n));
  }
  return same;
}

/// What a frame shows, besides the mapper's own images.
struct Frame
{
  stage::Pixels pixels;
  std::vector<float> depths;

  bool isPlain() const
  {
    return std::all_of(this->pixels.begin(), this->pixels.end(),
      [this](unsigned char byte) { return byte == this->pixels[0]; });
  }
};

Frame frameOf(World& world, Shown& shown)
{
  Frame frame;
  stage::Stage& stage = world.shown();
  shown.volume->SetVisibility(true);
  frame.pixels = stage.pixels();
  shown.volume->SetVisibility(false);
  const int* const size = stage.window->GetSize();
  vtkNew<vtkFloatArray> depths;
  stage.window->GetZbufferData(0, 0, size[0] - 1, size[1] - 1, depths);
  frame.depths.assign(depths->GetPointer(0), depths->GetPointer(0) + depths->GetNumberOfValues());
  return frame;
}

/// What a mapper has said, so that nobody else does.
struct Silence
{
  explicit Silence(vtkObject* object)
    : errors(object, vtkCommand::ErrorEvent),
      warnings(object, vtkCommand::WarningEvent)
  {
  }
  stage::Messages errors, warnings;
};

/// How many pictures were compared, and how many of them show nothing, and why.
struct Counts
{
  int pictures = 0, refused = 0, transparent = 0, other = 0, rayCast = 0;

  void add(bool isPlain, bool isRefused, bool isTransparent)
  {
    ++this->pictures;
    ++(!isPlain         ? this->shown
        : isRefused     ? this->refused
        : isTransparent ? this->transparent
                        : this->other);
  }

  /// A walk that is run alone says nothing of the others.
  bool areEnough() const { return this->shown > 0 || !reference::onlyScene().empty(); }

private:
  int shown = 0;
};

std::ostream& operator<<(std::ostream& stream, const Counts& counts)
{
  return stream << counts.refused + counts.transparent + counts.other << " of " << counts.pictures
                << " pictures are plain (" << counts.refused << " refused, " << counts.transparent
                << " transparent, " << counts.other << " culled or cut away)";
}

/// A mapper that goes through a walk.
class MapperWalk
{
public:
  MapperWalk(World& scene, const Settings<Shown>& settings, bool standsIn, Counts& counts)
    : Scene(scene),
      StandsIn(standsIn),
      Count(counts),
      Walk(settings),
      Live(standsIn),
      Said(Live.mapper)
  {
    this->enter(this->Live);
  }
  ~MapperWalk() { this->In->renderer->RemoveVolume(this->Live.volume); }

  void begin(reference::Random& random) { this->Walk.begin(this->Live, this->Scene, random); }

  /// A setting or something in the scene is changed, then frames are compared.
  void step(reference::Checks& check, const std::string& name, reference::Random& random)
  {
    if (random.oneIn(12))
    {
      this->Scene.changeInput(random);
      this->Walk.setAll(this->Live, this->Scene); // the mask, too
      this->Live.mapper->SetInputDataObject(this->Scene.input.data);
      this->Walk.note("another input");
    }
    else if (random.oneIn(2))
    {
      this->Walk.note(this->Scene.change(random));
    }
    else
    {
      this->Walk.change(this->Live, this->Scene, random);
    }
    if (this->In != &this->Scene.shown())
    {
      this->In->renderer->RemoveVolume(this->Live.volume);
      this->enter(this->Live);
    }
    if (random.oneIn(12))
    {
      this->disturb(random);
    }
    this->compare(check, name + " after" + this->Walk.takeSteps());
  }

private:
  void enter(Shown& shown)
  {
    this->In = &this->Scene.shown();
    this->In->renderer->AddVolume(shown.volume);
    shown.volume->SetVisibility(false);
    shown.volume->SetProperty(this->Scene.property);
    shown.mapper->SetInputDataObject(this->Scene.input.data);
  }

  /// A frame that is aborted, a selection, or a loss of what OpenGL holds.
  void disturb(reference::Random& random)
  {
    vtkRenderWindow* const window = this->In->window;
    this->Live.volume->SetVisibility(true);
    switch (random.uniform(0, 2))
    {
      case 0:
      {
        vtkNew<vtkCallbackCommand> abort;
        abort->SetClientData(window);
        abort->SetCallback([](vtkObject*, unsigned long, void* of, void*)
          { static_cast<vtkRenderWindow*>(of)->SetAbortRender(1); });
        const unsigned long tag =
          this->Live.splatting->AddObserver(vtkCommand::VolumeMapperRenderProgressEvent, abort);
        window->Render();
        this->Live.splatting->RemoveObserver(tag);
        this->Walk.note("an aborted frame");
        break;
      }
      case 1:
      {
        vtkNew<vtkPropPicker> picker;
        const int* const size = window->GetSize();
        picker->Pick(0.5 * size[0], 0.5 * size[1], 0.0, this->In->renderer);
        this->Walk.note("a selection");
        break;
      }
      default:
        this->Live.volume->ReleaseGraphicsResources(window);
        this->Walk.note("resources released");
    }
    this->Live.volume->SetVisibility(false);
  }

  Frame frameOfLive()
  {
    const stage::Messages renders(this->Live.splatting, vtkCommand::VolumeMapperRenderStartEvent);
    const Frame frame = frameOf(this->Scene, this->Live);
    this->LiveIsRendered = !renders.texts.empty();
    return frame;
  }

  void compare(reference::Checks& check, const std::string& name)
  {
    const Frame frame = this->frameOfLive();
    // VTK's GPU mapper refuses some valid inputs of the splatting mapper.
    Shown fresh(this->StandsIn && !this->LiveIsRendered);
    const Silence said(fresh.mapper);
    const stage::Messages renders(fresh.splatting, vtkCommand::VolumeMapperRenderStartEvent);
    this->enter(fresh);
    this->Walk.setAll(fresh, this->Scene);
    const Frame expected = frameOf(this->Scene, fresh);
    const bool wasRendered = !renders.texts.empty(); // not culled, nor refused by VTK
    vtkSplattingMIPVolumeMapper *const a = this->Live.splatting, *const b = fresh.splatting;
    // What is ray cast is not always the same, even if a walk is repeated.
    const bool isRayCast = a->GetLastRenderUsedRayCasting() && b->GetLastRenderUsedRayCasting();
    check(isRayCast || frame.pixels == expected.pixels, name, " the picture differs");
    check(frame.depths == expected.depths, name, " the depth buffer differs");
    check(
      !wasRendered || !a->GetRecordLocations() || sameImages(a->GetLocations(), b->GetLocations()),
      name, " locations differ");
    if (b->GetShearImage()) // else nothing has been projected, and the live one's is an older one
    {
      check(
        sameShearImages(a->GetShearImage(), b->GetShearImage()), name, " the shear image differs");
      check(a->GetPrincipalAxis() == b->GetPrincipalAxis() &&
          a->GetShear()[0] == b->GetShear()[0] && a->GetShear()[1] == b->GetShear()[1],
        name, " the shear differs");
    }
    this->In->renderer->RemoveVolume(fresh.volume);
    this->Count.rayCast += isRayCast;
    this->Count.add(expected.isPlain(), !said.errors.texts.empty(), this->Scene.isTransparent());
  }

  World& Scene;
  bool StandsIn;
  bool LiveIsRendered = false;
  Counts& Count;
  Walker<Shown> Walk;
  Shown Live;
  Silence Said;
  stage::Stage* In = nullptr;
};

#if defined(__unix__) || defined(__APPLE__)
char sceneOfCrash[300];
struct sigaction handlerBefore;

/// Says in which scene a page was touched that must not be; then all goes its usual way.
void tellScene(int)
{
  write(STDERR_FILENO, sceneOfCrash, std::strlen(sceneOfCrash)) < 0 ? std::abort() : void();
  sigaction(SIGSEGV, &handlerBefore, nullptr);
}

void watchCrashes()
{
  struct sigaction handler = {};
  handler.sa_handler = &tellScene;
  sigaction(SIGSEGV, &handler, &handlerBefore);
}

void rememberScene()
{
  const std::string text = "crashes in a walk" + reference::howToRepeat() + "\n";
  sceneOfCrash[text.copy(sceneOfCrash, sizeof(sceneOfCrash) - 1)] = 0;
}
#else
void watchCrashes() {}
void rememberScene() {}
#endif

void testMappers(
  std::array<stage::Stage, 2>& stages, bool standsIn, int scenes, reference::Checks& check)
{
  const std::string name = standsIn ? "stand-in" : "mapper";
  const Settings<Shown> settings = settingsOfMapper(standsIn);
  Counts counts;
  reference::forScenes(name, scenes,
    [&](int, reference::Random& random)
    {
      rememberScene();
      World world(stages, false, random);
      MapperWalk walk(world, settings, standsIn, counts);
      walk.begin(random);
      for (int step = 0; step < StepsPerWalk; ++step)
      {
        walk.step(check, name + ", step " + std::to_string(step), random);
      }
    });
  check(counts.areEnough(), name, ": all pictures are plain");
  std::cout << name << ": " << counts << "; " << counts.rayCast << " were ray cast\n";
}

void compare(vtkSplattingMIPProjection* live, vtkSplattingMIPProjection* fresh,
  reference::Checks& check, const std::string& name)
{
  live->Update();
  fresh->Update();
  check(sameImages(live->GetOutput(), fresh->GetOutput()), name, " the output differs");
  check(sameShearImages(live->GetShearImage(), fresh->GetShearImage()), name,
    " the shear image differs");
}

/// A filter that goes through a walk.
void walkFilter(World& world, const Settings<vtkSplattingMIPProjection>& settings, Counts& counts,
  reference::Checks& check, reference::Random& random)
{
  Walker<vtkSplattingMIPProjection> walker(settings);
  vtkNew<vtkSplattingMIPProjection> live;
  const Silence said(live);
  walker.begin(*live, world, random);
  for (int step = 0; step < StepsPerWalk; ++step)
  {
    if (random.oneIn(12))
    {
      world.changeInput(random);
      walker.note("another input");
    }
    else if (random.oneIn(3))
    {
      walker.note(world.change(random));
    }
    else
    {
      walker.change(*live, world, random);
    }
    live->SetInputDataObject(world.input.data);
    vtkNew<vtkSplattingMIPProjection> fresh;
    const Silence alsoSaid(fresh);
    fresh->SetInputDataObject(world.input.data);
    walker.setAll(*fresh, world);
    const std::string name = "filter, step " + std::to_string(step) + " after";
    compare(live, fresh, check, name + walker.takeSteps());
    const double* const range = fresh->GetOutput()->GetScalarRange();
    counts.add(!(range[0] < range[1]), !alsoSaid.errors.texts.empty(), false);
  }
}

void testFilters(std::array<stage::Stage, 2>& stages, int scenes, reference::Checks& check)
{
  const Settings<vtkSplattingMIPProjection> settings = settingsOfFilter();
  Counts counts;
  reference::forScenes("filter", scenes,
    [&](int, reference::Random& random)
    {
      rememberScene();
      World world(stages, true, random);
      walkFilter(world, settings, counts, check, random);
    });
  check(counts.areEnough(), "filter: all pictures are plain");
  std::cout << "filter: " << counts << "\n";
}

/// No setting is left out.
void testSettings(reference::Checks& check)
{
  vtkNew<vtkSplattingMIPVolumeMapper> mapper;
  vtkNew<vtkFixedPointVolumeRayCastMapper> other;
  const std::string ofMapper = missingSettings(mapper, other, settingsOfMapper(false),
    { "QualityModeUsed", "AccelerationUsed", "LastRenderUsedRayCasting", "PrincipalAxis", "Shear",
      "IndexMemorySize", "IndexTime", "NumberOfProjections", "ProjectionTime", "InstructionSet",
      "Controller", "Texture" });
  check(ofMapper.empty(), "settings of mappers that no walk changes:", ofMapper);
  vtkNew<vtkSplattingMIPProjection> filter;
  vtkNew<vtkImageFlip> otherFilter;
  const std::string ofFilter = missingSettings(filter, otherFilter, settingsOfFilter(),
    { "IndexMemorySize", "NumberOfProjections", "InstructionSet" });
  check(ofFilter.empty(), "settings of filters that no walk changes:", ofFilter);
}
}

//------------------------------------------------------------------------------
int TestWalk(int, char*[])
{
  reference::Checks check;
  testSettings(check);
  watchCrashes();
  std::array<stage::Stage, 2> stages{ { { 40, 30 }, { 40, 30 } } };
  testMappers(stages, false, 400, check);
  testMappers(stages, true, 200, check);
  testFilters(stages, 200, check);
  return check.exitCode();
}
