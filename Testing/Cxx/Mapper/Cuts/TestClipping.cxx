// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Planes through the volume, the camera's and the mapper's: which samples they leave, and pictures
// beside VTK's ray caster. And volumes that are one voxel thick.
#include "CoreTesting.h"
#include "MapperOracle.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

namespace
{
constexpr int Width = 210;
constexpr int Height = 190;

const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { 0.3, 0.4, -0.8 }, { -0.8, 0.3, 0.4 }, { 0.2, -0.9, 0.3 } };

/// Along every principal axis the picture must be that of the ray caster, and not that without
/// planes. A plane takes away whole slices' shares of a ray, so that pictures differ along the cut.
/// Measured: 38.9 dB, 0.9916 and 0.14 pixel at worst.
void compare(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image,
  const std::string& what, reference::Checks& check)
{
  // An eye in the volume sees voxels many pixels wide, and what averages take from them: 36.0 dB
  // and 0.9855; VTK's ray casters have 44 dB and 0.995 to each other there.
  const bool magnifies = stage.viewAngle > 0.0 && what == "Camera inside";
  const auto rayCaster = stage::fixedPointRayCaster(image, 0.25);
  rayCaster->SetClippingPlanes(mapper->GetClippingPlanes());
  stage.show(rayCaster);
  const reference::Image<double> truth = stage.gray();
  stage.show(mapper);
  const stage::Likeness likeness(truth, stage.gray());
  std::cout << what << ": " << likeness.text() << std::endl;
  check(likeness.psnr > (magnifies ? 35.0 : 37.0), what, ": PSNR.");
  check(likeness.ssim > (magnifies ? 0.9835 : 0.99), what, ": SSIM.");
  check(likeness.largestShift() < 0.2, what, ": shift.");
}

/// How far the cut picture is from the whole one, as PSNR: it must be visibly another.
void checkThatSomethingIsCut(
  const reference::Image<double>& whole, stage::Stage& stage, reference::Checks& check)
{
  check(reference::psnr(whole, stage.gray(), 255.0) < 34.0, "Something is cut away.");
}

void testClippingRange(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
  vtkImageData* image, reference::Checks& check)
{
  for (const stage::Vector& direction : directions)
  {
    stage.show(mapper);
    stage.look(direction, up);
    const reference::Image<double> whole = stage.gray();
    vtkCamera* const camera = stage.renderer->GetActiveCamera();
    const double middle = camera->GetDistance();
    camera->SetClippingRange(middle - 2.3, middle + 1000.0);
    compare(stage, mapper, image, "Near plane", check);
    checkThatSomethingIsCut(whole, stage, check);
    camera->SetClippingRange(1.0, middle - 1.7);
    compare(stage, mapper, image, "Far plane", check);
    checkThatSomethingIsCut(whole, stage, check);
  }
}

/// The camera in the middle of the volume sees what is before it. In perspective it is near a
/// corner, where the volume is dark: what counts there is a matter of half a slice.
void testCameraInside(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image,
  reference::Checks& check)
{
  for (const stage::Vector& direction : directions)
  {
    stage.show(mapper);
    stage.look(direction, up);
    vtkCamera* const camera = stage.renderer->GetActiveCamera();
    double focus[3], eye[3];
    image->GetCenter(eye);
    vtkMath::Add(eye, direction.data(), focus);
    for (int a = 0; a < 3 && stage.viewAngle > 0.0; ++a)
    {
      eye[a] = direction[a] > 0.0 ? 3.0 : image->GetDimensions()[a] - 4.0;
      focus[a] = image->GetCenter()[a];
    }
    camera->SetPosition(eye);
    camera->SetFocalPoint(focus);
    camera->SetClippingRange(0.1, 1000.0);
    compare(stage, mapper, image, "Camera inside", check);
  }
}

void testClippingPlanes(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
  vtkImageData* image, reference::Checks& check)
{
  // In the world, where the volume is turned and moved.
  stage.volume->SetOrientation(10.0, 20.0, 30.0);
  stage.volume->SetPosition(5.0, -8.0, 12.0);
  for (const stage::Vector& direction : directions)
  {
    stage.show(mapper);
    stage.look(direction, up);
    const reference::Image<double> whole = stage.gray();
    for (const stage::Vector& normal : { stage::Vector{ 0.9, 0.3, 0.2 }, { -0.2, -0.1, 0.9 } })
    {
      vtkNew<vtkPlane> plane;
      plane->SetOrigin(stage.volume->GetCenter());
      plane->SetNormal(normal.data());
      plane->Push(-3.0);
      mapper->AddClippingPlane(plane);
      compare(stage, mapper, image, "Clipping planes", check);
      checkThatSomethingIsCut(whole, stage, check);
    }
    mapper->RemoveAllClippingPlanes();
    check(stage.gray().value == whole.value, "Without planes the volume is whole again.");
  }
  stage.volume->SetOrientation(0.0, 0.0, 0.0);
  stage.volume->SetPosition(0.0, 0.0, 0.0);
}

/// What a plane of the world leaves, in index space.
std::array<double, 4> halfSpaceOf(
  vtkVolume* volume, vtkImageData* image, const stage::Vector& origin, const stage::Vector& normal)
{
  vtkNew<vtkMatrix4x4> toWorld;
  vtkMatrix4x4::Multiply4x4(volume->GetMatrix(), image->GetIndexToPhysicalMatrix(), toWorld);
  const double plane[4] = { normal[0], normal[1], normal[2],
    -vtkMath::Dot(normal.data(), origin.data()) };
  std::array<double, 4> halfSpace{};
  for (int n = 0; n < 16; ++n)
  {
    halfSpace[n % 4] += plane[n / 4] * toWorld->GetElement(n / 4, n % 4);
  }
  for (int a = 0; a < 3; ++a)
  {
    halfSpace[3] += halfSpace[a] * image->GetExtent()[2 * a];
  }
  return halfSpace;
}

/// Half-spaces that hold all voxels cut nothing, not even where rays run beside the volume.
void forgetIdlePlanes(
  const std::array<int, 3>& size, std::vector<std::array<double, 4>>& halfSpaces)
{
  const auto holdsAll = [&](const std::array<double, 4>& h)
  {
    double least = h[3];
    for (int a = 0; a < 3; ++a)
    {
      least += std::min(-0.5 * h[a], (size[a] - 0.5) * h[a]);
    }
    return least >= 0.0;
  };
  halfSpaces.erase(
    std::remove_if(halfSpaces.begin(), halfSpaces.end(), holdsAll), halfSpaces.end());
}

void turnAtRandom(vtkVolume* volume, reference::Random& random)
{
  stage::Vector angles, scales;
  for (int a = 0; a < 3; ++a)
  {
    angles[a] = random.uniform(0.0, 360.0);
    scales[a] = random.uniform(0.7, 1.4);
  }
  volume->SetOrientation(angles.data());
  volume->SetScale(scales.data());
  stage::Vector place = stage::anyDirection(random);
  vtkMath::MultiplyScalar(place.data(), 50.0);
  volume->SetPosition(place.data());
}

/// Sets the camera's planes as far before and behind the middle of the volume as it reaches, or
/// nearer, and returns what they leave in index space.
std::vector<std::array<double, 4>> clipAtRandom(stage::Stage& stage, vtkImageData* image,
  const stage::Vector& direction, double reach, reference::Random& random)
{
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  const double middle = camera->GetDistance();
  double range[2];
  range[0] = middle + reach * random.uniform(-1.0, 0.3);
  range[1] = std::max(middle + reach * random.uniform(-0.3, 1.0), range[0] + 0.1);
  camera->SetClippingRange(range);
  stage::Vector near, far, backwards;
  for (int a = 0; a < 3; ++a)
  {
    near[a] = camera->GetPosition()[a] + range[0] * direction[a];
    far[a] = camera->GetPosition()[a] + range[1] * direction[a];
    backwards[a] = -direction[a];
  }
  return { halfSpaceOf(stage.volume, image, near, direction),
    halfSpaceOf(stage.volume, image, far, backwards) };
}

/// Whatever planes there are, the camera's among them, shear images of previews have the samples
/// that they leave, and no others.
void testSamples(reference::Checks& check)
{
  coretesting::Sightings cut;
  reference::forScenes("samples", 100,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int& voxels : size)
      {
        voxels = random.uniform(1, 20);
      }
      const auto volume = reference::uniformNoise<std::uint8_t>(size, random);
      const auto image = stage::toImageData(volume);
      coretesting::placeAtRandom(image, random, false);
      const auto mapper = stage::splatting(image);
      mapper->SetQualityModeToPreview();
      mapper->SetMaximumType(random.uniform(0, 2));
      mapper->SetLocalMaximumThreshold(200.0);
      n % 3 == 0 ? mapper->SetBlendModeToMinimumIntensity()
                 : mapper->SetBlendModeToMaximumIntensity();
      stage::Stage stage(Width, Height);
      stage.show(mapper);
      turnAtRandom(stage.volume, random);
      const stage::Vector direction = stage::anyDirection(random);
      const stage::Vector up = stage::anyDirection(random);
      stage.look(direction, up);
      const double reach = 0.6 * stage.volume->GetLength();
      std::vector<std::array<double, 4>> halfSpaces =
        clipAtRandom(stage, image, direction, reach, random);
      for (int planes = random.uniform(0, 3); planes > 0; --planes)
      {
        stage::Vector origin = stage::anyDirection(random);
        vtkMath::MultiplyScalar(origin.data(), 0.3 * reach * random.uniform(0.0, 1.0));
        vtkMath::Add(origin.data(), stage.volume->GetCenter(), origin.data());
        const stage::Vector normal = stage::anyDirection(random);
        vtkNew<vtkPlane> plane;
        plane->SetOrigin(origin.data());
        plane->SetNormal(normal.data());
        mapper->AddClippingPlane(plane);
        halfSpaces.push_back(halfSpaceOf(stage.volume, image, origin, normal));
      }
      forgetIdlePlanes(size, halfSpaces);
      stage.window->Render();
      const double error = stage::shearImageError(stage, mapper, image, volume, halfSpaces);
      check(error <= stage::allowedError(mapper),
        "The shear image is that of the samples that are left: ", error);
      cut.add(stage::shearImageError(stage, mapper, image, volume) > 0.0);
    });
  check(cut.areEnough(0.3), "Something is cut away.");
}

/// The number of pixels that are not black.
int litPixels(stage::Stage& stage)
{
  const reference::Image<double> picture = stage.gray();
  return static_cast<int>(
    std::count_if(picture.value.begin(), picture.value.end(), [](double v) { return v > 0.0; }));
}

/// The picture of a box of voxels ends at voxel centres, or is as wide as a voxel. Of a convex part
/// of the plane with area A and perimeter P no more than A + P / 2 + 1 pixels have their centres
/// in it, and no fewer than A - P / 2 (Nosarzewska).
void testThinVolumes(reference::Checks& check)
{
  reference::forScenes("thin volumes", 120,
    [&](int n, reference::Random& random)
    {
      std::array<int, 3> size;
      for (int a = 0; a < 3; ++a)
      {
        const int most = random.uniform(2, 40);
        size[a] = n >> a & 1 ? most : 1;
      }
      const auto image = stage::toImageData(reference::constant<std::uint8_t>(size, 255));
      const auto mapper = stage::splatting(image);
      mapper->SetQualityMode(random.uniform(0, 3));
      stage::Stage stage(Width, Height);
      stage.show(mapper);
      stage::Vector direction = stage::anyDirection(random);
      if (random.oneIn(2))
      {
        const int axis = random.uniform(0, 2);
        const double side = random.sign();
        direction = { 0.0, 0.0, 0.0 };
        direction[axis] = side;
      }
      const stage::Vector up = stage::anyDirection(random);
      stage.look(direction, up);
      // All of it is in the window, and voxels are wider than pixels.
      const double pixelsPerVoxel = random.uniform(1.3, std::min(9.0, 180.0 / image->GetLength()));
      vtkCamera* const camera = stage.renderer->GetActiveCamera();
      camera->SetParallelScale(0.5 * Height / pixelsPerVoxel);
      stage::Vector eye; // a single voxel has no extent to look at from twice as far
      for (int a = 0; a < 3; ++a)
      {
        eye[a] = image->GetCenter()[a] - 200.0 * direction[a];
      }
      camera->SetPosition(eye.data());
      camera->SetClippingRange(1.0, 400.0);
      double area = 0.0, perimeter = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        const auto edge = [&](int b) { return pixelsPerVoxel * std::max(size[b % 3] - 1, 1); };
        area += std::abs(direction[a]) * edge(a + 1) * edge(a + 2);
        perimeter += 2.0 * edge(a) * std::sqrt(std::max(1.0 - direction[a] * direction[a], 0.0));
      }
      const int lit = litPixels(stage);
      check(lit >= area - 0.5 * perimeter - 1e-6 && lit <= area + 0.5 * perimeter + 1.0 + 1e-6,
        size[0], " x ", size[1], " x ", size[2], " voxels, ", mapper->GetQualityModeAsString(),
        ": ", lit, " pixels, not ", area);
    });
}
}

//------------------------------------------------------------------------------
int TestClipping(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  testSamples(check);
  testThinVolumes(check);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToHigh();
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testClippingRange(stage, mapper, image, check);
    testCameraInside(stage, mapper, image, check);
    testClippingPlanes(stage, mapper, image, check);
  }
  return check.exitCode();
}
