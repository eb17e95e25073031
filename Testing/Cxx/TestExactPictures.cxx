// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestExactPictures [--demo-data DIR] [--test-data DIR]
//
// Mode EXACT in a window: each pixel is the largest or the least value of the field along its ray.
// Averages and dependent components of exact mode, too. TestRenderTime tests when it projects.
#include "ScreenOracle.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkSMPTools.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>

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

/// Where the oracle knows a pixel, its gray value; pixels without a sample are black.
struct Truth
{
  reference::Image<double> grays{ Size / Step, Size / Step };
  std::vector<unsigned char> isCertain = std::vector<unsigned char>(this->grays.value.size());
};

/// The picture by the oracle, at every Step-th pixel.
Truth oracle(stage::Stage& stage, vtkImageData* image, const double range[2], bool isMinimum)
{
  const reference::CellScene<double> field = reference::cellScene(voxelsOf(image));
  const stage::ScreenRays rays(stage, image);
  Truth truth;
  vtkSMPTools::For(0, truth.grays.height, 4,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (int y = static_cast<int>(begin); y < end; ++y)
      {
        for (int x = 0; x < truth.grays.width; ++x)
        {
          const auto extremum = stage::extremumOnRay(field, rays, x * Step, y * Step, isMinimum);
          const auto grayOf = [&](double value)
          { return 255.0 * std::clamp((value - range[0]) / (range[1] - range[0]), 0.0, 1.0); };
          const double gray = extremum.isHit ? grayOf(extremum.low) : 0.0;
          truth.grays.at(x, y) = gray;
          truth.isCertain[truth.grays.index(x, y)] = extremum.isCertain &&
            (!extremum.isHit || std::abs(grayOf(extremum.high) - gray) < 0.01);
        }
      }
    });
  return truth;
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

/// Half a gray as pictures have bytes, as much as their colours are tables, and what the oracle
/// leaves open.
constexpr double GrayTolerance = 0.5 + 1.0 / 16 + 0.01;

void compareWithOracle(const Truth& truth, const reference::Image<double>& picture,
  const std::string& what, reference::Checks& check)
{
  int compared = 0, wrong = 0;
  double worst = 0.0;
  for (std::size_t p = 0; p < picture.value.size(); ++p)
  {
    if (truth.isCertain[p])
    {
      const double error = std::abs(picture.value[p] - truth.grays.value[p]);
      wrong += !(error <= GrayTolerance);
      worst = std::max(worst, error);
      ++compared;
    }
  }
  check(wrong == 0 && compared > Size / Step * Size / Step / 2, what, ": ", wrong, " of ", compared,
    " pixels are not the field's extremum; the worst is ", worst, " grays off.");
}

void comparePictures(
  stage::Stage& stage, reference::Checks& check, const std::string& name, vtkImageData* image)
{
  double range[2];
  image->GetScalarRange(range);
  stage.setGrayRamp(range[0], range[1]);
  const auto exact = stage::splatting(image);
  exact->SetQualityModeToExact();
  for (double viewAngle : { 0.0, 30.0 })
  {
    const std::string what = name + (viewAngle > 0.0 ? ", perspective" : ", parallel");
    stage.viewAngle = viewAngle;
    exact->SetBlendModeToMaximumIntensity();
    stage.show(exact);
    stage.look(oblique, up, 0.7);
    compareWithOracle(oracle(stage, image, range, false), pictureOf(stage, exact), what, check);
    check(exact->GetQualityModeUsed() == Mapper::EXACT, "The mode is used.");
    check(!exact->GetShearImage() && exact->GetPrincipalAxis() == -1, "There is no shear image.");
    exact->SetBlendModeToMinimumIntensity();
    compareWithOracle(
      oracle(stage, image, range, true), pictureOf(stage, exact), what + ", minimum", check);
  }
  stage.viewAngle = 0.0;
}

void compareFile(
  stage::Stage& stage, reference::Checks& check, const std::string& folder, const std::string& name)
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

/// Means are those of HIGH.
void testMeans(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 40, 40, 40 }, 5));
  const auto mapper = stage::splatting(image);
  stage.setGrayRamp(0.0, 255.0);
  stage.look(oblique, up);
  mapper->SetBlendModeToAverageIntensity();
  mapper->SetQualityModeToHigh();
  const auto high = pictureOf(stage, mapper);
  const vtkIdType before = mapper->GetNumberOfProjections();
  mapper->SetQualityModeToExact();
  check(pictureOf(stage, mapper).value == high.value, "EXACT shows what HIGH shows.");
  check(mapper->GetNumberOfProjections() == before, "And uses its image.");
  check(mapper->GetQualityModeUsed() == Mapper::HIGH, "And says so.");
}

/// Where pixels are wider than voxels EXACT shows previews of their areas.
void testOverviews(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 40, 40, 40 }, 5));
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.look(oblique, up, 60.0);
  stage.window->Render();
  check(mapper->GetQualityModeUsed() == Mapper::PREVIEW && mapper->GetShearImage(),
    "Overviews are previews.");
  stage.look(oblique, up, 0.7);
  stage.window->Render();
  check(mapper->GetQualityModeUsed() == Mapper::EXACT && !mapper->GetShearImage(),
    "Other views are exact.");
}
}

//------------------------------------------------------------------------------
int TestExactPictures(int argc, char* argv[])
{
  reference::Checks check;
  stage::Stage stage(Size, Size);
  testMeans(stage, check);
  testOverviews(stage, check);
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
