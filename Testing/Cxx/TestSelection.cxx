// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hardware selection finds the volume where its picture is not transparent, whatever renders it,
// and leaves no trace. Pickers that cast a ray through the mapper's input find what they find with
// VTK's ray caster.
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

namespace
{
constexpr int Width = 160;
constexpr int Height = 130;

/// White where the volume is not transparent; a green sphere beside it and partly behind.
struct Scene
{
  stage::Stage stage{ Width, Height };
  vtkSmartPointer<vtkImageData> image = stage::toImageData(stage::blobsAndTubes({ 48, 44, 40 }, 7));
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper = stage::splatting(image);
  vtkNew<vtkActor> actor;

  Scene()
  {
    vtkNew<vtkColorTransferFunction> white;
    white->AddRGBPoint(0.0, 1.0, 1.0, 1.0);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(90.0, 0.0);
    opacity->AddPoint(90.001, 1.0);
    this->stage.property->SetColor(white);
    this->stage.property->SetScalarOpacity(opacity);
    this->stage.show(this->mapper);
    vtkNew<vtkSphereSource> source;
    source->SetCenter(44.0, 8.0, 20.0);
    source->SetRadius(12.0);
    source->SetPhiResolution(40);
    source->SetThetaResolution(40);
    vtkNew<vtkPolyDataMapper> polyMapper;
    polyMapper->SetInputConnection(source->GetOutputPort());
    this->actor->SetMapper(polyMapper);
    this->actor->GetProperty()->SetColor(0.0, 1.0, 0.0);
    this->actor->GetProperty()->LightingOff();
    this->stage.renderer->AddActor(this->actor);
    this->look(0.0);
  }

  void look(double viewAngle)
  {
    this->stage.viewAngle = viewAngle;
    this->stage.look({ 0.3, 0.4, -0.8 }, { 0.0, 1.0, 0.0 });
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

vtkSmartPointer<vtkHardwareSelector> selectorFor(Scene& scene, int association)
{
  const auto selector = vtkSmartPointer<vtkHardwareSelector>::New();
  selector->SetRenderer(scene.stage.renderer);
  selector->SetArea(0, 0, Width - 1, Height - 1);
  selector->SetFieldAssociation(association);
  return selector;
}

bool isRim(const Scene& scene, const stage::Pixels& pixels, int x, int y)
{
  bool differs = false;
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
void testPixels(Scene& scene, const std::string& what, bool isRayCast, stage::Checks& check)
{
  const stage::Pixels before = scene.stage.pixels();
  const vtkIdType projections = scene.mapper->GetNumberOfProjections();
  const auto selector = selectorFor(scene, vtkDataObject::FIELD_ASSOCIATION_CELLS);
  selector->SetProcessID(5);
  check(selector->CaptureBuffers(), what + ": the selector captures its passes.");
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
  check(volume > 500 && actor > 100, what + ": volume and actor are seen.");
  check(wrong == 0, what + ": " + std::to_string(wrong) + " pixels are something else.");
  check(scene.mapper->GetNumberOfProjections() == projections, what + ": nothing is projected.");
  check(scene.stage.pixels() == before, what + ": the next picture is as before.");
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

void testSelect(Scene& scene, int association, stage::Checks& check)
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
        what + ": all of the volume's pixels.");
      auto* const ids = vtkIdTypeArray::SafeDownCast(node->GetSelectionList());
      check(ids && ids->GetNumberOfValues() == 1 && ids->GetValue(0) == 0, what + ": one thing.");
    }
  }
  check(nodes == 1, what + ": the volume is found once.");
  check(scene.stage.pixels() == before, what + ": the next picture is as before.");
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

void testPicking(Scene& scene, stage::Checks& check)
{
  const stage::Pixels before = scene.stage.pixels();
  vtkRenderer* const renderer = scene.stage.renderer;
  for (vtkProp* prop : { static_cast<vtkProp*>(scene.stage.volume),
         static_cast<vtkProp*>(scene.actor), static_cast<vtkProp*>(nullptr) })
  {
    int place[2];
    if (check(findPlace(scene, before, prop, place), "There is a place to pick at."))
    {
      vtkAssemblyPath* const path = renderer->PickProp(place[0], place[1]);
      check((path ? path->GetFirstNode()->GetViewProp() : nullptr) == prop,
        "PickProp finds what is seen.");
      vtkNew<vtkPropPicker> picker;
      check(picker->Pick(place[0], place[1], 0.0, renderer) == (prop ? 1 : 0) &&
          picker->GetViewProp() == prop,
        "vtkPropPicker finds what is seen.");
    }
  }
  int place[2];
  findPlace(scene, before, scene.stage.volume, place);
  scene.stage.volume->PickableOff();
  vtkNew<vtkPropPicker> picker;
  picker->Pick(place[0], place[1], 0.0, renderer);
  check(picker->GetViewProp() != scene.stage.volume, "What is not pickable is not picked.");
  scene.stage.volume->PickableOn();
  check(scene.stage.pixels() == before, "The picture after picking is as before.");
}

/// A scene with the sphere before the volume, and a pixel where it hides the volume.
struct HidingScene : Scene
{
  int place[2] = { 0, 0 };

  explicit HidingScene(stage::Checks& check)
  {
    this->actor->SetPosition(-36.0, -7.0, 42.0);
    this->stage.renderer->ResetCameraClippingRange();
    vtkCamera* const camera = this->stage.renderer->GetActiveCamera();
    this->mapper->IntermixIntersectingGeometryOff();
    const stage::Pixels over = this->stage.pixels();
    camera->Azimuth(180.0);
    const stage::Pixels behind = this->stage.pixels();
    camera->Azimuth(-180.0);
    this->mapper->IntermixIntersectingGeometryOn();
    const stage::Pixels pixels = this->stage.pixels();
    int count = 0;
    for (int pixel = 0; pixel < Width * Height && count == 0; ++pixel)
    {
      const int x = pixel % Width, y = pixel / Width;
      const bool isRimOfAny =
        isRim(*this, over, x, y) || isRim(*this, behind, x, y) || isRim(*this, pixels, x, y);
      if (!isRimOfAny && this->shownAt(pixels, x, y) == this->actor &&
        this->shownAt(over, x, y) == this->stage.volume &&
        this->shownAt(behind, x, y) == this->stage.volume)
      {
        this->place[0] = x;
        this->place[1] = y;
        ++count;
      }
    }
    check(count > 0, "The sphere hides some of the volume.");
  }

  vtkProp* picked(vtkRenderer* renderer, int left = 0) const
  {
    vtkAssemblyPath* const path = renderer->PickProp(left + this->place[0], this->place[1]);
    return path ? path->GetFirstNode()->GetViewProp() : nullptr;
  }
};

/// Two renderers show one volume, but only one the sphere before it.
void testTwoRenderers(stage::Checks& check)
{
  HidingScene scene(check);
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
void testOtherView(stage::Checks& check)
{
  HidingScene scene(check);
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

/// The same places and positions as with VTK's ray caster. Returns how often the volume was hit.
template <class Picker>
int testRayPicker(Scene& scene, const std::string& what, bool isCropped, stage::Checks& check)
{
  const auto caster = stage::fixedPointRayCaster(scene.image, 1.0);
  for (vtkVolumeMapper* mapper :
    { static_cast<vtkVolumeMapper*>(caster), static_cast<vtkVolumeMapper*>(scene.mapper) })
  {
    mapper->SetCropping(isCropped);
    mapper->SetCroppingRegionPlanes(18.0, 40.0, 5.0, 38.0, 5.0, 24.0);
    mapper->SetCroppingRegionFlagsToSubVolume();
  }
  int hits = 0, differences = 0;
  for (int y = 2; y < Height; y += 4)
  {
    for (int x = 2; x < Width; x += 4)
    {
      const Pick expected = pickBy<Picker>(scene, caster, x, y);
      const Pick pick = pickBy<Picker>(scene, scene.mapper, x, y);
      hits += pick.volume == scene.stage.volume;
      differences += pick.found != expected.found || pick.position != expected.position ||
        pick.volume != expected.volume;
      if (isCropped && pick.volume)
      {
        check(pick.position[0] >= 18.0 - 1e-9 && pick.position[2] <= 24.0 + 1e-9,
          what + ": picks lie in the cropping region.");
      }
    }
  }
  scene.mapper->CroppingOff();
  check(hits > 20, what + ": the volume is picked.");
  check(differences == 0, what + ": as with VTK's ray caster.");
  return hits;
}
}

//------------------------------------------------------------------------------
int TestSelection(int, char*[])
{
  stage::Checks check;
  Scene scene;
  for (double viewAngle : { 60.0, 0.0 })
  {
    scene.look(viewAngle);
    for (int mode = 0; mode < 3; ++mode)
    {
      scene.mapper->SetQualityMode(mode);
      testPixels(scene, scene.mapper->GetQualityModeAsString(), false, check);
    }
  }
  testSelect(scene, vtkDataObject::FIELD_ASSOCIATION_CELLS, check);
  testSelect(scene, vtkDataObject::FIELD_ASSOCIATION_POINTS, check);
  testPicking(scene, check);
  testTwoRenderers(check);
  testOtherView(check);
  const int hits = testRayPicker<vtkVolumePicker>(scene, "vtkVolumePicker", false, check);
  check(testRayPicker<vtkVolumePicker>(scene, "vtkVolumePicker, cropping", true, check) < hits,
    "Cropping takes picks away.");
  testRayPicker<vtkCellPicker>(scene, "vtkCellPicker", false, check);

  scene.mapper->CroppingOn();
  scene.mapper->SetCroppingRegionPlanes(12.0, 48.0, 5.0, 44.0, 0.0, 32.0);
  testPixels(scene, "cropped", false, check);
  scene.mapper->CroppingOff();
  const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
  scene.mapper->SetBlendModeToComposite();
  testPixels(scene, "composite", true, check);
  return check.exitCode();
}
