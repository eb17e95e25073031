// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Dependent components: the last one is projected, the others go with the samples that win. The
// shear image is compared with the voxels along each ray.
#include "CoreTesting.h"
#include "MapperOracle.h"
#include "ScalarTesting.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

using namespace scalartesting;

namespace
{
vtkSmartPointer<vtkImageData> noise(const Size& size, int components, std::uint64_t seed)
{
  return plainImage(
    size, noiseArray(VTK_UNSIGNED_CHAR, size[0] * size[1] * size[2], components, seed));
}

/// The voxel that a ray sees: the first of those whose last component wins.
vtkIdType winnerOf(vtkImageData* image, const std::vector<std::array<int, 3>>& path, bool isMinimum)
{
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  const int last = scalars->GetNumberOfComponents() - 1;
  vtkIdType winner = -1;
  for (const std::array<int, 3>& voxel : path)
  {
    int ijk[3] = { voxel[0], voxel[1], voxel[2] };
    const vtkIdType id = image->ComputePointId(ijk);
    const double value = scalars->GetComponent(id, last);
    const double best = winner < 0 ? 0.0 : scalars->GetComponent(winner, last);
    if (winner < 0 || (isMinimum ? value < best : value > best))
    {
      winner = id;
    }
  }
  return winner;
}

/// Whether each pixel of a preview has the whole tuple of the voxel that wins.
bool carriesTuples(stage::Stage& stage, Mapper* mapper, vtkImageData* image)
{
  const int* const n = image->GetDimensions();
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  const int components = scalars->GetNumberOfComponents();
  const reference::ShearView view = stage::viewOf(mapper);
  const bool reversed = stage::looksBackwards(stage, image, view.axis);
  vtkImageData* const shear = mapper->GetShearImage();
  bool same = shear->GetNumberOfScalarComponents() == components;
  const int* const size = shear->GetDimensions();
  const reference::ImageRays rays = reference::raysOf({ n[0], n[1], n[2] }, view);
  for (vtkIdType pixel = 0; same && pixel < shear->GetNumberOfPoints(); ++pixel)
  {
    auto path = reference::crossedVoxels(
      rays, static_cast<int>(pixel % size[0]), static_cast<int>(pixel / size[0]));
    if (reversed)
    {
      std::reverse(path.begin(), path.end());
    }
    const vtkIdType winner =
      winnerOf(image, path, mapper->GetBlendMode() == vtkVolumeMapper::MINIMUM_INTENSITY_BLEND);
    same = (shear->GetPointGhostArray()->GetValue(pixel) == 0) == (winner >= 0);
    for (int c = 0; same && winner >= 0 && c < components; ++c)
    {
      same = shear->GetPointData()->GetScalars()->GetComponent(pixel, c) ==
        scalars->GetComponent(winner, c);
    }
  }
  return same;
}

/// From anywhere.
void lookAtRandom(stage::Stage& stage, double scale, reference::Random& random)
{
  const stage::Vector direction = stage::anyDirection(random);
  const stage::Vector up = stage::anyDirection(random);
  stage.look(direction, up, scale);
}

void testTuples(stage::Stage& stage, reference::Checks& check)
{
  stage.property->IndependentComponentsOff();
  reference::forScenes("tuples", 80,
    [&](int n, reference::Random& random)
    {
      const int components = n % 2 ? 4 : 2;
      const Size size = coretesting::anySize(random, 6, 24);
      const auto image = noise(size, components, random.bits());
      const auto mapper = stage::splatting(image);
      mapper->SetQualityModeToPreview();
      mapper->SetBlendMode(random.oneIn(2) ? vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND
                                           : vtkVolumeMapper::MINIMUM_INTENSITY_BLEND);
      stage.show(mapper);
      const stage::Vector direction = stage::anyDirection(random), up = stage::anyDirection(random);
      // From the opposite side other voxels of equal opacity win.
      for (const double side : { 1.0, -1.0 })
      {
        stage.look({ side * direction[0], side * direction[1], side * direction[2] }, up, 1.0);
        stage.window->Render();
        check(!mapper->GetLastRenderUsedRayCasting() && carriesTuples(stage, mapper, image),
          "Each pixel has the tuple that wins.");
      }
    });
}

/// The mean of each component by itself, as if it were alone.
void testMeans(stage::Stage& stage, reference::Checks& check)
{
  stage.property->IndependentComponentsOff();
  reference::forScenes("means", 24,
    [&](int n, reference::Random& random)
    {
      const Size size = coretesting::anySize(random, 6, 24);
      const auto image = noise(size, n % 2 ? 4 : 2, random.bits());
      const auto mapper = stage::splatting(image);
      mapper->SetQualityMode(random.uniform(0, 3));
      mapper->SetBlendModeToAverageIntensity();
      stage.viewAngle = random.oneIn(2) ? random.uniform(5.0, 90.0) : 0.0;
      stage.show(mapper);
      lookAtRandom(stage, 1.0, random);
      stage.window->Render();
      vtkNew<vtkImageData> all;
      all->DeepCopy(mapper->GetShearImage());
      for (int c = 0; c < all->GetNumberOfScalarComponents(); ++c)
      {
        const auto alone =
          stage::splatting(plainImage(size, componentOf(image->GetPointData()->GetScalars(), c)));
        alone->SetQualityMode(mapper->GetQualityMode());
        alone->SetBlendModeToAverageIntensity();
        stage.show(alone);
        stage.window->Render();
        vtkImageData* const shear = alone->GetShearImage();
        bool same = shear->GetNumberOfPoints() == all->GetNumberOfPoints();
        for (vtkIdType p = 0; same && p < shear->GetNumberOfPoints(); ++p)
        {
          const double a = shear->GetPointData()->GetScalars()->GetComponent(p, 0);
          const double b = all->GetPointData()->GetScalars()->GetComponent(p, c);
          same = a == b || (std::isnan(a) && std::isnan(b));
        }
        check(same, "The mean of component ", c, " is that of it alone.");
      }
    });
  stage.viewAngle = 0.0;
}

/// Noise as opacity; the colour is the voxel's number, counted from 1.
vtkSmartPointer<vtkImageData> numberedVoxels(const Size& size, reference::Random& random)
{
  const auto image = noise(size, 4, random.bits());
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n)
  {
    for (int c = 0; c < 3; ++c)
    {
      scalars->SetComponent(n, c, double((n + 1) >> (8 * c) & 255));
    }
  }
  return image;
}

/// Where the window shows a box about a voxel.
class ScreenBoxes
{
public:
  struct Box
  {
    double low[2] = { HUGE_VAL, HUGE_VAL }, high[2] = { -HUGE_VAL, -HUGE_VAL };
  };

  ScreenBoxes(stage::Stage& stage, vtkImageData* image) : Image(image)
  {
    std::copy_n(stage.window->GetSize(), 2, this->Size);
    vtkMatrix4x4::Multiply4x4(
      stage.renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
        stage.renderer->GetTiledAspectRatio(), -1.0, 1.0),
      image->GetIndexToPhysicalMatrix(), this->ToClip);
  }

  /// Of so many voxels to all sides of the middle of voxel n.
  Box at(vtkIdType n, double reach) const
  {
    const int* const size = this->Image->GetDimensions();
    const vtkIdType voxel[3] = { n % size[0], n / size[0] % size[1], n / size[0] / size[1] };
    Box box;
    for (int corner = 0; corner < 8; ++corner)
    {
      double p[4] = { 0.0, 0.0, 0.0, 1.0 };
      for (int a = 0; a < 3; ++a)
      {
        p[a] = static_cast<double>(voxel[a]) + ((corner >> a & 1) ? reach : -reach);
      }
      this->ToClip->MultiplyPoint(p, p);
      for (int a = 0; a < 2; ++a)
      {
        const double pixel = 0.5 * this->Size[a] * (p[a] / p[3] + 1.0) - 0.5;
        box.low[a] = std::min(box.low[a], pixel);
        box.high[a] = std::max(box.high[a], pixel);
      }
    }
    return box;
  }

private:
  vtkImageData* Image;
  vtkNew<vtkMatrix4x4> ToClip;
  int Size[2];
};

/// A picture of numbered voxels, and where it shows them.
struct Overview
{
  static constexpr int Width = 60, Height = 50;
  stage::Pixels pixels;
  ScreenBoxes boxes;
  vtkDataArray* scalars;

  Overview(stage::Stage& stage, vtkImageData* image)
    : pixels(stage.pixels()),
      boxes(stage, image),
      scalars(image->GetPointData()->GetScalars())
  {
  }

  /// Which voxel a pixel shows; -1 for none.
  vtkIdType voxelAt(int x, int y) const
  {
    const unsigned char* const rgb = &this->pixels[3 * (std::size_t(y) * Width + x)];
    return vtkIdType(rgb[0] | rgb[1] << 8 | rgb[2] << 16) - 1;
  }
};

/// Returns whether a pixel shows a voxel.
bool testPixels(const Overview& overview, reference::Checks& check)
{
  bool isShown = false;
  for (int y = 0; y < Overview::Height; ++y)
  {
    for (int x = 0; x < Overview::Width; ++x)
    {
      const vtkIdType voxel = overview.voxelAt(x, y);
      if (voxel < 0 ||
        !check(voxel < overview.scalars->GetNumberOfTuples(), "A pixel has a tuple."))
      {
        continue;
      }
      isShown = true;
      const ScreenBoxes::Box box = overview.boxes.at(voxel, 1.5);
      check(box.low[0] <= x + 0.5 && box.high[0] >= x - 0.5 && box.low[1] <= y + 0.5 &&
          box.high[1] >= y - 0.5,
        "A pixel has the tuple of a voxel that is near its area.");
    }
  }
  return isShown;
}

/// Returns whether a voxel is wholly in a pixel.
bool testVoxels(const Overview& overview, bool isMinimum, reference::Checks& check)
{
  bool isChosen = false;
  for (vtkIdType voxel = 0; voxel < overview.scalars->GetNumberOfTuples(); ++voxel)
  {
    const ScreenBoxes::Box box = overview.boxes.at(voxel, 0.5);
    const int x = static_cast<int>(std::lround(box.low[0]));
    const int y = static_cast<int>(std::lround(box.low[1]));
    if (x < 0 || y < 0 || x >= Overview::Width || y >= Overview::Height ||
      box.high[0] > x + 0.4999 || box.high[1] > y + 0.4999 || box.low[0] < x - 0.4999 ||
      box.low[1] < y - 0.4999)
    {
      continue;
    }
    isChosen = true;
    const vtkIdType winner = overview.voxelAt(x, y);
    const double own = overview.scalars->GetComponent(voxel, 3);
    const double best = winner < 0 ? NAN : overview.scalars->GetComponent(winner, 3);
    check(isMinimum ? best <= own : best >= own, "A voxel of ", own,
      " is lost in a pixel that shows one of ", best, ".");
  }
  return isChosen;
}

/// In overviews of previews a pixel has the tuple of a voxel in its area, or near it, and that of
/// the largest last component there.
///
/// A sample is a voxel wide at most, and may be half of that beside the area (see PixelArea.h). Its
/// ray crosses voxels whose middle is no more than one beside it. Conversely, the ray that passes
/// nearest to a voxel's middle is no more than half a voxel beside it.
void testOverviews(reference::Checks& check)
{
  stage::Stage stage(Overview::Width, Overview::Height);
  stage.property->IndependentComponentsOff();
  coretesting::Sightings shown, chosen;
  reference::forScenes("overviews", 120,
    [&](int n, reference::Random& random)
    {
      const Size size = coretesting::anySize(random, 6, 24);
      const auto image = numberedVoxels(size, random);
      const auto mapper = stage::splatting(image);
      mapper->SetQualityModeToPreview();
      const bool isMinimum = random.oneIn(3);
      mapper->SetBlendMode(isMinimum ? vtkVolumeMapper::MINIMUM_INTENSITY_BLEND
                                     : vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND);
      stage.viewAngle = n % 2 ? random.uniform(5.0, 40.0) : 0.0;
      stage.show(mapper);
      // Pixels so wide in the middle are wider than the longest edge of a voxel, 1.25, everywhere:
      // in perspective by diagonal / height tan(angle / 2) < 0.35 less in the nearest corner.
      const double pixel = random.uniform(1.7, 6.0);
      lookAtRandom(stage, Overview::Height * pixel / image->GetLength(), random);
      const Overview overview(stage, image);
      shown.add(testPixels(overview, check));
      chosen.add(testVoxels(overview, isMinimum, check));
    });
  check(shown.areEnough(0.5) && chosen.areEnough(0.3), "Overviews are seen.");
}

/// Of two components the first one is coloured, and the second one is the opacity.
void testTwoComponents(stage::Stage& stage, reference::Checks& check)
{
  const Size size{ 8, 8, 8 };
  const auto scalars = noiseArray(VTK_FLOAT, 8 * 8 * 8, 2, 1);
  scalars->FillComponent(0, 60.0);
  scalars->FillComponent(1, 100.0);
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0.0, 0.0, 0.2, 1.0);
  color->AddRGBPoint(120.0, 1.0, 0.8, 0.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(125.0, 1.0);
  stage.property->IndependentComponentsOff();
  stage.property->SetColor(color);
  stage.property->SetScalarOpacity(opacity);
  const auto mapper = stage::splatting(plainImage(size, scalars));
  stage.show(mapper);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    stage.look({ 0.5, 0.7, -0.3 }, { 0.0, 0.2, 1.0 }, 0.8);
    const stage::Pixels pixels = stage.pixels();
    const int* const window = stage.window->GetSize();
    const std::size_t middle = 3 * (std::size_t(window[1] / 2) * window[0] + window[0] / 2);
    for (int c = 0; c < 3; ++c)
    {
      // Half of the function, times the opacity; colour, opacity and product are rounded.
      check(std::abs(pixels[middle + c] - 0.5 * 255.0 * 0.8) <= 1.5, "Colour ", c, " is ",
        int(pixels[middle + c]), ".");
    }
  }
  stage.viewAngle = 0.0;
  stage.setGrayRamp(0.0, 255.0);
}

/// Other colours need no projection, other kinds of components do.
void testChanges(stage::Stage& stage, reference::Checks& check)
{
  reference::forScenes("changes", 12,
    [&](int, reference::Random& random)
    {
      const Size size = coretesting::anySize(random, 6, 24);
      const auto image = noise(size, 2, random.bits());
      const auto mapper = stage::splatting(image);
      stage.property->IndependentComponentsOff();
      stage.viewAngle = random.oneIn(2) ? random.uniform(5.0, 90.0) : 0.0;
      stage.show(mapper);
      lookAtRandom(stage, 1.0, random);
      const stage::Pixels dependent = stage.pixels();
      const vtkIdType before = mapper->GetNumberOfProjections();
      stage.setGrayRamp(10.0, 90.0);
      check(stage.pixels() != dependent && mapper->GetNumberOfProjections() == before,
        "Other colours show without a projection.");
      stage.setGrayRamp(0.0, 255.0);
      stage.property->IndependentComponentsOn();
      check(stage.pixels() != dependent && mapper->GetNumberOfProjections() == before + 1,
        "Independent components are projected anew.");
      stage.property->IndependentComponentsOff();
      check(stage.pixels() == dependent, "Dependent again, they show what they did.");
    });
  stage.viewAngle = 0.0;
}

void testBadInput(stage::Stage& stage, reference::Checks& check)
{
  stage.property->IndependentComponentsOff();
  const Size size{ 8, 7, 6 };
  const auto mapper =
    stage::splatting(plainImage(size, noiseArray(VTK_SHORT, size[0] * size[1] * size[2], 4, 2)));
  stage.show(mapper);
  stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  stage.window->Render();
  stage.window->Render();
  check(errors.texts.size() == 1 && errors.texts[0].find("unsigned char") != std::string::npos,
    "Four dependent shorts: one sentence.");
  mapper->SetInputData(noise(size, 4, 2));
  stage.window->Render();
  check(errors.texts.size() == 1 && mapper->GetNumberOfProjections() == 1,
    "Four dependent bytes afterwards are shown.");
  mapper->SetMaximumTypeToSigned();
  stage.window->Render();
  check(errors.texts.size() == 2 && errors.texts[1].find("no signed maximum") != std::string::npos,
    "Their signed maximum is refused.");
  stage.property->IndependentComponentsOn();
  stage.window->Render();
  check(errors.texts.size() == 2 && mapper->GetNumberOfProjections() == 2,
    "That of independent bytes is shown.");
}
}

int TestDependentComponents(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(180, 170);
  testTuples(stage, check);
  testMeans(stage, check);
  testOverviews(check);
  testChanges(stage, check);
  testTwoComponents(stage, check);
  testBadInput(stage, check);
  return check.exitCode();
}
