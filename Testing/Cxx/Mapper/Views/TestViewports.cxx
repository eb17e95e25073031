// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One mapper, by itself and in the place of VTK's GPU mapper, in several viewports, renderers and
// windows, beside other props, and at the rim of the view.
#include "Stage.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cstdlib>

namespace
{
constexpr int Width = 140;
constexpr int Height = 120;

const stage::Vector leftDirection = { 0.3, 0.4, -0.8 };
const stage::Vector rightDirection = { -0.8, 0.3, 0.4 };
const stage::Vector up = { 0.0, 1.0, 0.1 };

vtkSmartPointer<vtkImageData> blobs()
{
  return stage::toImageData(stage::blobsAndTubes({ 36, 40, 44 }, 14));
}

bool isBlack(const stage::Pixels& pixels)
{
  return std::all_of(pixels.begin(), pixels.end(), [](unsigned char byte) { return byte == 0; });
}

/// One quarter of the picture of a window with twice the width and height.
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

stage::Pixels alone(double viewAngle, vtkVolumeMapper* mapper, const stage::Vector& direction)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(direction, up);
  stage::Pixels pixels = stage.pixels();
  stage.volume->SetMapper(nullptr);
  return pixels;
}

/// The lower left and the upper right quarter of a window.
void testTwoViewports(double viewAngle, vtkVolumeMapper* mapper, reference::Checks& check)
{
  const stage::Pixels left = alone(viewAngle, mapper, leftDirection);
  const stage::Pixels right = alone(viewAngle, mapper, rightDirection);
  stage::Stage stage(2 * Width, 2 * Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(leftDirection, up);
  stage.renderer->SetViewport(0.0, 0.0, 0.5, 0.5);
  stage::Stage other(Width, Height);
  other.viewAngle = viewAngle; // only its camera is used
  other.show(mapper);
  other.look(rightDirection, up);
  vtkNew<vtkRenderer> second;
  second->SetViewport(0.5, 0.5, 1.0, 1.0);
  second->AddVolume(stage.volume);
  second->SetActiveCamera(other.renderer->GetActiveCamera());
  stage.window->AddRenderer(second);
  for (int time = 0; time < 2; ++time)
  {
    const stage::Pixels both = stage.pixels();
    check(quarter(both, 0, 0) == left, "The left viewport shows what it does alone.");
    check(quarter(both, Width, Height) == right, "The right viewport shows what it does alone.");
    check(isBlack(quarter(both, Width, 0)) && isBlack(quarter(both, 0, Height)),
      "Nothing is drawn outside the viewports.");
  }
}

void testTwoWindows(double viewAngle, vtkVolumeMapper* mapper, reference::Checks& check)
{
  const stage::Pixels expectedLeft = alone(viewAngle, mapper, leftDirection);
  const stage::Pixels expectedRight = alone(viewAngle, mapper, rightDirection);
  stage::Stage left(Width, Height);
  left.viewAngle = viewAngle;
  left.show(mapper);
  left.look(leftDirection, up);
  stage::Stage right(Width, Height);
  right.viewAngle = viewAngle;
  right.show(mapper);
  right.look(rightDirection, up);
  for (int time = 0; time < 2; ++time)
  {
    check(left.pixels() == expectedLeft, "The first window shows what it does alone.");
    check(right.pixels() == expectedRight, "The second window shows what it does alone.");
  }
  left.volume->ReleaseGraphicsResources(left.window);
  check(right.pixels() == expectedRight, "The second window outlives the first one's resources.");
  check(left.pixels() == expectedLeft, "The first window gets new resources.");
}

/// A window whose picture is copied in parts, between frames of one with multisampling, where none
/// is.
void testWindowWithMultisampling(
  double viewAngle, vtkVolumeMapper* mapper, reference::Checks& check)
{
  const auto look = [=](stage::Stage& stage, const stage::Vector& direction, int samples)
  {
    stage.window->SetMultiSamples(samples);
    stage.viewAngle = viewAngle;
    stage.show(mapper);
    stage.look(direction, up, 0.6);
    return stage.pixels();
  };
  stage::Stage one(2 * Width, 2 * Height), other(2 * Width, 2 * Height);
  const stage::Pixels left = look(one, leftDirection, 0);
  const stage::Pixels right = look(other, rightDirection, 4);
  check(left != right, "The windows show different views.");
  check(look(one, rightDirection, 0) == right, "A window shows the view of another.");
  check(look(other, leftDirection, 4) == left, "The other shows the view of the first.");
}

void testReleasedWindow(double viewAngle, vtkVolumeMapper* mapper, reference::Checks& check)
{
  stage::Pixels first;
  {
    stage::Stage stage(Width, Height);
    stage.viewAngle = viewAngle;
    stage.show(mapper);
    stage.look(leftDirection, up);
    first = stage.pixels();
    mapper->ReleaseGraphicsResources(stage.window);
    check(stage.pixels() == first, "A window is used again after its resources were released.");
    stage.window->Finalize();
  }
  check(alone(viewAngle, mapper, leftDirection) == first, "The mapper goes on to another window.");
}

vtkSmartPointer<vtkActor> sphereBehind(vtkImageData* image)
{
  double centre[3];
  image->GetCenter(centre);
  vtkNew<vtkSphereSource> source;
  source->SetCenter(centre[0] + 40.0 * 0.3, centre[1] + 40.0 * 0.4, centre[2] - 40.0 * 0.8);
  source->SetRadius(20.0);
  vtkNew<vtkPolyDataMapper> polyMapper;
  polyMapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(polyMapper);
  actor->GetProperty()->SetColor(0.2, 0.9, 0.4);
  return actor;
}

struct Counts
{
  int through = 0;
  int covered = 0;
  int wrong = 0;
};

/// Where the volume is transparent the picture of the geometry must remain, where it is opaque that
/// of the volume. (The volume's colours have no black: black is transparent.)
Counts compare(
  const stage::Pixels& volume, const stage::Pixels& geometry, const stage::Pixels& both)
{
  Counts counts;
  for (std::size_t p = 0; p < both.size(); p += 3)
  {
    const bool transparent = volume[p] == 0;
    const auto expected = (transparent ? geometry : volume).begin() + p;
    const bool isRight = std::equal(expected, expected + 3, both.begin() + p);
    counts.wrong += !isRight;
    counts.through += transparent && geometry[p] != 0;
    counts.covered += !transparent && geometry[p] != 0;
  }
  return counts;
}

void testGeometryBehind(
  double viewAngle, vtkVolumeMapper* mapper, vtkImageData* image, reference::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(80.0, 0.0);
  opacity->AddPoint(80.000001, 1.0);
  stage.property->SetScalarOpacity(opacity);
  stage.show(mapper);
  stage.look(leftDirection, up);
  const auto actor = sphereBehind(image);
  stage.renderer->AddActor(actor);
  stage.renderer->ResetCameraClippingRange();
  const stage::Pixels both = stage.pixels();
  actor->VisibilityOff();
  const stage::Pixels volume = stage.pixels();
  actor->VisibilityOn();
  stage.volume->VisibilityOff();
  const Counts counts = compare(volume, stage.pixels(), both);
  check(counts.through > 100, "Geometry shows through transparent values.");
  check(counts.covered > 100, "Opaque values cover geometry.");
  // The table of colours is fine, but not infinitely so.
  check(counts.wrong <= 5, "Nothing else is seen: ", counts.wrong, " pixels.");
}

/// Whether the part of the picture that is still in view is the same, moved by whole pixels.
bool isMoved(const stage::Pixels& from, const stage::Pixels& to, int dx, int dy)
{
  for (int y = std::max(0, dy); y < std::min(Height, Height + dy); ++y)
  {
    for (int x = std::max(0, dx); x < std::min(Width, Width + dx); ++x)
    {
      const int a = from[3 * ((y - dy) * Width + x - dx)];
      const int b = to[3 * (y * Width + x)];
      if (std::abs(a - b) > 1) // the warp's coordinates are rounded
      {
        return false;
      }
    }
  }
  return true;
}

void testPartlyOutside(double viewAngle, vtkVolumeMapper* mapper, reference::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(leftDirection, up);
  const stage::Pixels middle = stage.pixels();
  for (const auto& [dx, dy] :
    { std::pair(60, 0), { -75, 0 }, { 0, 50 }, { 0, -65 }, { 50, 40 }, { -50, -40 } })
  {
    stage.renderer->GetActiveCamera()->SetWindowCenter(-2.0 * dx / Width, -2.0 * dy / Height);
    const stage::Pixels moved = stage.pixels();
    check(!isBlack(moved) && isMoved(middle, moved, dx, dy), "Partly outside by ", dx, ", ", dy,
      " pixels.");
  }
}

void testOutside(double viewAngle, vtkVolumeMapper* mapper, reference::Checks& check)
{
  stage::Stage stage(Width, Height);
  stage.viewAngle = viewAngle;
  stage.show(mapper);
  stage.look(leftDirection, up);
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  for (const auto& [x, y] : { std::pair(4.0, 0.0), { -4.0, 0.0 }, { 0.0, 4.0 }, { 0.0, -4.0 } })
  {
    camera->SetWindowCenter(x, y);
    check(isBlack(stage.pixels()), "Beside the view there is nothing to see.");
  }
  camera->SetWindowCenter(0.0, 0.0);
  camera->SetClippingRange(1.0, 2.0);
  check(isBlack(stage.pixels()), "Behind the far plane there is nothing to see.");
  check(errors.texts.empty(), "Being outside is no error.");
}
}

//------------------------------------------------------------------------------
int TestViewports(int, char*[])
{
  reference::Checks check;
  const auto image = blobs();
  vtkNew<vtkSplattingMIPGPUVolumeRayCastMapper> override;
  override->SetInputData(image);
  override->SetBlendModeToMaximumIntensity();
  // X servers may restart when their last client leaves, so one window stays throughout.
  stage::Stage keeper(10, 10);
  keeper.window->Render();
  const auto splatting = stage::splatting(image);
  for (vtkVolumeMapper* mapper : std::initializer_list<vtkVolumeMapper*>{ splatting, override })
  {
    for (double viewAngle : { 0.0, 50.0 })
    {
      testTwoViewports(viewAngle, mapper, check);
      testTwoWindows(viewAngle, mapper, check);
      testWindowWithMultisampling(viewAngle, mapper, check);
      testReleasedWindow(viewAngle, mapper, check);
      testGeometryBehind(viewAngle, mapper, image, check);
      testPartlyOutside(viewAngle, mapper, check);
      testOutside(viewAngle, mapper, check);
    }
  }
  return check.exitCode();
}
