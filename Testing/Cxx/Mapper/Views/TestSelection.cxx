// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hardware selection finds the volume where its picture is not transparent, whatever renders it,
// and leaves no trace. Pickers that cast a ray through the mapper's input find what they find with
// VTK's ray caster.
#include "CoreTesting.h"
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkAssemblyNode.h"
#include "vtkAssemblyPath.h"
#include "vtkCamera.h"
#include "vtkCellPicker.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkHardwareSelector.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPolyDataMapper.h"
#include "vtkPropPicker.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumePicker.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <array>

namespace
{
constexpr int Width = 160;
constexpr int Height = 130;

/// White where the volume is not transparent; a green sphere somewhere in it, beside it, before it
/// or behind.
struct Scene
{
  stage::Stage stage{ Width, Height };
  vtkSmartPointer<vtkImageData> image;
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper;
  vtkNew<vtkActor> actor;
  double radius;

  explicit Scene(reference::Random& random)
    : image(stage::toImageData(stage::anyBlobs(random))),
      mapper(stage::splatting(image)),
      radius(random.uniform(5.0, 15.0))
  {
    vtkNew<vtkColorTransferFunction> white;
    white->AddRGBPoint(0.0, 1.0, 1.0, 1.0);
    vtkNew<vtkPiecewiseFunction> opacity;
    const double threshold = random.uniform(40.0, 140.0);
    opacity->AddPoint(threshold, 0.0);
    opacity->AddPoint(threshold + 0.001, 1.0);
    this->stage.property->SetColor(white);
    this->stage.property->SetScalarOpacity(opacity);
    this->mapper->SetQualityMode(random.uniform(0, 3));
    this->stage.show(this->mapper);
    vtkNew<vtkSphereSource> source;
    source->SetRadius(this->radius);
    source->SetPhiResolution(40);
    source->SetThetaResolution(40);
    vtkNew<vtkPolyDataMapper> polyMapper;
    polyMapper->SetInputConnection(source->GetOutputPort());
    this->actor->SetMapper(polyMapper);
    this->actor->GetProperty()->SetColor(0.0, 1.0, 0.0);
    this->actor->GetProperty()->LightingOff();
    const stage::Vector side = stage::anyDirection(random);
    const double away = random.uniform(0.0, 50.0) / vtkMath::Norm(side.data());
    const double* const middle = this->image->GetCenter();
    this->actor->SetPosition(
      middle[0] + away * side[0], middle[1] + away * side[1], middle[2] + away * side[2]);
    this->stage.renderer->AddActor(this->actor);
    this->stage.viewAngle = random.oneIn(2) ? random.uniform(10.0, 80.0) : 0.0;
    const stage::Vector direction = stage::anyDirection(random);
    const stage::Vector up = stage::anyDirection(random);
    this->stage.look(direction, up, random.uniform(0.8, 1.5));
  }

  /// What a picture shows at a pixel.
  vtkProp* shownAt(const stage::Pixels& pixels, int x, int y) const
  {
    const unsigned char* const rgb = &pixels[3 * (static_cast<std::size_t>(y) * Width + x)];
    return rgb[0] ? static_cast<vtkProp*>(this->stage.volume)
      : rgb[1]    ? static_cast<vtkProp*>(this->actor)
                  : nullptr;
  }
};

/// Puts the sphere before the volume (-1) or behind it (1) in a parallel view of both.
void moveSphere(Scene& scene, double side)
{
  vtkCamera* const camera = scene.stage.renderer->GetActiveCamera();
  const double* const direction = camera->GetDirectionOfProjection();
  const double* const middle = scene.image->GetCenter();
  const double away = side * (0.5 * scene.image->GetLength() + scene.radius);
  scene.actor->SetPosition(middle[0] + away * direction[0], middle[1] + away * direction[1],
    middle[2] + away * direction[2]);
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * scene.image->GetLength());
  scene.stage.renderer->ResetCameraClippingRange();
}

/// The scenes in which volumes and spheres are seen.
struct Seen
{
  coretesting::Sightings volume, actor;

  bool both() const { return this->volume.areEnough(0.3) && this->actor.areEnough(0.2); }
};

vtkSmartPointer<vtkHardwareSelector> selectorFor(Scene& scene, int association)
{
  const auto selector = vtkSmartPointer<vtkHardwareSelector>::New();
  selector->SetRenderer(scene.stage.renderer);
  selector->SetArea(0, 0, Width - 1, Height - 1);
  selector->SetFieldAssociation(association);
  return selector;
}

/// Whether a pixel shows something else than those about it, or the volume's soft edge.
bool isRim(const Scene& scene, const stage::Pixels& pixels, int x, int y)
{
  const unsigned char red = pixels[3 * (static_cast<std::size_t>(y) * Width + x)];
  bool differs = red > 0 && red < 255;
  for (int n = 0; n < 9; ++n)
  {
    const int i = std::clamp(x + n % 3 - 1, 0, Width - 1);
    const int j = std::clamp(y + n / 3 - 1, 0, Height - 1);
    differs |= scene.shownAt(pixels, i, j) != scene.shownAt(pixels, x, y);
  }
  return differs;
}

/// Every pixel of the window. VTK's display of ray cast pictures interpolates between pixels, so
/// that these may differ at rims.
void testPixels(
  Scene& scene, const std::string& what, bool isRayCast, Seen& seen, reference::Checks& check)
{
  const stage::Pixels before = scene.stage.pixels();
  const vtkIdType projections = scene.mapper->GetNumberOfProjections();
  const auto selector = selectorFor(scene, vtkDataObject::FIELD_ASSOCIATION_CELLS);
  selector->SetProcessID(5);
  check(selector->CaptureBuffers(), what, ": the selector captures its passes.");
  int wrong = 0, volume = 0, actor = 0;
  for (unsigned int y = 0; y < Height; ++y)
  {
    for (unsigned int x = 0; x < Width; ++x)
    {
      const unsigned int position[2] = { x, y };
      const auto found = selector->GetPixelInformation(position);
      vtkProp* const shown = scene.shownAt(before, static_cast<int>(x), static_cast<int>(y));
      const bool isVolume = shown == scene.stage.volume;
      volume += isVolume;
      actor += shown == scene.actor;
      const bool numbersFit = !shown || found.ProcessID == 5;
      const bool isOne = !isVolume || (found.AttributeID == 0 && found.CompositeID == 1);
      const bool isRight = found.Prop == shown && numbersFit && isOne;
      wrong +=
        !isRight && !(isRayCast && isRim(scene, before, static_cast<int>(x), static_cast<int>(y)));
    }
  }
  seen.volume.add(volume > 0);
  seen.actor.add(actor > 0);
  check(wrong == 0, what, ": ", wrong, " pixels are something else.");
  check(scene.mapper->GetNumberOfProjections() == projections, what, ": nothing is projected.");
  check(scene.stage.pixels() == before, what, ": the next picture is as before.");
}

int countPixels(Scene& scene, const stage::Pixels& pixels, vtkProp* prop)
{
  int count = 0;
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      count += scene.shownAt(pixels, x, y) == prop;
    }
  }
  return count;
}

void testSelect(Scene& scene, int association, reference::Checks& check)
{
  const std::string what = "Selecting by association " + std::to_string(association);
  const stage::Pixels before = scene.stage.pixels();
  const auto selection =
    vtkSmartPointer<vtkSelection>::Take(selectorFor(scene, association)->Select());
  int nodes = 0;
  for (unsigned int n = 0; n < selection->GetNumberOfNodes(); ++n)
  {
    vtkSelectionNode* const node = selection->GetNode(n);
    vtkInformation* const properties = node->GetProperties();
    if (properties->Get(vtkSelectionNode::PROP()) == scene.stage.volume)
    {
      ++nodes;
      check(properties->Get(vtkSelectionNode::PIXEL_COUNT()) ==
          countPixels(scene, before, scene.stage.volume),
        what, ": all of the volume's pixels.");
      auto* const ids = vtkIdTypeArray::SafeDownCast(node->GetSelectionList());
      check(ids && ids->GetNumberOfValues() == 1 && ids->GetValue(0) == 0, what, ": one thing.");
    }
  }
  const bool isSeen = countPixels(scene, before, scene.stage.volume) > 0;
  check(nodes == (isSeen ? 1 : 0), what, ": the volume is found once where it is seen.");
  check(scene.stage.pixels() == before, what, ": the next picture is as before.");
}

/// A pixel in whose neighbourhood only this is seen.
bool findPlace(const Scene& scene, const stage::Pixels& pixels, vtkProp* prop, int place[2])
{
  for (place[1] = 6; place[1] < Height - 6; ++place[1])
  {
    for (place[0] = 6; place[0] < Width - 6; ++place[0])
    {
      bool isAlone = true;
      for (int n = 0; n < 49; ++n)
      {
        isAlone &= scene.shownAt(pixels, place[0] + n % 7 - 3, place[1] + n / 7 - 3) == prop;
      }
      if (isAlone)
      {
        return true;
      }
    }
  }
  return false;
}

void testPicking(Scene& scene, Seen& seen, reference::Checks& check)
{
  const stage::Pixels before = scene.stage.pixels();
  bool isVolume = false, isActor = false;
  vtkRenderer* const renderer = scene.stage.renderer;
  for (vtkProp* prop : { static_cast<vtkProp*>(scene.stage.volume),
         static_cast<vtkProp*>(scene.actor), static_cast<vtkProp*>(nullptr) })
  {
    int place[2];
    if (findPlace(scene, before, prop, place))
    {
      isVolume = isVolume || prop == scene.stage.volume;
      isActor = isActor || prop == scene.actor;
      vtkAssemblyPath* const path = renderer->PickProp(place[0], place[1]);
      check((path ? path->GetFirstNode()->GetViewProp() : nullptr) == prop,
        "PickProp finds what is seen.");
      vtkNew<vtkPropPicker> picker;
      check(picker->Pick(place[0], place[1], 0.0, renderer) == (prop ? 1 : 0) &&
          picker->GetViewProp() == prop,
        "vtkPropPicker finds what is seen.");
    }
  }
  seen.volume.add(isVolume);
  seen.actor.add(isActor);
  int place[2];
  if (!findPlace(scene, before, scene.stage.volume, place))
  {
    return;
  }
  scene.stage.volume->PickableOff();
  vtkNew<vtkPropPicker> picker;
  picker->Pick(place[0], place[1], 0.0, renderer);
  check(picker->GetViewProp() != scene.stage.volume, "What is not pickable is not picked.");
  scene.stage.volume->PickableOn();
  check(scene.stage.pixels() == before, "The picture after picking is as before.");
}

/// A scene with the sphere before the volume, and a pixel where it hides the volume, if there is
/// one.
struct HidingScene : Scene
{
  int place[2] = { 0, 0 };
  bool hides = false;

  explicit HidingScene(reference::Random& random) : Scene(random)
  {
    vtkCamera* const camera = this->stage.renderer->GetActiveCamera();
    camera->OrthogonalizeViewUp();
    moveSphere(*this, -1.0);
    this->mapper->IntermixIntersectingGeometryOff();
    const stage::Pixels over = this->stage.pixels();
    camera->Azimuth(180.0);
    const stage::Pixels behind = this->stage.pixels();
    camera->Azimuth(-180.0);
    this->mapper->IntermixIntersectingGeometryOn();
    const stage::Pixels pixels = this->stage.pixels();
    for (int pixel = 0; pixel < Width * Height && !this->hides; ++pixel)
    {
      const int x = pixel % Width, y = pixel / Width;
      const bool isRimOfAny =
        isRim(*this, over, x, y) || isRim(*this, behind, x, y) || isRim(*this, pixels, x, y);
      this->hides = !isRimOfAny && this->shownAt(pixels, x, y) == this->actor &&
        this->shownAt(over, x, y) == this->stage.volume &&
        this->shownAt(behind, x, y) == this->stage.volume;
      this->place[0] = x;
      this->place[1] = y;
    }
  }

  vtkProp* picked(vtkRenderer* renderer, int left = 0) const
  {
    vtkAssemblyPath* const path = renderer->PickProp(left + this->place[0], this->place[1]);
    return path ? path->GetFirstNode()->GetViewProp() : nullptr;
  }
};

/// Two renderers show one volume, but only one the sphere before it.
void testTwoRenderers(HidingScene& scene, reference::Checks& check)
{
  vtkRenderer* const left = scene.stage.renderer;
  vtkNew<vtkRenderer> right;
  scene.stage.window->SetSize(2 * Width, Height);
  scene.stage.window->AddRenderer(right);
  left->SetViewport(0.0, 0.0, 0.5, 1.0);
  right->SetViewport(0.5, 0.0, 1.0, 1.0);
  right->SetActiveCamera(left->GetActiveCamera());
  right->AddVolume(scene.stage.volume);
  scene.stage.window->Render();
  for (int time = 0; time < 2; ++time)
  {
    check(scene.picked(left) == scene.actor, "What hides the volume is picked.");
    check(scene.picked(right, Width) == scene.stage.volume, "What another renderer hides, too.");
  }
}

/// What the last frame has found does not matter to a view that it did not show.
void testOtherView(HidingScene& scene, reference::Checks& check)
{
  vtkRenderer* const renderer = scene.stage.renderer;
  check(scene.picked(renderer) == scene.actor, "What hides the volume is picked.");
  scene.mapper->IntermixIntersectingGeometryOff();
  check(scene.picked(renderer) == scene.stage.volume, "Without intermixing nothing hides it.");
  scene.mapper->IntermixIntersectingGeometryOn();
  check(scene.picked(renderer) == scene.actor, "With intermixing it is hidden again.");
  renderer->GetActiveCamera()->Azimuth(180.0);
  check(scene.picked(renderer) == scene.stage.volume, "From behind nothing hides the volume.");
}

struct Pick
{
  int found;
  stage::Vector position;
  vtkVolume* volume;
};

template <class Picker>
Pick pickBy(Scene& scene, vtkVolumeMapper* mapper, int x, int y)
{
  scene.stage.volume->SetMapper(mapper);
  vtkNew<Picker> picker;
  picker->SetVolumeOpacityIsovalue(0.5);
  picker->SetTolerance(1e-6);
  Pick pick;
  pick.found = picker->Pick(x, y, 0.0, scene.stage.renderer);
  picker->GetPickPosition(pick.position.data());
  pick.volume = vtkVolume::SafeDownCast(picker->GetProp3D());
  scene.stage.volume->SetMapper(scene.mapper);
  return pick;
}

/// Of each axis a part, with both planes in the volume.
void cropAtRandom(vtkVolumeMapper* mapper, const double* bounds, reference::Random& random)
{
  double planes[6];
  for (int a = 0; a < 3; ++a)
  {
    const double width = bounds[2 * a + 1] - bounds[2 * a];
    planes[2 * a] = bounds[2 * a] + width * random.uniform(0.0, 0.4);
    planes[2 * a + 1] = bounds[2 * a] + width * random.uniform(0.6, 1.0);
  }
  mapper->SetCroppingRegionPlanes(planes);
  mapper->SetCroppingRegionFlagsToSubVolume();
}

/// The same places and positions as with VTK's ray caster. Returns how often the volume was hit.
template <class Picker>
int testRayPicker(Scene& scene, const std::string& what, reference::Checks& check)
{
  const auto caster = stage::fixedPointRayCaster(scene.image, 1.0);
  const double* const planes = scene.mapper->GetCroppingRegionPlanes();
  caster->SetCropping(scene.mapper->GetCropping());
  caster->SetCroppingRegionPlanes(planes);
  caster->SetCroppingRegionFlagsToSubVolume();
  int hits = 0, differences = 0;
  for (int y = 2; y < Height; y += 8)
  {
    for (int x = 2; x < Width; x += 8)
    {
      const Pick expected = pickBy<Picker>(scene, caster, x, y);
      const Pick pick = pickBy<Picker>(scene, scene.mapper, x, y);
      hits += pick.volume == scene.stage.volume;
      differences += pick.found != expected.found || pick.position != expected.position ||
        pick.volume != expected.volume;
      for (int a = 0; a < 3 && scene.mapper->GetCropping() && pick.volume; ++a)
      {
        check(
          pick.position[a] >= planes[2 * a] - 1e-6 && pick.position[a] <= planes[2 * a + 1] + 1e-6,
          what, ": picks lie in the cropping region.");
      }
    }
  }
  check(differences == 0, what, ": as with VTK's ray caster.");
  return hits;
}

void testRayPickers(reference::Checks& check)
{
  coretesting::Sightings hit, less;
  reference::forScenes("ray pickers", 24,
    [&](int, reference::Random& random)
    {
      Scene scene(random);
      const int hits = testRayPicker<vtkVolumePicker>(scene, "vtkVolumePicker", check);
      hit.add(hits > 0);
      testRayPicker<vtkCellPicker>(scene, "vtkCellPicker", check);
      cropAtRandom(scene.mapper, scene.image->GetBounds(), random);
      scene.mapper->CroppingOn();
      less.add(testRayPicker<vtkVolumePicker>(scene, "vtkVolumePicker, cropping", check) < hits);
    });
  check(hit.areEnough(0.3) && less.areEnough(0.2),
    "Volumes are picked, and cropping takes picks away.");
}
}

//------------------------------------------------------------------------------
int TestSelection(int, char*[])
{
  reference::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  Seen pixels;
  reference::forScenes("pixels", 40,
    [&](int n, reference::Random& random)
    {
      Scene scene(random);
      scene.mapper->SetCropping(n % 3 == 0);
      cropAtRandom(scene.mapper, scene.image->GetBounds(), random);
      testPixels(scene, scene.mapper->GetQualityModeAsString(), false, pixels, check);
      testSelect(scene,
        n % 2 ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS,
        check);
    });
  reference::forScenes("ray cast", 8,
    [&](int, reference::Random& random)
    {
      Scene scene(random);
      // Within a volume VTK's ray caster shows and selects geometry in places of its own.
      moveSphere(scene, 1.0);
      const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
      scene.mapper->SetBlendModeToComposite();
      testPixels(scene, "composite", true, pixels, check);
    });
  check(pixels.both(), "Volumes and spheres are seen.");
  Seen picked;
  coretesting::Sightings hiding;
  reference::forScenes("picking", 40,
    [&](int n, reference::Random& random)
    {
      Scene scene(random);
      testPicking(scene, picked, check);
      HidingScene hidden(random);
      hiding.add(hidden.hides);
      if (hidden.hides)
      {
        n % 2 ? testTwoRenderers(hidden, check) : testOtherView(hidden, check);
      }
    });
  check(
    picked.both() && hiding.areEnough(0.3), "Volumes and spheres are picked, and hide each other.");
  testRayPickers(check);
  return check.exitCode();
}
