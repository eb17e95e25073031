// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Masks are NaN, bit for bit; masks and hidden points are what VTK's GPU ray caster makes of them,
// and what is ray cast has them, too.
#include "ScalarTesting.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderer.h"
#include "vtkUniformGrid.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

using namespace scalartesting;

namespace
{
const Size size = { 11, 9, 14 };
constexpr vtkIdType Voxels = 11 * 9 * 14;

constexpr unsigned char HiddenPoint = vtkDataSetAttributes::HIDDENPOINT;

//------------------------------------------------------------------------------
/// Not 0 shows, as in the GPU ray caster's shader; the mask adds to what is hidden otherwise.
void testMask(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_UNSIGNED_SHORT, Voxels, 1, 4);
  const auto inside = flags(Voxels, 1, 0.6, 10);
  inside->SetName("mask");
  const auto mask = plainImage(size, inside);
  const auto image = plainImage(size, scalars);
  const auto mapper = stage::splatting(image);
  mapper->SetMaskInput(mask);
  const auto isOutside = [&](vtkIdType n) { return inside->GetValue(n) == 0; };
  const auto plain = plainImage(size, withoutHidden(scalars, VTK_FLOAT, isOutside));
  expectSame(stage, stage::splatting(plain), mapper, "Mask", check);

  // Another mask without a word from the mapper, values above 1.
  for (vtkIdType n = 0; n < Voxels; n += 2)
  {
    inside->SetValue(n, n % 4 ? 0 : 255);
  }
  inside->Modified();
  const auto changed = plainImage(size, withoutHidden(scalars, VTK_FLOAT, isOutside));
  expectSame(stage, stage::splatting(changed), mapper, "Changed mask", check);

  const auto ghosts = flags(Voxels, HiddenPoint, 0.2, 11);
  image->GetPointData()->AddArray(ghosts);
  const auto both = plainImage(size,
    withoutHidden(
      scalars, VTK_FLOAT, [&](vtkIdType n) { return isOutside(n) || ghosts->GetValue(n) != 0; }));
  expectSame(stage, stage::splatting(both), mapper, "Mask and hidden points", check);

  mapper->SetMaskInput(nullptr);
  image->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  expectSame(stage, stage::splatting(plainImage(size, scalars)), mapper, "No mask", check);
}

/// The mask of cells has their number of points, or of cells.
void testMaskOfCells(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  const auto inside = flags(Voxels, 255, 0.6, 12);
  inside->SetName("mask");
  const auto plain = stage::splatting(cellImage(size,
    withoutHidden(scalars, VTK_FLOAT, [&](vtkIdType n) { return inside->GetValue(n) == 0; })));
  for (const auto& mask : { plainImage(size, inside), cellImage(size, inside) })
  {
    const auto mapper = stage::splatting(cellImage(size, scalars));
    mapper->SetMaskInput(mask);
    expectSame(stage, plain, mapper, "Mask of cells", check);
  }
}

/// Every component has the same holes.
void testMaskOfComponents(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 2, 4);
  const auto inside = flags(Voxels, 255, 0.6, 12);
  inside->SetName("mask");
  const auto holes = noiseArray(VTK_FLOAT, Voxels, 2, 4);
  for (vtkIdType n = 0; n < 2 * Voxels; ++n)
  {
    holes->SetComponent(n / 2, static_cast<int>(n % 2),
      inside->GetValue(n / 2) ? scalars->GetComponent(n / 2, static_cast<int>(n % 2))
                              : vtkMath::Nan());
  }
  const auto mapper = stage::splatting(plainImage(size, scalars));
  mapper->SetMaskInput(plainImage(size, inside));
  expectSame(stage, stage::splatting(plainImage(size, holes)), mapper, "Mask of components", check);
}

/// A mask that hides nothing costs nothing.
void testMaskOfNothing(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  vtkNew<vtkUnsignedCharArray> inside;
  inside->SetNumberOfValues(Voxels);
  inside->FillValue(3);
  const auto plain = stage::splatting(plainImage(size, scalars));
  const auto mapper = stage::splatting(plainImage(size, scalars));
  mapper->SetMaskInput(plainImage(size, inside));
  expectSame(stage, plain, mapper, "Mask of nothing", check);
  check(mapper->GetIndexMemorySize() == plain->GetIndexMemorySize(), "Nothing hidden, no copy.");
  inside->SetValue(5, 0);
  inside->Modified();
  stage.pixels();
  check(mapper->GetIndexMemorySize() > plain->GetIndexMemorySize(), "One hidden, a copy.");
}

/// Voxels of one slice have nothing to be interpolated with, and are shown all the same.
void testThinMask(stage::Stage& stage, reference::Checks& check)
{
  const auto inside = flags(Voxels, 0, 0.0, 1);
  const auto mapper =
    stage::splatting(plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, Voxels, 1, 4)));
  mapper->SetMaskInput(plainImage(size, inside));
  const vtkIdType slice = vtkIdType(size[0]) * size[1];
  for (int slices = 1; slices <= 2; ++slices)
  {
    std::fill_n(inside->GetPointer(2 * slice), slices * slice, static_cast<unsigned char>(1));
    inside->Modified();
    for (const int mode : { vtkSplattingMIPVolumeMapper::HIGH, vtkSplattingMIPVolumeMapper::EXACT })
    {
      mapper->SetQualityMode(mode);
      stage.show(mapper);
      const std::vector<double> pixels = stage.gray().value;
      const bool isShown =
        std::any_of(pixels.begin(), pixels.end(), [](double pixel) { return pixel > 0.0; });
      check(isShown, "A mask of ", slices, " slices in mode ", mode, ".");
    }
  }
}

//------------------------------------------------------------------------------
/// Twice the same blobs and tubes side by side, with nothing where they meet, so that it does not
/// matter where between two voxels a renderer cuts.
const Size Twins = { 96, 40, 44 };

vtkSmartPointer<vtkDataArray> twins()
{
  const auto blobs = stage::blobsAndTubes({ 48, 40, 44 }, 14);
  auto scalars = vtkSmartPointer<vtkUnsignedCharArray>::New();
  for (int k = 0; k < Twins[2]; ++k)
  {
    for (int j = 0; j < Twins[1]; ++j)
    {
      for (int i = 0; i < Twins[0]; ++i)
      {
        scalars->InsertNextValue(blobs.at(i % 48, j, k));
      }
    }
  }
  return scalars;
}

bool isSecondTwin(vtkIdType voxel)
{
  return voxel % Twins[0] >= 48;
}

vtkSmartPointer<vtkImageData> maskOfTwins()
{
  const auto mask = plainImage(Twins, twins());
  for (vtkIdType n = 0; n < mask->GetNumberOfPoints(); ++n)
  {
    mask->GetPointData()->GetScalars()->SetComponent(n, 0, isSecondTwin(n) ? 0.0 : 255.0);
  }
  return mask;
}

/// What is not splatted gets the same voxels: here a blend mode for
/// vtkFixedPointVolumeRayCastMapper, which knows neither cells nor masks nor vectors.
void testRayCasting(reference::Checks& check)
{
  stage::Stage stage(200, 190);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(20.0, 0.0);
  opacity->AddPoint(255.0, 0.4);
  stage.property->SetScalarOpacity(opacity);
  const auto scalars = twins();
  vtkNew<vtkUnsignedCharArray> vectors;
  vectors->SetNumberOfComponents(2);
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n)
  {
    vectors->InsertNextTuple2(7.0, scalars->GetComponent(n, 0));
  }
  const auto image = bareImage({ Twins[0] + 1, Twins[1] + 1, Twins[2] + 1 });
  image->GetCellData()->SetScalars(vectors);
  const auto mapper = stage::splatting(image);
  mapper->SetMaskInput(maskOfTwins());
  mapper->SetVectorModeToComponent();
  mapper->SetVectorComponent(1);
  mapper->SetBlendModeToComposite();
  stage.show(mapper);
  stage.look({ 0.4, -0.3, 0.8 }, { 0.0, 1.0, 0.0 });
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  const stage::Pixels picture = stage.pixels();
  check(mapper->GetLastRenderUsedRayCasting() && warnings.texts.size() == 1,
    "Other blend modes are not splatted.");

  const auto shown = componentOf(scalars, 0, VTK_FLOAT);
  for (vtkIdType n = 0; n < shown->GetNumberOfTuples(); ++n)
  {
    shown->SetComponent(n, 0, isSecondTwin(n) ? 0.0 : shown->GetComponent(n, 0));
  }
  const auto points = plainImage(Twins, shown);
  const double* const spacing = image->GetSpacing();
  const double* const origin = image->GetOrigin();
  points->SetOrigin(
    origin[0] + spacing[0] / 2, origin[1] + spacing[1] / 2, origin[2] + spacing[2] / 2);
  const auto rayCaster = stage::fixedPointRayCaster(points, 0.75);
  rayCaster->SetBlendModeToComposite();
  stage.show(rayCaster);
  check(!isBlack(picture) && stage.pixels() == picture, "Ray casting meets the same voxels.");
}

/// Hidden voxels have the lowest value in what is ray cast, and so have those without a number.
void testRayCastHoles(bool byMask, reference::Checks& check)
{
  stage::Stage stage(200, 190);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(20.0, 0.2);
  opacity->AddPoint(255.0, 0.02);
  stage.property->SetScalarOpacity(opacity);
  const auto scalars = componentOf(twins(), 0, VTK_FLOAT);
  const vtkIdType voxels = scalars->GetNumberOfTuples();
  for (vtkIdType n = 0; n < voxels; ++n)
  {
    scalars->SetComponent(n, 0, 240.0 - 0.8 * scalars->GetComponent(n, 0)); // from 36 to 240
  }
  const auto holes = withoutHidden(scalars, VTK_FLOAT, isSecondTwin);
  const auto mapper = stage::splatting(plainImage(Twins, byMask ? scalars : holes));
  mapper->SetMaskInput(byMask ? maskOfTwins().Get() : nullptr);
  mapper->SetBlendModeToComposite();
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  const auto shown = componentOf(scalars, 0);
  for (vtkIdType n = 0; n < voxels; ++n)
  {
    const double lowest = scalars->GetRange()[0]; // of the first twin, too
    shown->SetComponent(n, 0, isSecondTwin(n) ? lowest : scalars->GetComponent(n, 0));
  }
  const auto rayCaster = stage::fixedPointRayCaster(plainImage(Twins, shown), 0.75);
  rayCaster->SetBlendModeToComposite();
  stage.show(rayCaster);
  stage.look({ 0.8, -0.3, 0.4 }, { 0.0, 1.0, 0.0 }); // through both
  const stage::Pixels truth = stage.pixels();
  stage.show(mapper);
  const stage::Pixels picture = stage.pixels();
  const std::string name = byMask ? "Mask" : "NaN";
  check(mapper->GetLastRenderUsedRayCasting(), name, ": ray cast.");
  check(!isBlack(truth) && picture == truth, name, ": what is hidden has the lowest value.");
}

/// A mask and blanked points against VTK's GPU ray caster.
void testAgainstGPU(bool byMask, double viewAngle, reference::Checks& check)
{
  stage::Stage stage(200, 190);
  stage.viewAngle = viewAngle;
  vtkNew<vtkUniformGrid> image;
  image->ShallowCopy(plainImage(Twins, twins()));
  const auto mask = maskOfTwins();
  for (vtkIdType n = 0; n < image->GetNumberOfPoints() && !byMask; ++n)
  {
    if (isSecondTwin(n))
    {
      image->BlankPoint(n);
    }
  }
  const auto mapper = stage::splatting(image);
  mapper->SetMaskInput(byMask ? mask.Get() : nullptr);
  stage.show(mapper);
  stage.look({ 0.4, -0.3, 0.8 }, { 0.0, 1.0, 0.0 });
  const auto picture = stage.gray();
  const auto rayCaster = stage::gpuRayCaster(image, 0.2);
  rayCaster->SetMaskInput(byMask ? mask.Get() : nullptr);
  rayCaster->SetMaskTypeToBinary();
  stage.show(rayCaster);
  const stage::Likeness likeness(stage.gray(), picture);
  const std::string name = byMask ? "Mask" : "Blanked points";
  std::cout << name << ": " << likeness.text() << std::endl;
  check(likeness.psnr > 35.0 && likeness.largestShift() < 0.1, name, ": the GPU ray caster's.");
  rayCaster->ReleaseGraphicsResources(stage.window);
}
}

//------------------------------------------------------------------------------
int TestMask(int, char*[])
{
  reference::Checks check;
  {
    stage::Stage stage(120, 110);
    stage.setGrayRamp(0.0, 110.0);
    for (double viewAngle : { 0.0, 50.0 })
    {
      stage.viewAngle = viewAngle;
      testMask(stage, check);
      testMaskOfCells(stage, check);
      testMaskOfComponents(stage, check);
      testMaskOfNothing(stage, check);
      testThinMask(stage, check);
    }
  }
  testRayCasting(check);
  testRayCastHoles(true, check);
  testRayCastHoles(false, check);
  for (double viewAngle : { 0.0, 50.0 })
  {
    testAgainstGPU(true, viewAngle, check);
    testAgainstGPU(false, viewAngle, check);
  }
  return check.exitCode();
}
