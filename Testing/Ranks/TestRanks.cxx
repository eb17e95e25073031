// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// mpiexec -n N splatmip-test-ranks: several ranks show the picture of one, bit for bit, from pieces
// of any size, and come to the same end where one of them has nothing, has something wrong, or does
// not see its piece.
#include "Checks.h"
#include "Scenes.h"
#include "Volume.h"
#include "Ways.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMPIController.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace
{
using Extent = std::array<int, 6>;

constexpr int Size[3] = { 41, 34, 29 }, First[3] = { -3, 5, 0 };
constexpr int WindowSize = 120;

struct Ranks
{
  vtkMPIController* controller;
  int count, own;
  reference::Checks checks = {};

  /// What does not hold on any rank is told there.
  bool check(bool condition, const std::string& what)
  {
    return this->checks(condition, "rank ", this->own, " of ", this->count, ": ", what);
  }
  bool any(bool here) const
  {
    int mine = here, all = 0;
    this->controller->AllReduce(&mine, &all, 1, vtkCommunicator::MAX_OP);
    return all != 0;
  }
};

vtkSmartPointer<vtkImageData> wholeImage(int vtkType, int components, bool holes)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(First[0], First[0] + Size[0] - 1, First[1], First[1] + Size[1] - 1, First[2],
    First[2] + Size[2] - 1);
  image->SetSpacing(0.7, 1.0, 1.3);
  image->SetOrigin(1.0, -20.0, 3.5);
  image->SetDirectionMatrix(0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0);
  image->AllocateScalars(vtkType, components);
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  reference::Random random(vtkType + components);
  const double most = vtkType == VTK_UNSIGNED_CHAR ? 255.0 : 30000.0;
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n)
  {
    for (int c = 0; c < components; ++c)
    {
      const double x = random.uniform(0.0, 1.0);
      scalars->SetComponent(n, c, std::floor(most * x * x * x));
      if (holes && random.uniform(0, 4) == 0)
      {
        scalars->SetComponent(n, c, std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
  return image;
}

/// A part of an image; nothing of it for an empty extent.
vtkSmartPointer<vtkImageData> cropped(vtkImageData* image, Extent extent)
{
  auto piece = vtkSmartPointer<vtkImageData>::New();
  if (extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5])
  {
    return piece;
  }
  piece->DeepCopy(image);
  piece->Crop(extent.data());
  return piece;
}

/// Planes between pieces at uneven places. One rank may have nothing.
Extent extentOf(vtkImageData* image, int rank, int count, int way)
{
  Extent extent;
  std::copy(image->GetExtent(), image->GetExtent() + 6, extent.begin());
  const bool hasEmpty = way % 2 == 1 && count > 1;
  if (hasEmpty && rank == 0)
  {
    return { 0, -1, 0, -1, 0, -1 };
  }
  const int pieces = hasEmpty ? count - 1 : count, piece = hasEmpty ? rank - 1 : rank;
  const int axis = way / 2 % 3;
  const auto place = [&](int n) // the first pieces are the thinnest
  { return First[axis] + (Size[axis] * n * (n + 1)) / (pieces * (pieces + 1)); };
  if (way < 6 || pieces < 3)
  {
    extent[2 * axis] = place(piece);
    extent[2 * axis + 1] = place(piece + 1) - 1;
    return extent;
  }
  // One piece of half of the volume, the others share the rest along another axis.
  const int half = First[axis] + Size[axis] / 3, other = (axis + 1) % 3;
  if (piece == 0)
  {
    extent[2 * axis + 1] = half - 1;
    return extent;
  }
  extent[2 * axis] = half;
  extent[2 * other] = First[other] + Size[other] * (piece - 1) / (pieces - 1);
  extent[2 * other + 1] = First[other] + Size[other] * piece / (pieces - 1) - 1;
  return extent;
}

Extent withGhosts(Extent extent, vtkImageData* image, int layers)
{
  for (int a = 0; a < 3 && extent[0] <= extent[1]; ++a)
  {
    extent[2 * a] = std::max(extent[2 * a] - layers, image->GetExtent()[2 * a]);
    extent[2 * a + 1] = std::min(extent[2 * a + 1] + layers, image->GetExtent()[2 * a + 1]);
  }
  return extent;
}

/// A window with one volume.
struct Scene
{
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkVolume> volume;
  vtkNew<Mapper> mapper;
  int errors = 0;
  std::string lastError;

  explicit Scene(int components)
  {
    this->window->SetOffScreenRendering(1);
    this->window->SetMultiSamples(0);
    this->window->SetSize(WindowSize, WindowSize);
    this->window->AddRenderer(this->renderer);
    this->renderer->SetBackground(0.1, 0.2, 0.3);
    this->renderer->AddVolume(this->volume);
    this->volume->SetMapper(this->mapper);
    this->mapper->SetAutoAdjustSampleDistances(0);
    this->mapper->AddObserver(vtkCommand::ErrorEvent, this, &Scene::onError);
    vtkVolumeProperty* const property = this->volume->GetProperty();
    for (int c = 0; c < components; ++c)
    {
      vtkNew<vtkColorTransferFunction> color;
      color->AddRGBPoint(0, 0.1 * c, 0.0, 0.3);
      color->AddRGBPoint(20000, 1.0, 0.8 - 0.5 * c, 0.2);
      vtkNew<vtkPiecewiseFunction> opacity;
      opacity->AddPoint(0, 0.05);
      opacity->AddPoint(15000, 0.9);
      property->SetColor(c, color);
      property->SetScalarOpacity(c, opacity);
    }
    property->SetIndependentComponents(1);
  }

  void onError(vtkObject*, unsigned long, void* text)
  {
    ++this->errors;
    this->lastError = static_cast<const char*>(text);
  }

  std::vector<unsigned char> render()
  {
    this->window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->window->GetRGBACharPixelData(0, 0, WindowSize - 1, WindowSize - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }
};

void look(Scene& scene, vtkImageData* whole, int view)
{
  double bounds[6], centre[3];
  whole->GetBounds(bounds);
  for (int a = 0; a < 3; ++a)
  {
    centre[a] = 0.5 * (bounds[2 * a] + bounds[2 * a + 1]);
  }
  vtkCamera* const camera = scene.renderer->GetActiveCamera();
  static const double directions[][3] = { { 0.3, 0.2, 1.0 }, { 1.0, 0.25, -0.4 },
    { -0.2, -1.0, 0.6 }, { 0.0, 0.0, 1.0 }, { 0.7, 0.7, 0.7 } };
  const double* const direction = directions[view % 5];
  const bool perspective = view >= 5;
  const double distance = view >= 10 ? 6.0 : perspective ? 60.0 : 100.0;
  camera->SetFocalPoint(centre);
  camera->SetPosition(centre[0] + distance * direction[0], centre[1] + distance * direction[1],
    centre[2] + distance * direction[2]);
  camera->SetViewUp(0.1, 1.0, 0.05);
  camera->SetParallelProjection(!perspective);
  camera->SetParallelScale(28.0);
  camera->SetViewAngle(view >= 10 ? 80.0 : 40.0);
  camera->SetClippingRange(0.5, 400.0);
}

/// All modes, views and ways to cut the image: the pictures are those of one rank.
void testPictures(Ranks& ranks, int vtkType, int components, bool holes)
{
  const auto whole = wholeImage(vtkType, components, holes);
  int shown = 0, different = 0;
  const int views = reference::scenesOf(12);
  for (const Way& way : ways())
  {
    Scene one(components), many(components);
    one.mapper->SetInputDataObject(whole);
    many.mapper->SetController(ranks.controller);
    way.set(one.mapper);
    way.set(many.mapper);
    for (int n = 0; n < views; ++n)
    {
      const int view = n * 5 % 12; // from outside, in perspective and from nearby in turn
      const int cut = (view * 5 + int(way.name.size())) % 12;
      const Extent extent =
        withGhosts(extentOf(whole, ranks.own, ranks.count, cut), whole, way.layers);
      const auto piece = cropped(whole, extent);
      many.mapper->SetInputDataObject(piece);
      look(one, whole, view);
      look(many, whole, view);
      const auto expected = one.render(), found = many.render();
      ranks.check(found == expected && many.errors == 0,
        way.name + ", view " + std::to_string(view) + ", cut " + std::to_string(cut) + ", type " +
          std::to_string(vtkType) + ": the picture differs from one rank's. " + many.lastError);
      shown += std::any_of(expected.begin() + 4, expected.end(),
        [&, n = 4](unsigned char value) mutable { return value != expected[n++ % 4]; });
      different += many.mapper->GetNumberOfProjections() != 0;
      // Colours and a second look need no projection.
      const vtkIdType projections = many.mapper->GetNumberOfProjections();
      many.volume->GetProperty()->GetScalarOpacity(0)->AddPoint(9000, 0.2 + 0.01 * view);
      one.volume->GetProperty()->GetScalarOpacity(0)->AddPoint(9000, 0.2 + 0.01 * view);
      const auto opaque = one.render();
      ranks.check(many.render() == opaque, way.name + ": other colours give another picture");
      ranks.check(
        many.mapper->GetClippingPlanes() || projections == many.mapper->GetNumberOfProjections(),
        way.name + ": colours need no projection");
    }
  }
  const int frames = int(ways().size()) * views;
  ranks.check(2 * shown > frames && 2 * different > frames,
    "pictures are empty: " + std::to_string(shown) + " of " + std::to_string(frames));
}

/// Where the samples lie is known on all ranks; which voxel of a slice adds most only where it is.
void testLocations(Ranks& ranks)
{
  const auto whole = wholeImage(VTK_UNSIGNED_CHAR, 1, false);
  const int scenes = reference::scenesOf(24);
  for (int scene = 0; scene < scenes; ++scene)
  {
    const int n = scene * 7 % 24, mode = scene % 4;
    Scene one(1), many(1);
    one.mapper->SetInputDataObject(whole);
    many.mapper->SetInputDataObject(
      cropped(whole, withGhosts(extentOf(whole, ranks.own, ranks.count, n % 12), whole, 2)));
    many.mapper->SetController(ranks.controller);
    for (Scene* own : { &one, &many })
    {
      own->mapper->SetQualityMode(mode);
      own->mapper->SetBlendMode(scene % 3 ? vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND
                                          : vtkVolumeMapper::MINIMUM_INTENSITY_BLEND);
      own->mapper->SetMaximumType(scene % 3 == 1 ? Mapper::SIGNED : Mapper::GLOBAL);
      own->mapper->SetSignedOrigin(127.0);
      own->mapper->RecordLocationsOn();
      look(*own, whole, n % 12);
      own->window->Render();
    }
    vtkImageData *const expected = one.mapper->GetLocations(),
                        *const found = many.mapper->GetLocations();
    if (!ranks.check(expected && found, "there are no locations"))
    {
      continue;
    }
    for (const char* name : { "Depth", "Position", "Voxel" })
    {
      vtkDataArray *const a = expected->GetPointData()->GetArray(name),
                          *const b = found->GetPointData()->GetArray(name);
      const bool isOwn =
        std::string(name) == "Voxel" && (mode == Mapper::STANDARD || mode == Mapper::HIGH);
      const std::size_t bytes = std::size_t(a->GetNumberOfValues()) * a->GetDataTypeSize();
      ranks.check(isOwn ||
          (a->GetNumberOfValues() == b->GetNumberOfValues() &&
            std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), bytes) == 0),
        std::string(name) + " differs in view " + std::to_string(n));
    }
  }
}

/// Zoomed in, the pieces of most ranks are out of sight, from the first frame on.
void testCulling(Ranks& ranks)
{
  const auto whole = wholeImage(VTK_SHORT, 1, false);
  for (const bool updated : { false, true })
  {
    Scene one(1), many(1);
    one.mapper->SetInputDataObject(whole);
    many.mapper->SetInputDataObject(
      cropped(whole, withGhosts(extentOf(whole, ranks.own, ranks.count, 0), whole, 2)));
    many.mapper->SetController(ranks.controller);
    if (updated)
    {
      ranks.check(many.mapper->UpdateWhole(), "the whole is not known");
      double expected[6];
      whole->GetBounds(expected);
      ranks.check(std::equal(expected, expected + 6, many.mapper->GetBounds()), "other bounds");
    }
    for (int frame = 0; frame < 4; ++frame)
    {
      for (Scene* scene : { &one, &many })
      {
        look(*scene, whole, frame);
        vtkCamera* const camera = scene->renderer->GetActiveCamera();
        camera->SetParallelScale(3.0);
        const double* const focus = camera->GetFocalPoint();
        const double* const place = camera->GetPosition();
        const double move = frame == 3 ? 500.0 : 12.0; // at last all is out of sight
        camera->SetPosition(place[0] - move, place[1] - 8.0, place[2]);
        camera->SetFocalPoint(focus[0] - move, focus[1] - 8.0, focus[2]);
      }
      const auto expected = one.render();
      ranks.check(many.render() == expected, "a picture with culled pieces differs");
    }
  }
}

/// What several ranks do not project is refused, and then all is as before.
void testRefusals(Ranks& ranks, Scene& many, const std::vector<unsigned char>& expected)
{
  many.mapper->SetBlendModeToAverageIntensity();
  many.render();
  ranks.check(many.lastError.find("only maxima and minima") != std::string::npos,
    "averages are not refused but: " + many.lastError);
  many.mapper->SetBlendModeToMaximumIntensity();
  many.mapper->SetMaximumTypeToLocal();
  many.render();
  ranks.check(many.lastError.find("local maxima") != std::string::npos,
    "local maxima are not refused but: " + many.lastError);
  many.mapper->SetMaximumTypeToGlobal();
  ranks.check(many.render() == expected, "after refusals the picture differs");
}

/// A rank that does not render the volume keeps no other waiting.
void testAbsence(
  Ranks& ranks, Scene& many, vtkImageData* whole, const std::vector<unsigned char>& expected)
{
  const bool last = ranks.own == ranks.count - 1;
  vtkCamera* const camera = many.renderer->GetActiveCamera();
  const auto hide = [&] { many.volume->VisibilityOff(); };
  const auto cull = [&]
  {
    camera->SetPosition(1e4, 1e4, 1e4);
    camera->SetFocalPoint(2e4, 1e4, 1e4);
  };
  const auto show = [&]
  {
    many.volume->VisibilityOn();
    look(many, whole, 1);
  };
  const std::string absent = "Rank " + std::to_string(ranks.count - 1) + " does not render";
  for (const bool hides : { true, false })
  {
    const int before = many.errors;
    for (int frame = 0; frame < 3; ++frame)
    {
      if (last)
      {
        hides ? hide() : cull();
      }
      many.render();
    }
    ranks.check(many.errors == before + 1 && many.lastError.find(absent) != std::string::npos,
      "a volume that one rank does not render is not told once but: " + many.lastError);
    show();
    ranks.check(many.render() == expected, "once all ranks render, the picture differs");
    hides ? hide() : cull();
    many.render();
    ranks.check(many.errors == before + 1, "no rank renders: " + many.lastError);
    show();
    ranks.check(many.render() == expected, "after no rank has rendered, the picture differs");
  }
  // Without the volume, ranks are by themselves.
  many.renderer->RemoveVolume(many.volume);
  for (int frame = 0; frame < ranks.own; ++frame)
  {
    many.render();
  }
  many.renderer->AddVolume(many.volume);
  ranks.check(many.render() == expected, "once the volume is back, the picture differs");
}

/// What is wrong on one rank is told by all, and all are well again when it is mended.
void testProblems(Ranks& ranks)
{
  const auto whole = wholeImage(VTK_UNSIGNED_CHAR, 1, false);
  const Extent own = extentOf(whole, ranks.own, ranks.count, 2);
  const auto good = cropped(whole, withGhosts(own, whole, 2));
  Scene one(1), many(1);
  one.mapper->SetInputDataObject(whole);
  many.mapper->SetController(ranks.controller);
  look(one, whole, 1);
  look(many, whole, 1);
  const auto expected = one.render();
  const bool last = ranks.own == ranks.count - 1, several = ranks.count > 1;
  const auto wrong = [&](const std::string& name, const std::string& told, const auto& picture)
  {
    const int before = many.errors;
    many.render();
    ranks.check(many.errors == before + 1 && many.lastError.find(told) != std::string::npos,
      name + " is not told but: " + many.lastError);
    many.mapper->SetInputDataObject(good);
    look(many, whole, 1);
    ranks.check(many.render() == picture, "after " + name + " the picture differs");
  };
  const auto without = vtkSmartPointer<vtkImageData>::New();
  without->SetExtent(good->GetExtent());
  without->SetSpacing(whole->GetSpacing());
  many.mapper->SetInputDataObject(last ? without : good);
  wrong("a rank without scalars", "no numeric scalars", expected);
  if (!several)
  {
    return;
  }
  many.mapper->SetInputDataObject(cropped(whole, withGhosts(own, whole, last ? 0 : 1)));
  wrong("a piece without ghosts", "1 layer ", expected);
  for (Scene* scene : { &one, &many })
  {
    scene->mapper->SetQualityModeToHigh();
  }
  many.mapper->SetInputDataObject(cropped(whole, withGhosts(own, whole, last ? 0 : 2)));
  const auto high = one.render();
  wrong("a piece without ghosts in high mode", "2 layers", high);
  for (Scene* scene : { &one, &many })
  {
    scene->mapper->SetQualityModeToExact();
  }
  const auto moved = cropped(whole, withGhosts(own, whole, 2));
  moved->SetOrigin(1.0, -20.0, last ? 3.6 : 3.5);
  many.mapper->SetInputDataObject(moved);
  wrong("a piece that lies elsewhere", "not of one image", expected);
  const auto other =
    cropped(wholeImage(last ? VTK_SHORT : VTK_UNSIGNED_CHAR, 1, false), withGhosts(own, whole, 2));
  many.mapper->SetInputDataObject(other);
  wrong("a piece of another type", "differ in type", expected);
  const auto large = cropped(wholeImage(VTK_FLOAT, 1, false), withGhosts(own, whole, 2));
  large->GetPointData()->GetScalars()->SetComponent(0, 0, last ? 3e38 : 0.0);
  many.mapper->SetInputDataObject(large);
  wrong("a piece with large scalars", "magnitudes above", expected);
  // Each piece alone could be projected.
  const auto wide = cropped(wholeImage(VTK_FLOAT, 1, false), withGhosts(own, whole, 2));
  wide->GetPointData()->GetScalars()->SetComponent(
    0, 0, last ? std::numeric_limits<double>::infinity() : 1e20);
  many.mapper->SetInputDataObject(wide);
  wrong("large scalars, and infinities in another piece", "magnitudes above", expected);
  many.mapper->SetInputDataObject(good);
  many.renderer->GetActiveCamera()->SetParallelScale(last ? 20.0 : 21.0);
  wrong("another camera", "differ between ranks", expected);
  many.mapper->SetInputDataObject(vtkSmartPointer<vtkImageData>::New());
  wrong("ranks with nothing", "No rank has any voxels", expected);
  testRefusals(ranks, many, expected);
  testAbsence(ranks, many, whole, expected);
  // One rank by itself again.
  many.mapper->SetController(nullptr);
  many.mapper->SetInputDataObject(whole);
  ranks.check(many.render() == expected, "without a controller the picture differs");
}

/// An abort on one rank gives up the frame on all.
void testAbort(Ranks& ranks)
{
  const auto whole = wholeImage(VTK_SHORT, 1, false);
  Scene one(1), many(1);
  one.mapper->SetInputDataObject(whole);
  many.mapper->SetInputDataObject(
    cropped(whole, withGhosts(extentOf(whole, ranks.own, ranks.count, 4), whole, 2)));
  many.mapper->SetController(ranks.controller);
  look(one, whole, 6);
  look(many, whole, 6);
  const auto expected = one.render();
  struct Abort : vtkCommand
  {
    static Abort* New() { return new Abort; }
    vtkRenderWindow* window = nullptr;
    void Execute(vtkObject*, unsigned long, void*) override { this->window->SetAbortRender(1); }
  };
  vtkNew<Abort> abort;
  abort->window = many.window;
  const unsigned long tag =
    ranks.own == ranks.count - 1 ? many.window->AddObserver(vtkCommand::AbortCheckEvent, abort) : 0;
  many.render();
  ranks.check(many.mapper->GetNumberOfProjections() == 0, "an aborted frame has a projection");
  if (tag)
  {
    many.window->RemoveObserver(tag);
  }
  ranks.check(many.render() == expected, "after an abort the picture differs");
}

/// Only the first rank shows something.
void testRoot(Ranks& ranks)
{
  const auto whole = wholeImage(VTK_FLOAT, 1, false);
  Scene one(1), many(1);
  one.mapper->SetInputDataObject(whole);
  many.mapper->SetInputDataObject(
    cropped(whole, withGhosts(extentOf(whole, ranks.own, ranks.count, 1), whole, 2)));
  many.mapper->SetController(ranks.controller);
  many.mapper->DisplayOnRootOnlyOn();
  look(one, whole, 2);
  look(many, whole, 2);
  if (ranks.own > 0)
  {
    one.volume->VisibilityOff();
  }
  const auto expected = one.render();
  ranks.check(many.render() == expected, "others than the first rank show something");
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  Ranks ranks{ controller, controller->GetNumberOfProcesses(), controller->GetLocalProcessId() };
  testPictures(ranks, VTK_UNSIGNED_CHAR, 1, false);
  testPictures(ranks, VTK_SHORT, 1, false);
  testPictures(ranks, VTK_FLOAT, 1, true);
  testPictures(ranks, VTK_DOUBLE, 2, false);
  testLocations(ranks);
  testCulling(ranks);
  testProblems(ranks);
  testAbort(ranks);
  testRoot(ranks);
  const bool failed = ranks.any(ranks.checks.exitCode() != EXIT_SUCCESS);
  controller->Finalize();
  return failed ? 1 : 0;
}
