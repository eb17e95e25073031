// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Picks return the world positions of bright voxels. GetLocations() returns the same. If there are
// no locations, one message says why.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>

namespace
{
using Point = std::array<double, 3>;
using Voxel = std::array<int, 3>;

const char* const ModeNames[] = { "preview", "standard", "high", "exact" };

Point worldOf(stage::Stage& stage, vtkImageData* image, const Point& index)
{
  const int* const extent = image->GetExtent();
  Point point;
  for (int a = 0; a < 3; ++a)
  {
    point[a] = index[a] + extent[2 * a];
  }
  image->TransformContinuousIndexToPhysicalPoint(point.data(), point.data());
  double homogeneous[4] = { point[0], point[1], point[2], 1.0 };
  stage.volume->GetMatrix()->MultiplyPoint(homogeneous, homogeneous);
  return { homogeneous[0], homogeneous[1], homogeneous[2] };
}

/// In pixels whose centres are integers.
Point shownAt(stage::Stage& stage, const Point& world)
{
  stage.renderer->SetWorldPoint(world[0], world[1], world[2], 1.0);
  stage.renderer->WorldToDisplay();
  const double* const display = stage.renderer->GetDisplayPoint();
  return { display[0] - 0.5, display[1] - 0.5, display[2] };
}

double distance(const Point& a, const Point& b)
{
  return std::sqrt(vtkMath::Distance2BetweenPoints(a.data(), b.data()));
}

double depthOf(stage::Stage& stage, const Point& world)
{
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  Point way, direction;
  vtkMath::Subtract(world.data(), camera->GetPosition(), way.data());
  camera->GetDirectionOfProjection(direction.data());
  return camera->GetParallelProjection() ? vtkMath::Dot(way.data(), direction.data())
                                         : vtkMath::Norm(way.data());
}

struct Arrays
{
  explicit Arrays(vtkImageData* locations)
    : image(locations),
      voxels(locations->GetPointData()->GetArray("Voxel")),
      depths(locations->GetPointData()->GetArray("Depth")),
      positions(locations->GetPointData()->GetArray("Position"))
  {
  }
  vtkIdType at(int x, int y) const
  {
    int ijk[3] = { x, y, 0 };
    return this->image->ComputePointId(ijk);
  }
  Voxel voxel(int x, int y) const
  {
    const vtkIdType n = this->at(x, y);
    return { static_cast<int>(this->voxels->GetComponent(n, 0)),
      static_cast<int>(this->voxels->GetComponent(n, 1)),
      static_cast<int>(this->voxels->GetComponent(n, 2)) };
  }

  vtkImageData* image;
  vtkDataArray *voxels, *depths, *positions;
};

/// How wide a voxel is seen, in pixels.
double widthOf(stage::Stage& stage, vtkImageData* image, const Voxel& voxel)
{
  const Point at = { double(voxel[0]), double(voxel[1]), double(voxel[2]) };
  const Point middle = shownAt(stage, worldOf(stage, image, at));
  double width = 0.0;
  for (int n = 0; n < 8; ++n)
  {
    Point corner = at;
    for (int a = 0; a < 3; ++a)
    {
      corner[a] += (n >> a) % 2 ? 0.5 : -0.5;
    }
    const Point shown = shownAt(stage, worldOf(stage, image, corner));
    width = std::max(width, 2.0 * std::hypot(shown[0] - middle[0], shown[1] - middle[1]));
  }
  return width;
}

/// Makes up to twelve voxels white that are seen apart. A pixel beside one of them shows a ray that
/// is within a voxel of it, whose footprints reach two voxels further at most.
std::vector<Voxel> brighten(stage::Stage& stage, vtkImageData* image, reference::Random& random)
{
  std::vector<Voxel> bright;
  for (int tries = 0; tries < 10000 && bright.size() < 12; ++tries)
  {
    const Voxel voxel = { random.uniform(4, 35), random.uniform(4, 39), random.uniform(4, 43) };
    const auto place = [&](const Voxel& v) {
      return shownAt(stage, worldOf(stage, image, { double(v[0]), double(v[1]), double(v[2]) }));
    };
    const Point shown = place(voxel);
    const double width = widthOf(stage, image, voxel);
    bool isAlone = shown[0] > 30.0 + width && shown[0] < 285.0 - width && shown[1] > 13.0 + width &&
      shown[1] < 260.0 - width;
    for (const Voxel& other : bright)
    {
      const Point at = place(other);
      const double reach = 3.0 * std::max(width, widthOf(stage, image, other));
      isAlone = isAlone && std::hypot(at[0] - shown[0], at[1] - shown[1]) > reach;
    }
    if (isAlone)
    {
      bright.push_back(voxel);
      const int* const extent = image->GetExtent();
      image->SetScalarComponentFromDouble(
        voxel[0] + extent[0], voxel[1] + extent[2], voxel[2] + extent[4], 0, 255.0);
    }
  }
  image->Modified();
  return bright;
}

/// Whether one of the pixels that show the voxel picks it. A ray of the shear image passes within
/// half a voxel of its middle, and one of these pixels is the nearest to that ray.
bool isPicked(stage::Stage& stage, vtkImageData* image, vtkSplattingMIPVolumeMapper* mapper,
  const Arrays& arrays, const Voxel& voxel)
{
  const Point world =
    worldOf(stage, image, { double(voxel[0]), double(voxel[1]), double(voxel[2]) });
  const Point shown = shownAt(stage, world);
  const double* const spacing = image->GetSpacing();
  const double voxelSize = 1.3 * std::max({ spacing[0], spacing[1], spacing[2] });
  const double width = widthOf(stage, image, voxel);
  for (int y = static_cast<int>(std::floor(shown[1] - 0.5 * width));
       y <= shown[1] + 0.5 * width + 1.0; ++y)
  {
    for (int x = static_cast<int>(std::floor(shown[0] - 0.5 * width));
         x <= shown[0] + 0.5 * width + 1.0; ++x)
    {
      Point picked;
      if (mapper->PickWorldPosition(x, y, picked.data()) && arrays.voxel(x, y) == voxel &&
        distance(picked, world) < 1.5 * voxelSize)
      {
        return true;
      }
    }
  }
  return false;
}

/// Whether arrays and picks name the same places for many pixels of the viewport, on their rays.
bool agree(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, const Arrays& arrays)
{
  int samples = 0;
  bool consistent = true;
  for (int y = 13; y < 260; y += 3)
  {
    for (int x = 30; x < 285; x += 3)
    {
      Point picked;
      const bool has = mapper->PickWorldPosition(x, y, picked.data());
      const vtkIdType n = arrays.at(x, y);
      Point position;
      arrays.positions->GetTuple(n, position.data());
      const double depth = arrays.depths->GetComponent(n, 0);
      if (!has)
      {
        consistent =
          consistent && arrays.voxel(x, y)[0] == -1 && std::isnan(position[0]) && std::isnan(depth);
        continue;
      }
      ++samples;
      const Point shown = shownAt(stage, picked);
      consistent = consistent && position == picked && std::abs(shown[0] - x) < 1e-3 &&
        std::abs(shown[1] - y) < 1e-3 &&
        std::abs(depth - depthOf(stage, picked)) < 1e-4 * std::abs(depth);
    }
  }
  return consistent && samples > 500;
}

/// Bright voxels in noise, seen from anywhere: they are picked where they are seen.
void testBrightVoxels(
  reference::Checks& check, int mode, double viewAngle, reference::Random& random)
{
  const auto image =
    stage::toImageData(reference::uniformNoise<std::uint8_t>({ 40, 44, 48 }, random, 0, 20));
  coretesting::placeAtRandom(image, random, false);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityMode(mode);
  mapper->RecordLocationsOn();
  mapper->AutoAdjustSampleDistancesOff();
  stage::Stage stage(300, 260);
  stage.show(mapper);
  stage.volume->RotateX(30.0);
  stage.volume->SetScale(1.3);
  stage.viewAngle = viewAngle;
  const stage::Vector direction = { random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
    random.uniform(0.1, 1.0) };
  stage.look(direction, { 0.1, 1.0, 0.2 });
  stage.renderer->SetViewport(0.1, 0.05, 0.95, 1.0);
  const std::vector<Voxel> bright = brighten(stage, image, random);
  stage.window->Render();
  const Arrays arrays(mapper->GetLocations());
  const std::string what = std::string(ModeNames[mode]) + " at " + std::to_string(viewAngle);
  check(bright.size() >= 6, what, ": there is room for bright voxels.");
  for (const Voxel& voxel : bright)
  {
    check(isPicked(stage, image, mapper, arrays, voxel), what, ": bright voxel ", voxel[0], " ",
      voxel[1], " ", voxel[2], " is picked.");
  }
  check(agree(stage, mapper, arrays), what, ": arrays and picks agree, on the pixels' rays.");
  const int* const extent = arrays.image->GetExtent();
  check(extent[0] == 30 && extent[1] == 284 && extent[2] == 13 && extent[3] == 259, what,
    ": the extent is the viewport.");
  Point untouched = { 1.0, 2.0, 3.0 };
  check(!mapper->PickWorldPosition(2, 2, untouched.data()) &&
      !mapper->PickWorldPosition(-5, 9999, untouched.data()) && untouched[2] == 3.0,
    what, ": there is nothing outside the viewport.");
}

/// Turned about, the nearest of equal voxels is another one, although the shear image is the same.
void testOtherSide(reference::Checks& check)
{
  reference::Volume<std::uint8_t> volume({ 20, 20, 20 }, 0);
  volume.at(Voxel{ 10, 10, 3 }) = volume.at(Voxel{ 10, 10, 16 }) = 200;
  const auto image = stage::toImageData(volume);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToPreview();
  mapper->RecordLocationsOn();
  mapper->CullBelowWindowOn();
  stage::Stage stage(101, 101);
  stage.show(mapper);
  for (int side = 0; side < 2; ++side)
  {
    stage.look({ 0.0, 0.0, side ? -1.0 : 1.0 }, { 0.0, 1.0, 0.0 });
    stage.window->Render();
    const Point shown = shownAt(stage, { 10.0, 10.0, 3.0 });
    Point picked = { 0.0, 0.0, 0.0 };
    mapper->PickWorldPosition(static_cast<int>(std::lround(shown[0])),
      static_cast<int>(std::lround(shown[1])), picked.data());
    check(std::abs(picked[2] - (side ? 16.0 : 3.0)) < 1e-6, "From each side the nearest one.");
  }
}

/// Pixels that geometry hides have no location.
void testHidden(reference::Checks& check)
{
  reference::Volume<std::uint8_t> volume({ 30, 30, 30 }, 50);
  volume.at(Voxel{ 15, 15, 5 }) = 250;
  const auto image = stage::toImageData(volume);
  const auto mapper = stage::splatting(image);
  mapper->RecordLocationsOn();
  stage::Stage stage(121, 121);
  stage.show(mapper);
  stage.look({ 0.0, 0.0, 1.0 }, { 0.0, 1.0, 0.0 }, 0.8);
  const Point shown = shownAt(stage, { 15.0, 15.0, 5.0 });
  const int x = static_cast<int>(std::lround(shown[0])),
            y = static_cast<int>(std::lround(shown[1]));
  stage.window->Render();
  Point picked = { 0.0, 0.0, 0.0 };
  check(mapper->PickWorldPosition(x, y, picked.data()) && std::abs(picked[2] - 5.0) < 1e-4,
    "The largest is picked.");
  vtkNew<vtkSphereSource> source;
  source->SetCenter(15.0, 15.0, -4.0);
  source->SetRadius(2.0);
  vtkNew<vtkPolyDataMapper> polyMapper;
  polyMapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(polyMapper);
  stage.renderer->AddActor(actor);
  stage.renderer->ResetCameraClippingRange();
  stage.window->Render();
  check(!mapper->PickWorldPosition(x, y, picked.data()), "What is hidden is not picked.");
  check(Arrays(mapper->GetLocations()).voxel(x, y)[0] == -1, "Nor is it in the arrays.");
}

void testSentences(reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 34, 34, 34 }, 3));
  const auto mapper = stage::splatting(image);
  stage::Stage stage(80, 80);
  stage.show(mapper);
  stage.look({ 0.0, 0.0, 1.0 }, { 0.0, 1.0, 0.0 });
  stage.window->Render();
  double position[3];
  {
    stage::Messages errors(mapper, vtkCommand::ErrorEvent);
    check(!mapper->GetLocations() && errors.texts.size() == 1,
      "Without RecordLocations there is a sentence.");
    check(
      mapper->PickWorldPosition(40, 40, position) && errors.texts.size() == 1, "Picks do without.");
  }
  mapper->WriteDepthOn();
  stage.window->Render();
  check(stage.window->GetZbufferDataAtPoint(40, 40) < 1.0f, "So do depths that are written.");
  mapper->WriteDepthOff();
  mapper->RecordLocationsOn();
  stage.window->Render();
  check(mapper->PickWorldPosition(40, 40, position), "It works once it is on.");
  const vtkIdType projections = mapper->GetNumberOfProjections();
  stage.window->Render();
  check(mapper->GetNumberOfProjections() == projections, "Frames that show the same re-use it.");
  mapper->SetBlendModeToAverageIntensity();
  {
    stage::Messages warnings(mapper, vtkCommand::WarningEvent);
    stage.window->Render();
    stage.window->Render();
    check(warnings.texts.size() == 1, "Averages are warned of, once.");
  }
  check(!mapper->PickWorldPosition(40, 40, position), "Averages have no location.");
  const Arrays arrays(mapper->GetLocations());
  check(arrays.voxel(40, 40)[0] == -1, "Nor voxels.");
  mapper->SetBlendModeToMaximumIntensity();
  stage.window->Render();
  check(mapper->PickWorldPosition(40, 40, position), "Maxima have one again.");
}
}

//------------------------------------------------------------------------------
int TestLocations(int, char*[])
{
  reference::Checks check;
  reference::forScenes("bright voxels", 12,
    [&](int n, reference::Random& random)
    { testBrightVoxels(check, n % 4, n / 4 % 2 ? 40.0 : 0.0, random); });
  testOtherSide(check);
  testHidden(check);
  testSentences(check);
  return check.exitCode();
}
