// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Perspective views are put together from images along several principal axes: where these meet
// nothing may be seen, neither in one picture nor in a turn. And what is special about eyes: they
// can be anywhere, and turn.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Gray = reference::Image<double>;

constexpr int Width = 210;
constexpr int Height = 190;
const stage::Vector Up = { 0.1, 1.0, 0.05 };

vtkSmartPointer<vtkImageData> blobs()
{
  return stage::toImageData(stage::blobsAndTubes({ 64, 64, 64 }, 45));
}

/// The world's axis that the ray of each pixel follows most.
reference::Image<int> axesOfRays(stage::Stage& stage)
{
  vtkNew<vtkMatrix4x4> toWorld;
  toWorld->DeepCopy(stage.renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
    stage.renderer->GetTiledAspectRatio(), -1.0, 1.0));
  toWorld->Invert();
  const double* const eye = stage.renderer->GetActiveCamera()->GetPosition();
  reference::Image<int> axes(Width, Height);
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      double p[4] = { (2.0 * x + 1.0) / Width - 1.0, (2.0 * y + 1.0) / Height - 1.0, 0.0, 1.0 };
      toWorld->MultiplyPoint(p, p);
      double along[3];
      for (int a = 0; a < 3; ++a)
      {
        along[a] = std::abs(p[a] / p[3] - eye[a]);
      }
      axes.at(x, y) = static_cast<int>(std::max_element(along, along + 3) - along);
    }
  }
  return axes;
}

/// How far a pixel is from the next one whose ray follows another axis: less than `most`, or that.
int distanceToSeam(const reference::Image<int>& axes, int x, int y, int most)
{
  int nearest = most;
  for (int dy = -most + 1; dy < most; ++dy)
  {
    for (int dx = -most + 1; dx < most; ++dx)
    {
      const int i = x + dx, j = y + dy;
      const bool isInside = i >= 0 && i < Width && j >= 0 && j < Height;
      if (isInside && axes.at(i, j) != axes.at(x, y))
      {
        nearest = std::min(nearest, std::max(std::abs(dx), std::abs(dy)));
      }
    }
  }
  return nearest;
}

/// Sums of squared differences, at the seams and beside them, where rays are much the same.
struct Errors
{
  double at = 0.0, beside = 0.0;
  int pixelsAt = 0, pixelsBeside = 0;

  void add(const reference::Image<int>& axes, const Gray& truth, const Gray& picture)
  {
    constexpr int near = 3, far = 12;
    for (int y = 0; y < Height; ++y)
    {
      for (int x = 0; x < Width; ++x)
      {
        const int distance = distanceToSeam(axes, x, y, far);
        const double error = truth.at(x, y) - picture.at(x, y);
        const bool isNear = distance < near;
        (isNear ? this->at : this->beside) += distance < far ? error * error : 0.0;
        this->pixelsAt += isNear;
        this->pixelsBeside += !isNear && distance < far;
      }
    }
  }
  double rmsAt() const { return std::sqrt(this->at / this->pixelsAt); }
  double rmsBeside() const { return std::sqrt(this->beside / this->pixelsBeside); }
};

/// Along diagonals of the volume's faces and of the volume the images of two and three axes meet in
/// the middle of the picture.
void testSeams(stage::Stage& stage, reference::Checks& check)
{
  const auto image = blobs();
  const auto mapper = stage::splatting(image);
  Errors errors[3];
  for (const stage::Vector& direction : { stage::Vector{ 1.0, 1.0, 0.0 }, { 0.0, -1.0, 1.0 },
         { -1.0, 0.02, -1.0 }, { 1.0, 1.0, 1.0 }, { -1.0, 1.0, -1.0 }, { 1.0, -1.03, 0.98 } })
  {
    for (double angle : { 25.0, 60.0, 100.0 })
    {
      stage.viewAngle = angle;
      const auto rayCaster = stage::fixedPointRayCaster(image, 0.2);
      stage.show(rayCaster);
      stage.look(direction, Up, 0.8);
      const Gray truth = stage.gray();
      const auto axes = axesOfRays(stage);
      stage.show(mapper);
      for (int mode = 0; mode < 3; ++mode)
      {
        mapper->SetQualityMode(mode);
        errors[mode].add(axes, truth, stage.gray());
      }
    }
  }
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    const Errors& found = errors[mode];
    std::cout << "Seams, " << mapper->GetQualityModeAsString() << ": rms difference "
              << found.rmsAt() << " in " << found.pixelsAt << " pixels at seams, "
              << found.rmsBeside() << " in " << found.pixelsBeside << " beside them" << std::endl;
    check(found.pixelsAt > 5000, "There are seams.");
    check(found.rmsAt() <= 1.1 * found.rmsBeside(), "Errors at seams are no larger than beside.");
  }
}

double rms(const Gray& a, const Gray& b)
{
  return 255.0 * std::pow(10.0, -reference::psnr(a, b, 255.0) / 20.0);
}

/// Small steps of a turn through 45 degrees change the picture by as much each.
template <class Step>
void testTurn(stage::Stage& stage, const std::string& name, Step step, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  stage.show(mapper);
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    stage.viewAngle = 50.0;
    stage.look({ 0.75, 0.1, 1.0 }, Up, 0.9);
    Gray before = stage.gray();
    std::vector<double> changes;
    for (int n = 0; n < 60; ++n)
    {
      step(stage.renderer->GetActiveCamera());
      stage.renderer->ResetCameraClippingRange();
      const Gray picture = stage.gray();
      changes.push_back(rms(before, picture));
      before = picture;
    }
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    std::cout << name << ", " << mapper->GetQualityModeAsString() << ": changes by "
              << sorted.front() << " to " << sorted.back() << ", median " << median << std::endl;
    check(sorted.back() <= 1.5 * median, name, ": no step changes more than the others.");
    check(sorted.front() > 0.0, name, ": each step changes something.");
  }
}

/// Whether the mapper shows what one does that has not shown anything before.
bool showsAsNew(stage::Stage& stage, Mapper* mapper, const stage::Pixels& pixels)
{
  const auto fresh = stage::splatting(vtkImageData::SafeDownCast(mapper->GetInput()));
  fresh->SetQualityMode(mapper->GetQualityMode());
  fresh->SetBlendMode(mapper->GetBlendMode());
  fresh->SetMaximumType(mapper->GetMaximumType());
  stage.show(fresh);
  const bool same = stage.pixels() == pixels;
  stage.show(mapper);
  return same;
}

/// What leaves the eye where it is and the whole volume in the window leaves the images as they
/// are; what moves the eye does not.
void testReuse(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  stage.show(mapper);
  stage.viewAngle = 50.0;
  const auto counts = [&](int projections, const char* what, auto step)
  {
    stage.look({ 0.7, 0.1, 0.8 }, Up, 1.6);
    camera->SetWindowCenter(0.0, 0.0);
    const stage::Pixels before = stage.pixels();
    const vtkIdType count = mapper->GetNumberOfProjections();
    step();
    stage.renderer->ResetCameraClippingRange();
    const stage::Pixels after = stage.pixels();
    check(mapper->GetNumberOfProjections() - count == projections, what, ": projections, ",
      mapper->GetQualityModeAsString());
    check(before != after, what, ": the picture changes.");
    check(showsAsNew(stage, mapper, after), what, ": the picture is right.");
  };
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    counts(0, "Yaw", [&] { camera->Yaw(3.0); });
    counts(0, "Pitch", [&] { camera->Pitch(-2.0); });
    counts(0, "Roll", [&] { camera->Roll(20.0); });
    counts(0, "Zoom", [&] { camera->Zoom(0.8); });
    counts(0, "Window centre", [&] { camera->SetWindowCenter(0.1, 0.05); });
    counts(0, "Colours", [&] { stage.setGrayRamp(20.0, 200.0); });
    stage.setGrayRamp(0.0, 255.0);
    counts(1, "Azimuth", [&] { camera->Azimuth(1.0); });
    counts(1, "Dolly", [&] { camera->Dolly(1.1); });
    counts(1, "Zoom into a part", [&] { camera->Zoom(3.0); });
    counts(1, "Part in the window", [&] { camera->Yaw(20.0); });
  }
}

/// A volume and its mirror image, seen from opposite sides.
void testMirrored(stage::Stage& stage, reference::Checks& check)
{
  const reference::Volume<std::uint8_t> volume = stage::blobsAndTubes({ 48, 52, 56 }, 30);
  reference::Volume<std::uint8_t> mirror = volume;
  for (int k = 0; k < volume.size[2]; ++k)
  {
    for (int j = 0; j < volume.size[1]; ++j)
    {
      for (int i = 0; i < volume.size[0]; ++i)
      {
        mirror.at(i, j, k) = volume.at(i, j, volume.size[2] - 1 - k);
      }
    }
  }
  stage.viewAngle = 60.0;
  for (int kind = 0; kind < 5; ++kind)
  {
    for (const stage::Vector& direction :
      { stage::Vector{ 0.3, 0.2, 1.0 }, { 0.9, 0.2, 0.4 }, { 0.6, 0.5, -0.7 } })
    {
      for (int mode = 0; mode < 3; ++mode)
      {
        const auto picture = [&](const reference::Volume<std::uint8_t>& seen, double sign)
        {
          const auto mapper = stage::splatting(stage::toImageData(seen));
          mapper->SetQualityMode(mode);
          mapper->SetMaximumType(kind < 3 ? kind : Mapper::GLOBAL);
          mapper->SetLocalMaximumThreshold(90.0);
          kind == 3     ? mapper->SetBlendModeToMinimumIntensity()
            : kind == 4 ? mapper->SetBlendModeToAverageIntensity()
                        : mapper->SetBlendModeToMaximumIntensity();
          stage.show(mapper);
          stage.look({ direction[0], direction[1], sign * direction[2] }, { 0.1, 1.0, 0.0 }, 0.7);
          return stage.gray();
        };
        const Gray expected = picture(volume, 1.0), mirrored = picture(mirror, -1.0);
        Gray turned(Width, Height);
        double brightest = 0.0;
        for (int y = 0; y < Height; ++y)
        {
          for (int x = 0; x < Width; ++x)
          {
            turned.at(x, y) = mirrored.at(Width - 1 - x, y);
            brightest = std::max(brightest, turned.at(x, y));
          }
        }
        const double likeness = reference::psnr(expected, turned, 255.0);
        check(likeness > 45.0 && (brightest > 30.0 || kind == 3), "Kind ", kind, ", mode ", mode,
          ": the mirror image is seen, ", likeness, " dB.");
      }
    }
  }
}

bool isBlack(const stage::Pixels& pixels)
{
  return std::all_of(pixels.begin(), pixels.end(), [](unsigned char byte) { return byte == 0; });
}

/// Projections that programs give themselves.
void testExplicitProjection(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  stage.show(mapper);
  stage.viewAngle = 40.0;
  stage.look({ 0.7, 0.3, 0.8 }, Up, 1.1);
  camera->SetWindowCenter(0.3, -0.2);
  const stage::Pixels expected = stage.pixels();
  vtkNew<vtkMatrix4x4> projection;
  projection->DeepCopy(
    camera->GetProjectionTransformMatrix(stage.renderer->GetTiledAspectRatio(), -1.0, 1.0));
  camera->SetExplicitProjectionTransformMatrix(projection);
  camera->UseExplicitProjectionTransformMatrixOn();
  // Neither of these means anything now.
  camera->SetViewAngle(90.0);
  camera->ParallelProjectionOn();
  check(!isBlack(expected) && stage.pixels() == expected, "An explicit perspective is one.");
  camera->UseExplicitProjectionTransformMatrixOff();
  camera->SetWindowCenter(0.0, 0.0);
}

/// Cameras that see nothing, and cameras that mean nothing.
void testCameras(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(blobs());
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  stage.show(mapper);
  stage.viewAngle = 50.0;
  const auto look = [&] { stage.look({ 0.7, 0.3, 0.8 }, Up); };
  look();
  const stage::Pixels expected = stage.pixels();
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  const auto showsNothing = [&](const char* what, auto change, std::size_t messages)
  {
    const std::size_t before = errors.texts.size();
    look();
    change();
    check(isBlack(stage.pixels()) && isBlack(stage.pixels()), what, ": nothing is seen.");
    check(errors.texts.size() - before == messages, what, ": what is said.");
    look();
    check(stage.pixels() == expected, what, ": afterwards all is as before.");
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  showsNothing(
    "Behind",
    [&]
    {
      camera->Yaw(180.0);
      camera->SetClippingRange(0.1, 1000.0);
    },
    0);
  showsNothing(
    "Beside",
    [&]
    {
      camera->Yaw(100.0);
      camera->SetClippingRange(0.1, 1000.0);
    },
    0);
  showsNothing(
    "NaN angle", [&] { camera->SetViewAngle(nan); }, 1);
  // VTK 9.1 leaves the direction as it was, and the view transform has no place then.
  look();
  camera->SetFocalPoint(camera->GetPosition());
  stage.pixels();
  look();
  check(stage.pixels() == expected, "An eye on the focal point does not matter later.");
}
}

//------------------------------------------------------------------------------
int TestPerspectiveViews(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  testSeams(stage, check);
  testTurn(
    stage, "Orbit", [](vtkCamera* camera) { camera->Azimuth(0.25); }, check);
  testTurn(
    stage, "Turn of the eye", [](vtkCamera* camera) { camera->Yaw(0.25); }, check);
  testReuse(stage, check);
  testMirrored(stage, check);
  testExplicitProjection(stage, check);
  testCameras(stage, check);
  return check.exitCode();
}
