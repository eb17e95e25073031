// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mapper refuses invalid input and settings with one sentence. Other props are rendered, and
// the mapper works again after the input is corrected. TestBadViews has invalid views.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiVolume.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRectilinearGrid.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkStringArray.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace
{
constexpr int Width = 160;
constexpr int Height = 150;

struct Scene
{
  stage::Stage stage{ Width, Height };
  vtkSmartPointer<vtkImageData> image;
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper;

  Scene()
    : image(stage::toImageData(stage::blobsAndTubes({ 36, 36, 36 }, 12))),
      mapper(stage::splatting(image))
  {
    this->stage.show(this->mapper);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(10.0, 0.0);
    opacity->AddPoint(20.0, 1.0);
    this->stage.property->SetScalarOpacity(opacity);
    this->stage.look({ 0.3, 0.4, -0.8 }, { 0.0, 1.0, 0.0 });
    this->addSphere();
  }

  /// Green, beside the volume.
  void addSphere()
  {
    vtkNew<vtkSphereSource> source;
    source->SetCenter(-4.0, 18.0, 18.0);
    source->SetRadius(4.0);
    vtkNew<vtkPolyDataMapper> polyMapper;
    polyMapper->SetInputConnection(source->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(polyMapper);
    actor->GetProperty()->SetColor(0.0, 1.0, 0.0);
    actor->GetProperty()->LightingOff();
    this->stage.renderer->AddActor(actor);
    this->stage.renderer->ResetCameraClippingRange();
  }

  void mend()
  {
    this->mapper->SetInputData(this->image);
    this->mapper->SetScalarModeToDefault();
    this->mapper->SetVectorModeToDisabled();
    this->mapper->SetMaskInput(nullptr);
    this->stage.property->IndependentComponentsOn();
    this->stage.volume->SetScale(1.0, 1.0, 1.0);
    this->stage.volume->SetUserMatrix(nullptr);
    this->stage.volume->SetPosition(0.0, 0.0, 0.0);
    this->mapper->SetFinalColorWindow(1.0f);
    this->mapper->SetFinalColorLevel(0.5f);
    this->mapper->SetKernelRadius(1.0);
    this->mapper->RemoveAllClippingPlanes();
    this->mapper->SetBlendModeToMaximumIntensity();
  }
};

bool showsSphere(const stage::Pixels& pixels)
{
  int green = 0;
  for (std::size_t pixel = 0; pixel < pixels.size(); pixel += 3)
  {
    green += pixels[pixel] == 0 && pixels[pixel + 1] == 255 && pixels[pixel + 2] == 0;
  }
  return green > 50;
}

vtkSmartPointer<vtkImageData> bareImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(36, 36, 36);
  return image;
}

vtkSmartPointer<vtkImageData> withArray(vtkDataArray* array, vtkIdType tuples, bool onCells)
{
  auto image = bareImage();
  array->SetNumberOfTuples(tuples);
  array->Fill(1.0);
  if (onCells)
  {
    image->GetCellData()->SetScalars(array);
  }
  else
  {
    image->GetPointData()->SetScalars(array);
  }
  return image;
}

struct Fault
{
  const char* name;
  const char* word; // which the sentence must have
  std::function<void(Scene&)> make;
};

std::vector<Fault> inputFaults()
{
  return {
    { "no input", "input", [](Scene& s) { s.mapper->SetInputDataObject(nullptr); } },
    { "empty extent", "extent", [](Scene& s) { s.mapper->SetInputData(vtkNew<vtkImageData>()); } },
    { "no scalars", "scalars", [](Scene& s) { s.mapper->SetInputData(bareImage()); } },
    { "wrong array name", "array",
      [](Scene& s)
      {
        s.mapper->SetScalarModeToUsePointFieldData();
        s.mapper->SelectScalarArray("nonsense");
      } },
    { "wrong array number", "array",
      [](Scene& s)
      {
        s.mapper->SetScalarModeToUsePointFieldData();
        s.mapper->SelectScalarArray(7);
      } },
    { "strings", "numeric",
      [](Scene& s)
      {
        const auto image = bareImage();
        vtkNew<vtkStringArray> strings;
        strings->SetName("names");
        strings->SetNumberOfValues(36 * 36 * 36);
        image->GetPointData()->AddArray(strings);
        s.mapper->SetScalarModeToUsePointFieldData();
        s.mapper->SelectScalarArray("names");
        s.mapper->SetInputData(image);
      } },
    { "field data", "field data",
      [](Scene& s)
      {
        const auto image = bareImage();
        vtkNew<vtkUnsignedCharArray> array;
        array->SetName("numbers");
        array->SetNumberOfTuples(36 * 36 * 36);
        image->GetFieldData()->AddArray(array);
        s.mapper->SetScalarMode(VTK_SCALAR_MODE_USE_FIELD_DATA);
        s.mapper->SelectScalarArray("numbers");
        s.mapper->SetInputData(image);
      } },
    { "cell scalars for points", "cells",
      [](Scene& s)
      { s.mapper->SetInputData(withArray(vtkNew<vtkUnsignedCharArray>(), 36 * 36 * 36, true)); } },
    { "bit array", "bits",
      [](Scene& s)
      { s.mapper->SetInputData(withArray(vtkNew<vtkBitArray>(), 36 * 36 * 36, false)); } },
    { "too large scalars", "magnitudes above 1e37",
      [](Scene& s)
      {
        vtkNew<vtkDoubleArray> array;
        const auto image = withArray(array, 36 * 36 * 36, false);
        array->SetValue(0, -1e308);
        s.mapper->SetInputData(image);
      } },
    { "too few scalars", "tuples",
      [](Scene& s)
      { s.mapper->SetInputData(withArray(vtkNew<vtkUnsignedCharArray>(), 36 * 36, false)); } },
    { "structured grid", "vtkStructuredGrid",
      [](Scene& s) { s.mapper->SetInputDataObject(vtkNew<vtkStructuredGrid>()); } },
  };
}

vtkSmartPointer<vtkDataArray> withComponents(int components)
{
  auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetNumberOfComponents(components);
  return array;
}

std::vector<Fault> componentFaults()
{
  return {
    { "component out of range", "VectorComponent",
      [](Scene& s)
      {
        s.mapper->SetInputData(withArray(withComponents(2), 36 * 36 * 36, false));
        s.mapper->SetVectorModeToComponent();
        s.mapper->SetVectorComponent(2);
      } },
    { "five components", "5 components",
      [](Scene& s) { s.mapper->SetInputData(withArray(withComponents(5), 36 * 36 * 36, false)); } },
    { "three dependent components", "3 components",
      [](Scene& s)
      {
        s.mapper->SetInputData(withArray(withComponents(3), 36 * 36 * 36, false));
        s.stage.property->IndependentComponentsOff();
      } },
  };
}

vtkSmartPointer<vtkImageData> maskOf(int type, int width, int components)
{
  auto mask = vtkSmartPointer<vtkImageData>::New();
  mask->SetDimensions(width, 36, 36);
  mask->AllocateScalars(type, components);
  return mask;
}

std::vector<Fault> maskFaults()
{
  return {
    { "mask of another size", "mask",
      [](Scene& s) { s.mapper->SetMaskInput(maskOf(VTK_UNSIGNED_CHAR, 35, 1)); } },
    { "mask of another type", "mask",
      [](Scene& s) { s.mapper->SetMaskInput(maskOf(VTK_SHORT, 36, 1)); } },
    { "mask with two components", "mask",
      [](Scene& s) { s.mapper->SetMaskInput(maskOf(VTK_UNSIGNED_CHAR, 36, 2)); } },
    { "mask without scalars", "mask", [](Scene& s) { s.mapper->SetMaskInput(bareImage()); } },
    { "too few ghosts", "vtkGhostType",
      [](Scene& s)
      {
        const auto image = vtkSmartPointer<vtkImageData>::New();
        image->ShallowCopy(s.image);
        vtkNew<vtkUnsignedCharArray> ghosts;
        ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
        ghosts->SetNumberOfTuples(36);
        image->GetPointData()->AddArray(ghosts);
        s.mapper->SetInputData(image);
      } },
  };
}

/// A grid of 3 x 36 x 36 points.
vtkSmartPointer<vtkRectilinearGrid> gridWith(const std::vector<double>& x)
{
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetDimensions(3, 36, 36);
  for (int a = 0; a < 3; ++a)
  {
    vtkNew<vtkDoubleArray> coordinates;
    for (int n = 0; n < (a ? 36 : static_cast<int>(x.size())); ++n)
    {
      coordinates->InsertNextValue(a ? n : x[n]);
    }
    a == 0     ? grid->SetXCoordinates(coordinates)
      : a == 1 ? grid->SetYCoordinates(coordinates)
               : grid->SetZCoordinates(coordinates);
  }
  vtkNew<vtkUnsignedCharArray> scalars;
  scalars->SetNumberOfTuples(3 * 36 * 36);
  scalars->Fill(1.0);
  grid->GetPointData()->SetScalars(scalars);
  return grid;
}

std::vector<Fault> gridFaults()
{
  return {
    { "coordinates to and fro", "X coordinates",
      [](Scene& s) {
        s.mapper->SetInputData(gridWith({ 0.0, 2.0, 1.0 }));
      } },
    { "coordinates that are equal", "X coordinates",
      [](Scene& s) {
        s.mapper->SetInputData(gridWith({ 0.0, 1.0, 1.0 }));
      } },
    { "coordinates without number", "X coordinates",
      [](Scene& s) {
        s.mapper->SetInputData(gridWith({ 0.0, vtkMath::Nan(), 2.0 }));
      } },
    { "too few coordinates", "X coordinates",
      [](Scene& s) {
        s.mapper->SetInputData(gridWith({ 0.0, 1.0 }));
      } },
  };
}

std::vector<Fault> matrixFaults()
{
  return {
    { "zero spacing", "singular",
      [](Scene& s)
      {
        vtkNew<vtkImageData> flat;
        flat->ShallowCopy(s.image);
        flat->SetSpacing(1.0, 0.0, 1.0);
        s.mapper->SetInputData(flat);
      } },
    { "singular prop matrix", "singular",
      [](Scene& s) { s.stage.volume->SetScale(1.0, 0.0, 1.0); } },
    { "not a number", "singular",
      [](Scene& s)
      {
        vtkNew<vtkImageData> odd;
        odd->ShallowCopy(s.image);
        odd->SetSpacing(1.0, vtkMath::Nan(), 1.0);
        s.mapper->SetInputData(odd);
      } },
  };
}

/// The errors of the mapper in two frames.
std::vector<std::string> errorsOfRendering(
  Scene& scene, const std::string& name, reference::Checks& check)
{
  const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
  // VTK's pipeline reports an error, too, if there is no input.
  const stage::Messages pipelineErrors(scene.mapper->GetExecutive(), vtkCommand::ErrorEvent);
  scene.stage.pixels();
  check(showsSphere(scene.stage.pixels()), name, ": other props are rendered.");
  // The renderer culls volumes without input or with bounds that are NaN.
  scene.mapper->Render(scene.stage.renderer, scene.stage.volume);
  return errors.texts;
}

void test(Scene& scene, const Fault& fault, reference::Checks& check)
{
  const std::string name = fault.name;
  const stage::Pixels before = scene.stage.pixels();
  fault.make(scene);
  const std::vector<std::string> texts = errorsOfRendering(scene, name, check);
  check(texts.size() == 1, name, ": one error, not ", texts.size(), ".");
  if (!texts.empty())
  {
    check(stage::isSentence(texts[0]), name, ": a sentence.");
    check(texts[0].find(fault.word) != std::string::npos, name, ": the sentence is to the point.");
  }
  check(!scene.mapper->GetLastRenderUsedRayCasting(), name, ": nothing was passed on.");
  scene.mend();
  check(scene.stage.pixels() == before, name, ": once mended, the picture is as before.");
}

std::vector<Fault> settingFaults()
{
  std::vector<Fault> faults;
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  for (float window : { 0.0f, -0.0f, 1e-45f, nan, infinity, -infinity })
  {
    faults.push_back({ "no window", "FinalColorWindow",
      [window](Scene& s) { s.mapper->SetFinalColorWindow(window); } });
  }
  for (float level : { nan, infinity, -infinity })
  {
    faults.push_back({ "no level", "FinalColorLevel",
      [level](Scene& s) { s.mapper->SetFinalColorLevel(level); } });
  }
  for (double element : { 0.0, vtkMath::Nan(), vtkMath::Inf() })
  {
    faults.push_back({ "user matrix", "singular",
      [element](Scene& s)
      {
        vtkNew<vtkMatrix4x4> matrix;
        matrix->SetElement(1, 1, element);
        s.stage.volume->SetUserMatrix(matrix);
      } });
  }
  faults.push_back({ "position that is not a number", "singular",
    [](Scene& s) { s.stage.volume->SetPosition(0.0, vtkMath::Nan(), 0.0); } });
  for (const auto& [x, length] : { std::pair(vtkMath::Nan(), 1.0), { 0.0, 0.0 } })
  {
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(x, 0.0, 0.0);
    plane->SetNormal(0.0, 0.0, length);
    const vtkSmartPointer<vtkPlane> kept = plane;
    faults.push_back(
      { "plane", "clipping plane", [kept](Scene& s) { s.mapper->AddClippingPlane(kept); } });
  }
  // TestProjectionProperties tests the other settings.
  faults.push_back({ "radius that is not a number", "KernelRadius",
    [](Scene& s) { s.mapper->SetKernelRadius(vtkMath::Nan()); } });
  faults.push_back(
    { "no slice function", "SetSliceFunction", [](Scene& s) { s.mapper->SetBlendModeToSlice(); } });
  return faults;
}

/// The sphere has none.
double meanRed(const stage::Pixels& pixels)
{
  double sum = 0.0;
  for (std::size_t pixel = 0; pixel < pixels.size(); pixel += 3)
  {
    sum += pixels[pixel];
  }
  return 3.0 * sum / static_cast<double>(pixels.size());
}

/// Empty functions give the pictures of VTK's ray caster. A volume without a property gets VTK's.
void testProperties(Scene& scene, reference::Checks& check)
{
  const stage::Pixels before = scene.stage.pixels();
  const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
  const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
  const auto caster = stage::fixedPointRayCaster(scene.image, 1.0);
  const auto seenAsByRayCaster = [&](const std::string& name)
  {
    const stage::Pixels pixels = scene.stage.pixels();
    scene.stage.volume->SetMapper(caster);
    const stage::Pixels cast = scene.stage.pixels();
    scene.stage.volume->SetMapper(scene.mapper);
    const double ours = meanRed(pixels), theirs = meanRed(cast);
    check(std::abs(ours - theirs) <= 0.5, name, ": as bright as with VTK's ray caster, ", ours,
      " and ", theirs, ".");
  };
  vtkNew<vtkVolumeProperty> property;
  property->DeepCopy(scene.stage.property);
  scene.stage.volume->SetProperty(property);
  property->SetColor(vtkNew<vtkColorTransferFunction>());
  seenAsByRayCaster("colours without points");
  property->SetColor(vtkNew<vtkPiecewiseFunction>());
  seenAsByRayCaster("greys without points");
  property->SetScalarOpacity(vtkNew<vtkPiecewiseFunction>());
  seenAsByRayCaster("opacity without points");
  scene.stage.volume->SetProperty(nullptr);
  seenAsByRayCaster("no property");
  check(meanRed(scene.stage.pixels()) > 1.0, "What has no property has VTK's grey ramp.");
  scene.stage.volume->SetProperty(scene.stage.property);
  check(scene.stage.pixels() == before, "With the property the picture is as before.");
  check(errors.texts.empty() && warnings.texts.empty(), "The mapper has nothing to say.");
}

/// vtkMultiVolume, which only VTK's GPU ray caster supports.
void testMultiVolume(Scene& scene, reference::Checks& check)
{
  const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
  vtkNew<vtkMultiVolume> several;
  const stage::Messages ownErrors(several, vtkCommand::ErrorEvent);
  scene.mapper->Render(scene.stage.renderer, several);
  scene.mapper->Render(scene.stage.renderer, several);
  check(errors.texts.size() == 1 && stage::isSentence(errors.texts[0]) &&
      errors.texts[0].find("vtkMultiVolume") != std::string::npos,
    "Several volumes give one sentence.");
}
}

//------------------------------------------------------------------------------
int TestBadInput(int, char*[])
{
  reference::Checks check;
  Scene scene;
  check(showsSphere(scene.stage.pixels()), "The sphere is seen to begin with.");
  for (const auto& faults :
    { inputFaults(), componentFaults(), maskFaults(), gridFaults(), matrixFaults() })
  {
    for (const Fault& fault : faults)
    {
      test(scene, fault, check);
    }
  }
  testMultiVolume(scene, check);
  for (const Fault& fault : settingFaults())
  {
    test(scene, fault, check);
  }
  testProperties(scene, check);
  return check.exitCode();
}
