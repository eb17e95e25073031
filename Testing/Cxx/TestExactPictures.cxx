// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestExactPictures [--demo-data DIR] [--test-data DIR]
//
// Mode EXACT in a window, where shear images are as fine as the screen: its pictures are nearer to
// the largest value of the field along each pixel's ray than those of VTK's ray caster with a
// sample per voxel. Also what the mode does where there are no exact maxima.
#include "FieldMaximum.h"
#include "ImageComparison.h"
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSMPTools.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

constexpr int Size = 1024; // of the window
constexpr int Step = 32;   // pixels from one that is compared to the next

const stage::Vector oblique = { 0.35, -0.45, 0.8 };
const stage::Vector up = { 0.0, 1.0, 0.1 };

reference::Volume<double> voxelsOf(vtkImageData* image)
{
  const int* const n = image->GetDimensions();
  reference::Volume<double> volume({ n[0], n[1], n[2] });
  for (std::size_t voxel = 0; voxel < volume.voxels.size(); ++voxel)
  {
    volume.voxels[voxel] =
      image->GetPointData()->GetScalars()->GetComponent(static_cast<vtkIdType>(voxel), 0);
  }
  return volume;
}

/// The rays of a window's pixels in index space, from the camera's matrices.
class ScreenRays
{
public:
  ScreenRays(stage::Stage& stage, vtkImageData* image)
  {
    vtkMatrix4x4::Multiply4x4(
      stage.volume->GetMatrix(), image->GetIndexToPhysicalMatrix(), this->ToIndex);
    vtkMatrix4x4::Multiply4x4(
      stage.renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
        stage.renderer->GetTiledAspectRatio(), -1.0, 1.0),
      this->ToIndex, this->ToIndex);
    this->ToIndex->Invert();
  }

  reference::FieldRay at(int x, int y) const
  {
    const auto begin = this->point(x, y, -1.0), end = this->point(x, y, 1.0);
    std::array<double, 3> way;
    int k = 0;
    for (int a = 0; a < 3; ++a)
    {
      way[a] = end[a] - begin[a];
      k = std::abs(way[a]) > std::abs(way[k]) ? a : k;
    }
    reference::FieldRay ray;
    ray.axes = { k == 0 ? 1 : 0, k == 2 ? 1 : 2, k };
    ray.start = begin[k];
    for (int a = 0; a < 2; ++a)
    {
      ray.at[a] = begin[ray.axes[a]];
      ray.slope[a] = way[ray.axes[a]] / way[k];
    }
    return ray;
  }

private:
  std::array<double, 3> point(int x, int y, double depth) const
  {
    double p[4] = { (2.0 * x + 1.0) / Size - 1.0, (2.0 * y + 1.0) / Size - 1.0, depth, 1.0 };
    this->ToIndex->MultiplyPoint(p, p);
    return { p[0] / p[3], p[1] / p[3], p[2] / p[3] };
  }

  vtkNew<vtkMatrix4x4> ToIndex;
};

/// The picture's gray values by the oracle, at every Step-th pixel.
reference::Image<double> oracle(stage::Stage& stage, vtkImageData* image, const double range[2])
{
  const reference::Volume<double> volume = voxelsOf(image);
  const ScreenRays rays(stage, image);
  reference::Image<double> picture(Size / Step, Size / Step);
  vtkSMPTools::For(0, picture.height, 4,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (int y = static_cast<int>(begin); y < end; ++y)
      {
        for (int x = 0; x < picture.width; ++x)
        {
          const reference::FieldRay ray = rays.at(x * Step, y * Step);
          const auto depths = reference::depthsInField(
            volume.size, ray, reference::FieldDomain::Centres, -1.0, volume.size[ray.axes[2]]);
          if (depths[1] > depths[0])
          {
            const double value = reference::fieldMaximum(volume, ray, depths[0], depths[1]);
            picture.at(x, y) =
              255.0 * std::clamp((value - range[0]) / (range[1] - range[0]), 0.0, 1.0);
          }
        }
      }
    });
  return picture;
}

reference::Image<double> pictureOf(stage::Stage& stage, vtkVolumeMapper* mapper)
{
  stage.show(mapper);
  const reference::Image<double> all = stage.gray();
  reference::Image<double> picture(Size / Step, Size / Step);
  for (int y = 0; y < picture.height; ++y)
  {
    for (int x = 0; x < picture.width; ++x)
    {
      picture.at(x, y) = all.at(x * Step, y * Step);
    }
  }
  return picture;
}

void comparePictures(
  stage::Stage& stage, stage::Checks& check, const std::string& name, vtkImageData* image)
{
  double range[2];
  image->GetScalarRange(range);
  stage.setGrayRamp(range[0], range[1]);
  const double* const spacing = image->GetSpacing();
  const double voxel = *std::min_element(spacing, spacing + 3);
  const auto exact = stage::splatting(image), high = stage::splatting(image);
  exact->SetQualityModeToExact();
  high->SetQualityModeToHigh();
  for (double viewAngle : { 0.0, 30.0 })
  {
    stage.viewAngle = viewAngle;
    stage.show(exact);
    stage.look(oblique, up, 0.7);
    const auto truth = oracle(stage, image, range);
    const auto ours = pictureOf(stage, exact);
    const auto theirs = pictureOf(stage, stage::fixedPointRayCaster(image, voxel));
    const auto psnr = [](const reference::Image<double>& a, const reference::Image<double>& b)
    { return reference::psnr(a, b, 255.0); };
    const double our = psnr(truth, ours), caster = psnr(truth, theirs);
    std::printf(
      "%s, %s, %d samples per voxel's side: PSNR to the oracle: exact %.2f dB, ray caster "
      "%.2f dB, high %.2f dB\n",
      name.c_str(), viewAngle > 0.0 ? "perspective" : "parallel",
      static_cast<int>(std::lround(1.0 / exact->GetShearImage()->GetSpacing()[0])), our, caster,
      psnr(truth, pictureOf(stage, high)));
    // A minute's figures, of which nothing is judged.
    if (viewAngle <= 0.0 && reference::scenesOf(100) == 100)
    {
      const auto fine = pictureOf(stage, stage::fixedPointRayCaster(image, 0.05 * voxel));
      std::printf("  to the ray caster at 0.05 voxel, which is %.2f dB from the oracle: exact %.2f "
                  "dB, ray caster %.2f dB\n",
        psnr(truth, fine), psnr(fine, ours), psnr(fine, theirs));
    }
    check(our > caster, name + ": EXACT is nearer to the field's maxima than the ray caster.");
    check(exact->GetQualityModeUsed() == Mapper::EXACT, "The mode is used.");
  }
  stage.viewAngle = 0.0;
}

void compareFile(
  stage::Stage& stage, stage::Checks& check, const std::string& folder, const std::string& name)
{
  const std::string file = folder + "/" + name;
  if (!vtksys::SystemTools::FileExists(file, true))
  {
    check.skip(name);
    return;
  }
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  comparePictures(stage, check, name, reader->GetOutput());
}

double spacingOf(Mapper* mapper)
{
  return mapper->GetShearImage()->GetSpacing()[0];
}

/// All modes have a pixel per voxel by default. AUTOMATIC_SAMPLING gives each as many as the screen
/// asks for, no fewer.
void testSampling(stage::Stage& stage, stage::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 40, 40, 40 }, 5));
  const auto mapper = stage::splatting(image);
  mapper->AutoAdjustSampleDistancesOff();
  stage.show(mapper);
  const auto spacingIn = [&](int mode, int sampling)
  {
    mapper->SetQualityMode(mode);
    mapper->SetShearImageSampling(sampling);
    stage.window->Render();
    return spacingOf(mapper);
  };
  const auto isNear = [](double a, double b) { return std::abs(a - b) < 0.01 * b; };
  for (double viewAngle : { 0.0, 20.0 })
  {
    stage.viewAngle = viewAngle;
    for (double pixelsPerVoxel : { 0.5, 1.1, 1.9, 2.2, 3.9, 4.3, 30.0 })
    {
      const double diagonal = 39.0 * std::sqrt(3.0);
      stage.look({ 0.0, 0.0, -1.0 }, { 0.0, 1.0, 0.0 }, Size / (pixelsPerVoxel * diagonal));
      check(isNear(spacingIn(Mapper::HIGH, vtkNew<Mapper>()->GetShearImageSampling()), 1.0),
        "Modes have a pixel per voxel.");
      check(isNear(spacingIn(Mapper::HIGH, 2), 0.5), "Unless another sampling is asked for.");
      // Where the volume is farthest from the eye.
      const double distance = stage.renderer->GetActiveCamera()->GetDistance();
      const double farthest =
        viewAngle > 0.0 ? pixelsPerVoxel * distance / (distance + 20.0) : pixelsPerVoxel;
      const double needed = farthest <= 1.0 ? 1.0 : farthest <= 2.0 ? 0.5 : 0.25;
      for (int mode : { Mapper::PREVIEW, Mapper::HIGH, Mapper::EXACT })
      {
        check(isNear(spacingIn(mode, Mapper::AUTOMATIC_SAMPLING), needed),
          "Automatic sampling is as fine as the screen.");
      }
    }
  }
  stage.viewAngle = 0.0;
}

/// Minima, means and dependent components are those of HIGH.
void testWithoutMaxima(stage::Stage& stage, stage::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 40, 40, 40 }, 5));
  const auto mapper = stage::splatting(image);
  mapper->SetShearImageSampling(1);
  stage.setGrayRamp(0.0, 255.0);
  stage.look(oblique, up);
  for (int blendMode :
    { vtkVolumeMapper::MINIMUM_INTENSITY_BLEND, vtkVolumeMapper::AVERAGE_INTENSITY_BLEND })
  {
    mapper->SetBlendMode(blendMode);
    mapper->SetQualityModeToHigh();
    const auto high = pictureOf(stage, mapper);
    const vtkIdType before = mapper->GetNumberOfProjections();
    mapper->SetQualityModeToExact();
    check(pictureOf(stage, mapper).value == high.value, "EXACT shows what HIGH shows.");
    check(mapper->GetNumberOfProjections() == before, "And uses its image.");
  }
}

/// As other better images, one in EXACT is kept while a faster mode is wanted.
void testKept(stage::Stage& stage, stage::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 64, 64 }, 9));
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToExact();
  stage.show(mapper);
  stage.look(oblique, up);
  stage.window->Render();
  stage.window->SetDesiredUpdateRate(1e5);
  stage.renderer->GetActiveCamera()->Azimuth(1.0); // a first frame does not count
  stage.window->Render();
  const vtkIdType before = mapper->GetNumberOfProjections();
  stage.setGrayRamp(0.0, 200.0);
  stage.window->Render();
  check(mapper->GetNumberOfProjections() == before && mapper->GetQualityModeUsed() == Mapper::EXACT,
    "New colours use the exact image.");
  stage.renderer->GetActiveCamera()->Azimuth(1.0);
  stage.window->Render();
  check(mapper->GetQualityModeUsed() == Mapper::HIGH, "A new view is projected in a faster mode.");
  stage.window->SetDesiredUpdateRate(1e-4);
  stage.window->Render();
  check(mapper->GetQualityModeUsed() == Mapper::EXACT, "A still frame is exact again.");
}
}

//------------------------------------------------------------------------------
int TestExactPictures(int argc, char* argv[])
{
  stage::Checks check;
  stage::Stage stage(Size, Size);
  testSampling(stage, check);
  testWithoutMaxima(stage, check);
  testKept(stage, check);
  reference::forScenes("pictures", 3,
    [&](int number, reference::Random&)
    {
      switch (number)
      {
        case 0:
        {
          reference::Random random(3);
          comparePictures(stage, check, "phantom",
            stage::toImageData(stage::blobsAndTubes({ 96, 96, 96 }, 30, random)));
        }
        break;
        case 1:
          compareFile(stage, check, stage::argument(argc, argv, "--demo-data"), "aorta-stent.vti");
          break;
        default:
          compareFile(stage, check, stage::argument(argc, argv, "--test-data"), "headsq.vti");
      }
    });
  return check.exitCode();
}
