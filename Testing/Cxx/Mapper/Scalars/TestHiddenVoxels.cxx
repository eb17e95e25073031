// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares pictures with masks and hidden points with VTK's GPU ray caster. TestBlanking tests
// which voxels are hidden, TestScalarSource the values of the others.
#include "ScalarTesting.h"

#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkUniformGrid.h"

#include <iostream>

using namespace scalartesting;

namespace
{
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
int TestHiddenVoxels(int, char*[])
{
  reference::Checks check;
  for (double viewAngle : { 0.0, 50.0 })
  {
    testAgainstGPU(true, viewAngle, check);
    testAgainstGPU(false, viewAngle, check);
  }
  return check.exitCode();
}
