// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// If vtkSplattingMIPGPUVolumeRayCastMapper does not splat, it renders VTK's own picture, bit for
// bit. TestWalk compares splatted pictures with those of vtkSplattingMIPVolumeMapper.
#include "ScalarTesting.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkMultiVolume.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkShaderProperty.h"
#include "vtkSphereSource.h"
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
  /// Checks that both pictures are equal.
  void same(const std::string& name, reference::Checks& check)
  {
    const stage::Pixels expected = this->of(this->splatting);
    check(!isBlack(expected), name, ": there is something to see.");
    check(this->of(this->override) == expected, name, ": the same picture.");
    check(this->override->GetLastRenderUsedSplatting(), name, ": splatted.");
    double here[6], there[6];
    this->splatting->GetBounds(here);
    this->override->GetBounds(there);
    check(std::equal(here, here + 6, there), name, ": the same bounds.");
  }
};

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
  testExceptions(check);
  testLabelMap(check);
  testRenderToImage(check);
  testMultiVolume(check);
  return check.exitCode();
}
