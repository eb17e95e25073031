// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Viewports, large screenshots, stereo, multisampling and shared mappers do not change the picture
// of the volume. TestIntermix tests layers.
#include "CoreTesting.h"
#include "ScreenOracle.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <cmath>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

constexpr int Width = 130;
constexpr int Height = 110;

/// A volume, a mapper of it, and how both are seen.
struct Scene
{
  reference::Volume<std::uint8_t> volume;
  vtkSmartPointer<vtkImageData> image;
  vtkSmartPointer<Mapper> mapper;
  stage::Vector direction, up;
  double viewAngle;

  explicit Scene(reference::Random& random)
    : volume(stage::anyBlobs(random)),
      image(stage::toImageData(this->volume)),
      mapper(stage::splatting(this->image)),
      direction(stage::anyDirection(random)),
      up(stage::anyDirection(random)),
      viewAngle(random.oneIn(2) ? random.uniform(5.0, 45.0) : 0.0)
  {
    this->mapper->SetQualityMode(random.uniform(0, 2));
  }

  void look(stage::Stage& stage, double scale = 1.0) const
  {
    stage.viewAngle = this->viewAngle;
    stage.show(this->mapper);
    stage.look(this->direction, this->up, scale);
  }

  /// Shows it on the left of the window, where `second` is on the right: the spheres about them do
  /// not meet in any view of no more than 45 degrees.
  void lookAtBoth(stage::Stage& stage, vtkVolume* second) const
  {
    stage::Vector right;
    vtkMath::Cross(this->direction.data(), this->up.data(), right.data());
    vtkMath::Normalize(right.data());
    vtkMath::MultiplyScalar(right.data(), 1.25 * this->image->GetLength());
    second->SetPosition(right.data());
    stage.renderer->AddVolume(second);
    this->look(stage, 1.8);
    stage.renderer->GetActiveCamera()->SetWindowCenter(0.5, 0.0);
    stage.renderer->ResetCameraClippingRange();
  }
};

int largestDifference(const stage::Pixels& a, const stage::Pixels& b)
{
  int largest = a.size() == b.size() ? 0 : 255;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n)
  {
    largest = std::max(largest, std::abs(a[n] - b[n]));
  }
  return largest;
}

bool isBlack(const stage::Pixels& pixels)
{
  return std::all_of(pixels.begin(), pixels.end(), [](unsigned char byte) { return byte == 0; });
}

/// A part of a window of twice the width and height.
stage::Pixels quarter(const stage::Pixels& pixels, int left, int bottom)
{
  stage::Pixels result;
  for (int y = 0; y < Height; ++y)
  {
    const auto row = pixels.begin() + 3 * (2 * Width * (bottom + y) + left);
    result.insert(result.end(), row, row + 3 * Width);
  }
  return result;
}

/// Two windows that are rendered in turn keep their pictures. Two viewports show the pictures of
/// the windows, and nothing else. Volumes are larger than the windows, so that pictures are
/// cropped.
void testViewports(const Scene& scene, reference::Random& random, reference::Checks& check)
{
  Scene other = scene;
  other.direction = stage::anyDirection(random);
  stage::Stage left(Width, Height), right(Width, Height), both(2 * Width, 2 * Height);
  scene.look(left, 0.6);
  const stage::Pixels expectedLeft = left.pixels();
  other.look(right, 0.6);
  const stage::Pixels expectedRight = right.pixels();
  for (int time = 0; time < 2; ++time)
  {
    check(left.pixels() == expectedLeft, "The first window shows what it did.");
    check(right.pixels() == expectedRight, "The second window shows what it did.");
    left.volume->ReleaseGraphicsResources(left.window);
  }
  scene.look(both, 0.6);
  both.renderer->SetViewport(0.0, 0.0, 0.5, 0.5);
  vtkNew<vtkRenderer> second;
  second->SetViewport(0.5, 0.5, 1.0, 1.0);
  second->AddVolume(both.volume);
  second->SetActiveCamera(right.renderer->GetActiveCamera());
  both.window->AddRenderer(second);
  for (int time = 0; time < 2; ++time)
  {
    const stage::Pixels pixels = both.pixels();
    check(quarter(pixels, 0, 0) == expectedLeft, "The left viewport shows what a window does.");
    check(quarter(pixels, Width, Height) == expectedRight,
      "The right viewport shows what a window does.");
    check(isBlack(quarter(pixels, Width, 0)) && isBlack(quarter(pixels, 0, Height)),
      "Nothing is drawn outside the viewports.");
  }
}

/// A screenshot in tiles is that of a larger window: coordinates in the shear image are rounded in
/// another way, which moves a grey level by no more than one. Nothing is projected again.
void testScreenshot(const Scene& scene, int scale, reference::Checks& check)
{
  Mapper* const mapper = scene.mapper;
  stage::Stage large(scale * Width, scale * Height);
  scene.look(large);
  const stage::Pixels expected = large.pixels();

  stage::Stage stage(Width, Height);
  scene.look(stage);
  const stage::Pixels before = stage.pixels();
  const vtkIdType projections = mapper->GetNumberOfProjections();
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(stage.window);
  filter->SetScale(scale);
  filter->ReadFrontBufferOff();
  filter->Update();
  auto* const bytes =
    vtkUnsignedCharArray::SafeDownCast(filter->GetOutput()->GetPointData()->GetScalars());
  const stage::Pixels tiled(
    bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  const std::string what = std::to_string(scale) + " x " + std::to_string(scale) +
    " tiles in mode " + mapper->GetQualityModeAsString();
  const int difference = largestDifference(tiled, expected);
  check(!isBlack(expected) && difference <= 1, what, " differ by ", difference);
  // In perspective each tile has images of what it shows.
  check(scene.viewAngle > 0.0 || mapper->GetNumberOfProjections() == projections, what,
    " share a shear image.");
  check(stage.pixels() == before, what, ": the window is as before.");
}

stage::Pixels eye(stage::Stage& stage, int stereoType)
{
  stage.window->SetStereoType(stereoType);
  stage.window->StereoRenderOn();
  const stage::Pixels pixels = stage.pixels();
  stage.window->StereoRenderOff();
  return pixels;
}

/// How many pixels are not what the voxels near the rays of a camera allow, as it was last used.
int countStrange(stage::Stage& stage, const Scene& scene, const stage::Pixels& pixels)
{
  const stage::Envelope envelope(scene.volume, scene.mapper->GetQualityMode());
  const stage::ScreenRays rays(stage, scene.image);
  int strange = 0;
  for (int n = 0; n < Width * Height; n += 3)
  {
    const stage::Envelope::Limits limits = envelope.at(rays, n % Width, n / Width);
    const double found = pixels[3 * static_cast<std::size_t>(n)];
    strange += found < limits.low - stage::GrayTolerance;
    strange += found > limits.high + stage::GrayTolerance;
  }
  return strange;
}

/// Each eye sees what is near its rays. Returns whether the other eye sees something else.
bool testStereo(const Scene& scene, reference::Checks& check)
{
  stage::Stage stage(Width, Height);
  // No pixel is wider than a voxel: they show points, not areas.
  scene.look(stage, 0.8);
  stage.renderer->GetActiveCamera()->SetEyeAngle(50.0);
  stage.renderer->ResetCameraClippingRange();
  const stage::Pixels middle = stage.pixels();
  const stage::Pixels left = eye(stage, VTK_STEREO_LEFT);
  const int strangeLeft = countStrange(stage, scene, left);
  const stage::Pixels right = eye(stage, VTK_STEREO_RIGHT);
  const int strangeRight = countStrange(stage, scene, right);
  const bool differs = countStrange(stage, scene, left) > 0;
  check(left != middle && right != middle && left != right, "Eyes see different pictures.");
  check(strangeLeft == 0 && strangeRight == 0, "The pictures of the left and the right eye have ",
    strangeLeft, " and ", strangeRight, " wrong pixels.");
  check(stage.pixels() == middle, "Without stereo the picture is as before.");

  // Anaglyph: red from the left eye, the rest from the right one.
  stage.window->SetAnaglyphColorSaturation(1.0f);
  stage.window->SetAnaglyphColorMask(4, 3);
  const stage::Pixels anaglyph = eye(stage, VTK_STEREO_ANAGLYPH);
  int wrong = 0;
  for (std::size_t n = 0; n < anaglyph.size(); ++n)
  {
    wrong += std::abs(anaglyph[n] - (n % 3 == 0 ? left : right)[n]) > 1; // VTK rounds in between
  }
  check(wrong == 0, "An anaglyph has the pixels of both eyes.");

  // Interlaced: the rows of both eyes in turn.
  const stage::Pixels rows = eye(stage, VTK_STEREO_INTERLACED);
  int leftRows = 0, rightRows = 0;
  for (int y = 0; y < Height; ++y)
  {
    const auto isRowOf = [&](const stage::Pixels& pixels)
    {
      return std::equal(
        &rows[3 * y * Width], &rows[3 * y * Width] + 3 * Width, &pixels[3 * y * Width]);
    };
    leftRows += isRowOf(left);
    rightRows += isRowOf(right);
    check(isRowOf(left) || isRowOf(right), "An interlaced row belongs to an eye.");
  }
  check(leftRows >= Height / 2 && rightRows >= Height / 2, "Both eyes have their rows.");
  return differs;
}

/// Two props with one mapper, side by side and with properties of their own.
void testTwoProps(const Scene& scene, double turn, reference::Checks& check)
{
  Mapper* const mapper = scene.mapper;
  stage::Stage stage(Width, Height);
  vtkNew<vtkVolume> second;
  vtkNew<vtkVolumeProperty> property;
  property->DeepCopy(stage.property);
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
  color->AddRGBPoint(200.0, 1.0, 0.5, 0.0);
  property->SetColor(color);
  second->SetProperty(property);
  second->SetMapper(mapper);
  second->SetOrigin(scene.image->GetCenter());
  second->RotateZ(turn);
  scene.lookAtBoth(stage, second);
  const stage::Pixels both = stage.pixels();
  check(stage.pixels() == both, "Two props with one mapper stay as they are.");
  second->VisibilityOff();
  const stage::Pixels first = stage.pixels();
  second->VisibilityOn();
  stage.volume->VisibilityOff();
  const stage::Pixels other = stage.pixels();
  check(!isBlack(first) && !isBlack(other) && first != other, "Both props are seen.");
  const auto fresh = stage::splatting(vtkImageData::SafeDownCast(mapper->GetInput()));
  fresh->SetQualityMode(mapper->GetQualityMode());
  second->SetMapper(fresh);
  check(stage.pixels() == other, "The second prop has its own colours and place.");
  second->SetMapper(mapper);
  stage::Pixels expected(both.size());
  std::transform(first.begin(), first.end(), other.begin(), expected.begin(),
    [](unsigned char a, unsigned char b) { return std::max(a, b); });
  check(both == expected, "Both look as each does alone.");
  second->VisibilityOff();
  check(isBlack(stage.pixels()), "Invisible volumes are not seen.");
}

/// Large opaque parts of a picture are copied, but for windows with multisampling, which must show
/// the same, whether all of the picture is opaque, some, or nothing.
void testMultisampling(const Scene& scene, reference::Checks& check)
{
  constexpr double opacities[][2] = { { 1.0, 1.0 }, { 0.4, 1.0 }, { 0.4, 0.6 } };
  stage::Pixels last;
  for (const double(&opacity)[2] : opacities)
  {
    stage::Pixels pixels[2];
    for (int samples : { 0, 4 })
    {
      stage::Stage stage(3 * Width, 3 * Height);
      stage.window->SetMultiSamples(samples);
      vtkNew<vtkPiecewiseFunction> function;
      function->AddPoint(20.0, opacity[0]);
      function->AddPoint(20.5, opacity[1]);
      stage.property->SetScalarOpacity(function);
      stage.renderer->SetBackground(0.1, 0.2, 0.4);
      scene.look(stage, 0.6);
      pixels[samples > 0] = stage.pixels();
    }
    check(pixels[0] == pixels[1], "Multisampling changes nothing in mode ",
      scene.mapper->GetQualityModeAsString(), " with opacity ", opacity[0], ".");
    check(pixels[0] != last, "Opacity matters.");
    last = pixels[0];
  }
}

/// Windows without pixels draw nothing and say nothing.
void testEmptyWindow(const Scene& scene, reference::Checks& check)
{
  stage::Stage stage(Width, Height);
  scene.look(stage);
  const stage::Pixels before = stage.pixels();
  const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
  stage.renderer->SetViewport(0.5, 0.5, 0.5, 0.5);
  stage.window->Render();
  stage.renderer->SetViewport(0.0, 0.0, 1.0, 1.0);
  check(stage.pixels() == before, "A viewport without pixels does not matter later.");
  stage.window->SetSize(1, 1);
  stage.window->Render();
  stage.window->SetSize(Width, Height);
  check(stage.pixels() == before, "Nor does a window without pixels.");
  check(errors.texts.empty(), "Neither is an error.");
}
}

//------------------------------------------------------------------------------
int TestWindows(int, char*[])
{
  reference::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  coretesting::Sightings eyes;
  reference::forScenes("windows", 24,
    [&](int, reference::Random& random)
    {
      const Scene scene(random);
      testViewports(scene, random, check);
      testScreenshot(scene, random.uniform(2, 4), check);
      eyes.add(testStereo(scene, check));
      testMultisampling(scene, check);
      testTwoProps(scene, random.uniform(0.0, 360.0), check);
      testEmptyWindow(scene, check);
    });
  check(eyes.areEnough(0.5), "Eyes do not see what the others do.");
  return check.exitCode();
}
