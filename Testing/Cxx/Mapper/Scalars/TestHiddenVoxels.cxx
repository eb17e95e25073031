// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hidden points and cells: the same picture as NaN in a float (or double) image, bit for bit.
#include "ScalarTesting.h"

#include "vtkIdList.h"
#include "vtkRectilinearGrid.h"
#include "vtkUniformGrid.h"

#include <utility>

using namespace scalartesting;

namespace
{
const Size size = { 11, 9, 14 };
constexpr vtkIdType Voxels = 11 * 9 * 14;

constexpr unsigned char HiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
constexpr unsigned char HiddenCell = vtkDataSetAttributes::HIDDENCELL;

//------------------------------------------------------------------------------
void testHiddenPoints(stage::Stage& stage, reference::Checks& check)
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
      name, ": the copy is counted.");
  }
}

/// A point goes with the last of its cells.
void testCellsThatHidePoints(stage::Stage& stage, reference::Checks& check)
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
void testHiddenCells(stage::Stage& stage, reference::Checks& check)
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
void testDuplicates(stage::Stage& stage, reference::Checks& check)
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
void testBlankPoint(stage::Stage& stage, reference::Checks& check)
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
/// Holes of a resampled grid are as near to its hidden points as its points let it.
void testHolesOfGrids(stage::Stage& stage, reference::Checks& check)
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
}

//------------------------------------------------------------------------------
int TestHiddenVoxels(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(120, 110);
  stage.setGrayRamp(0.0, 110.0);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    testHiddenPoints(stage, check);
    testCellsThatHidePoints(stage, check);
    testHiddenCells(stage, check);
    testDuplicates(stage, check);
    testBlankPoint(stage, check);
    testHolesOfGrids(stage, check);
  }
  return check.exitCode();
}
