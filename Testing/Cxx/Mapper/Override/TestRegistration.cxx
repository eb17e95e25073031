// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The picture must lie where VTK's ray casters put it, whatever the camera, spacing, origin,
// extent, direction and prop matrix. Half a voxel is up to a pixel here.
//
// What parallel views show is compared with the definition, pixel by pixel; perspective views with
// the voxels near each ray.
#include "ScreenOracle.h"

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

constexpr int SomePixels = 6;  // of a view that are computed by definition, in each mode
constexpr int ManyPixels = 60; // that are compared with the voxels near their rays

using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

const char* const ModeNames[] = { "preview", "standard", "high" };

/// In pixels. Half a pixel is the least of the mistakes that are looked for: a picture that is
/// nearer to where it should be than to where such a mistake would put it.
constexpr double MostShift = 0.25;

/// Pixels. Larger shifts are not measured: pictures of few voxels, each wider than that, may be
/// nearly ramps, of which shift, gain and offset cannot be told apart.
constexpr double MostMeasured = 5.0;

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

/// Rotation, scales that differ and every other time a reflection.
void turnPropAtRandom(vtkVolume* volume, reference::Random& random)
{
  const stage::Vector axis = stage::anyDirection(random);
  const double mirror = random.sign();
  stage::Vector scale;
  for (double& factor : scale)
  {
    factor = random.uniform(0.8, 1.2);
  }
  vtkNew<vtkTransform> transform;
  transform->Translate(random.uniform(-50.0, 50.0), 10.0, -20.0);
  transform->RotateWXYZ(random.uniform(0.0, 360.0), axis.data());
  transform->Scale(mirror * scale[0], scale[1], scale[2]);
  transform->RotateWXYZ(random.uniform(0.0, 360.0), axis[1], axis[2], axis[0]);
  volume->SetUserTransform(transform);
}

/// A rotation and, if wanted, a reflection of the image's first axis.
vtkSmartPointer<vtkMatrix4x4> randomTurn(reference::Random& random, bool mirrored)
{
  const stage::Vector axis = stage::anyDirection(random);
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
  const stage::Vector direction = stage::anyDirection(random);
  const stage::Vector up = stage::anyDirection(random);
  // No pixel is wider than a voxel: pixels show points, not areas.
  vtkImageData* const image =
    vtkImageData::SafeDownCast(stage.volume->GetMapper()->GetDataSetInput());
  const double* const spacing = image->GetSpacing();
  const double* const bounds = stage.volume->GetBounds();
  const double diagonal =
    std::hypot(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]);
  double prop[3][3], u[3][3], stretches[3], v[3][3];
  for (int n = 0; n < 9; ++n)
  {
    prop[n / 3][n % 3] = stage.volume->GetMatrix()->GetElement(n / 3, n % 3);
  }
  vtkMath::SingularValueDecomposition3x3(prop, u, stretches, v);
  const double shrinks =
    std::min({ std::abs(stretches[0]), std::abs(stretches[1]), std::abs(stretches[2]) });
  const double most = Height * shrinks * *std::min_element(spacing, spacing + 3) / diagonal;
  stage.look(direction, up, std::min(random.uniform(0.75, 0.95), most));
  // Off the middle, by other than whole pixels.
  const double x = random.uniform(-0.06, 0.06);
  const double y = random.uniform(-0.06, 0.06);
  stage.renderer->GetActiveCamera()->SetWindowCenter(x, y);
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

using Pictures = std::array<reference::Image<double>, 3>; // of the modes

Pictures picturesOf(stage::Stage& stage, Mapper* mapper)
{
  Pictures pictures;
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    pictures[mode] = pictureOf(stage, mapper);
  }
  return pictures;
}

/// Whether the picture is nearer to the truth than to the truth moved so many pixels, in each of
/// eight directions, where both have pixels.
bool isNearer(
  const reference::Image<double>& truth, const reference::Image<double>& picture, int distance)
{
  for (int direction = 0; direction < 9; ++direction)
  {
    const int dx = (direction % 3 - 1) * distance, dy = (direction / 3 - 1) * distance;
    double excess = 0.0;
    for (int y = std::max(dy, 0); y < Height + std::min(dy, 0); ++y)
    {
      for (int x = std::max(dx, 0); x < Width + std::min(dx, 0); ++x)
      {
        const double here = picture.at(x, y) - truth.at(x, y);
        const double moved = picture.at(x, y) - truth.at(x - dx, y - dy);
        excess += here * here - moved * moved;
      }
    }
    if (excess > 0.0)
    {
      return false;
    }
  }
  return true;
}

/// Judges view by view, and tells of all at the end.
class Comparison
{
public:
  explicit Comparison(const std::string& truth) : Truth(truth) {}

  /// Of a picture that shows its structures where they are, with some allowance.
  void judge(reference::Checks& check, int mode, const reference::Image<double>& truth,
    const reference::Image<double>& picture, double unit = 1.0, double allowance = 0.0)
  {
    const stage::Likeness likeness(truth, picture);
    this->Summaries[mode].add(likeness, unit);
    const double most = (MostShift + allowance) * unit;
    check(most > MostMeasured ? isNearer(truth, picture, std::lround(2.0 * most))
                              : likeness.largestShift() <= most,
      ModeNames[mode], " and ", this->Truth, ": ", likeness.text());
  }

  void print() const
  {
    for (int mode = 0; mode < 3; ++mode)
    {
      if (this->Summaries[mode].views > 0)
      {
        this->Summaries[mode].print(std::string(ModeNames[mode]) + " and " + this->Truth);
      }
    }
  }

private:
  std::string Truth;
  Summary Summaries[3];
};

/// A parallel view's pixels by definition. `truth` says where there is something to see.
void compareWithDefinition(stage::Stage& stage, vtkImageData* image, Mapper* mapper,
  stage::Definition& definition, const Pictures& pictures, const reference::Image<double>& truth,
  reference::Random& random, reference::Checks& check)
{
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    if (!definition.look(stage, image, mapper))
    {
      continue;
    }
    for (int n = 0; n < SomePixels; ++n)
    {
      const auto at = stage::somePixel(truth, n % 2 == 0, random);
      const stage::Definition::Pixel expected = definition.pixel(at[0], at[1]);
      const double found = pictures[mode].at(at[0], at[1]);
      check(!expected.isCertain || std::abs(found - expected.value) <= stage::GrayTolerance,
        ModeNames[mode], ": pixel ", at[0], " ", at[1], " is ", found, ", not ", expected.value);
    }
  }
}

/// The prop's matrix turns and mirrors the volume; vtkFixedPointVolumeRayCastMapper is the truth of
/// where things are (previews show each structure at the voxels that a ray crosses, up to half a
/// voxel off), the definition of what they are.
void testPropMatrices(
  stage::Stage& stage, const Bytes& volume, vtkImageData* image, reference::Checks& check)
{
  Comparison comparison("the fixed-point ray caster");
  stage::Definition definition(volume);
  reference::forScenes("prop matrices", Cameras,
    [&](int, reference::Random& random)
    {
      coretesting::placeAtRandom(image, random, false);
      const auto mapper = stage::splatting(image);
      stage.show(mapper);
      turnPropAtRandom(stage.volume, random);
      lookAtRandom(stage, random);
      const auto truth = pictureOf(stage, stage::fixedPointRayCaster(image, fineDistance(image)));
      const Pictures pictures = picturesOf(stage, mapper);
      comparison.judge(check, Mapper::STANDARD, truth, pictures[Mapper::STANDARD]);
      comparison.judge(check, Mapper::HIGH, truth, pictures[Mapper::HIGH]);
      compareWithDefinition(stage, image, mapper, definition, pictures, truth, random, check);
    });
  comparison.print();
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

/// Some pixels between what the voxels near their rays allow.
void compareWithVoxels(stage::Stage& stage, vtkImageData* image,
  const std::array<stage::Envelope, 3>& envelopes, const Pictures& pictures,
  const reference::Image<double>& truth, reference::Random& random, reference::Checks& check)
{
  const stage::ScreenRays rays(stage, image);
  for (int n = 0; n < ManyPixels; ++n)
  {
    const auto at = stage::somePixel(truth, n % 2 == 0, random);
    for (int mode = 0; mode < 3; ++mode)
    {
      const stage::Envelope::Limits limits = envelopes[mode].at(rays, at[0], at[1]);
      const double found = pictures[mode].at(at[0], at[1]);
      check(
        found >= limits.low - stage::GrayTolerance && found <= limits.high + stage::GrayTolerance,
        ModeNames[mode], " in perspective: pixel ", at[0], " ", at[1], " is ", found, ", not from ",
        limits.low, " to ", limits.high);
    }
  }
}

/// The largest voxel of those that the ray from the eye through the middle of each pixel crosses.
reference::Image<double> exactPreview(
  stage::Stage& stage, const stage::Envelope& voxels, vtkImageData* image)
{
  const stage::ScreenRays rays(stage, image);
  reference::Image<double> picture(Width, Height);
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      picture.at(x, y) = voxels.at(rays, x, y).high;
    }
  }
  return picture;
}

/// Perspective views, beside both ray casters and, for previews, what they are defined by. Shifts
/// are in pixels, or in shares of a voxel in the volume's middle where that is wider: an eye inside
/// the volume sees voxels up to 40 pixels wide. The GPU's ray caster is the truth, for previews
/// with nearest interpolation: edges of voxels near the eye are not where interpolated ones are.
/// vtkFixedPointVolumeRayCastMapper is off it by itself, and may be as much off what is splatted.
void testPerspective(
  stage::Stage& stage, const Bytes& volume, vtkImageData* image, reference::Checks& check)
{
  Comparison fixedPoint("the fixed-point ray caster in perspective"),
    gpu("the GPU ray caster in perspective"), exact("an exact traversal in perspective");
  Summary rayCasters;
  const std::array<stage::Envelope, 3> envelopes = { stage::Envelope(volume, Mapper::PREVIEW),
    stage::Envelope(volume, Mapper::STANDARD), stage::Envelope(volume, Mapper::HIGH) };
  const stage::Envelope voxels(volume);
  reference::forScenes("perspective", Cameras,
    [&](int camera, reference::Random& random)
    {
      coretesting::placeAtRandom(image, random, false);
      const auto mapper = stage::splatting(image);
      stage.show(mapper);
      turnPropAtRandom(stage.volume, random);
      lookInPerspective(stage, image, camera, random);
      const double distance = fineDistance(image);
      const auto fixed = pictureOf(stage, stage::fixedPointRayCaster(image, distance));
      const auto truth = pictureOf(stage, stage::gpuRayCaster(image, distance));
      const double unit = std::max(1.0, pixelsPerVoxel(stage, image));
      const stage::Likeness casters(truth, fixed);
      rayCasters.add(casters, unit);
      const Pictures pictures = picturesOf(stage, mapper);
      const auto boxes = pictureOfVoxels(stage, stage::gpuRayCaster(image, distance));
      gpu.judge(check, Mapper::PREVIEW, boxes, pictures[Mapper::PREVIEW], unit);
      for (int mode : { Mapper::STANDARD, Mapper::HIGH })
      {
        gpu.judge(check, mode, truth, pictures[mode], unit);
        fixedPoint.judge(check, mode, fixed, pictures[mode], unit, casters.largestShift() / unit);
      }
      compareWithVoxels(stage, image, envelopes, pictures, truth, random, check);
      if (camera < ExactCameras)
      {
        exact.judge(check, Mapper::PREVIEW, exactPreview(stage, voxels, image),
          pictures[Mapper::PREVIEW], unit);
      }
    });
  stage.viewAngle = 0.0;
  rayCasters.print("For orientation, the two ray casters in perspective");
  exact.print();
  fixedPoint.print();
  gpu.print();
}

/// The image's own matrix turns the volume, and the prop's besides.
/// vtkFixedPointVolumeRayCastMapper ignores direction matrices and the GPU's ray caster draws
/// nothing where they mirror (VTK 9.1), so the truth of every other view has the matrix in the
/// prop.
void testDirectionMatrices(
  stage::Stage& stage, const Bytes& volume, vtkImageData* image, reference::Checks& check)
{
  Comparison comparison("the GPU ray caster, with direction matrices");
  stage::Definition definition(volume);
  reference::forScenes("direction matrices", TurnedCameras,
    [&](int camera, reference::Random& random)
    {
      coretesting::placeAtRandom(image, random, false);
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
      const Pictures pictures = picturesOf(stage, mapper);
      for (int mode : { Mapper::STANDARD, Mapper::HIGH })
      {
        comparison.judge(check, mode, truth, pictures[mode]);
      }
      compareWithDefinition(stage, turned, mapper, definition, pictures, truth, random, check);
    });
  comparison.print();
}
}

//------------------------------------------------------------------------------
int TestRegistration(int, char*[])
{
  reference::Checks check;
  reference::Random random(3);
  const auto volume = stage::blobsAndTubes({ 72, 80, 88 }, 60, random);
  const auto image = stage::toImageData(volume);
  stage::Stage stage(Width, Height);
  testPropMatrices(stage, volume, image, check);
  testPerspective(stage, volume, image, check);
  testDirectionMatrices(stage, volume, image, check);
  return check.exitCode();
}
