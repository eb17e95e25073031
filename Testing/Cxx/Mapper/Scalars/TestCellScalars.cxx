// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells are voxels half a voxel from the points, and the picture ends with them.
#include "ScalarTesting.h"

#include "vtkCamera.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkRenderer.h"

#include <cmath>
#include <iostream>

using namespace scalartesting;

namespace
{
const Size size = { 11, 9, 14 };
constexpr vtkIdType Voxels = 11 * 9 * 14;

//------------------------------------------------------------------------------
/// Cells are points half a voxel further on.
void testCellsAsPoints(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  const auto cells = cellImage(size, scalars);
  const auto points = plainImage(size, scalars);
  const double* const spacing = cells->GetSpacing();
  const double* const origin = cells->GetOrigin();
  points->SetOrigin(
    origin[0] + spacing[0] / 2, origin[1] + spacing[1] / 2, origin[2] + spacing[2] / 2);
  const auto mapper = stage::splatting(cells);
  const auto plain = stage::splatting(points);
  expectSame(stage, plain, mapper, "Cells", check, false);
  // In mode EXACT the field goes on to the sides of cells: they need a little more.
  const vtkIdType copy = Voxels * vtkIdType(sizeof(short));
  check(mapper->GetIndexMemorySize() < plain->GetIndexMemorySize() + copy, "Cells: no copy.");

  // Cropping lies where it is told to, whatever voxels are.
  for (vtkVolumeMapper* cropped : { plain.Get(), mapper.Get() })
  {
    cropped->CroppingOn();
    cropped->SetCroppingRegionPlanes(-1.2, 4.1, 4.3, 11.9, 7.0, 12.6);
  }
  expectSame(stage, plain, mapper, "Cropped cells", check, false);
}

/// Where both show something it is the same, and that is where points end: their outermost centres
/// are half a voxel within.
void testPictureOfCells(const Size& cells, stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, vtkIdType(cells[0]) * cells[1] * cells[2], 1, 4);
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n)
  {
    scalars->SetComponent(n, 0, scalars->GetComponent(n, 0) / 2 + 50.0); // none is black
  }
  // A layer of cells lies on its points.
  const Size points = { cells[0] + 1, cells[1] + 1, cells[2] > 1 ? cells[2] + 1 : 1 };
  const auto cellImage = bareImage(points);
  cellImage->GetCellData()->SetScalars(scalars);
  cellImage->SetDirectionMatrix(0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1);
  const auto pointImage = plainImage(cells, scalars);
  pointImage->SetDirectionMatrix(cellImage->GetDirectionMatrix());
  double middle[3];
  cellImage->TransformContinuousIndexToPhysicalPoint(0.5, 0.5, cells[2] > 1 ? 0.5 : 0.0, middle);
  pointImage->SetOrigin(middle);
  const auto cellMapper = stage::splatting(cellImage);
  const auto pointMapper = stage::splatting(pointImage);
  // The field of mode EXACT goes on to where the picture ends.
  cellMapper->SetQualityModeToHigh();
  pointMapper->SetQualityModeToHigh();
  for (const stage::Vector& direction : directions())
  {
    stage.show(cellMapper);
    stage.look(direction, { 0.0, 1.0, 0.1 });
    const stage::Pixels cellPicture = stage.pixels();
    stage.show(pointMapper);
    const stage::Pixels pointPicture = stage.pixels();
    int differences = 0, beyond = 0;
    for (std::size_t n = 0; n < cellPicture.size(); ++n)
    {
      // The two origins differ by roundings, which may turn a colour's last bit.
      differences += pointPicture[n] != 0 && std::abs(cellPicture[n] - pointPicture[n]) > 1;
      beyond += pointPicture[n] == 0 && cellPicture[n] != 0;
    }
    check(differences == 0 && beyond > 100, "Cells: the points' picture with a wider rim.");
  }
}

/// Seen along an axis, the picture of cells fills the projection of the bounds: pixel centres
/// within them and no others.
void testBoundsOfCells(reference::Checks& check)
{
  stage::Stage stage(120, 110);
  const auto scalars = noiseArray(VTK_UNSIGNED_CHAR, 5 * 4 * 3, 1, 4);
  scalars->Fill(255.0);
  const auto image = cellImage({ 5, 4, 3 }, scalars);
  image->SetSpacing(3.1, 4.3, 2.7);
  image->SetExtent(2, 7, -1, 3, 6, 9);
  stage.show(stage::splatting(image));
  stage.look({ 0.0, 0.0, -1.0 }, { 0.0, 1.0, 0.0 });
  const stage::Pixels pixels = stage.pixels();
  const double pixel = 2.0 * stage.renderer->GetActiveCamera()->GetParallelScale() / 110;
  int wrong = 0;
  for (int y = 0; y < 110; ++y)
  {
    for (int x = 0; x < 120; ++x)
    {
      const bool inside =
        std::abs(x - 59.5) * pixel <= 2.5 * 3.1 && std::abs(y - 54.5) * pixel <= 2.0 * 4.3;
      wrong += (pixels[3 * (120 * y + x)] == 255) != inside;
    }
  }
  check(wrong == 0, "Cells: the picture ends with the bounds.");
}

/// Smooth contents against VTK's GPU ray caster.
void testCellsAgainstGPU(reference::Checks& check)
{
  stage::Stage stage(200, 190);
  const Size large = { 48, 40, 44 };
  const auto blobs = stage::toImageData(stage::blobsAndTubes(large, 14));
  const auto image = cellImage(large, blobs->GetPointData()->GetScalars());
  const auto mapper = stage::splatting(image);
  for (const stage::Vector& direction : directions())
  {
    stage.show(mapper);
    stage.look(direction, { 0.0, 1.0, 0.0 });
    const auto picture = stage.gray();
    const auto rayCaster = stage::gpuRayCaster(image, 0.2);
    stage.show(rayCaster);
    const stage::Likeness likeness(stage.gray(), picture);
    std::cout << "Cells: " << likeness.text() << std::endl;
    // Two thirds of a pixel would be wrong by half a voxel.
    check(likeness.psnr > 35.0 && likeness.largestShift() < 0.1, "Cells are the GPU ray caster's.");
    rayCaster->ReleaseGraphicsResources(stage.window);
  }
}

/// One point along an axis is one layer of cells about it, as for points.
void testFlatCells(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_FLOAT, 12 * 10, 1, 4);
  const auto cells = bareImage({ 13, 11, 1 });
  cells->GetCellData()->SetScalars(scalars);
  const auto points = plainImage({ 12, 10, 1 }, scalars);
  const double* const spacing = cells->GetSpacing();
  const double* const origin = cells->GetOrigin();
  points->SetOrigin(origin[0] + spacing[0] / 2, origin[1] + spacing[1] / 2, origin[2]);
  expectSame(stage, stage::splatting(points), stage::splatting(cells), "Flat cells", check, false);
}
}

//------------------------------------------------------------------------------
int TestCellScalars(int, char*[])
{
  reference::Checks check;
  {
    stage::Stage stage(120, 110);
    stage.setGrayRamp(0.0, 110.0);
    for (double viewAngle : { 0.0, 50.0 })
    {
      stage.viewAngle = viewAngle;
      testCellsAsPoints(stage, check);
      testPictureOfCells(size, stage, check);
      testPictureOfCells({ 15, 12, 1 }, stage, check);
      testFlatCells(stage, check);
    }
  }
  testBoundsOfCells(check);
  testCellsAgainstGPU(check);
  return check.exitCode();
}
