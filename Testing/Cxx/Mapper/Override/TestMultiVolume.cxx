// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A vtkMultiVolume with the mapper that stands in for VTK's: maxima and minima of all its inputs
// are, bit for bit, those of separate volumes with splatting mappers.
#include "Stage.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkMultiVolume.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

namespace
{
using Override = vtkSplattingMIPGPUVolumeRayCastMapper;
using Mapper = vtkSplattingMIPVolumeMapper;
constexpr int Width = 150;
constexpr int Height = 120;
/// The ports in use, not in the order in which they are connected.
constexpr int Ports[] = { 2, 0, 1 };
constexpr int Count = 3;

void setColors(vtkVolumeProperty* property, int n, reference::Random& random)
{
  vtkNew<vtkColorTransferFunction> color;
  std::array<double, 3> rgb = { random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), 0.4 };
  rgb[n] = 1.0;
  color->AddRGBPoint(0.0, 0.3, 0.1, 0.0);
  color->AddRGBPoint(255.0, rgb[0], rgb[1], rgb[2]);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, random.uniform(0.0, 0.2));
  opacity->AddPoint(255.0, random.uniform(0.5, 1.0));
  property->SetColor(color);
  property->SetScalarOpacity(opacity);
}

/// Inputs and volumes by port, in a window with the multi-volume and one with separate volumes.
struct Scene
{
  explicit Scene(reference::Random& random)
  {
    for (int n = 0; n < Count; ++n)
    {
      this->images[n] = stage::toImageData(stage::blobsAndTubes({ 32, 35, 33 }, 12, random));
      coretesting::placeAtRandom(this->images[n], random, false);
      const double* const centre = this->images[n]->GetCenter();
      for (vtkVolume* volume : { this->parts[n].Get(), this->separate[n].Get() })
      {
        volume->SetProperty(this->properties[n]);
      }
      const double angle = random.uniform(-180.0, 180.0), scale = random.uniform(0.7, 1.4);
      const double shift = random.uniform(-8.0, 8.0);
      for (vtkVolume* volume : { this->parts[n].Get(), this->separate[n].Get() })
      {
        volume->SetOrigin(centre);
        volume->SetOrientation(0.3 * angle, angle, -angle);
        volume->SetScale(scale);
        volume->SetPosition(shift - centre[0], -shift - centre[1], -centre[2]);
      }
      setColors(this->properties[n], n, random);
      this->mappers[n] = stage::splatting(this->images[n]);
      this->separate[n]->SetMapper(this->mappers[n]);
      this->others.renderer->AddVolume(this->separate[n]);
    }
    this->mapper->SetBlendModeToMaximumIntensity();
    this->multi->SetMapper(this->mapper);
    for (int n : Ports)
    {
      this->mapper->SetInputDataObject(n, this->images[n]);
      this->multi->SetVolume(this->parts[n], n);
    }
    this->stage.renderer->AddVolume(this->multi);
    vtkNew<vtkSphereSource> source;
    source->SetRadius(13.0);
    vtkNew<vtkPolyDataMapper> poly;
    poly->SetInputConnection(source->GetOutputPort());
    this->sphere->SetMapper(poly);
    this->sphere->GetProperty()->SetColor(0.2, 0.8, 0.9);
    vtkCamera* const camera = this->stage.renderer->GetActiveCamera();
    camera->SetParallelProjection(random.uniform(0, 1));
    const auto direction = stage::anyDirection(random);
    camera->SetPosition(direction.data());
    camera->SetViewUp(direction[1], direction[2], -direction[0]);
    camera->SetFocalPoint(0.0, 0.0, 0.0);
    this->others.renderer->SetActiveCamera(camera);
    this->others.renderer->ResetCamera();
    camera->Zoom(1.5);
    for (vtkRenderer* renderer : { this->stage.renderer.Get(), this->others.renderer.Get() })
    {
      renderer->SetBackground(0.6, 0.7, 0.9);
    }
  }

  void compare(const std::string& what, reference::Checks& check)
  {
    const stage::Pixels expected = this->others.pixels(), pixels = this->stage.pixels();
    int differing = 0, shown = 0;
    for (std::size_t at = 0; at < pixels.size(); ++at)
    {
      differing += pixels[at] != expected[at];
      shown += pixels[at] != pixels[at % 3];
    }
    check(differing == 0 && shown > 1000, what, ": ", differing, " bytes differ, ", shown,
      " are shown.");
    check(this->mapper->GetLastRenderUsedSplatting(), what, ": not splatted.");
  }

  std::array<vtkSmartPointer<vtkImageData>, Count> images;
  std::array<vtkNew<vtkVolumeProperty>, Count> properties;
  std::array<vtkNew<vtkVolume>, Count> parts, separate;
  std::array<vtkSmartPointer<Mapper>, Count> mappers;
  vtkNew<vtkMultiVolume> multi;
  vtkNew<Override> mapper;
  vtkNew<vtkActor> sphere;
  stage::Stage stage{ Width, Height }, others{ Width, Height };
};

void testPictures(Scene& scene, reference::Random& random, reference::Checks& check)
{
  scene.compare("Maxima", check);
  scene.mapper->SetBlendModeToMinimumIntensity();
  for (const auto& each : scene.mappers)
  {
    each->SetBlendModeToMinimumIntensity();
  }
  scene.compare("Minima", check);
  scene.mapper->SetBlendModeToMaximumIntensity();
  for (int n = 0; n < Count; ++n)
  {
    scene.mappers[n]->SetBlendModeToMaximumIntensity();
    for (Mapper* each : { scene.mappers[n].Get(), scene.mapper->GetSplattingMapper(n) })
    {
      each->SetQualityMode(n);
      each->SetPictureBlending(n);
    }
  }
  scene.compare("Modes and blending by port", check);
  // Cropping is ignored, as VTK does with several inputs.
  scene.mapper->CroppingOn();
  vtkNew<vtkPlane> plane;
  plane->SetNormal(stage::anyDirection(random).data());
  scene.mapper->AddClippingPlane(plane);
  for (const auto& each : scene.mappers)
  {
    each->AddClippingPlane(plane);
  }
  scene.compare("A clipping plane", check);
  for (vtkRenderer* renderer : { scene.stage.renderer.Get(), scene.others.renderer.Get() })
  {
    renderer->AddActor(scene.sphere);
  }
  scene.compare("Geometry", check);
  scene.parts[1]->RotateX(20.0);
  scene.separate[1]->RotateX(20.0);
  scene.compare("A volume turns", check);
  scene.mapper->SetInputDataObject(1, scene.images[0]);
  scene.mappers[1]->SetInputData(scene.images[0]);
  scene.compare("Another input", check);
  scene.mapper->RemoveInputConnection(1, 0);
  scene.multi->RemoveVolume(1);
  scene.others.renderer->RemoveVolume(scene.separate[1]);
  scene.compare("Without an input", check);
}

void testRest(Scene& scene, reference::Checks& check)
{
  scene.stage.pixels();
  check(scene.mapper->GetSplattingMapper(1)->GetNumberOfProjections() == 1, "One projection.");
  scene.stage.pixels();
  check(scene.mapper->GetSplattingMapper(1)->GetNumberOfProjections() == 1, "No other projection.");
  check(scene.mapper->GetSplattingMapper() == scene.mapper->GetSplattingMapper(0) &&
      scene.mapper->GetSplattingMapper(-5) == scene.mapper->GetSplattingMapper(0),
    "The first port's mapper.");
  for (const auto& part : scene.parts)
  {
    check(part->GetAllocatedRenderTime() == scene.multi->GetAllocatedRenderTime() / Count,
      "The time is shared.");
  }
  // A fault of one input is one error, and the others are drawn.
  {
    const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
    scene.mapper->GetSplattingMapper(1)->SlabOn();
    scene.mapper->GetSplattingMapper(1)->SetSlabThickness(-1.0);
    scene.stage.pixels();
    scene.stage.pixels();
    check(errors.texts.size() == 1, errors.texts.size(), " errors.");
  }
  scene.mapper->GetSplattingMapper(1)->SlabOff();
  // Two-dimensional functions of one volume are the superclass's, which has errors here.
  scene.properties[2]->SetTransferFunctionMode(vtkVolumeProperty::TF_2D);
  vtkObject::GlobalWarningDisplayOff();
  scene.stage.pixels();
  vtkObject::GlobalWarningDisplayOn();
  check(!scene.mapper->GetLastRenderUsedSplatting(), "Two-dimensional functions.");
}
}

//------------------------------------------------------------------------------
int TestMultiVolume(int, char*[])
{
  reference::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  reference::forScenes("several inputs", 4,
    [&](int, reference::Random& random)
    {
      Scene scene(random);
      testPictures(scene, random, check);
      Scene other(random);
      testRest(other, check);
    });
  return check.exitCode();
}
