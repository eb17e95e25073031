// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The scalars that are passed to a ray caster in frames without splatting. TestScalarSource
// compares them with the input.
#include "ScalarTesting.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

using namespace scalartesting;

namespace
{
vtkIdType voxelsOf(const Size& size)
{
  return vtkIdType(size[0]) * size[1] * size[2];
}

/// The picture in a blend mode that is ray cast.
stage::Pixels seen(
  stage::Stage& stage, Mapper* mapper, int blendMode = vtkVolumeMapper::COMPOSITE_BLEND)
{
  mapper->SetBlendMode(blendMode);
  stage.show(mapper);
  stage.look({ 0.45, -0.5, -0.74 }, { 0.1, 1.0, 0.0 });
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  return stage.pixels();
}

/// Nothing is seen where all is hidden; after that the volume is there again.
void testNothingShown(stage::Stage& stage, reference::Checks& check)
{
  const Size size = { 20, 16, 24 };
  const vtkIdType voxels = voxelsOf(size);
  const auto scalars = noiseArray(VTK_UNSIGNED_CHAR, voxels, 1, 6);
  vtkNew<vtkUnsignedCharArray> inside;
  inside->SetNumberOfValues(voxels);
  const auto hidden = withoutHidden(scalars, VTK_FLOAT, [](vtkIdType) { return true; });
  const auto masked = stage::splatting(plainImage(size, scalars));
  masked->SetMaskInput(plainImage(size, inside));
  const auto undefined = stage::splatting(plainImage(size, hidden));
  for (int blendMode : { vtkVolumeMapper::COMPOSITE_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    for (Mapper* mapper : { masked.Get(), undefined.Get() })
    {
      inside->FillValue(0);
      inside->Modified();
      const std::string name = std::string(mapper == masked ? "Mask" : "NaN") + ", blend mode " +
        std::to_string(blendMode) + ": ";
      check(isBlack(seen(stage, mapper, blendMode)), name, "nothing is seen.");
      check(isBlack(seen(stage, mapper, blendMode)), name, "nor in the next frame.");
    }
    inside->FillValue(1);
    inside->Modified();
    check(!isBlack(seen(stage, masked, blendMode)), "What is no more hidden is seen.");
  }
}

/// More components than in the frame before, though the property stays as it is.
void testMoreComponents(stage::Stage& stage, reference::Checks& check)
{
  const Size size = { 20, 16, 24 };
  for (int c = 1; c < 4; ++c)
  {
    stage.property->SetColor(c, stage.property->GetRGBTransferFunction(0));
    stage.property->SetScalarOpacity(c, stage.property->GetScalarOpacity(0));
  }
  for (int blendMode : { vtkVolumeMapper::COMPOSITE_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    const std::string name = "Blend mode " + std::to_string(blendMode) + ": ";
    const auto one = plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, voxelsOf(size), 1, 6));
    const auto four = plainImage(size, noiseArray(VTK_UNSIGNED_CHAR, voxelsOf(size), 4, 7));
    const auto mapper = stage::splatting(one), fresh = stage::splatting(four);
    const stage::Pixels first = seen(stage, mapper, blendMode);
    mapper->SetInputData(four);
    const stage::Pixels second = seen(stage, mapper, blendMode);
    check(second == seen(stage, fresh, blendMode), name, "four components in place of one.");
    mapper->SetInputData(one);
    check(first == seen(stage, mapper, blendMode), name, "one component in place of four.");
  }
}

/// A volume that was ray cast does not stay in memory when there is another one, or none.
void testRelease(stage::Stage& stage, reference::Checks& check)
{
  const Size size = { 20, 16, 24 };
  const vtkIdType voxels = voxelsOf(size);
  const auto first = noiseArray(VTK_UNSIGNED_CHAR, voxels, 1, 6);
  const auto second = noiseArray(VTK_UNSIGNED_CHAR, voxels, 1, 7);
  for (int blendMode : { vtkVolumeMapper::COMPOSITE_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    for (bool splat : { true, false })
    {
      const std::string name = "Blend mode " + std::to_string(blendMode) +
        (splat ? ", splatted afterwards: " : ", ray cast afterwards: ");
      const auto mapper = stage::splatting(plainImage(size, first));
      seen(stage, mapper, blendMode);
      check(mapper->GetLastRenderUsedRayCasting(), name, "ray cast.");
      mapper->SetInputData(plainImage(size, second));
      const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
      mapper->SetBlendMode(splat ? vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND : blendMode);
      check(!isBlack(stage.pixels()), name, "the new volume is seen.");
      check(mapper->GetLastRenderUsedRayCasting() != splat, name, "as expected.");
      check(first->GetReferenceCount() == 1, name, "the old scalars are ours alone.");
      check(!isBlack(seen(stage, mapper, blendMode)), name, "the new volume is ray cast again.");
    }
  }
  const auto mapper = stage::splatting(plainImage(size, first));
  vtkNew<vtkUnsignedCharArray> inside;
  inside->SetNumberOfValues(voxels);
  inside->FillValue(1);
  inside->SetValue(0, 0);
  mapper->SetMaskInput(plainImage(size, inside));
  seen(stage, mapper);
  mapper->SetMaskInput(nullptr);
  mapper->SetBlendModeToMaximumIntensity();
  stage.pixels();
  const auto fresh = stage::splatting(plainImage(size, first));
  stage.show(fresh);
  stage.pixels();
  check(mapper->GetIndexMemorySize() == fresh->GetIndexMemorySize(), "Nor does a copy stay.");
  fresh->SetInputData(plainImage(size, second));
  stage.show(mapper);
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  vtkNew<vtkImageData> empty;
  mapper->SetInputData(empty);
  stage.pixels();
  check(first->GetReferenceCount() == 1, "Without voxels, the old scalars are ours alone.");
}
}

//------------------------------------------------------------------------------
int TestRayCastScalars(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(120, 110);
  stage.setGrayRamp(0.0, 110.0);
  testNothingShown(stage, check);
  testRelease(stage, check);
  testMoreComponents(stage, check);
  return check.exitCode();
}
