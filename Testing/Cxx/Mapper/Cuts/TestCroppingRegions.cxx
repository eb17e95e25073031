// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's cropping regions in the mapper: the sets that have names and others, against VTK's ray
// caster and against the definition, and planes that change at run time.
#include "FieldMaximum.h"
#include "ScreenOracle.h"

#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkMatrix3x3.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkTransform.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
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

/**
 * The picture of a ray caster with the mapper's cropping. vtkFixedPointVolumeRayCastMapper
 * (VTK 9.1) takes the first voxel to lie at the origin where it crops, whatever the extent, so its
 * planes are moved; the GPU's ray caster does not.
 */
reference::Image<double> truthOf(stage::Stage& stage, vtkVolumeMapper* rayCaster, Mapper* mapper,
  vtkImageData* image, bool ignoresExtent)
{
  double planes[6];
  for (int plane = 0; plane < 6; ++plane)
  {
    const int a = plane / 2;
    const double offset = image->GetExtent()[2 * a] * image->GetSpacing()[a];
    planes[plane] = mapper->GetCroppingRegionPlanes()[plane] - (ignoresExtent ? offset : 0.0);
  }
  rayCaster->CroppingOn();
  rayCaster->SetCroppingRegionPlanes(planes);
  rayCaster->SetCroppingRegionFlags(mapper->GetCroppingRegionFlags());
  stage.show(rayCaster);
  const reference::Image<double> truth = stage.gray();
  stage.volume->SetMapper(nullptr);
  rayCaster->ReleaseGraphicsResources(stage.window);
  return truth;
}

constexpr int SomePixels = 12;  // of a parallel view that are computed by definition
constexpr int ManyPixels = 200; // that are compared with the voxels near their rays

/// In grays, of VTK's ray casters: half of one as pictures have bytes, as much as their colours are
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

/// Of a parallel view.
void compareWithDefinition(stage::Stage& stage, vtkImageData* image, Mapper* mapper,
  stage::Definition& definition, const reference::Image<double>& picture,
  const reference::Image<double>& other, reference::Random& random, const std::string& what,
  reference::Checks& check)
{
  const bool isClear = definition.look(stage, image, mapper);
  for (int n = 0; isClear && n < SomePixels; ++n)
  {
    const auto at = stage::somePixel(other, n % 2 == 0, random);
    const stage::Definition::Pixel expected = definition.pixel(at[0], at[1]);
    const double found = picture.at(at[0], at[1]);
    check(!expected.isCertain || std::abs(found - expected.value) <= stage::GrayTolerance, what,
      ": pixel ", at[0], " ", at[1], " is ", found, ", not ", expected.value, ".");
  }
}

/// Of a view in mode EXACT: the largest value of the field on the part of the ray that is shown.
void compareWithField(const stage::ScreenRays& rays, const reference::Volume<double>& field,
  const reference::RayCuts& cuts, const reference::Image<double>& picture,
  const reference::Image<double>& other, reference::Random& random, const std::string& what,
  reference::Checks& check)
{
  for (int n = 0; n < ManyPixels; ++n)
  {
    const auto at = stage::somePixel(other, n % 2 == 0, random);
    const auto maximum = stage::maximumOnRay(field, rays, at[0], at[1], cuts);
    const double low = maximum.isHit ? maximum.low : 0.0;
    const double high = maximum.isHit ? maximum.high : 0.0;
    const double found = picture.at(at[0], at[1]);
    check(!maximum.isCertain ||
        (found >= low - stage::FieldTolerance && found <= high + stage::FieldTolerance),
      what, ": pixel ", at[0], " ", at[1], " is ", found, ", not from ", low, " to ", high, ".");
  }
}

void testAgainstRayCasters(stage::Stage& stage, reference::Checks& check)
{
  reference::Random blobs(3);
  const Bytes volume = stage::blobsAndTubes({ 64, 56, 60 }, 40, blobs);
  const auto image = stage::toImageData(volume);
  const reference::Volume<double> field = reference::toDouble(volume);
  stage::Definition definition(volume);
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
      const double* spacing = image->GetSpacing();
      const double distance = 0.25 * *std::min_element(spacing, spacing + 3);
      const std::string what =
        std::string(mapper->GetQualityModeAsString()) + ", flags " + std::to_string(region);
      const auto fixed =
        truthOf(stage, stage::fixedPointRayCaster(image, distance), mapper, image, true);
      const auto gpu = truthOf(stage, stage::gpuRayCaster(image, distance), mapper, image, false);
      std::cout << what << ": " << stage::Likeness(gpu, picture).text() << std::endl;
      const stage::ScreenRays rays(stage, image);
      const reference::RayCuts cuts = stage::croppingOf(mapper, image);
      const stage::Envelope envelope(volume, mode, cuts);
      compareWithVoxels(rays, envelope, picture, gpu, stage::GrayTolerance, random, what, check);
      compareWithVoxels(
        rays, envelope, gpu, gpu, RayCasterTolerance, random, what + ", the GPU's", check);
      compareWithVoxels(
        rays, envelope, fixed, gpu, RayCasterTolerance, random, what + ", fixed-point", check);
      if (mapper->GetQualityModeUsed() == Mapper::EXACT)
      {
        compareWithField(rays, field, cuts, picture, gpu, random, what, check);
      }
      else if (mode != Mapper::EXACT && stage.viewAngle <= 0.0)
      {
        compareWithDefinition(stage, image, mapper, definition, picture, gpu, random, what, check);
      }
    });
  check(cut > 0 || !reference::onlyScene().empty(), "Something is cut away.");
}

void setDirection(vtkImageData* image, reference::Random& random)
{
  vtkNew<vtkTransform> turn;
  turn->RotateWXYZ(random.uniform(0.0, 360.0), 0.5, -0.3, 1.0);
  turn->Scale(random.oneIn(2) ? -1.0 : 1.0, 1.0, 1.0);
  vtkNew<vtkMatrix3x3> direction;
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      direction->SetElement(r, c, turn->GetMatrix()->GetElement(r, c));
    }
  }
  image->SetDirectionMatrix(direction);
}

/// All kinds of projection, and planes across the axes of images that are turned and mirrored.
/// (With direction matrices VTK's ray casters disagree: one ignores them, the other crops
/// elsewhere.)
void testDefinition(stage::Stage& stage, reference::Checks& check)
{
  const Bytes volume = reference::uniformNoise<std::uint8_t>({ 14, 17, 12 }, 3);
  const auto image = stage::toImageData(volume);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToPreview();
  mapper->SetLocalMaximumThreshold(100.0);
  stage.show(mapper);
  reference::forScenes("definition", 90,
    [&](int turn, reference::Random& random)
    {
      coretesting::placeAtRandom(image, random, false);
      setDirection(image, random);
      stage.look(
        { random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.1, 1.0) }, up);
      placePlanes(mapper, image, random, -0.1);
      mapper->SetCroppingRegionFlags(
        turn % 3 == 0 && turn < 81 ? 1 << turn / 3 : randomFlags(random));
      const int kind = turn % 5;
      kind == 3     ? mapper->SetBlendModeToMinimumIntensity()
        : kind == 4 ? mapper->SetBlendModeToAverageIntensity()
                    : mapper->SetBlendModeToMaximumIntensity();
      mapper->SetMaximumType(kind % 3);
      mapper->SetAcceleration(random.uniform<int>(Mapper::AUTO, Mapper::SORTED_VOLUME));
      stage.window->Render();
      const double error = stage::shearImageError(stage, mapper, image, volume);
      check(error <= stage::allowedError(mapper), "View ", turn, ", kind ", kind, ", axis ",
        mapper->GetPrincipalAxis(), " has an error of ", error, ".");
    });
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

/// What changes the samples projects anew, and nothing else does.
void testChanges(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.look(directions[0], up);
  const stage::Pixels whole = stage.pixels();
  const auto projections = [&](auto&& change)
  {
    const vtkIdType before = mapper->GetNumberOfProjections();
    change();
    stage.window->Render();
    return mapper->GetNumberOfProjections() - before;
  };
  double planes[6] = { 20.0, 40.0, 20.0, 40.0, 20.0, 40.0 };
  check(projections([&] { mapper->SetCroppingRegionPlanes(planes); }) == 0,
    "Planes of a cropping that is off change nothing.");
  check(projections([&] { mapper->CroppingOn(); }) == 1, "Cropping projects anew.");
  const stage::Pixels cropped = stage.pixels();
  check(cropped != whole, "Cropping can be seen.");
  check(projections([&] { stage.setGrayRamp(0.0, 200.0); }) == 0, "Colours do not project.");
  stage.setGrayRamp(0.0, 255.0);
  for (int plane = 0; plane < 6; ++plane)
  {
    planes[plane] += plane % 2 ? 5.0 : -5.0;
    check(projections([&] { mapper->SetCroppingRegionPlanes(planes); }) == 1, "Plane ", plane,
      " was moved.");
    planes[plane] -= plane % 2 ? 5.0 : -5.0;
  }
  mapper->SetCroppingRegionPlanes(planes);
  check(stage.pixels() == cropped, "The planes are back.");
  check(projections([&] { mapper->SetCroppingRegionFlagsToFence(); }) == 1, "Other regions.");
  check(stage.pixels() != cropped, "A fence is no subvolume.");
  mapper->SetCroppingRegionFlags(All);
  check(stage.pixels() == whole, "All regions are the whole.");
  mapper->SetCroppingRegionFlags(0);
  const stage::Pixels nothing = stage.pixels();
  check(std::all_of(nothing.begin(), nothing.end(), [](unsigned char c) { return c == 0; }),
    "No regions are nothing.");
  mapper->SetCroppingRegionFlagsToSubVolume();
  check(stage.pixels() == cropped, "The subvolume is back.");
  // Together with a clipping plane that leaves all, and one that leaves nothing.
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(-100.0, 0.0, 0.0);
  plane->SetNormal(1.0, 0.0, 0.0);
  mapper->AddClippingPlane(plane);
  check(stage.pixels() == cropped, "A plane outside cuts nothing.");
  plane->SetOrigin(100.0, 0.0, 0.0);
  check(stage.pixels() == nothing, "A plane may leave nothing.");
  mapper->RemoveAllClippingPlanes();
  mapper->CroppingOff();
  check(stage.pixels() == whole, "Without cropping the volume is whole again.");
}
}

//------------------------------------------------------------------------------
int TestCroppingRegions(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  testDefinition(stage, check);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testAgainstRayCasters(stage, check);
    testChanges(stage, check);
    testRayCasting(stage, check);
  }
  return check.exitCode();
}
