// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MIP's relatives as the mapper offers them: minimum, average, depth-shaded and local maximum,
// against VTK's ray casters where these mean the same, and against the definition.
#include "ScreenOracle.h"

#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkTransform.h"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <limits>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

constexpr int Width = 231;
constexpr int Height = 208;
const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { -0.8, 0.3, 0.45 }, { 0.2, 0.9, -0.3 }, { 0.3, -0.4, 0.8 },
  { 0.8, 0.2, 0.5 }, { 0.4, -0.9, 0.2 }, { -0.3, -0.4, -0.8 } };

Bytes negative(Bytes volume)
{
  for (std::uint8_t& voxel : volume.voxels)
  {
    voxel = static_cast<std::uint8_t>(255 - voxel);
  }
  return volume;
}

/// In pixels. Half a pixel is the least of the mistakes that are looked for: a picture that is
/// nearer to where it should be than to where such a mistake would put it.
constexpr double MostShift = 0.25;

constexpr int SomePixels = 12;  // of a view that are computed by definition
constexpr int ManyPixels = 200; // that are compared with the voxels near their rays

/// Some pixels of a parallel view; `truth` says where there is something to see.
void compareWithDefinition(stage::Stage& stage, vtkImageData* image, Mapper* mapper,
  stage::Definition& definition, bool isNegative, const reference::Image<double>& picture,
  const reference::Image<double>& truth, reference::Random& random, const std::string& what,
  reference::Checks& check)
{
  check(definition.look(stage, image, mapper), what, ": one axis is the nearest to the rays.");
  for (int n = 0; n < SomePixels; ++n)
  {
    const auto at = stage::somePixel(truth, n % 2 == 0, random);
    const stage::Definition::Pixel expected = definition.pixel(at[0], at[1]);
    const double gray = expected.isHit && isNegative ? 255.0 - expected.value : expected.value;
    const double found = picture.at(at[0], at[1]);
    check(!expected.isCertain || std::abs(found - gray) <= stage::GrayTolerance, what, ": pixel ",
      at[0], " ", at[1], " is ", found, ", not ", gray, ".");
  }
}

/// What is dark in the volume is bright in the picture, which therefore is like a MIP of the
/// negative. Previews show structures up to half a voxel off, at the voxels that rays cross.
void testMinimumAgainstRayCaster(stage::Stage& stage, reference::Checks& check)
{
  reference::Random blobs(3);
  const Bytes positive = stage::blobsAndTubes({ 72, 80, 88 }, 60, blobs);
  const Bytes volume = negative(positive);
  const std::array<stage::Envelope, 3> envelopes = { stage::Envelope(positive, Mapper::PREVIEW),
    stage::Envelope(positive, Mapper::STANDARD), stage::Envelope(positive, Mapper::HIGH) };
  stage::Definition definition(volume);
  const auto image = stage::toImageData(volume);
  stage.setGrayRamp(255.0, 0.0);
  reference::forScenes(stage.viewAngle > 0.0 ? "minimum in perspective" : "minimum", 6,
    [&](int number, reference::Random& random)
    {
      const auto rayCaster = stage::gpuRayCaster(image, 0.2);
      rayCaster->SetBlendModeToMinimumIntensity();
      stage.show(rayCaster);
      stage.look(directions[number], up, 0.85);
      const reference::Image<double> truth = stage.gray();
      stage.volume->SetMapper(nullptr);
      rayCaster->ReleaseGraphicsResources(stage.window);
      const auto mapper = stage::splatting(image);
      mapper->SetBlendModeToMinimumIntensity();
      stage.show(mapper);
      const stage::ScreenRays rays(stage, image);
      for (int mode = 0; mode < 3; ++mode)
      {
        mapper->SetQualityMode(mode);
        const reference::Image<double> picture = stage.gray();
        const stage::Likeness likeness(truth, picture);
        const std::string what = std::string("Minimum, ") + mapper->GetQualityModeAsString();
        std::cout << what << ": " << likeness.text() << std::endl;
        check(!mapper->GetLastRenderUsedRayCasting(), what, ": is splatted.");
        check(mode == Mapper::PREVIEW || likeness.largestShift() <= MostShift, what, ": shift.");
        for (int n = 0; n < ManyPixels; ++n)
        {
          const auto at = stage::somePixel(truth, n % 2 == 0, random);
          const stage::Envelope::Limits limits = envelopes[mode].at(rays, at[0], at[1]);
          const double found = picture.at(at[0], at[1]);
          check(found >= limits.low - stage::GrayTolerance &&
              found <= limits.high + stage::GrayTolerance,
            what, ": what voxels near the ray allow.");
        }
        if (stage.viewAngle <= 0.0)
        {
          compareWithDefinition(
            stage, image, mapper, definition, true, picture, truth, random, what, check);
        }
      }
    });
  stage.setGrayRamp(0.0, 255.0);
}

/// How much of a ray lies between the outermost voxels' centres, in slices, and how many slices
/// have voxels that it crosses.
struct SlicesOfRay
{
  double length = 0.0;
  int count = 0;

  SlicesOfRay(const stage::ScreenRays& rays, const std::array<int, 3>& size, int x, int y)
  {
    const auto begin = rays.begin(x, y), end = rays.end(x, y);
    int k = 0;
    for (int a = 0; a < 3; ++a)
    {
      k = std::abs(end[a] - begin[a]) > std::abs(end[k] - begin[k]) ? a : k;
    }
    // Without and with half a voxel at either end: the slices' middles between are crossed ones.
    const auto between = [&](double rim)
    {
      std::array<double, 2> way = { 0.0, 1.0 };
      for (int a = 0; a < 3; ++a)
      {
        const double low = (-rim - begin[a]) / (end[a] - begin[a]);
        const double high = (size[a] - 1 + rim - begin[a]) / (end[a] - begin[a]);
        way[0] = std::max(way[0], std::min(low, high));
        way[1] = std::min(way[1], std::max(low, high));
      }
      const double from = begin[k] + way[0] * (end[k] - begin[k]),
                   to = begin[k] + way[1] * (end[k] - begin[k]);
      return way[0] < way[1] ? std::array<double, 2>{ std::min(from, to), std::max(from, to) }
                             : std::array<double, 2>{ 0.0, 0.0 };
    };
    const auto centres = between(0.0), boxes = between(0.5);
    this->length = centres[1] - centres[0];
    this->count = static_cast<int>(std::ceil(boxes[1] - 0.5) - std::floor(boxes[0] + 0.5)) + 1;
  }
};

/// Averages over all slices that rays cross, from the ray caster's picture, which has those over
/// the way between the outermost voxels' centres.
struct ExpectedAverages
{
  reference::Image<double> gray;
  std::vector<std::size_t> seen; // pixels that are not black
  double slack = 0.0;            // what a slice more or less makes of them, all together

  /// The ray caster shows a voxel of `white` as 255.
  ExpectedAverages(const reference::Image<double>& picture, const stage::ScreenRays& rays,
    const std::array<int, 3>& size, double white)
    : gray(picture)
  {
    for (int y = 0; y < Height; ++y)
    {
      for (int x = 0; x < Width; ++x)
      {
        double& average = this->gray.at(x, y);
        if (average > 0.0)
        {
          const SlicesOfRay slices(rays, size, x, y);
          average *= white / 255.0 * slices.length / slices.count;
          this->slack += average / slices.count;
          this->seen.push_back(this->gray.index(x, y));
        }
      }
    }
  }
};

/**
 * The GPU's ray caster averages over the way between the outermost voxels' centres, where this
 * averages over all slices of which a ray crosses voxels. Nothing is near the border, so that both
 * see the same sum, and each pixel's ratio is known. It shows averages as grays, the largest voxel
 * being white, and asks no colour function.
 *
 * On average over the pixels that see something both round to a gray. Neighbours in the shear image
 * may cross a slice more or less.
 */
void testAverageAgainstRayCaster(stage::Stage& stage, reference::Checks& check)
{
  reference::Random blobs(3);
  const Bytes volume = stage::blobsAndTubes({ 72, 80, 88 }, 60, blobs);
  stage::Definition definition(volume);
  const auto image = stage::toImageData(volume);
  const double white = *std::max_element(volume.voxels.begin(), volume.voxels.end());
  reference::forScenes(stage.viewAngle > 0.0 ? "average in perspective" : "average", 6,
    [&](int number, reference::Random& random)
    {
      const auto rayCaster = stage::gpuRayCaster(image, 0.25);
      rayCaster->SetBlendModeToAverageIntensity();
      stage.show(rayCaster);
      stage.look(directions[number], up, 0.85);
      const reference::Image<double> theirs = stage.gray();
      stage.volume->SetMapper(nullptr);
      rayCaster->ReleaseGraphicsResources(stage.window);
      const auto mapper = stage::splatting(image);
      mapper->SetBlendModeToAverageIntensity();
      stage.show(mapper);
      const stage::ScreenRays rays(stage, image);
      const ExpectedAverages truth(theirs, rays, volume.size, white);
      for (int mode : { Mapper::STANDARD, Mapper::HIGH })
      {
        mapper->SetQualityMode(mode);
        const reference::Image<double> picture = stage.gray();
        const stage::Likeness likeness(truth.gray, picture);
        const std::string what = std::string("Average, ") + mapper->GetQualityModeAsString();
        double difference = 0.0, mean = 0.0;
        for (std::size_t pixel : truth.seen)
        {
          difference += (picture.value[pixel] - truth.gray.value[pixel]) / truth.seen.size();
          mean += truth.gray.value[pixel] / truth.seen.size();
        }
        const double most = 1.0 + truth.slack / truth.seen.size();
        std::cout << what << ": " << likeness.text() << ", mean " << mean << ", off by "
                  << difference << " of at most " << most << std::endl;
        check(!mapper->GetLastRenderUsedRayCasting(), what, ": is splatted.");
        check(truth.seen.size() > 2000, what, ": there is something to see.");
        check(std::abs(difference) < most, what, ": mean.");
        check(likeness.largestShift() < MostShift, what, ": shift.");
        if (stage.viewAngle <= 0.0)
        {
          compareWithDefinition(
            stage, image, mapper, definition, false, picture, truth.gray, random, what, check);
        }
      }
    });
}

/// All kinds of projection with all their settings, seen from all sides, with props that mirror.
void testDefinitions(stage::Stage& stage, reference::Checks& check)
{
  const Bytes volume = reference::uniformNoise<std::uint8_t>({ 13, 11, 16 }, 5, 20, 240);
  const auto image = stage::toImageData(volume);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToPreview();
  stage.show(mapper);
  reference::forScenes("definitions", 60,
    [&](int turn, reference::Random& random)
    {
      vtkNew<vtkTransform> prop;
      prop->RotateWXYZ(random.uniform(0.0, 360.0), 0.3, 1.0, -0.4);
      const double scale = random.uniform(0.8, 1.2);
      prop->Scale(1.0, scale, random.sign());
      stage.volume->SetUserTransform(prop);
      stage.look(directions[turn % 6], up);
      const double low = random.uniform(0.0, 120.0);
      mapper->SetAverageIPScalarRange(low, random.uniform(120.0, 300.0));
      mapper->SetDepthShadingAmbient(random.uniform(0.0, 1.0));
      mapper->SetDepthShadingChangeRate(random.uniform(0.0, 1.0));
      mapper->SetLocalMaximumThreshold(random.uniform(0.0, 255.0));
      mapper->SetSignedOrigin(random.uniform(100.0, 160.0));
      for (int kind = 0; kind < 6; ++kind)
      {
        kind == 0     ? mapper->SetBlendModeToMinimumIntensity()
          : kind == 1 ? mapper->SetBlendModeToAverageIntensity()
                      : mapper->SetBlendModeToMaximumIntensity();
        mapper->SetMaximumType(std::max(0, kind - 2));
        stage.window->Render();
        const double error = stage::shearImageError(stage, mapper, image, volume);
        check(error <= stage::allowedError(mapper), "View ", turn, ", kind ", kind, ", axis ",
          mapper->GetPrincipalAxis(), " has an error of ", error, ".");
      }
    });
  stage.volume->SetUserTransform(nullptr);
}

/// A view from the opposite side has the same rays: only what depends on the side is projected
/// anew. Blend modes come and go without a trace.
void testReuse(stage::Stage& stage, reference::Checks& check)
{
  const auto image =
    stage::toImageData(reference::uniformNoise<std::uint8_t>({ 13, 11, 16 }, 7, 0, 255));
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToHigh(); // the same at the rim of the field for all of them
  stage.show(mapper);
  const auto projectionsOfTurn = [&]
  {
    stage.look({ 0.25, -0.5, 1.0 }, up);
    stage.window->Render();
    const vtkIdType before = mapper->GetNumberOfProjections();
    stage.look({ -0.25, 0.5, -1.0 }, up);
    stage.window->Render();
    return mapper->GetNumberOfProjections() - before;
  };
  check(projectionsOfTurn() == 0, "The far side's maximum is the same.");
  const stage::Pixels maximum = stage.pixels();
  mapper->SetMaximumTypeToLocal();
  check(projectionsOfTurn() == 1, "The far side has other local maxima.");
  mapper->SetMaximumTypeToDepthShaded();
  check(projectionsOfTurn() == 1, "The far side has other depth shades.");
  check(stage.pixels() != maximum, "Depth shades can be seen.");
  mapper->SetDepthShadingAmbient(1.0);
  mapper->SetDepthShadingChangeRate(0.0);
  check(stage.pixels() == maximum, "Without shades it is the maximum.");
  mapper->SetMaximumTypeToSigned();
  check(projectionsOfTurn() == 0, "The far side's signed maximum is the same.");
  check(stage.pixels() == maximum, "Of scalars that are not negative it is the maximum.");
  mapper->SetSignedOrigin(300.0);
  const stage::Pixels farthest = stage.pixels();
  mapper->SetBlendModeToMinimumIntensity();
  check(stage.pixels() == farthest, "From an origin above all scalars the minimum is farthest.");
  check(projectionsOfTurn() == 0, "The far side's minimum is the same.");
  check(stage.pixels() != maximum, "The minimum is no maximum.");
  mapper->SetBlendModeToAverageIntensity();
  check(projectionsOfTurn() == 0, "The far side's average is the same.");
  mapper->SetBlendModeToMaximumIntensity();
  mapper->SetMaximumTypeToGlobal();
  check(stage.pixels() == maximum, "The maximum is back.");
}

/// Rays without a sample in the range are transparent, and black only if the background is.
void testEmptyRange(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(reference::constant<std::uint8_t>({ 20, 20, 20 }, 100));
  const auto mapper = stage::splatting(image);
  mapper->SetBlendModeToAverageIntensity();
  stage.show(mapper);
  stage.look(directions[2], up);
  const auto greatest = [&]
  {
    const stage::Pixels pixels = stage.pixels();
    return *std::max_element(pixels.begin(), pixels.end());
  };
  for (int mode = 0; mode < 3; ++mode)
  {
    mapper->SetQualityMode(mode);
    mapper->SetAverageIPScalarRange(0.0, 255.0);
    check(greatest() == 100, "The average of a constant volume is that constant.");
    mapper->SetAverageIPScalarRange(100.0, 255.0);
    check(greatest() == 100, "The range includes its lower end.");
    mapper->SetAverageIPScalarRange(0.0, 100.0);
    check(greatest() == 100, "The range includes its upper end.");
    mapper->SetAverageIPScalarRange(0.0, 99.0);
    check(greatest() == 0, "No sample is in the range.");
    mapper->SetAverageIPScalarRange(101.0, 255.0);
    check(greatest() == 0, "No sample is in the range.");
    stage.renderer->SetBackground(0.0, 0.2, 0.0);
    check(greatest() == 51, "Rays without a sample are transparent.");
    stage.renderer->SetBackground(0.0, 0.0, 0.0);
  }
}
}

//------------------------------------------------------------------------------
int TestBlendModes(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testMinimumAgainstRayCaster(stage, check);
    testAverageAgainstRayCaster(stage, check);
  }
  testEmptyRange(stage, check);
  stage.viewAngle = 0.0;
  testDefinitions(stage, check);
  testReuse(stage, check);
  testEmptyRange(stage, check);
  return check.exitCode();
}
