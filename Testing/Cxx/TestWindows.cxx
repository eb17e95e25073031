// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Large screenshots, stereo, layers, multisampling, and mappers that are shared, hidden, replaced
// and set beside others: the volume looks as it does alone.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartVolumeMapper.h"
#include "vtkSphereSource.h"
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
const stage::Vector Direction = { 0.3, 0.4, -0.8 };
const stage::Vector Up = { 0.0, 1.0, 0.0 };

vtkSmartPointer<vtkImageData> blobs()
{
  return stage::toImageData(stage::blobsAndTubes({ 48, 44, 40 }, 9));
}

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

/// A screenshot in tiles is that of a larger window: coordinates in the shear image are rounded in
/// another way, which moves a grey level by no more than one. Nothing is projected again.
void testScreenshot(Mapper* mapper, double viewAngle, int scale, stage::Checks& check)
{
  stage::Stage large(scale * Width, scale * Height);
  large.viewAngle = viewAngle;
  large.show(mapper);
  large.look(Direction, Up);
  const stage::Pixels expected = large.pixels();

  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(Direction, Up);
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
  check(!isBlack(expected) && difference <= 1, what + " differ by " + std::to_string(difference));
  // In perspective each tile has images of what it shows.
  check(viewAngle > 0.0 || mapper->GetNumberOfProjections() == projections,
    what + " share a shear image.");
  check(stage.pixels() == before, what + ": the window is as before.");
}

stage::Pixels eye(stage::Stage& stage, int stereoType)
{
  stage.window->SetStereoType(stereoType);
  stage.window->StereoRenderOn();
  const stage::Pixels pixels = stage.pixels();
  stage.window->StereoRenderOff();
  return pixels;
}

reference::Image<double> grayOf(const stage::Pixels& pixels)
{
  reference::Image<double> image(Width, Height);
  for (std::size_t n = 0; n < image.value.size(); ++n)
  {
    image.value[n] = pixels[3 * n];
  }
  return image;
}

/// Each eye sees what a ray caster shows it, as near as TestRegistration has both without
/// stereo.
void testStereo(Mapper* mapper, double viewAngle, vtkImageData* image, stage::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(Direction, Up);
  stage.renderer->GetActiveCamera()->SetEyeAngle(20.0);
  const stage::Pixels middle = stage.pixels();
  const stage::Pixels left = eye(stage, VTK_STEREO_LEFT), right = eye(stage, VTK_STEREO_RIGHT);
  check(left != middle && right != middle && left != right, "Eyes see different pictures.");
  check(stage.pixels() == middle, "Without stereo the picture is as before.");

  const auto caster = stage::fixedPointRayCaster(image, 0.5);
  stage.show(caster);
  const reference::Image<double> truths[] = { grayOf(eye(stage, VTK_STEREO_LEFT)),
    grayOf(eye(stage, VTK_STEREO_RIGHT)) };
  stage.show(mapper);
  for (int e = 0; e < 2; ++e)
  {
    const reference::Image<double> picture = grayOf(e == 0 ? left : right);
    const stage::Likeness same(truths[e], picture), other(truths[1 - e], picture);
    check(same.largestShift() < 0.13, "An eye sees what it should: " + same.text());
    check(other.psnr < same.psnr - 2.0, "It does not see the other's: " + other.text());
  }

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
}

vtkSmartPointer<vtkActor> greenSphere(double x, double y, double z, double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetCenter(x, y, z);
  source->SetRadius(radius);
  vtkNew<vtkPolyDataMapper> polyMapper;
  polyMapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(polyMapper);
  actor->GetProperty()->SetColor(0.1, 0.8, 0.3);
  return actor;
}

/// A volume in a transparent layer above is a volume behind which the other layer is.
void testLayers(Mapper* mapper, double viewAngle, stage::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(50.0, 0.0);
  opacity->AddPoint(200.0, 0.8);
  stage.property->SetScalarOpacity(opacity);
  stage.show(mapper);
  const auto actor = greenSphere(30.0, 30.0, -40.0, 15.0); // behind the volume
  stage.renderer->AddActor(actor);
  stage.renderer->SetBackground(0.1, 0.2, 0.4);
  stage.look({ 0.1, 0.2, -0.9 }, Up);
  stage.renderer->ResetCameraClippingRange();
  const stage::Pixels expected = stage.pixels();
  vtkNew<vtkRenderer> top;
  top->SetActiveCamera(stage.renderer->GetActiveCamera());
  top->SetLayer(1);
  stage.renderer->RemoveVolume(stage.volume);
  check(stage.pixels() != expected, "Without the volume the picture differs.");
  top->AddVolume(stage.volume);
  stage.window->SetNumberOfLayers(2);
  stage.window->AddRenderer(top);
  check(stage.pixels() == expected, "A volume in the upper layer is blended over the lower one.");
  stage.window->RemoveRenderer(top);
}

/// Two props with one mapper, side by side and with properties of their own.
void testTwoProps(Mapper* mapper, double viewAngle, stage::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  vtkNew<vtkVolume> second;
  vtkNew<vtkVolumeProperty> property;
  property->DeepCopy(stage.property);
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
  color->AddRGBPoint(200.0, 1.0, 0.5, 0.0);
  property->SetColor(color);
  second->SetProperty(property);
  second->SetMapper(mapper);
  second->SetPosition(90.0, 0.0, 0.0);
  second->RotateZ(20.0);
  stage.renderer->AddVolume(second);
  stage.look({ 0.1, 0.2, -0.9 }, Up, 1.8);
  stage.renderer->GetActiveCamera()->SetWindowCenter(0.5, 0.0);
  stage.renderer->ResetCameraClippingRange();
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
void testMultisampling(Mapper* mapper, double viewAngle, stage::Checks& check)
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
      stage.viewAngle = viewAngle;
      stage.show(mapper);
      vtkNew<vtkPiecewiseFunction> function;
      function->AddPoint(20.0, opacity[0]);
      function->AddPoint(20.5, opacity[1]);
      stage.property->SetScalarOpacity(function);
      stage.renderer->SetBackground(0.1, 0.2, 0.4);
      stage.look(Direction, Up, 0.6);
      pixels[samples > 0] = stage.pixels();
    }
    check(pixels[0] == pixels[1],
      std::string("Multisampling changes nothing in mode ") + mapper->GetQualityModeAsString() +
        " with opacity " + std::to_string(opacity[0]) + ".");
    check(pixels[0] != last, "Opacity matters.");
    last = pixels[0];
  }
}

stage::Pixels alone(vtkImageData* image, int mode, double viewAngle)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  const auto mapper = stage::splatting(image);
  mapper->SetQualityMode(mode);
  stage.show(mapper);
  stage.look(Direction, Up);
  return stage.pixels();
}

void testReplacements(Mapper* mapper, double viewAngle, vtkImageData* image, stage::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(Direction, Up);
  const stage::Pixels before = stage.pixels();
  for (int time = 0; time < 2; ++time)
  {
    stage.show(stage::fixedPointRayCaster(image, 0.5));
    const stage::Pixels cast = stage.pixels();
    check(!isBlack(cast) && cast != before, "A ray caster takes the mapper's place.");
    stage.show(mapper);
    check(stage.pixels() == before, "The mapper comes back.");
  }
  mapper->SetInputDataObject(nullptr);
  const stage::Messages pipelineErrors(mapper->GetExecutive(), vtkCommand::ErrorEvent);
  check(isBlack(stage.pixels()), "Without input there is nothing to see.");
  const auto other = stage::toImageData(stage::blobsAndTubes({ 48, 44, 40 }, 4));
  mapper->SetInputData(other);
  const stage::Pixels replaced = stage.pixels();
  check(replaced == alone(other, mapper->GetQualityMode(), viewAngle) && replaced != before,
    "Other data are shown.");
  auto* const voxels = static_cast<unsigned char*>(other->GetScalarPointer());
  std::fill(voxels + 48 * 44 * 10, voxels + 48 * 44 * 30, static_cast<unsigned char>(90));
  other->GetPointData()->GetScalars()->Modified();
  const stage::Pixels changed = stage.pixels();
  check(changed == alone(other, mapper->GetQualityMode(), viewAngle) && changed != replaced,
    "Changed data are shown.");
  mapper->SetInputData(image);
  check(stage.pixels() == before, "The first data are shown again.");
}

/// Where only it is seen, a volume beside ones by VTK's own mapper looks as it does alone, and they
/// do, too.
void testBesideSmartMapper(Mapper* mapper, vtkImageData* image, stage::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.show(mapper);
  vtkNew<vtkSmartVolumeMapper> smart;
  smart->SetInputData(image);
  smart->SetBlendModeToMaximumIntensity();
  smart->SetRequestedRenderModeToRayCast();
  vtkNew<vtkVolume> second;
  second->SetMapper(smart);
  second->SetProperty(stage.property);
  second->SetPosition(90.0, 0.0, 0.0);
  stage.renderer->AddVolume(second);
  stage.look({ 0.1, 0.2, -0.9 }, Up, 1.8);
  stage.renderer->GetActiveCamera()->SetWindowCenter(0.5, 0.0);
  stage.renderer->ResetCameraClippingRange();
  const stage::Pixels both = stage.pixels();
  second->VisibilityOff();
  const stage::Pixels ours = stage.pixels();
  second->VisibilityOn();
  stage.volume->VisibilityOff();
  const stage::Pixels theirs = stage.pixels();
  stage::Pixels expected(both.size());
  std::transform(ours.begin(), ours.end(), theirs.begin(), expected.begin(),
    [](unsigned char a, unsigned char b) { return std::max(a, b); });
  check(!isBlack(ours) && !isBlack(theirs), "Both mappers' volumes are seen.");
  check(both == expected, "vtkSmartVolumeMapper and the mapper do not disturb each other.");
}

/// Windows without pixels draw nothing and say nothing.
void testEmptyWindow(Mapper* mapper, stage::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.show(mapper);
  stage.look(Direction, Up);
  const stage::Pixels before = stage.pixels();
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
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
  stage::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  const auto image = blobs();
  const auto mapper = stage::splatting(image);
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    for (double viewAngle : { 0.0, 45.0 })
    {
      testScreenshot(mapper, viewAngle, 3, check);
      testStereo(mapper, viewAngle, image, check);
      testLayers(mapper, viewAngle, check);
      testMultisampling(mapper, viewAngle, check);
      testTwoProps(mapper, viewAngle, check);
      testReplacements(mapper, viewAngle, image, check);
    }
  }
  mapper->SetQualityModeToHigh();
  testBesideSmartMapper(mapper, image, check);
  testEmptyWindow(mapper, check);
  return check.exitCode();
}
