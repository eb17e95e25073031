// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares rectilinear grids with equal steps with images, and tests the messages about grids that
// cannot be resampled with their smallest step. TestVolumeGrid and TestScalarSource test other
// grids.
#include "ScalarTesting.h"

#include "vtkCommand.h"
#include "vtkRectilinearGrid.h"

#include <cmath>

using namespace scalartesting;

namespace
{
const Size size = { 11, 9, 14 };
constexpr vtkIdType Voxels = 11 * 9 * 14;

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataArray> coordinates(int type, const std::vector<double>& values)
{
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  for (double value : values)
  {
    array->InsertNextTuple1(value);
  }
  return array;
}

/// first, first + step, ...
std::vector<double> equalSteps(int count, double first, double step)
{
  std::vector<double> values;
  for (int n = 0; n < count; ++n)
  {
    values.push_back(first + n * step);
  }
  return values;
}

using Axes = std::array<std::vector<double>, 3>;

vtkSmartPointer<vtkRectilinearGrid> gridOf(const Axes& axes, int type)
{
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetDimensions(static_cast<int>(axes[0].size()), static_cast<int>(axes[1].size()),
    static_cast<int>(axes[2].size()));
  grid->SetXCoordinates(coordinates(type, axes[0]));
  grid->SetYCoordinates(coordinates(type, axes[1]));
  grid->SetZCoordinates(coordinates(type, axes[2]));
  return grid;
}

/// Where bareImage() has its points.
Axes equalAxes(const Size& points)
{
  return { equalSteps(points[0], -3.0, 1.0), equalSteps(points[1], 2.0, 1.25),
    equalSteps(points[2], 5.5, 0.75) };
}

/// Equal steps: the same as the image, in float and in double, without a copy.
void testEqualSteps(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_UNSIGNED_SHORT, Voxels, 1, 4);
  for (int type : { VTK_FLOAT, VTK_DOUBLE, VTK_INT })
  {
    Axes axes = equalAxes(size);
    const auto image = plainImage(size, scalars);
    if (type == VTK_INT)
    {
      axes = { equalSteps(size[0], 7, 2), equalSteps(size[1], -3, 1), equalSteps(size[2], 0, 1) };
      image->SetSpacing(2.0, 1.0, 1.0);
      image->SetOrigin(7.0, -3.0, 0.0);
    }
    const auto grid = gridOf(axes, type);
    grid->GetPointData()->SetScalars(scalars);
    auto mapper = vtkSmartPointer<Mapper>::New();
    mapper->SetInputData(grid);
    const auto plain = stage::splatting(image);
    expectSame(stage, plain, mapper, "Equal steps", check);
    check(mapper->GetIndexMemorySize() == plain->GetIndexMemorySize(), "Equal steps: no copy.");
  }
  const auto grid = gridOf(equalAxes({ size[0] + 1, size[1] + 1, size[2] + 1 }), VTK_DOUBLE);
  grid->GetCellData()->SetScalars(scalars);
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetInputData(grid);
  expectSame(
    stage, stage::splatting(cellImage(size, scalars)), mapper, "Cells with equal steps", check);
}

/// Steps that would ask for 10^18 voxels are enlarged to the limit; a byte each.
void testLimit(stage::Stage& stage, reference::Checks& check)
{
  const std::vector<double> axis = { 0.0, 10.0, 10.00001, 20.0 };
  const auto grid = gridOf({ axis, axis, axis }, VTK_DOUBLE);
  const auto scalars = noiseArray(VTK_UNSIGNED_CHAR, 27, 1, 1);
  scalars->Fill(55.0); // half of the ramp
  grid->GetCellData()->SetScalars(scalars);
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetQualityModeToPreview();
  mapper->SetInputData(grid);
  stage.show(mapper);
  stage.look({ 0.0, 0.0, -1.0 }, { 0.0, 1.0, 0.0 });
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  stage.pixels();
  const stage::Pixels picture = stage.pixels();
  check(warnings.texts.size() == 1 && warnings.texts[0].find("larger steps") != std::string::npos,
    "Many small steps: one warning.");
  check(std::abs(picture[3 * (55 * 120 + 60)] - 127.5) <= 1.0, "Many small steps: the picture.");
  const double size = static_cast<double>(mapper->GetIndexMemorySize());
  const double limit = 1 << 26;
  check(size > 0.9 * limit && size <= limit * (1.0 + 4.0 / 128.0), "Many small steps: the limit.");
}

}

//------------------------------------------------------------------------------
int TestScalarGrids(int, char*[])
{
  reference::Checks check;
  {
    stage::Stage stage(120, 110);
    stage.setGrayRamp(0.0, 110.0);
    for (double viewAngle : { 0.0, 50.0 })
    {
      stage.viewAngle = viewAngle;
      testEqualSteps(stage, check);
    }
    stage.viewAngle = 0.0;
    testLimit(stage, check);
  }
  return check.exitCode();
}
