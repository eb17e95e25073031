// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cell scalars: voxels are the cells, half a voxel from the points, and the picture covers the
// cells. TestVolumeGrid tests the position of each voxel.
#include "ScalarTesting.h"

#include "vtkCamera.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkRenderer.h"

#include <cmath>
#include <iostream>

using namespace scalartesting;

namespace
{
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

}

//------------------------------------------------------------------------------
int TestCellScalars(int, char*[])
{
  reference::Checks check;
  testBoundsOfCells(check);
  testCellsAgainstGPU(check);
  return check.exitCode();
}
