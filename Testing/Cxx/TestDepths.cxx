// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Depth coding and the depth buffer, which hides props behind the samples of the volume.
// TestLocations and TestPicks test the positions of samples.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMath.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr int Size = 128;
using Rgb = std::array<int, 3>;

/// Boxes of 9 x 9 voxels at three depths, in a background of 0, seen along z.
struct Scene
{
  stage::Stage stage{ Size, Size };
  vtkSmartPointer<vtkImageData> image;
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> mapper;
  std::array<int, 3> depths = { { 4, 24, 44 } }; // of boxes at x = 8, 24, 40

  Scene()
  {
    reference::Volume<std::uint8_t> volume({ 49, 49, 49 }, 0);
    for (int n = 0; n < 3; ++n)
    {
      for (int j = 20; j < 29; ++j)
      {
        for (int i = 4 + 16 * n; i < 13 + 16 * n; ++i)
        {
          volume.at(std::array<int, 3>{ i, j, this->depths[n] }) = 200;
        }
      }
    }
    this->image = stage::toImageData(volume);
    this->mapper = stage::splatting(this->image);
    this->mapper->SetQualityModeToPreview();
    this->stage.show(this->mapper);
    this->stage.setGrayRamp(0.0, 200.0);
  }

  void look(double viewAngle)
  {
    this->stage.viewAngle = viewAngle;
    this->stage.look({ 0.0, 0.0, 1.0 }, { 0.0, 1.0, 0.0 }, 0.7);
  }

  std::array<int, 2> pixelOf(double x, double y, double z)
  {
    this->stage.renderer->SetWorldPoint(x, y, z, 1.0);
    this->stage.renderer->WorldToDisplay();
    const double* const display = this->stage.renderer->GetDisplayPoint();
    return { static_cast<int>(display[0]), static_cast<int>(display[1]) };
  }
  /// In the middle of box n.
  std::array<int, 2> pixelOf(int n) { return this->pixelOf(8.0 + 16.0 * n, 24.0, this->depths[n]); }

  Rgb colorAt(const stage::Pixels& pixels, const std::array<int, 2>& pixel) const
  {
    const unsigned char* const rgb = &pixels[3 * (std::size_t(pixel[1]) * Size + pixel[0])];
    return { rgb[0], rgb[1], rgb[2] };
  }
};

bool isNear(const Rgb& a, const Rgb& b, int tolerance)
{
  return std::abs(a[0] - b[0]) <= tolerance && std::abs(a[1] - b[1]) <= tolerance &&
    std::abs(a[2] - b[2]) <= tolerance;
}

Rgb hueOf(double share, double value)
{
  const double hsv[3] = { share * 2.0 / 3.0, 1.0, value };
  double rgb[3];
  vtkMath::HSVToRGB(hsv, rgb);
  return { static_cast<int>(std::lround(255.0 * rgb[0])),
    static_cast<int>(std::lround(255.0 * rgb[1])), static_cast<int>(std::lround(255.0 * rgb[2])) };
}

std::string text(const Rgb& c)
{
  return std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
}

void testColors(reference::Checks& check)
{
  Scene scene;
  scene.mapper->DepthCodingOn();
  scene.look(0.0);
  const auto expect = [&](int n, const Rgb& color, const std::string& what)
  {
    const Rgb found = scene.colorAt(scene.stage.pixels(), scene.pixelOf(n));
    check(isNear(found, color, 4), what, ": box ", n, " is ", text(found), ", not ", text(color));
  };
  for (int n = 0; n < 3; ++n)
  {
    // The volume is 48 deep.
    expect(n, hueOf(scene.depths[n] / 48.0, 1.0), "hues");
  }
  scene.mapper->RecordLocationsOn();
  const stage::Pixels pixels = scene.stage.pixels();
  vtkDataArray* const positions =
    scene.mapper->GetLocations()->GetPointData()->GetArray("Position");
  int wrong = 0;
  for (int n = 0; n < Size * Size; ++n)
  {
    const Rgb found = scene.colorAt(pixels, { { n % Size, n / Size } });
    const double z = positions->GetComponent(n, 2);
    const int brightness = *std::max_element(found.begin(), found.end());
    wrong += brightness > 0 && !isNear(found, hueOf(z / 48.0, brightness / 255.0), 4);
  }
  check(wrong == 0, wrong, " pixels have other hues than the depths of their samples.");
  const Rgb background = scene.colorAt(pixels, { { Size / 2, 20 } });
  check(isNear(background, { 0, 0, 0 }, 0), "What is black stays black.");
  scene.stage.setGrayRamp(0.0, 400.0);
  expect(0, hueOf(scene.depths[0] / 48.0, 0.5), "half as bright");
  scene.stage.setGrayRamp(0.0, 200.0);

  double cameraZ[3];
  scene.stage.renderer->GetActiveCamera()->GetPosition(cameraZ);
  scene.mapper->SetDepthCodingRange(4.0 - cameraZ[2], 44.0 - cameraZ[2]);
  expect(0, { 255, 0, 0 }, "range");
  expect(1, hueOf(0.5, 1.0), "range");
  expect(2, { 0, 0, 255 }, "range");
  scene.mapper->SetDepthCodingRange(14.0 - cameraZ[2], 34.0 - cameraZ[2]);
  expect(0, { 255, 0, 0 }, "before the range");
  expect(2, { 0, 0, 255 }, "behind the range");
  scene.mapper->SetDepthCodingRange(4.0 - cameraZ[2], 44.0 - cameraZ[2]);

  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(-1.0, 0.0, 1.0, 0.0);
  colors->AddRGBPoint(3.0, 1.0, 0.0, 1.0);
  scene.mapper->SetDepthCodingColors(colors);
  expect(0, { 0, 255, 0 }, "own colours");
  expect(1, { 128, 128, 128 }, "own colours");
  expect(2, { 255, 0, 255 }, "own colours");
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(2);
  table->SetTableValue(0, 1.0, 1.0, 0.0);
  table->SetTableValue(1, 0.0, 1.0, 1.0);
  scene.mapper->SetDepthCodingColors(table);
  expect(0, { 255, 255, 0 }, "look-up table");
  expect(2, { 0, 255, 255 }, "look-up table");
  scene.mapper->SetDepthCodingColors(nullptr);
  scene.mapper->SetDepthCodingRange(0.0, 0.0);

  scene.mapper->DepthCodingOff();
  expect(2, { 255, 255, 255 }, "turned off");
}

/// The buffer itself, beside the positions of samples.
void testBuffer(Scene& scene, const std::string& what, reference::Checks& check)
{
  scene.stage.window->Render();
  std::vector<float> buffer(std::size_t(Size) * Size);
  scene.stage.window->GetZbufferData(0, 0, Size - 1, Size - 1, buffer.data());
  vtkDataArray* const positions =
    scene.mapper->GetLocations()->GetPointData()->GetArray("Position");
  int written = 0, wrong = 0;
  for (int n = 0; n < Size * Size; ++n)
  {
    if (buffer[n] >= 1.0f)
    {
      continue;
    }
    ++written;
    scene.stage.renderer->SetWorldPoint(positions->GetComponent(n, 0),
      positions->GetComponent(n, 1), positions->GetComponent(n, 2), 1.0);
    scene.stage.renderer->WorldToDisplay();
    wrong += !(std::abs(scene.stage.renderer->GetDisplayPoint()[2] - buffer[n]) < 1e-5);
  }
  check(written > 200 && wrong == 0, wrong, " of ", written, " depths are wrong", what);
  for (int n = 0; n < 3; ++n)
  {
    const auto pixel = scene.pixelOf(n);
    check(buffer[pixel[1] * Size + pixel[0]] < 1.0f, "Boxes have depths", what);
  }
  check(buffer[20 * Size + Size / 2] == 1.0f, "The background has none", what);
}

/// Later geometry: a green sphere in a layer above, which keeps depths.
struct LaterSphere
{
  Scene& scene;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkActor> actor;

  explicit LaterSphere(Scene& below) : scene(below)
  {
    this->renderer->SetLayer(1);
    this->renderer->PreserveDepthBufferOn();
    this->renderer->SetActiveCamera(this->scene.stage.renderer->GetActiveCamera());
    this->scene.stage.window->SetNumberOfLayers(2);
    this->scene.stage.window->AddRenderer(this->renderer);
    vtkNew<vtkSphereSource> source;
    source->SetRadius(3.0);
    vtkNew<vtkPolyDataMapper> polyMapper;
    polyMapper->SetInputConnection(source->GetOutputPort());
    this->actor->SetMapper(polyMapper);
    this->actor->GetProperty()->SetColor(0.0, 1.0, 0.0);
    this->actor->GetProperty()->LightingOff();
    this->renderer->AddActor(this->actor);
  }

  /// In the middle of box n, after the sphere is moved to z on the ray there.
  Rgb colorOfBox(int n, double z)
  {
    const double* const eye = this->scene.stage.renderer->GetActiveCamera()->GetPosition();
    const bool isPerspective = this->scene.stage.viewAngle > 0.0;
    const double x = 8.0 + 16.0 * n,
                 t = isPerspective ? (z - eye[2]) / (this->scene.depths[n] - eye[2]) : 1.0;
    this->actor->SetPosition(eye[0] + t * (x - eye[0]), eye[1] + t * (24.0 - eye[1]), z);
    if (!isPerspective)
    {
      this->actor->SetPosition(x, 24.0, z);
    }
    return this->scene.colorAt(this->scene.stage.pixels(), this->scene.pixelOf(n));
  }
};

void testDepthBuffer(reference::Checks& check, double viewAngle)
{
  Scene scene;
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(200.0, 1.0);
  scene.stage.property->SetScalarOpacity(opacity);
  scene.mapper->WriteDepthOn();
  scene.mapper->RecordLocationsOn();
  scene.look(viewAngle);
  scene.stage.renderer->SetViewport(0.0, 0.0, 1.0, 1.0);
  const std::string what = " at view angle " + std::to_string(viewAngle);
  testBuffer(scene, what, check);

  LaterSphere sphere(scene);
  const Rgb green = { 0, 255, 0 }, white = { 255, 255, 255 };
  for (int n = 0; n < 3; ++n)
  {
    check(isNear(sphere.colorOfBox(n, scene.depths[n] - 5.0), green, 0), "Before it is seen", what);
    check(
      isNear(sphere.colorOfBox(n, scene.depths[n] + 5.0), white, 0), "Behind it is hidden", what);
  }
  sphere.actor->SetPosition(24.0, 40.0, 45.0);
  check(isNear(scene.colorAt(scene.stage.pixels(), scene.pixelOf(24.0, 40.0, 45.0)), green, 0),
    "Beside vessels nothing is hidden", what);
  scene.mapper->SetWriteDepthOpacity(1.0);
  scene.stage.property->SetScalarOpacity(0);
  opacity->RemoveAllPoints();
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(200.0, 0.6);
  scene.stage.property->SetScalarOpacity(opacity);
  check(isNear(sphere.colorOfBox(1, scene.depths[1] + 5.0), green, 0),
    "What is not opaque enough hides nothing", what);
  scene.mapper->SetWriteDepthOpacity(0.5);
  check(!isNear(sphere.colorOfBox(1, scene.depths[1] + 5.0), green, 0),
    "What is opaque enough hides", what);
  scene.mapper->WriteDepthOff();
  check(
    isNear(sphere.colorOfBox(1, scene.depths[1] + 5.0), green, 0), "It can be turned off", what);
}

/// Geometry that is there before keeps its depth.
void testOpaqueBefore(reference::Checks& check)
{
  Scene scene;
  scene.mapper->WriteDepthOn();
  scene.mapper->SetWriteDepthOpacity(0.0);
  scene.look(0.0);
  vtkNew<vtkSphereSource> source;
  source->SetRadius(3.0);
  source->SetCenter(24.0, 24.0, 10.0);
  vtkNew<vtkPolyDataMapper> polyMapper;
  polyMapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(polyMapper);
  scene.stage.renderer->AddActor(actor);
  scene.stage.renderer->ResetCameraClippingRange();
  const auto pixel = scene.pixelOf(1);
  const auto depth = [&]()
  {
    scene.stage.window->Render();
    return scene.stage.window->GetZbufferDataAtPoint(pixel[0], pixel[1]);
  };
  const float with = depth();
  scene.stage.volume->VisibilityOff();
  const float alone = depth();
  check(with <= alone && alone < 1.0f, "Depths are never raised.");
}
}

//------------------------------------------------------------------------------
int TestDepths(int argc, char* argv[])
{
  reference::Checks check;
  testColors(check);
  testDepthBuffer(check, 0.0);
  testDepthBuffer(check, 40.0);
  testOpaqueBefore(check);

  stage::Stage stage(200, 200);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 64, 64 }, 12));
  const auto mapper = stage::splatting(image);
  mapper->DepthCodingOn();
  stage.show(mapper);
  stage.look({ 0.5, -0.3, 0.8 }, { 0.0, 1.0, 0.0 }, 0.8);
  stage.window->Render();
  check(vtkRegressionTestImage(stage.window) == vtkTesting::PASSED,
    "The depth-coded picture is the baseline.");
  return check.exitCode();
}
