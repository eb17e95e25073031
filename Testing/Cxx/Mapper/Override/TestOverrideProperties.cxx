// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkSplattingMIPGPUVolumeRayCastMapper: each property of vtkGPUVolumeRayCastMapper that matters in
// a projection changes the picture as it does with vtkSplattingMIPVolumeMapper, bit for bit, and
// back again. What it does not splat is VTK's own picture, bit for bit.
#include "ScalarTesting.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDoubleArray.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiVolume.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRectilinearGrid.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkShaderProperty.h"
#include "vtkSphereSource.h"
#include "vtkTransform.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <functional>

using namespace scalartesting;

namespace
{
using Override = vtkSplattingMIPGPUVolumeRayCastMapper;
const Size size = { 24, 20, 22 };
constexpr vtkIdType Voxels = 24 * 20 * 22;

/// Point scalars (the active ones "bytes", also "others"), cell scalars, a direction matrix, an
/// extent from anywhere on.
vtkSmartPointer<vtkImageData> manyScalars()
{
  const auto image = bareImage(size);
  reference::Random random(4);
  coretesting::placeAtRandom(image, random, false);
  image->SetDirectionMatrix(0, -1, 0, 0.8, 0, 0.6, -0.6, 0, 0.8);
  const auto add = [](vtkDataSetAttributes* to, const char* name, int type, vtkIdType count,
                     int components, int seed)
  {
    const auto array = noiseArray(type, count, components, seed);
    array->SetName(name);
    to->AddArray(array);
  };
  add(image->GetPointData(), "bytes", VTK_UNSIGNED_CHAR, Voxels, 1, 1);
  add(image->GetPointData(), "others", VTK_FLOAT, Voxels, 1, 2);
  image->GetPointData()->SetActiveScalars("bytes");
  add(image->GetCellData(), "cells", VTK_SHORT, image->GetNumberOfCells(), 1, 3);
  image->GetCellData()->SetActiveScalars("cells");
  return image;
}

/// One view of one volume by two mappers: the splatting mapper and the override.
struct Pair
{
  stage::Stage stage{ 110, 90 };
  vtkSmartPointer<Mapper> splatting = vtkSmartPointer<Mapper>::New();
  vtkSmartPointer<Override> override = vtkSmartPointer<Override>::New();

  explicit Pair(vtkDataSet* input)
  {
    this->override->SetBlendModeToMaximumIntensity();
    this->stage.setGrayRamp(0.0, 100.0);
    this->show(input);
  }
  void show(vtkDataSet* input)
  {
    this->splatting->SetInputDataObject(input);
    this->override->SetInputDataObject(input);
    this->stage.show(this->splatting);
    this->stage.look({ 0.3, 0.45, -0.8 }, { 0.0, 1.0, 0.1 });
  }
  stage::Pixels of(vtkVolumeMapper* mapper)
  {
    this->stage.show(mapper);
    return this->stage.pixels();
  }
  /// The picture, if both agree.
  stage::Pixels same(const std::string& name, reference::Checks& check)
  {
    const stage::Pixels expected = this->of(this->splatting);
    check(!isBlack(expected), name, ": there is something to see.");
    check(this->of(this->override) == expected, name, ": the same picture.");
    check(this->override->GetLastRenderUsedSplatting(), name, ": splatted.");
    double here[6], there[6];
    this->splatting->GetBounds(here);
    this->override->GetBounds(there);
    check(std::equal(here, here + 6, there), name, ": the same bounds.");
    return expected;
  }
};

struct Change
{
  const char* name;
  /// The first argument is either mapper.
  std::function<void(vtkVolumeMapper*, Pair&)> make;
  std::function<void(vtkVolumeMapper*, Pair&)> undo;
};

/// The setters that the two classes have beside those of vtkVolumeMapper.
template <class Set>
auto onBoth(Set&& set)
{
  return [set](vtkVolumeMapper* mapper, Pair&)
  {
    if (auto* const splatting = Mapper::SafeDownCast(mapper))
    {
      set(splatting);
    }
    else
    {
      set(Override::SafeDownCast(mapper));
    }
  };
}

vtkSmartPointer<vtkPlaneCollection> obliquePlane(vtkImageData* image)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(image->GetCenter());
  plane->SetNormal(0.5, 0.7, -0.2);
  auto planes = vtkSmartPointer<vtkPlaneCollection>::New();
  planes->AddItem(plane);
  return planes;
}

/// Planes between voxels, half-way and nearer to one.
std::array<double, 6> croppingPlanes(vtkImageData* image)
{
  const double* const origin = image->GetOrigin();
  const double* const spacing = image->GetSpacing();
  std::array<double, 6> planes;
  for (int p = 0; p < 6; ++p)
  {
    const int first = image->GetExtent()[2 * (p / 2)];
    planes[p] = origin[p / 2] + spacing[p / 2] * (first + (p % 2 ? 15.5 : 6.25));
  }
  return planes;
}

/// In place of an undo: the next change goes on from this one.
void nothing(vtkVolumeMapper*, Pair&) {}

/// Which samples of a ray count, and which of them wins.
std::vector<Change> changesOfRays(vtkImageData* image)
{
  const std::array<double, 6> planes = croppingPlanes(image);
  const auto clipping = obliquePlane(image);
  const auto inside = flags(Voxels, 1, 0.6, 10);
  inside->SetName("mask");
  const auto mask = plainImage(size, inside);
  return {
    { "Minimum", [](auto* m, Pair&) { m->SetBlendModeToMinimumIntensity(); },
      [](auto* m, Pair&) { m->SetBlendModeToMaximumIntensity(); } },
    { "Cropping",
      [=](auto* m, Pair&)
      {
        m->SetCroppingRegionPlanes(planes.data());
        m->CroppingOn();
      },
      nothing },
    { "Fence", [](auto* m, Pair&) { m->SetCroppingRegionFlagsToFence(); },
      [](auto* m, Pair&) { m->CroppingOff(); } },
    { "Clipping plane", [=](auto* m, Pair&) { m->SetClippingPlanes(clipping); },
      [](auto* m, Pair&) { m->RemoveAllClippingPlanes(); } },
    { "Binary mask",
      [=](auto* m, Pair& pair)
      {
        pair.override->SetMaskTypeToBinary();
        onBoth([=](auto* mapper) { mapper->SetMaskInput(mask); })(m, pair);
      },
      onBoth([](auto* m) { m->SetMaskInput(nullptr); }) },
  };
}

/// Of which array voxels are, how they are shown, and where.
std::vector<Change> changesOfVoxels()
{
  return {
    { "Window and level",
      onBoth(
        [](auto* m)
        {
          m->SetFinalColorWindow(0.5f);
          m->SetFinalColorLevel(0.6f);
        }),
      onBoth(
        [](auto* m)
        {
          m->SetFinalColorWindow(1.0f);
          m->SetFinalColorLevel(0.5f);
        }) },
    { "Array by name",
      [](auto* m, Pair&)
      {
        m->SetScalarModeToUsePointFieldData();
        m->SelectScalarArray("others");
      },
      nothing },
    { "Array by number", [](auto* m, Pair&) { m->SelectScalarArray(0); }, nothing },
    { "Another array by number", [](auto* m, Pair&) { m->SelectScalarArray(1); },
      [](auto* m, Pair&) { m->SetScalarModeToDefault(); } },
    { "Cell scalars", [](auto* m, Pair&) { m->SetScalarModeToUseCellData(); },
      [](auto* m, Pair&) { m->SetScalarModeToDefault(); } },
    { "Prop matrix",
      [](auto*, Pair& pair)
      {
        vtkNew<vtkTransform> turn;
        turn->RotateWXYZ(10.0, 0.2, 1.0, 0.4);
        pair.stage.volume->SetUserMatrix(turn->GetMatrix());
      },
      [](auto*, Pair& pair) { pair.stage.volume->SetUserMatrix(nullptr); } },
  };
}

std::vector<Change> changesOf(vtkImageData* image)
{
  std::vector<Change> changes = changesOfRays(image);
  const std::vector<Change> others = changesOfVoxels();
  changes.insert(changes.end(), others.begin(), others.end());
  return changes;
}

void testChanges(reference::Checks& check)
{
  const auto image = manyScalars();
  Pair pair(image);
  const stage::Pixels plain = pair.same("Plain", check);
  stage::Pixels before = plain;
  for (const Change& change : changesOf(image))
  {
    const std::string name = change.name;
    change.make(pair.splatting, pair);
    change.make(pair.override, pair);
    const stage::Pixels changed = pair.same(name, check);
    check(changed != before, name, ": it shows.");
    change.undo(pair.splatting, pair);
    change.undo(pair.override, pair);
    before = pair.same(name + " undone", check);
  }
  check(before == plain, "In the end all is as in the beginning.");
}

/// Properties of the volume and the scene reach the splatting mapper by themselves.
void testInputs(reference::Checks& check)
{
  Pair pair(plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 3, 5)));
  pair.same("Independent components", check);
  pair.stage.property->IndependentComponentsOff();
  pair.show(plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 4, 6)));
  pair.same("Dependent components", check);
  pair.stage.property->IndependentComponentsOn();

  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(size.data());
  vtkNew<vtkDoubleArray> steps[3];
  for (int a = 0; a < 3; ++a)
  {
    for (int n = 0; n < size[a]; ++n)
    {
      steps[a]->InsertNextValue(n + 0.02 * n * n);
    }
  }
  grid->SetXCoordinates(steps[0]);
  grid->SetYCoordinates(steps[1]);
  grid->SetZCoordinates(steps[2]);
  grid->GetPointData()->SetScalars(noiseArray(VTK_DOUBLE, Voxels, 1, 7));
  pair.show(grid);
  pair.same("Rectilinear grid", check);

  pair.show(manyScalars());
  const stage::Pixels plain = pair.same("Image", check);
  vtkNew<vtkSphereSource> source;
  source->SetCenter(pair.stage.volume->GetCenter());
  source->SetRadius(6.0);
  vtkNew<vtkPolyDataMapper> polyMapper;
  polyMapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> sphere;
  sphere->SetMapper(polyMapper);
  pair.stage.renderer->AddActor(sphere);
  check(pair.same("Opaque geometry", check) != plain, "Opaque geometry: it shows.");
}

struct Exception
{
  const char* name;
  std::function<void(vtkOpenGLGPUVolumeRayCastMapper*, stage::Stage&)> make;
};

std::vector<Exception> exceptions()
{
  using Gpu = vtkOpenGLGPUVolumeRayCastMapper;
  return {
    { "Composite", [](Gpu* m, stage::Stage&) { m->SetBlendModeToComposite(); } },
    { "Average", [](Gpu* m, stage::Stage&) { m->SetBlendModeToAverageIntensity(); } },
    { "Additive", [](Gpu* m, stage::Stage&) { m->SetBlendModeToAdditive(); } },
    { "Two-dimensional transfer function",
      [](Gpu*, stage::Stage& stage)
      {
        vtkNew<vtkImageData> table;
        table->SetDimensions(2, 2, 1);
        table->AllocateScalars(VTK_FLOAT, 4);
        for (int value = 0; value < 16; ++value)
        {
          table->SetScalarComponentFromDouble(
            value / 4 % 2, value / 8, 0, value % 4, value % 4 == 1 ? 0.25 : 1.0);
        }
        stage.property->SetTransferFunction2D(table);
        stage.property->SetTransferFunctionMode(vtkVolumeProperty::TF_2D); // since 9.2 not implied
      } },
    { "Shader code",
      [](Gpu*, stage::Stage& stage)
      {
        stage.volume->GetShaderProperty()->AddFragmentShaderReplacement("//VTK::Shading::Exit",
          true, "//VTK::Shading::Exit\n  g_fragColor = vec4(0.0, 0.5, 0.0, 0.5);\n", false);
      } },
    { "Depth peeling",
      [](Gpu*, stage::Stage& stage)
      {
        vtkNew<vtkSphereSource> source;
        source->SetCenter(9.0, 14.0, 12.0);
        source->SetRadius(9.0);
        vtkNew<vtkPolyDataMapper> polyMapper;
        polyMapper->SetInputConnection(source->GetOutputPort());
        vtkNew<vtkActor> sphere;
        sphere->SetMapper(polyMapper);
        sphere->GetProperty()->SetOpacity(0.5);
        stage.renderer->AddActor(sphere);
        stage.renderer->UseDepthPeelingOn();
        stage.renderer->UseDepthPeelingForVolumesOn();
        stage.window->SetAlphaBitPlanes(1);
      } },
  };
}

/// VTK's own mapper and the override, each with a volume of its own.
void testExceptions(reference::Checks& check)
{
  const auto image = plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 1, 8));
  for (const Exception& exception : exceptions())
  {
    stage::Pixels pictures[2];
    const auto override = vtkSmartPointer<Override>::New();
    const vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper> mappers[] = {
      vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New(), override
    };
    for (int n = 0; n < 2; ++n)
    {
      stage::Stage stage(90, 80);
      stage.setGrayRamp(0.0, 100.0);
      mappers[n]->SetInputData(image);
      mappers[n]->SetBlendModeToMaximumIntensity();
      exception.make(mappers[n], stage);
      stage.show(mappers[n]);
      stage.look({ 0.3, 0.45, -0.8 }, { 0.0, 1.0, 0.1 });
      pictures[n] = stage.pixels();
    }
    const std::string name = exception.name;
    check(!override->GetLastRenderUsedSplatting(), name, ": not splatted.");
    check(!isBlack(pictures[0]) && pictures[0] == pictures[1], name, ": VTK's own picture.");
  }
}

/// A label map changes no projection by VTK, so it must not change ours.
void testLabelMap(reference::Checks& check)
{
  Pair pair(plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 1, 8)));
  vtkNew<vtkOpenGLGPUVolumeRayCastMapper> vtks;
  vtks->SetInputDataObject(pair.splatting->GetInput());
  vtks->SetBlendModeToMaximumIntensity();
  const stage::Pixels before = pair.of(vtks);
  const auto labels = plainImage(size, flags(Voxels, 1, 0.6, 10));
  vtkNew<vtkColorTransferFunction> red;
  red->AddRGBPoint(0.0, 1.0, 0.0, 0.0);
  pair.stage.property->SetLabelColor(1, red);
  pair.stage.property->SetLabelScalarOpacity(1, pair.stage.property->GetScalarOpacity());
  vtks->SetMaskInput(labels);
  vtks->SetMaskTypeToLabelMap();
  check(pair.of(vtks) == before, "VTK's own projection does without label maps.");
  pair.override->SetMaskInput(labels);
  pair.override->SetMaskTypeToLabelMap();
  pair.same("Label map", check);
}

void testRenderToImage(reference::Checks& check)
{
  Pair pair(plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 1, 8)));
  pair.override->RenderToImageOn();
  pair.of(pair.override);
  check(!pair.override->GetLastRenderUsedSplatting(), "To an image: not splatted.");
  vtkNew<vtkImageData> image;
  pair.override->GetColorImage(image);
  check(image->GetScalarRange()[1] > 0.0, "To an image: there is something in it.");
  pair.override->RenderToImageOff();
  pair.same("Not to an image", check);
}

/// Several inputs are VTK's to composite.
void testMultiVolume(reference::Checks& check)
{
  const auto image = plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 1, 8));
  stage::Pixels pictures[2];
  const auto override = vtkSmartPointer<Override>::New();
  const vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper> mappers[] = {
    vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New(), override
  };
  for (int n = 0; n < 2; ++n)
  {
    stage::Stage stage(90, 80);
    stage.setGrayRamp(0.0, 100.0);
    vtkNew<vtkVolume> parts[2];
    vtkNew<vtkMultiVolume> volume;
    volume->SetMapper(mappers[n]);
    for (int port = 0; port < 2; ++port)
    {
      mappers[n]->SetInputDataObject(port, image);
      parts[port]->SetProperty(stage.property);
      parts[port]->SetPosition(9.0 * port, 0.0, 0.0);
      volume->SetVolume(parts[port], port);
    }
    stage.renderer->AddVolume(volume);
    stage.renderer->GetActiveCamera()->ParallelProjectionOn();
    stage.renderer->ResetCamera();
    pictures[n] = stage.pixels();
  }
  check(!override->GetLastRenderUsedSplatting(), "Several inputs: not splatted.");
  check(pictures[0] == pictures[1], "Several inputs: VTK's own picture.");
}
}

//------------------------------------------------------------------------------
int TestOverrideProperties(int, char*[])
{
  reference::Checks check;
  testChanges(check);
  testInputs(check);
  testExceptions(check);
  testLabelMap(check);
  testRenderToImage(check);
  testMultiVolume(check);
  return check.exitCode();
}
