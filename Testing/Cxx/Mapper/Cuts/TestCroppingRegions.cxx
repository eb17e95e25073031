// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares VTK's cropping regions, named and other sets, with VTK's GPU ray caster. Frames that are
// ray cast are cropped, too. TestCropping, TestCellCuts and TestProjection test which samples are
// visible.
#include "ScreenOracle.h"

#include "vtkCommand.h"
#include "vtkGPUVolumeRayCastMapper.h"

#include <algorithm>
#include <iostream>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

constexpr int Width = 210;
constexpr int Height = 190;
constexpr int All = (1 << 27) - 1;
const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { 0.3, 0.4, -0.8 }, { -0.8, 0.3, 0.4 }, { 0.2, -0.9, 0.3 } };

/// Planes at shares of the image's bounds without its direction matrix, lower and upper ones.
void placePlanes(
  vtkVolumeMapper* mapper, vtkImageData* image, reference::Random& random, double margin)
{
  double planes[6];
  for (int a = 0; a < 3; ++a)
  {
    const double spacing = image->GetSpacing()[a];
    const double first = image->GetOrigin()[a] + image->GetExtent()[2 * a] * spacing;
    const double length = (image->GetDimensions()[a] - 1) * spacing;
    planes[2 * a] = first + length * random.uniform(margin, 0.5);
    planes[2 * a + 1] = first + length * random.uniform(0.5, 1.0 - margin);
  }
  mapper->CroppingOn();
  mapper->SetCroppingRegionPlanes(planes);
}

int randomFlags(reference::Random& random)
{
  return static_cast<int>(random.bits() & All);
}

/// The picture of VTK's GPU ray caster with the cropping of the mapper.
reference::Image<double> truthOf(stage::Stage& stage, Mapper* mapper, vtkImageData* image)
{
  const double* const spacing = image->GetSpacing();
  const auto rayCaster = stage::gpuRayCaster(image, 0.25 * *std::min_element(spacing, spacing + 3));
  rayCaster->CroppingOn();
  rayCaster->SetCroppingRegionPlanes(mapper->GetCroppingRegionPlanes());
  rayCaster->SetCroppingRegionFlags(mapper->GetCroppingRegionFlags());
  stage.show(rayCaster);
  const reference::Image<double> truth = stage.gray();
  stage.volume->SetMapper(nullptr);
  rayCaster->ReleaseGraphicsResources(stage.window);
  return truth;
}

constexpr int ManyPixels = 200; // that are compared with the voxels near their rays

/// In grays, of VTK's ray caster: half of one as pictures have bytes, as much as their colours are
/// tables, and one as OpenGL may interpolate bytes with as many bits as they have.
constexpr double RayCasterTolerance = 2.0;

/// What the voxels near each ray allow: ray casters end rays at the planes, averages are of whole
/// voxels or none, and along a region's rim their pictures are up to half a voxel off.
void compareWithVoxels(const stage::ScreenRays& rays, const stage::Envelope& envelope,
  const reference::Image<double>& picture, const reference::Image<double>& other, double tolerance,
  reference::Random& random, const std::string& what, reference::Checks& check)
{
  for (int n = 0; n < ManyPixels; ++n)
  {
    const auto at = stage::somePixel(other, n % 2 == 0, random);
    const stage::Envelope::Limits limits = envelope.at(rays, at[0], at[1]);
    const double found = picture.at(at[0], at[1]);
    check(found >= limits.low - tolerance && found <= limits.high + tolerance, what, ": pixel ",
      at[0], " ", at[1], " is ", found, ", not from ", limits.low, " to ", limits.high, ".");
  }
}

void testAgainstRayCaster(stage::Stage& stage, reference::Checks& check)
{
  reference::Random blobs(3);
  const Bytes volume = stage::blobsAndTubes({ 64, 56, 60 }, 40, blobs);
  const auto image = stage::toImageData(volume);
  const int named[] = { VTK_CROP_SUBVOLUME, VTK_CROP_FENCE, VTK_CROP_INVERTED_FENCE, VTK_CROP_CROSS,
    VTK_CROP_INVERTED_CROSS };
  int cut = 0;
  reference::forScenes(stage.viewAngle > 0.0 ? "regions in perspective" : "regions", 36,
    [&](int number, reference::Random& random)
    {
      const int set = number % 9, direction = number / 9 % 3, mode = (number + number / 9) % 4;
      const int region = set < 5 ? named[set] : randomFlags(random);
      coretesting::placeAtRandom(image, random, false);
      const auto mapper = stage::splatting(image);
      mapper->SetQualityMode(mode);
      placePlanes(mapper, image, random, 0.15);
      mapper->SetCroppingRegionFlags(region);
      stage.show(mapper);
      stage.look(directions[direction], up, 0.85);
      const reference::Image<double> picture = stage.gray();
      check(!mapper->GetLastRenderUsedRayCasting(), "Cropped volumes are splatted.");
      mapper->CroppingOff();
      cut += stage.gray().value != picture.value;
      mapper->CroppingOn();
      const std::string what =
        std::string(mapper->GetQualityModeAsString()) + ", flags " + std::to_string(region);
      const auto truth = truthOf(stage, mapper, image);
      std::cout << what << ": " << stage::Likeness(truth, picture).text() << std::endl;
      const stage::ScreenRays rays(stage, image);
      const stage::Envelope envelope(volume, mode, stage::croppingOf(mapper, image));
      compareWithVoxels(rays, envelope, picture, truth, stage::GrayTolerance, random, what, check);
      compareWithVoxels(
        rays, envelope, truth, truth, RayCasterTolerance, random, what + ", the GPU's", check);
    });
  check(cut > 0 || !reference::onlyScene().empty(), "Something is cut away.");
}

/// What is ray cast is cropped at the same place, wherever the extent begins.
void testRayCasting(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto moved = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  // Whole numbers: both images lie at the same place, bit for bit.
  moved->SetExtent(10, 73, -20, 35, 7, 66);
  moved->SetOrigin(-10.0, 20.0, -7.0);
  const auto mapper = stage::splatting(image);
  reference::forScenes("ray casting", 1,
    [&](int, reference::Random& random) { placePlanes(mapper, image, random, 0.15); });
  mapper->SetCroppingRegionFlagsToSubVolume();
  stage.show(mapper);
  stage.look(directions[0], up);
  mapper->SetBlendModeToComposite();
  stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  const stage::Pixels cropped = stage.pixels();
  check(mapper->GetLastRenderUsedRayCasting(), "Composite is ray cast.");
  mapper->SetInputData(moved);
  check(stage.pixels() == cropped, "Ray casting crops where splatting does, whatever the extent.");
  mapper->CroppingOff();
  check(stage.pixels() != cropped, "Ray casting crops.");
}
}

//------------------------------------------------------------------------------
int TestCroppingRegions(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testAgainstRayCaster(stage, check);
    testRayCasting(stage, check);
  }
  return check.exitCode();
}
