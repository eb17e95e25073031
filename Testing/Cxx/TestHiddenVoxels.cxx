// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hidden points and cells and masks: the same picture as NaN in a float (or double) image, bit for
// bit.
#include "ScalarTesting.h"

#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataSetAttributes.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRectilinearGrid.h"
#include "vtkRenderer.h"
#include "vtkUniformGrid.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

using namespace scalartesting;

namespace
{
const Size size = { 11, 9, 14 };
constexpr vtkIdType Voxels = 11 * 9 * 14;

constexpr unsigned char HiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
constexpr unsigned char HiddenCell = vtkDataSetAttributes::HIDDENCELL;

/// About a share of the flags have the value, in lumps.
vtkSmartPointer<vtkUnsignedCharArray> flags(
  vtkIdType count, unsigned char value, double share, std::uint64_t seed)
{
  auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetNumberOfValues(count);
  array->SetName(vtkDataSetAttributes::GhostArrayName());
  reference::Random random(seed);
  unsigned char current = 0;
  for (vtkIdType n = 0; n < count; ++n)
  {
    current = n % 3 == 0 ? (random.uniform(0.0, 1.0) < share ? value : 0) : current;
    array->SetValue(n, current);
  }
  return array;
}

/// What all is compared with.
template <class IsHidden>
vtkSmartPointer<vtkDataArray> withoutHidden(vtkDataArray* scalars, int type, IsHidden&& isHidden)
{
  const auto result = componentOf(scalars, 0, type);
  for (vtkIdType n = 0; n < result->GetNumberOfTuples(); ++n)
  {
    if (isHidden(n))
    {
      result->SetComponent(n, 0, vtkMath::Nan());
    }
  }
  return result;
}

//------------------------------------------------------------------------------
void testHiddenPoints(stage::Stage& stage, stage::Checks& check)
{
  const auto ghosts = flags(Voxels, HiddenPoint, 0.4, 5);
  for (const auto& [type, copied] : { std::pair(VTK_UNSIGNED_CHAR, VTK_FLOAT),
         { VTK_FLOAT, VTK_FLOAT }, { VTK_INT, VTK_DOUBLE }, { VTK_LONG_LONG, VTK_DOUBLE } })
  {
    const auto scalars = noiseArray(type, Voxels, 1, 4);
    const auto image = plainImage(size, scalars);
    image->GetPointData()->AddArray(ghosts);
    const auto mapper = stage::splatting(image);
    const auto plain = stage::splatting(plainImage(
      size, withoutHidden(scalars, copied, [&](vtkIdType n) { return ghosts->GetValue(n) != 0; })));
    const std::string name = std::string("Hidden points, ") + vtkImageScalarTypeNameMacro(type);
    expectSame(stage, plain, mapper, name, check);
    check(mapper->GetIndexMemorySize() ==
        plain->GetIndexMemorySize() + Voxels * vtkDataArray::GetDataTypeSize(copied),
      name + ": the copy is counted.");
  }
}

/// A point goes with the last of its cells.
void testCellsThatHidePoints(stage::Stage& stage, stage::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  const auto image = plainImage(size, scalars);
  const auto ghosts = flags(image->GetNumberOfCells(), HiddenCell, 0.85, 6);
  image->GetCellData()->AddArray(ghosts);
  vtkNew<vtkIdList> cells;
  int hidden = 0;
  const auto plain = withoutHidden(scalars, VTK_FLOAT,
    [&](vtkIdType n)
    {
      image->GetPointCells(n, cells);
      bool all = true;
      for (vtkIdType c = 0; c < cells->GetNumberOfIds(); ++c)
      {
        all = all && ghosts->GetValue(cells->GetId(c)) != 0;
      }
      hidden += all;
      return all;
    });
  check(hidden > 50 && hidden < Voxels - 50, "Some points are hidden by cells.");
  expectSame(stage, stage::splatting(plainImage(size, plain)), stage::splatting(image),
    "Cells that hide points", check);
}

/// Cells are hidden as vtkImageData::IsCellVisible() tells: by themselves and by their points.
void testHiddenCells(stage::Stage& stage, stage::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  const auto image = cellImage(size, scalars);
  image->GetCellData()->AddArray(flags(Voxels, HiddenCell, 0.3, 7));
  image->GetPointData()->AddArray(flags(image->GetNumberOfPoints(), HiddenPoint, 0.05, 8));
  const auto plain = cellImage(
    size, withoutHidden(scalars, VTK_FLOAT, [&](vtkIdType n) { return !image->IsCellVisible(n); }));
  expectSame(stage, stage::splatting(plain), stage::splatting(image), "Hidden cells", check);
}

/// Duplicates belong to another process, too, but they are there.
void testDuplicates(stage::Stage& stage, stage::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  const auto image = plainImage(size, scalars);
  image->GetPointData()->AddArray(flags(Voxels, vtkDataSetAttributes::DUPLICATEPOINT, 0.5, 9));
  const auto mapper = stage::splatting(image);
  const auto plain = stage::splatting(plainImage(size, scalars));
  expectSame(stage, plain, mapper, "Duplicates", check);
  check(mapper->GetIndexMemorySize() == plain->GetIndexMemorySize(), "Duplicates: no copy.");
}

/// Blanked one after the other, and all at once; nothing is left then.
void testBlankPoint(stage::Stage& stage, stage::Checks& check)
{
  const auto scalars = noiseArray(VTK_SHORT, Voxels, 1, 4);
  vtkNew<vtkUniformGrid> image;
  image->ShallowCopy(plainImage(size, scalars));
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.look(directions()[2], { 0.0, 1.0, 0.1 });
  const stage::Pixels before = stage.pixels();
  for (vtkIdType n = 0; n < Voxels; n += 3)
  {
    image->BlankPoint(n);
  }
  image->Modified();
  const stage::Pixels some = stage.pixels();
  check(some != before && !isBlack(some), "BlankPoint() is noticed.");
  for (vtkIdType n = 0; n < Voxels; ++n)
  {
    image->BlankPoint(n);
  }
  image->Modified();
  check(isBlack(stage.pixels()), "Nothing is left of a volume that is hidden.");
  for (vtkIdType n = 0; n < Voxels; ++n)
  {
    image->UnBlankPoint(n);
  }
  image->Modified();
  check(stage.pixels() == before, "Nothing is missing of a volume that is shown again.");
}

//------------------------------------------------------------------------------
/// Not 0 shows, as in the GPU ray caster's shader; the mask adds to what is hidden otherwise.
void testMask(stage::Stage& stage, stage::Checks& check)
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
void testMaskOfCells(stage::Stage& stage, stage::Checks& check)
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
void testMaskOfComponents(stage::Stage& stage, stage::Checks& check)
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

//------------------------------------------------------------------------------
/// Holes of a resampled grid are as near to its hidden points as its points let it.
void testHolesOfGrids(stage::Stage& stage, stage::Checks& check)
{
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(5, 3, 2);
  const double places[] = { 0.0, 1.0, 4.0, 5.0, 6.0 };
  vtkSmartPointer<vtkDataArray> axes[3];
  for (int a = 0; a < 3; ++a)
  {
    axes[a] = noiseArray(VTK_DOUBLE, a == 0 ? 5 : a == 1 ? 3 : 2, 1, 1);
    for (vtkIdType n = 0; n < axes[a]->GetNumberOfTuples(); ++n)
    {
      axes[a]->SetComponent(n, 0, a == 0 ? places[n] : double(n));
    }
  }
  grid->SetXCoordinates(axes[0]);
  grid->SetYCoordinates(axes[1]);
  grid->SetZCoordinates(axes[2]);
  const auto scalars = noiseArray(VTK_FLOAT, 5 * 3 * 2, 1, 4);
  grid->GetPointData()->SetScalars(scalars);
  const auto ghosts = flags(5 * 3 * 2, 0, 0.0, 1);
  const auto resampled = noiseArray(VTK_FLOAT, 7 * 3 * 2, 1, 1);
  for (int row = 0; row < 6; ++row)
  {
    // The third point is at 4; two more lie between it and the second one. The hole reaches to the
    // nearer one, and the other has no share of it.
    const bool hole = row == 3;
    ghosts->SetValue(row * 5 + 2, hole ? HiddenPoint : 0);
    const auto point = [&](int n) { return scalars->GetComponent(row * 5 + n, 0); };
    const double values[7] = { point(0), point(1),
      hole ? point(1) : (2.0 * point(1) + point(2)) / 3.0,
      hole ? vtkMath::Nan() : (point(1) + 2.0 * point(2)) / 3.0, hole ? vtkMath::Nan() : point(2),
      point(3), point(4) };
    for (int n = 0; n < 7; ++n)
    {
      resampled->SetComponent(row * 7 + n, 0, values[n]);
    }
  }
  grid->GetPointData()->AddArray(ghosts);
  const auto image = plainImage({ 7, 3, 2 }, resampled);
  image->SetSpacing(1.0, 1.0, 1.0);
  image->SetOrigin(0.0, 0.0, 0.0);
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetInputData(grid);
  expectSame(stage, stage::splatting(image), mapper, "Holes of grids", check);
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
void testRayCasting(stage::Checks& check)
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

/// A mask and blanked points against VTK's GPU ray caster.
void testAgainstGPU(bool byMask, stage::Checks& check)
{
  stage::Stage stage(200, 190);
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
  check(likeness.psnr > 35.0 && likeness.largestShift() < 0.1, name + ": the GPU ray caster's.");
  rayCaster->ReleaseGraphicsResources(stage.window);
}
}

//------------------------------------------------------------------------------
int TestHiddenVoxels(int, char*[])
{
  stage::Checks check;
  {
    stage::Stage stage(120, 110);
    stage.setGrayRamp(0.0, 110.0);
    testHiddenPoints(stage, check);
    testCellsThatHidePoints(stage, check);
    testHiddenCells(stage, check);
    testDuplicates(stage, check);
    testBlankPoint(stage, check);
    testMask(stage, check);
    testMaskOfCells(stage, check);
    testMaskOfComponents(stage, check);
    testHolesOfGrids(stage, check);
  }
  testRayCasting(check);
  testAgainstGPU(true, check);
  testAgainstGPU(false, check);
  return check.exitCode();
}
