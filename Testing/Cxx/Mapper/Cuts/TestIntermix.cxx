// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares opaque geometry in front of, inside, behind and beside the volume with pictures of the
// parts and with VTK's ray caster, also in viewports, layers and tiles and with multisampling.
// TestSceneCuts tests the ends of rays at geometry.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCameraPass.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkLightsPass.h"
#include "vtkMath.h"
#include "vtkOpaquePass.h"
#include "vtkOverlayPass.h"
#include "vtkPlaneSource.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderPassCollection.h"
#include "vtkRenderStepsPass.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSequencePass.h"
#include "vtkSphereSource.h"
#include "vtkTranslucentPass.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumetricPass.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace
{
constexpr int Width = 210;
constexpr int Height = 190;

const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { 0.3, 0.4, -0.8 }, { -0.8, 0.3, 0.4 }, { 0.2, -0.9, 0.3 } };

vtkSmartPointer<vtkActor> actorOf(vtkAlgorithm* source)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.0, 0.6, 0.0);
  actor->GetProperty()->LightingOff();
  return actor;
}

/// The volume's centre, moved along a direction.
stage::Vector along(vtkImageData* image, const stage::Vector& direction, double distance)
{
  const double length = vtkMath::Norm(direction.data());
  stage::Vector place;
  for (int a = 0; a < 3; ++a)
  {
    place[a] = image->GetCenter()[a] + distance / length * direction[a];
  }
  return place;
}

vtkSmartPointer<vtkActor> sphere(const stage::Vector& centre, double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetCenter(centre[0], centre[1], centre[2]);
  source->SetRadius(radius);
  source->SetThetaResolution(48);
  source->SetPhiResolution(48);
  return actorOf(source);
}

/// A square wall with a point in its middle.
vtkSmartPointer<vtkActor> wall(
  const stage::Vector& centre, const stage::Vector& normal, double size)
{
  vtkNew<vtkPlaneSource> source;
  source->SetOrigin(0.0, 0.0, 0.0);
  source->SetPoint1(size, 0.0, 0.0);
  source->SetPoint2(0.0, size, 0.0);
  double unit[3] = { normal[0], normal[1], normal[2] };
  vtkMath::Normalize(unit);
  source->SetNormal(unit);
  source->SetCenter(centre[0], centre[1], centre[2]);
  return actorOf(source);
}

bool isSame(const stage::Pixels& a, const stage::Pixels& b, std::size_t pixel)
{
  return std::equal(a.begin() + 3 * pixel, a.begin() + 3 * pixel + 3, b.begin() + 3 * pixel);
}

/// The same but for so many levels.
bool isNearly(const stage::Pixels& a, const stage::Pixels& b, std::size_t pixel, int levels)
{
  return std::equal(a.begin() + 3 * pixel, a.begin() + 3 * pixel + 3, b.begin() + 3 * pixel,
    [=](unsigned char x, unsigned char y) { return std::abs(x - y) <= levels; });
}

bool isBlack(const stage::Pixels& a, std::size_t pixel)
{
  return a[3 * pixel] == 0 && a[3 * pixel + 1] == 0 && a[3 * pixel + 2] == 0;
}

int differing(const stage::Pixels& a, const stage::Pixels& b)
{
  int count = 0;
  for (std::size_t pixel = 0; pixel < a.size() / 3; ++pixel)
  {
    count += !isSame(a, b, pixel);
  }
  return count;
}

/// The picture of the upper where it is not black, else that of the lower.
stage::Pixels over(const stage::Pixels& upper, const stage::Pixels& lower)
{
  stage::Pixels result = lower;
  for (std::size_t pixel = 0; pixel < upper.size() / 3; ++pixel)
  {
    if (!isBlack(upper, pixel))
    {
      std::copy_n(upper.begin() + 3 * pixel, 3, result.begin() + 3 * pixel);
    }
  }
  return result;
}

/// The volume, an actor, and both.
struct Pictures
{
  stage::Pixels volume, actor, both;
  vtkIdType projections; // that the actor made necessary
};

Pictures pictures(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, vtkActor* actor)
{
  Pictures result;
  // The clipping range makes room for the actor from the beginning.
  stage.renderer->AddActor(actor);
  stage.renderer->ResetCameraClippingRange();
  stage.volume->VisibilityOff();
  result.actor = stage.pixels();
  stage.volume->VisibilityOn();
  actor->VisibilityOff();
  result.volume = stage.pixels();
  actor->VisibilityOn();
  const vtkIdType before = mapper->GetNumberOfProjections();
  result.both = stage.pixels();
  result.projections = mapper->GetNumberOfProjections() - before;
  stage.renderer->RemoveActor(actor);
  return result;
}

/// What does not meet the volume is before or behind it as a whole: every pixel is known. (The
/// volume has no black: black is transparent.)
void testBeforeAndBehind(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
  vtkImageData* image, reference::Checks& check)
{
  const bool hasShearImage = mapper->GetQualityMode() != vtkSplattingMIPVolumeMapper::EXACT;
  for (const stage::Vector& direction : directions)
  {
    stage.look(direction, up);
    const Pictures before = pictures(stage, mapper, sphere(along(image, direction, -80.0), 20.0));
    check(before.projections == 0 || !hasShearImage,
      "Geometry before the volume is a matter of the screen.");
    check(differing(before.actor, before.volume) > 0 &&
        before.both == over(before.actor, before.volume),
      "Geometry before the volume hides it.");
    const Pictures behind = pictures(stage, mapper, sphere(along(image, direction, 80.0), 20.0));
    check(
      behind.projections == 0 || !hasShearImage, "Geometry behind the volume costs no projection.");
    check(behind.both == over(behind.volume, behind.actor), "The volume hides what is behind it.");
    mapper->IntermixIntersectingGeometryOff();
    const Pictures off = pictures(stage, mapper, sphere(along(image, direction, -80.0), 20.0));
    check(off.both == over(off.volume, off.actor), "Nothing is hidden without intermixing.");
    mapper->IntermixIntersectingGeometryOn();
  }
}

/// Whether a picture changes between black and something else within some pixels.
bool isNearRim(const stage::Pixels& picture, int pixel, int reach)
{
  const int x = pixel % Width, y = pixel / Width;
  for (int row = std::max(y - reach, 0); row <= std::min(y + reach, Height - 1); ++row)
  {
    for (int column = std::max(x - reach, 0); column <= std::min(x + reach, Width - 1); ++column)
    {
      if (isBlack(picture, row * Width + column) != isBlack(picture, pixel))
      {
        return true;
      }
    }
  }
  return false;
}

/// PSNR of the red components where `counts` holds.
template <class Counts>
double psnrWhere(const stage::Pixels& truth, const stage::Pixels& picture, Counts counts)
{
  double sum = 0.0;
  int number = 0;
  for (int pixel = 0; pixel < Width * Height; ++pixel)
  {
    if (counts(pixel))
    {
      const double error = double(truth[3 * pixel]) - picture[3 * pixel];
      sum += error * error;
      ++number;
    }
  }
  return 10.0 * std::log10(255.0 * 255.0 * number / sum);
}

vtkSmartPointer<vtkRenderPass> sequencePass()
{
  vtkNew<vtkRenderPassCollection> passes;
  passes->AddItem(vtkNew<vtkLightsPass>());
  passes->AddItem(vtkNew<vtkOpaquePass>());
  passes->AddItem(vtkNew<vtkTranslucentPass>());
  passes->AddItem(vtkNew<vtkVolumetricPass>());
  passes->AddItem(vtkNew<vtkOverlayPass>());
  vtkNew<vtkSequencePass> sequence;
  sequence->SetPasses(passes);
  auto pass = vtkSmartPointer<vtkCameraPass>::New();
  pass->SetDelegatePass(sequence);
  return pass;
}

/// Render passes draw what the renderer draws without, pixel by pixel, and what VTK's GPU ray
/// caster draws under the same passes, which ends its rays exactly. Edges are as soft as the shear
/// image's pixels are large, 1.8 of the screen: off them pictures must agree as where a plane cuts
/// (see TestClipping), since rays end a slice sooner or later.
void testPasses(double viewAngle, vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image,
  reference::Checks& check)
{
  const auto rayCaster = stage::gpuRayCaster(image, 0.25);
  for (double distance : { -80.0, -20.0, 5.0 })
  {
    const auto actor = sphere(along(image, directions[0], distance), 14.0);
    stage::Stage plain(Width, Height);
    plain.viewAngle = viewAngle;
    plain.show(mapper);
    plain.look(directions[0], up);
    const Pictures expected = pictures(plain, mapper, actor);
    check(expected.both != expected.volume, "The sphere matters.");
    for (const vtkSmartPointer<vtkRenderPass>& pass :
      { sequencePass(), vtkSmartPointer<vtkRenderPass>(vtkNew<vtkRenderStepsPass>()) })
    {
      // A stage of its own: what renderers have counted before a pass is set does not change.
      stage::Stage stage(Width, Height);
      stage.viewAngle = viewAngle;
      stage.renderer->SetPass(pass);
      stage.show(mapper);
      stage.look(directions[0], up);
      stage.renderer->AddActor(actor);
      stage.renderer->ResetCameraClippingRange();
      const stage::Pixels mine = stage.pixels();
      stage.show(rayCaster);
      const stage::Pixels truth = stage.pixels();
      const double psnr =
        psnrWhere(truth, mine, [&](int pixel) { return !isNearRim(expected.actor, pixel, 2); });
      std::cout << pass->GetClassName() << ", sphere at " << distance << ": " << psnr << " dB, "
                << differing(mine, expected.both) << " pixels differ from no pass" << std::endl;
      check(mine == expected.both, "A render pass changes nothing.");
      check(psnr > 37.0, "Under render passes geometry ends rays as the GPU ray caster's.");
    }
  }
}

/// The lower left corner of a window.
stage::Pixels part(const stage::Pixels& pixels, int width, int left, int bottom)
{
  stage::Pixels result;
  for (int y = 0; y < Height; ++y)
  {
    const auto row = pixels.begin() + 3 * (width * (bottom + y) + left);
    result.insert(result.end(), row, row + 3 * Width);
  }
  return result;
}

/// To the right of the view along the first direction.
stage::Vector beside(stage::Vector place)
{
  double right[3];
  vtkMath::Cross(directions[0].data(), up.data(), right);
  vtkMath::Normalize(right);
  for (int a = 0; a < 3; ++a)
  {
    place[a] += 36.0 * right[a];
  }
  return place;
}

/// A scene with geometry before and in the volume.
struct Crowd
{
  stage::Stage stage;
  vtkSmartPointer<vtkActor> before, inside;

  Crowd(int width, int height, double viewAngle, vtkSplattingMIPVolumeMapper* mapper,
    vtkImageData* image)
    : stage(width, height),
      before(sphere(beside(along(image, directions[0], -80.0)), 12.0)),
      inside(sphere(along(image, directions[1], 10.0), 15.0))
  {
    this->stage.viewAngle = viewAngle;
    this->stage.setGrayRamp(-40.0, 255.0);
    this->stage.show(mapper);
    this->stage.look(directions[0], up);
    this->stage.renderer->AddActor(this->before);
    this->stage.renderer->AddActor(this->inside);
    this->stage.renderer->ResetCameraClippingRange();
  }
};

/// A picture of twice the size, which vtkWindowToImageFilter renders in four tiles.
stage::Pixels pictureInTiles(vtkRenderWindow* window)
{
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(window);
  filter->SetScale(2);
  filter->SetInputBufferTypeToRGB();
  filter->ReadFrontBufferOff();
  filter->Update();
  auto* const bytes =
    vtkUnsignedCharArray::SafeDownCast(filter->GetOutput()->GetPointData()->GetScalars());
  return { bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues() };
}

void testWindows(double viewAngle, vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image,
  reference::Checks& check)
{
  Crowd alone(Width, Height, viewAngle, mapper, image);
  const stage::Pixels expected = alone.stage.pixels();
  alone.stage.volume->VisibilityOff();
  const stage::Pixels actors = alone.stage.pixels();
  // In perspective coordinates are rounded in another way: a ray that passes between two pixels of
  // the depth buffer at a rim may end at either. It is seen in up to 5 x 5 pixels.
  const int most = viewAngle > 0.0 ? 1 : 0;
  {
    Crowd viewport(2 * Width, 2 * Height, viewAngle, mapper, image);
    viewport.stage.renderer->SetViewport(0.5, 0.5, 1.0, 1.0);
    const stage::Pixels picture = part(viewport.stage.pixels(), 2 * Width, Width, Height);
    int wrong = 0;
    for (int pixel = 0; pixel < Width * Height; ++pixel)
    {
      wrong += !isNearly(expected, picture, pixel, most);
    }
    check(wrong <= 25 * most, "A viewport shows what a window does.");
  }
  {
    // Rays that are seen beside a tile end at the depth of its rim: at seams pixels may differ by a
    // pixel of the shear image.
    alone.stage.volume->VisibilityOn();
    const stage::Pixels tiles = pictureInTiles(alone.stage.window);
    Crowd large(2 * Width, 2 * Height, viewAngle, mapper, image);
    const stage::Pixels whole = large.stage.pixels();
    int wrong = 0;
    for (int pixel = 0; pixel < 4 * Width * Height; ++pixel)
    {
      const int x = pixel % (2 * Width), y = pixel / (2 * Width);
      const bool isAtSeam = std::abs(x - Width) <= 4 || std::abs(y - Height) <= 4;
      wrong += !isAtSeam && !isNearly(whole, tiles, pixel, most);
    }
    check(wrong <= 25 * most, "Tiles make up the large picture.");
  }
  {
    Crowd layered(Width, Height, viewAngle, mapper, image);
    vtkNew<vtkRenderer> upper;
    layered.stage.window->SetNumberOfLayers(2);
    layered.stage.window->AddRenderer(upper);
    upper->SetLayer(1);
    upper->SetActiveCamera(layered.stage.renderer->GetActiveCamera());
    layered.stage.renderer->RemoveVolume(layered.stage.volume);
    upper->AddVolume(layered.stage.volume);
    const stage::Pixels over = layered.stage.pixels();
    check(over != expected && over != actors, "A layer of its own lies over the others.");
    upper->PreserveDepthBufferOn();
    check(layered.stage.pixels() == expected, "A layer with the depths of the one below.");
  }
}

/// With multisampling only pixels at the rims of geometry may differ, if it has the same depth at
/// all samples.
void testMultiSamples(double viewAngle, vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image,
  reference::Checks& check)
{
  Crowd plain(Width, Height, viewAngle, mapper, image),
    samples(Width, Height, viewAngle, mapper, image);
  for (Crowd* crowd : { &plain, &samples })
  {
    crowd->stage.renderer->RemoveActor(crowd->inside);
    crowd->stage.renderer->AddActor(wall(along(image, directions[0], 3.0), directions[0], 30.0));
  }
  const stage::Pixels expected = plain.stage.pixels();
  plain.stage.volume->VisibilityOff();
  const stage::Pixels actors = plain.stage.pixels();
  samples.stage.window->SetMultiSamples(4);
  const stage::Pixels picture = samples.stage.pixels();
  int wrong = 0;
  for (int pixel = 0; pixel < Width * Height; ++pixel)
  {
    wrong += !isNearRim(actors, pixel, 3) && !isSame(expected, picture, pixel);
  }
  std::cout << "multisampling: " << samples.stage.window->GetMultiSamples() << " samples, "
            << differing(expected, picture) << " pixels differ, " << wrong << " off the rims"
            << std::endl;
  check(wrong == 0, "Multisampling changes nothing but rims.");
}

/// A volume that is much smaller than a pixel, and a wall that hides it.
void testSmallVolume(stage::Stage& stage, vtkImageData* image, reference::Checks& check)
{
  for (const stage::Vector& direction : directions)
  {
    stage.look(direction, up);
    vtkCamera* const camera = stage.renderer->GetActiveCamera();
    const double scale = 1e6 * camera->GetParallelScale();
    const stage::Vector eye = along(image, direction, -scale);
    camera->SetPosition(eye.data());
    camera->SetParallelScale(scale);
    camera->SetClippingRange(0.1 * scale, 2.0 * scale);
    stage.volume->VisibilityOn();
    const stage::Pixels shown = stage.pixels();
    const auto before = wall(along(image, direction, -0.5 * scale), direction, 4.0 * scale);
    stage.renderer->AddActor(before);
    const stage::Pixels hidden = stage.pixels();
    stage.volume->VisibilityOff();
    const stage::Pixels alone = stage.pixels();
    stage.volume->VisibilityOn();
    stage.renderer->RemoveActor(before);
    check(differing(shown, stage::Pixels(shown.size(), 0)) > 0 && differing(hidden, alone) == 0,
      "A small volume is seen in ", differing(shown, stage::Pixels(shown.size(), 0)),
      " pixels, behind a wall in ", differing(hidden, alone), ".");
  }
}
}

//------------------------------------------------------------------------------
int TestIntermix(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto mapper = stage::splatting(image);
  for (double viewAngle : { 0.0, 50.0 })
  {
    testPasses(viewAngle, mapper, image, check);
  }
  stage.show(mapper);
  stage.setGrayRamp(-40.0, 255.0);
  stage.viewAngle = 0.0;
  testSmallVolume(stage, image, check);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    for (int mode : { vtkSplattingMIPVolumeMapper::HIGH, vtkSplattingMIPVolumeMapper::EXACT })
    {
      mapper->SetQualityMode(mode);
      testBeforeAndBehind(stage, mapper, image, check);
    }
    testWindows(viewAngle, mapper, image, check);
    testMultiSamples(viewAngle, mapper, image, check);
  }
  return check.exitCode();
}
