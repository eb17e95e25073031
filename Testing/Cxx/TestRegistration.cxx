// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture must lie where VTK's ray casters put it, whatever the camera, spacing, origin,
// extent, direction and prop matrix. Half a voxel is up to a pixel here, so that such a mistake is
// out of the bounds by far; half a pixel is too.
#include "Stage.h"
#include "Traversal.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTransform.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>

namespace
{
constexpr int Width = 231;
constexpr int Height = 208;
constexpr int Cameras = 100;
constexpr int TurnedCameras = 16; // with direction matrices
constexpr int ExactCameras = 30;  // in perspective, beside an exact traversal

struct Mode
{
  int value;
  const char* name;
  double shift; // in pixels
  double psnr;
  double ssim;
};

using Modes = std::array<Mode, 3>;

// Shift: vtkFixedPointVolumeRayCastMapper itself lies up to 0.06 pixel off the GPU's ray caster,
// with which the averages agree to 0.03. A preview shows each structure at the voxel that the ray
// crosses, up to half a voxel off; over many structures that averages out, to 0.13 pixel at most.
// PSNR and SSIM: measured minimum less 1 dB and less 0.002. What remains is the difference between
// averages, or the largest voxel, and point samples at the soft rims.
const Modes fixedPointBounds = { {
  { vtkSplattingMIPVolumeMapper::PREVIEW, "preview", 0.15, 32.5, 0.982 },
  { vtkSplattingMIPVolumeMapper::STANDARD, "standard", 0.1, 40.9, 0.993 },
  { vtkSplattingMIPVolumeMapper::HIGH, "high", 0.1, 37.4, 0.9915 },
} };
const Modes gpuBounds = { {
  { vtkSplattingMIPVolumeMapper::PREVIEW, "preview", 0.15, 36.2, 0.9915 },
  { vtkSplattingMIPVolumeMapper::STANDARD, "standard", 0.03, 47.2, 0.997 },
  { vtkSplattingMIPVolumeMapper::HIGH, "high", 0.04, 43.1, 0.997 },
} };

// In perspective shifts are in pixels, or in shares of a voxel in the volume's middle where that is
// wider: an eye inside the volume sees voxels up to 40 pixels wide. The GPU's ray caster is the
// truth, for previews with nearest interpolation: edges of voxels near the eye are not where
// interpolated ones are. It agrees to 0.10 with previews, to 0.05 with averages.
// vtkFixedPointVolumeRayCastMapper lies up to 0.22 off it, and as much off what is splatted; with
// nearest interpolation it would be up to two voxels off both.
const Modes perspectiveFixedPointBounds = { {
  { vtkSplattingMIPVolumeMapper::PREVIEW, "preview", 0.37, 25.6, 0.888 },
  { vtkSplattingMIPVolumeMapper::STANDARD, "standard", 0.24, 35.7, 0.960 },
  { vtkSplattingMIPVolumeMapper::HIGH, "high", 0.24, 34.6, 0.981 },
} };
const Modes perspectiveGpuBounds = { {
  { vtkSplattingMIPVolumeMapper::PREVIEW, "preview", 0.15, 32.4, 0.876 },
  { vtkSplattingMIPVolumeMapper::STANDARD, "standard", 0.07, 36.5, 0.961 },
  { vtkSplattingMIPVolumeMapper::HIGH, "high", 0.04, 34.1, 0.981 },
} };

/// The least alike and the mean over many views.
struct Summary
{
  int views = 0;
  double shift = 0.0;
  double shiftSum = 0.0;
  double psnr = 1e9;
  double psnrSum = 0.0;
  double ssim = 1.0;
  double ssimSum = 0.0;

  /// Shifts are measured in units of so many pixels.
  void add(const stage::Likeness& likeness, double unit = 1.0)
  {
    ++this->views;
    const double shifted = likeness.largestShift() / unit;
    this->shift = std::max(this->shift, shifted);
    this->shiftSum += shifted;
    this->psnr = std::min(this->psnr, likeness.psnr);
    this->psnrSum += likeness.psnr;
    this->ssim = std::min(this->ssim, likeness.ssim);
    this->ssimSum += likeness.ssim;
  }

  void print(const std::string& what) const
  {
    std::cout << what << ", " << this->views << " views: shift max " << this->shift << " mean "
              << this->shiftSum / this->views << " pixel, PSNR min " << this->psnr << " mean "
              << this->psnrSum / this->views << " dB, SSIM min " << this->ssim << " mean "
              << this->ssimSum / this->views << std::endl;
  }
};

stage::Vector randomDirection(reference::Random& random)
{
  stage::Vector direction;
  do
  {
    for (double& component : direction)
    {
      component = random.uniform(-1.0, 1.0);
    }
  } while (vtkMath::Norm(direction.data()) > 1.0 || vtkMath::Norm(direction.data()) < 0.1);
  return direction;
}

/// Rotation, scales that differ and every other time a reflection.
void turnPropAtRandom(vtkVolume* volume, reference::Random& random)
{
  const stage::Vector axis = randomDirection(random);
  vtkNew<vtkTransform> transform;
  transform->Translate(random.uniform(-50.0, 50.0), 10.0, -20.0);
  transform->RotateWXYZ(random.uniform(0.0, 360.0), axis.data());
  transform->Scale(random.uniform(0.8, 1.2) * (random.uniform(0, 1) ? 1.0 : -1.0),
    random.uniform(0.8, 1.2), random.uniform(0.8, 1.2));
  transform->RotateWXYZ(random.uniform(0.0, 360.0), axis[1], axis[2], axis[0]);
  volume->SetUserTransform(transform);
}

/// A rotation and, if wanted, a reflection of the image's first axis.
vtkSmartPointer<vtkMatrix4x4> randomTurn(reference::Random& random, bool mirrored)
{
  const stage::Vector axis = randomDirection(random);
  vtkNew<vtkTransform> turn;
  turn->RotateWXYZ(random.uniform(0.0, 360.0), axis.data());
  turn->Scale(mirrored ? -1.0 : 1.0, 1.0, 1.0);
  return turn->GetMatrix();
}

void setDirection(vtkImageData* image, vtkMatrix4x4* turn)
{
  vtkNew<vtkMatrix3x3> direction;
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      direction->SetElement(r, c, turn->GetElement(r, c));
    }
  }
  image->SetDirectionMatrix(direction);
}

/// Has the prop turn the image about its origin, as a direction matrix does.
void turnProp(vtkVolume* volume, const double origin[3], vtkMatrix4x4* turn)
{
  vtkNew<vtkTransform> transform;
  transform->SetMatrix(volume->GetUserMatrix());
  transform->Translate(origin);
  transform->Concatenate(turn);
  transform->Translate(-origin[0], -origin[1], -origin[2]);
  volume->SetUserTransform(transform);
}

void lookAtRandom(stage::Stage& stage, reference::Random& random)
{
  stage.look(randomDirection(random), randomDirection(random), random.uniform(0.75, 0.95));
  // Off the middle, by other than whole pixels.
  stage.renderer->GetActiveCamera()->SetWindowCenter(
    random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06));
}

/// A place inside the volume with nothing but background within three voxels: ray casters begin at
/// the eye, splatting with the slice before it.
void findDarkPlace(
  stage::Stage& stage, vtkImageData* image, reference::Random& random, double* place)
{
  const int* const extent = image->GetExtent();
  int ijk[3];
  bool isDark = false;
  while (!isDark)
  {
    for (int a = 0; a < 3; ++a)
    {
      ijk[a] = random.uniform(extent[2 * a] + 3, extent[2 * a + 1] - 3);
    }
    isDark = true;
    for (int n = 0; n < 343; ++n)
    {
      isDark &= image->GetScalarComponentAsDouble(
                  ijk[0] + n % 7 - 3, ijk[1] + n / 7 % 7 - 3, ijk[2] + n / 49 - 3, 0) == 0.0;
    }
  }
  double point[4] = { 0.0, 0.0, 0.0, 1.0 };
  const double inside[3] = { ijk[0] + 0.2, ijk[1] + 0.4, ijk[2] - 0.3 };
  image->TransformContinuousIndexToPhysicalPoint(inside, point);
  stage.volume->GetMatrix()->MultiplyPoint(point, point);
  std::copy_n(point, 3, place);
}

/// In perspective: the eye outside the volume or, every third time, inside it.
void lookInPerspective(
  stage::Stage& stage, vtkImageData* image, int camera, reference::Random& random)
{
  stage.viewAngle = random.uniform(5.0, 120.0);
  lookAtRandom(stage, random);
  if (camera % 3 == 2)
  {
    double eye[3];
    findDarkPlace(stage, image, random, eye);
    stage.renderer->GetActiveCamera()->SetPosition(eye);
  }
  stage.renderer->ResetCameraClippingRange();
}

/// A quarter of a voxel at most, in the world.
double fineDistance(vtkImageData* image)
{
  const double* spacing = image->GetSpacing();
  return 0.25 * 0.8 * *std::min_element(spacing, spacing + 3);
}

reference::Image<double> pictureOf(stage::Stage& stage, vtkVolumeMapper* mapper)
{
  stage.volume->SetMapper(mapper);
  reference::Image<double> picture = stage.gray();
  stage.volume->SetMapper(nullptr);
  mapper->ReleaseGraphicsResources(stage.window);
  return picture;
}

/// The voxels themselves, as previews show them.
reference::Image<double> pictureOfVoxels(stage::Stage& stage, vtkVolumeMapper* mapper)
{
  stage.volume->GetProperty()->SetInterpolationTypeToNearest();
  reference::Image<double> picture = pictureOf(stage, mapper);
  stage.volume->GetProperty()->SetInterpolationTypeToLinear();
  return picture;
}

class Comparison
{
public:
  explicit Comparison(const Modes& modes) : Bounds(modes) {}

  void add(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
    const reference::Image<double>& truth, double unit = 1.0)
  {
    this->add(stage, mapper, truth, truth, unit);
  }

  /// With a truth of their own for previews.
  void add(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
    const reference::Image<double>& voxels, const reference::Image<double>& field, double unit)
  {
    for (const Mode& mode : this->Bounds)
    {
      mapper->SetQualityMode(mode.value);
      const bool isPreview = mode.value == vtkSplattingMIPVolumeMapper::PREVIEW;
      this->Summaries[mode.value].add(
        stage::Likeness(isPreview ? voxels : field, pictureOf(stage, mapper)), unit);
    }
  }

  void judge(stage::Checks& check, const std::string& rayCaster) const
  {
    for (const Mode& mode : this->Bounds)
    {
      const Summary& found = this->Summaries[mode.value];
      const std::string what = std::string(mode.name) + " and " + rayCaster;
      found.print(what);
      check(found.shift <= mode.shift, what + ": no view is shifted by more than the bound.");
      check(found.psnr >= mode.psnr, what + ": PSNR.");
      check(found.ssim >= mode.ssim, what + ": SSIM.");
    }
  }

private:
  Modes Bounds;
  Summary Summaries[3];
};

/// The prop's matrix turns and mirrors the volume; vtkFixedPointVolumeRayCastMapper is the truth.
void testPropMatrices(stage::Stage& stage, vtkImageData* image, stage::Checks& check)
{
  reference::Random random(7);
  Comparison comparison(fixedPointBounds);
  for (int camera = 0; camera < Cameras; ++camera)
  {
    stage::placeAtRandom(image, random);
    const auto mapper = stage::splatting(image);
    stage.show(mapper);
    turnPropAtRandom(stage.volume, random);
    lookAtRandom(stage, random);
    comparison.add(
      stage, mapper, pictureOf(stage, stage::fixedPointRayCaster(image, fineDistance(image))));
  }
  comparison.judge(check, "the fixed-point ray caster");
}

/// How large a voxel is seen in the middle of the volume, along its shortest edge.
double pixelsPerVoxel(stage::Stage& stage, vtkImageData* image)
{
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  const double height = 2.0 * camera->GetDistance() *
    std::tan(0.5 * vtkMath::RadiansFromDegrees(camera->GetViewAngle()));
  const double* const spacing = image->GetSpacing();
  return Height / height * *std::min_element(spacing, spacing + 3);
}

/// From the viewport, with depths from -1 to 1, to the volume's voxels.
vtkSmartPointer<vtkMatrix4x4> clipToVoxels(stage::Stage& stage, vtkImageData* image)
{
  const auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  vtkMatrix4x4::Multiply4x4(stage.volume->GetMatrix(), image->GetIndexToPhysicalMatrix(), matrix);
  vtkMatrix4x4::Multiply4x4(
    stage.renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
      stage.renderer->GetTiledAspectRatio(), -1.0, 1.0),
    matrix, matrix);
  matrix->Invert();
  return matrix;
}

/// The largest voxel of those that the ray from the eye through the middle of each pixel crosses.
reference::Image<double> exactPreview(
  stage::Stage& stage, const reference::Volume<std::uint8_t>& volume, vtkImageData* image)
{
  const auto toVoxels = clipToVoxels(stage, image);
  const auto place = [&](double x, double y, double z, int axis)
  {
    double p[4] = { x, y, z, 1.0 };
    toVoxels->MultiplyPoint(p, p);
    return p[axis] / p[3] - image->GetExtent()[2 * axis];
  };
  const double* const eye = stage.renderer->GetActiveCamera()->GetPosition();
  vtkNew<vtkMatrix4x4> toIndex;
  vtkMatrix4x4::Multiply4x4(stage.volume->GetMatrix(), image->GetIndexToPhysicalMatrix(), toIndex);
  toIndex->Invert();
  double start[4] = { eye[0], eye[1], eye[2], 1.0 };
  toIndex->MultiplyPoint(start, start);
  reference::Image<double> picture(Width, Height);
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      std::array<reference::AxisMotion, 3> ray;
      for (int a = 0; a < 3; ++a)
      {
        const double begin = start[a] - image->GetExtent()[2 * a];
        const double end =
          place((2.0 * x + 1.0) / Width - 1.0, (2.0 * y + 1.0) / Height - 1.0, 1.0, a);
        ray[a].start = std::llround(std::ldexp(begin, 34));
        ray[a].velocity = std::llround(std::ldexp(end - begin, 34));
      }
      double largest = 0.0;
      for (const std::array<int, 3>& p : reference::traverse(ray, 1, volume.size))
      {
        largest = std::max<double>(largest, volume.at(p[0], p[1], p[2]));
      }
      picture.at(x, y) = largest;
    }
  }
  return picture;
}

/// Perspective views, beside both ray casters and, for previews, what they are defined by.
void testPerspective(stage::Stage& stage, const reference::Volume<std::uint8_t>& volume,
  vtkImageData* image, stage::Checks& check)
{
  reference::Random random(10);
  Comparison fixedPoint(perspectiveFixedPointBounds), gpu(perspectiveGpuBounds);
  Summary rayCasters, exact;
  for (int camera = 0; camera < Cameras; ++camera)
  {
    stage::placeAtRandom(image, random);
    const auto mapper = stage::splatting(image);
    stage.show(mapper);
    turnPropAtRandom(stage.volume, random);
    lookInPerspective(stage, image, camera, random);
    const double distance = fineDistance(image);
    const auto truth = pictureOf(stage, stage::fixedPointRayCaster(image, distance));
    const auto other = pictureOf(stage, stage::gpuRayCaster(image, distance));
    const double unit = std::max(1.0, pixelsPerVoxel(stage, image));
    rayCasters.add(stage::Likeness(truth, other), unit);
    fixedPoint.add(stage, mapper, truth, unit);
    const auto voxels = pictureOfVoxels(stage, stage::gpuRayCaster(image, distance));
    gpu.add(stage, mapper, voxels, other, unit);
    if (camera < ExactCameras)
    {
      const reference::Image<double> traversal = exactPreview(stage, volume, image);
      mapper->SetQualityModeToPreview();
      exact.add(stage::Likeness(traversal, pictureOf(stage, mapper)), unit);
    }
  }
  stage.viewAngle = 0.0;
  rayCasters.print("For orientation, the two ray casters in perspective");
  exact.print("preview and an exact traversal in perspective");
  check(exact.shift <= 0.15, "The preview lies where an exact traversal does.");
  check(exact.psnr >= 32.5 && exact.ssim >= 0.881, "The preview is like an exact traversal.");
  fixedPoint.judge(check, "the fixed-point ray caster in perspective");
  gpu.judge(check, "the GPU ray caster in perspective");
}

/// How well the truths agree with each other.
void compareRayCasters(stage::Stage& stage, vtkImageData* image)
{
  reference::Random random(8);
  Summary summary;
  for (int camera = 0; camera < TurnedCameras; ++camera)
  {
    stage::placeAtRandom(image, random);
    stage.show(stage::splatting(image));
    turnPropAtRandom(stage.volume, random);
    lookAtRandom(stage, random);
    const double distance = fineDistance(image);
    const auto gpu = pictureOf(stage, stage::gpuRayCaster(image, distance));
    summary.add(
      stage::Likeness(gpu, pictureOf(stage, stage::fixedPointRayCaster(image, distance))));
  }
  summary.print("For orientation, the two ray casters");
}

/// The image's own matrix turns the volume, and the prop's besides.
/// vtkFixedPointVolumeRayCastMapper ignores direction matrices and the GPU's ray caster draws
/// nothing where they mirror (VTK 9.1), so the truth of every other view has the matrix in the
/// prop.
void testDirectionMatrices(stage::Stage& stage, vtkImageData* image, stage::Checks& check)
{
  reference::Random random(9);
  Comparison comparison(gpuBounds);
  for (int camera = 0; camera < TurnedCameras; ++camera)
  {
    stage::placeAtRandom(image, random);
    vtkNew<vtkImageData> turned;
    turned->ShallowCopy(image);
    const bool mirrored = camera % 2 == 1;
    const vtkSmartPointer<vtkMatrix4x4> turn = randomTurn(random, mirrored);
    setDirection(turned, turn);
    const auto mapper = stage::splatting(turned);
    stage.show(mapper);
    turnPropAtRandom(stage.volume, random);
    lookAtRandom(stage, random);
    vtkNew<vtkMatrix4x4> propMatrix;
    propMatrix->DeepCopy(stage.volume->GetUserMatrix());
    if (mirrored)
    {
      turnProp(stage.volume, image->GetOrigin(), turn);
    }
    const auto truth =
      pictureOf(stage, stage::gpuRayCaster(mirrored ? image : turned, fineDistance(image)));
    stage.volume->SetUserMatrix(propMatrix);
    comparison.add(stage, mapper, truth);
  }
  comparison.judge(check, "the GPU ray caster, with direction matrices");
}
}

//------------------------------------------------------------------------------
int TestRegistration(int, char*[])
{
  stage::Checks check;
  const auto volume = stage::blobsAndTubes({ 72, 80, 88 }, 60);
  const auto image = stage::toImageData(volume);
  stage::Stage stage(Width, Height);
  testPropMatrices(stage, image, check);
  compareRayCasters(stage, image);
  testPerspective(stage, volume, image, check);
  testDirectionMatrices(stage, image, check);
  return check.exitCode();
}
