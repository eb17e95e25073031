// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Dependent components: the last one is projected, the others go with the samples that win. The
// shear image is compared with the voxels along each ray, pictures with VTK's ray casters.
#include "MapperOracle.h"
#include "ScalarTesting.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <iostream>

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
  for (vtkIdType pixel = 0; same && pixel < shear->GetNumberOfPoints(); ++pixel)
  {
    auto path = reference::crossedVoxels({ n[0], n[1], n[2] }, view,
      static_cast<int>(pixel % size[0]), static_cast<int>(pixel / size[0]));
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

void testTuples(stage::Stage& stage, stage::Checks& check)
{
  stage.property->IndependentComponentsOff();
  for (int components : { 2, 4 })
  {
    const auto image = noise({ 20, 17, 14 }, components, 5);
    const auto mapper = stage::splatting(image);
    mapper->SetQualityModeToPreview();
    stage.show(mapper);
    for (const stage::Vector& direction : directions())
    {
      for (double side : { 1.0, -1.0 })
      {
        stage.look(
          { side * direction[0], side * direction[1], side * direction[2] }, { 0.2, 0.9, 0.1 });
        for (int blendMode :
          { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, vtkVolumeMapper::MINIMUM_INTENSITY_BLEND })
        {
          mapper->SetBlendMode(blendMode);
          mapper->SetShearImageSampling(side > 0.0 ? 1 : 2);
          stage.window->Render();
          check(!mapper->GetLastRenderUsedRayCasting() && carriesTuples(stage, mapper, image),
            std::to_string(components) + " components, blend mode " + std::to_string(blendMode) +
              ": each pixel has the tuple that wins.");
        }
      }
    }
  }
}

/// The mean of each component by itself, as if it were alone.
void testMeans(stage::Stage& stage, stage::Checks& check)
{
  stage.property->IndependentComponentsOff();
  const auto image = noise({ 20, 17, 14 }, 2, 8);
  const auto mapper = stage::splatting(image);
  mapper->SetBlendModeToAverageIntensity();
  stage.show(mapper);
  stage.look(directions()[0], { 0.2, 0.9, 0.1 });
  stage.window->Render();
  vtkNew<vtkImageData> both;
  both->DeepCopy(mapper->GetShearImage());
  for (int c = 0; c < 2; ++c)
  {
    const auto alone = stage::splatting(
      plainImage({ 20, 17, 14 }, componentOf(image->GetPointData()->GetScalars(), c)));
    alone->SetBlendModeToAverageIntensity();
    stage.show(alone);
    stage.window->Render();
    vtkImageData* const shear = alone->GetShearImage();
    bool same = shear->GetNumberOfPoints() == both->GetNumberOfPoints();
    for (vtkIdType n = 0; same && n < shear->GetNumberOfPoints(); ++n)
    {
      const double a = shear->GetPointData()->GetScalars()->GetComponent(n, 0);
      const double b = both->GetPointData()->GetScalars()->GetComponent(n, c);
      same = a == b || (std::isnan(a) && std::isnan(b));
    }
    check(same, "The mean of component " + std::to_string(c) + " is that of it alone.");
  }
}

/// Soft blobs as opacity; the colour varies slowly, so that it hardly matters which of two
/// neighbours wins.
vtkSmartPointer<vtkImageData> colouredBlobs(int components)
{
  const Size size{ 64, 60, 56 };
  const auto blobs = stage::blobsAndTubes(size, 14);
  auto scalars =
    vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_UNSIGNED_CHAR));
  scalars->SetNumberOfComponents(components);
  scalars->SetNumberOfTuples(size[0] * size[1] * size[2]);
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n)
  {
    const double at[3] = { double(n % size[0]) / size[0], double(n / size[0] % size[1]) / size[1],
      double(n / size[0] / size[1]) / size[2] };
    for (int c = 0; c < components - 1; ++c)
    {
      scalars->SetComponent(n, c, std::round(255.0 * at[c]));
    }
    scalars->SetComponent(n, components - 1, blobs.voxels[n]);
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[0], size[1], size[2]);
  image->GetPointData()->SetScalars(scalars);
  return image;
}

/// The channels of a picture as gray ones.
std::array<reference::Image<double>, 3> channels(const stage::Pixels& pixels, int width, int height)
{
  std::array<reference::Image<double>, 3> result;
  for (int c = 0; c < 3; ++c)
  {
    result[c] = reference::Image<double>(width, height);
    for (std::size_t n = 0; n < result[c].value.size(); ++n)
    {
      result[c].value[n] = pixels[3 * n + c];
      result[c].hit[n] = 1;
    }
  }
  return result;
}

/// The ray casters differ much from each other (with two components, the GPU's colours lie
/// elsewhere): ours must be nearer to one of them than they are.
void testRayCasters(stage::Stage& stage, stage::Checks& check)
{
  constexpr int width = 180, height = 170;
  stage.property->IndependentComponentsOff();
  vtkNew<vtkColorTransferFunction> rainbow;
  rainbow->AddRGBPoint(0.0, 1.0, 0.2, 0.0);
  rainbow->AddRGBPoint(128.0, 0.1, 0.9, 0.3);
  rainbow->AddRGBPoint(255.0, 0.2, 0.3, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(255.0, 1.0);
  stage.property->SetColor(rainbow);
  stage.property->SetScalarOpacity(opacity);
  for (int components : { 2, 4 })
  {
    const auto image = colouredBlobs(components);
    const auto show = [&](vtkVolumeMapper* mapper)
    {
      stage.show(mapper);
      stage.look({ 0.5, 0.7, -0.3 }, { 0.0, 0.2, 1.0 }, 0.8);
      return channels(stage.pixels(), width, height);
    };
    const auto ours = show(stage::splatting(image));
    const auto fixedPoint = show(stage::fixedPointRayCaster(image, 0.25));
    const auto gpu = show(stage::gpuRayCaster(image, 0.25));
    for (int c = 0; c < 3; ++c)
    {
      const stage::Likeness casters(gpu[c], fixedPoint[c]);
      const stage::Likeness toGpu(gpu[c], ours[c]), toFixedPoint(fixedPoint[c], ours[c]);
      const std::string name =
        std::to_string(components) + " components, colour " + std::to_string(c);
      std::cout << name << ": casters " << casters.text() << "; ours and GPU " << toGpu.text()
                << "; ours and fixed point " << toFixedPoint.text() << std::endl;
      check(std::max(toGpu.psnr, toFixedPoint.psnr) >= 39.0,
        name + ": is as one of VTK's ray casters.");
      check(std::max(toGpu.psnr, toFixedPoint.psnr) >= casters.psnr,
        name + ": is nearer to it than the other one.");
    }
  }
  stage.setGrayRamp(0.0, 255.0);
}

/// Other colours need no projection, other kinds of components do.
void testChanges(stage::Stage& stage, stage::Checks& check)
{
  const auto image = noise({ 20, 17, 14 }, 2, 3);
  const auto mapper = stage::splatting(image);
  stage.property->IndependentComponentsOff();
  stage.show(mapper);
  stage.look(directions()[1], { 0.2, 0.9, 0.1 });
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
}

void testBadInput(stage::Stage& stage, stage::Checks& check)
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
}
}

int TestDependentComponents(int, char*[])
{
  stage::Checks check;
  stage::Stage stage(180, 170);
  testTuples(stage, check);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testMeans(stage, check);
    testRayCasters(stage, check);
    testChanges(stage, check);
  }
  testBadInput(stage, check);
  return check.exitCode();
}
