// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rectilinear grids with equal steps are the same as images, others are resampled.
#include "ScalarTesting.h"

#include "vtkCommand.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkRectilinearGrid.h"

#include <algorithm>
#include <cmath>
#include <iostream>

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

/// Descending coordinates are an image with negative spacing.
void testDescending(stage::Stage& stage, reference::Checks& check)
{
  const auto scalars = noiseArray(VTK_UNSIGNED_CHAR, Voxels, 1, 4);
  Axes axes = equalAxes(size);
  axes[1] = equalSteps(size[1], 2.0, -1.25);
  const auto grid = gridOf(axes, VTK_DOUBLE);
  grid->GetPointData()->SetScalars(scalars);
  const auto image = plainImage(size, scalars);
  image->SetSpacing(1.0, -1.25, 0.75);
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetInputData(grid);
  const auto plain = stage::splatting(image);
  expectSame(stage, plain, mapper, "Descending coordinates", check);
  for (vtkVolumeMapper* cropped : { plain.Get(), mapper.Get() })
  {
    cropped->CroppingOn();
    cropped->SetCroppingRegionPlanes(-1.2, 4.1, -6.0, 0.3, 7.0, 12.6);
  }
  expectSame(stage, plain, mapper, "Cropped grid", check);
}

/// Steps of 1, 2 and 3: the least one divides all, so that points are where they were and others
/// lie between.
Axes unequalAxes()
{
  return { { { 0, 1, 2, 4, 5, 8, 9, 10, 12, 13 }, { -4, -3, -1, 0, 1, 2, 5, 6 },
    { 2, 4, 5, 6, 9, 10, 11 } } };
}

/// The value at a position of an axis: weights of two points.
struct Between
{
  int index;
  double fraction;
};

Between between(const std::vector<double>& axis, double at)
{
  int n = 0;
  while (n + 2 < static_cast<int>(axis.size()) && axis[n + 1] <= at)
  {
    ++n;
  }
  return { n, (at - axis[n]) / (axis[n + 1] - axis[n]) };
}

/// Trilinear interpolation of points, or the cell that holds the position.
double valueAt(
  const Axes& axes, bool cells, vtkDataArray* scalars, const std::array<double, 3>& position)
{
  const Between x = between(axes[0], position[0]), y = between(axes[1], position[1]),
                z = between(axes[2], position[2]);
  const vtkIdType less = cells ? 1 : 0;
  const vtkIdType width = vtkIdType(axes[0].size()) - less,
                  height = vtkIdType(axes[1].size()) - less;
  const auto voxel = [&](int i, int j, int k) {
    return scalars->GetComponent(((z.index + k) * height + y.index + j) * width + x.index + i, 0);
  };
  if (cells)
  {
    return voxel(0, 0, 0);
  }
  double sum = 0.0;
  for (int n = 0; n < 8; ++n)
  {
    const int i = n & 1, j = (n >> 1) & 1, k = n >> 2;
    const double weight = (i ? x.fraction : 1.0 - x.fraction) *
      (j ? y.fraction : 1.0 - y.fraction) * (k ? z.fraction : 1.0 - z.fraction);
    sum += weight > 0.0 ? weight * voxel(i, j, k) : 0.0;
  }
  return sum;
}

/// Resampled by hand at steps of 1. Scalars are whole and weights are products of thirds or halves:
/// roundings in double vanish in float unless a sum lies on the edge; multiples of 27 have none.
void testUnequalSteps(bool cells, stage::Stage& stage, reference::Checks& check)
{
  const Axes axes = unequalAxes();
  const int less = cells ? 1 : 0;
  const Size fine = { 14 - less, 11 - less, 10 - less };
  const vtkIdType given = vtkIdType(axes[0].size() - less) * vtkIdType(axes[1].size() - less) *
    vtkIdType(axes[2].size() - less);
  const auto scalars = noiseArray(VTK_INT, given, 1, 6);
  const auto grid = gridOf(axes, VTK_DOUBLE);
  cells ? grid->GetCellData()->SetScalars(scalars) : grid->GetPointData()->SetScalars(scalars);
  const auto resampled =
    noiseArray(cells ? VTK_INT : VTK_DOUBLE, vtkIdType(fine[0]) * fine[1] * fine[2], 1, 1);
  vtkIdType voxel = 0;
  for (int k = 0; k < fine[2]; ++k)
  {
    for (int j = 0; j < fine[1]; ++j)
    {
      for (int i = 0; i < fine[0]; ++i)
      {
        const double shift = 0.5 * less;
        resampled->SetComponent(
          voxel++, 0, valueAt(axes, cells, scalars, { i + shift, j - 4 + shift, k + 2 + shift }));
      }
    }
  }
  const auto image = cells ? cellImage(fine, resampled) : plainImage(fine, resampled);
  image->SetSpacing(1.0, 1.0, 1.0);
  image->SetOrigin(0.0, -4.0, 2.0);
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetInputData(grid);
  const auto plain = stage::splatting(image);
  const std::string name = cells ? "Cells with unequal steps" : "Unequal steps";
  if (cells)
  {
    expectSame(stage, plain, mapper, name, check);
  }
  for (const stage::Vector& direction : directions())
  {
    stage.show(plain);
    stage.look(direction, { 0.0, 1.0, 0.1 });
    const stage::Pixels expected = stage.pixels();
    stage.show(mapper);
    const stage::Pixels picture = stage.pixels();
    int largest = 0;
    for (std::size_t n = 0; n < picture.size(); ++n)
    {
      largest = std::max(largest, std::abs(picture[n] - expected[n]));
    }
    // Roundings of the last bit of a double may turn the last bit of a colour.
    check(largest <= (cells ? 0 : 1) && !isBlack(picture), name,
      ": the picture differs from the one of the resampled volume by ", largest, ".");
  }
  check(mapper->GetIndexMemorySize() ==
      plain->GetIndexMemorySize() + resampled->GetNumberOfValues() * resampled->GetDataTypeSize(),
    name, ": the copy is counted.");
}

/// Coordinates that are modified in place are noticed.
void testModifiedCoordinates(stage::Stage& stage, reference::Checks& check)
{
  const auto grid = gridOf(equalAxes(size), VTK_DOUBLE);
  grid->GetPointData()->SetScalars(noiseArray(VTK_SHORT, Voxels, 1, 4));
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetInputData(grid);
  stage.show(mapper);
  stage.look(directions()[2], { 0.0, 1.0, 0.1 });
  const stage::Pixels before = stage.pixels();
  grid->GetXCoordinates()->SetComponent(size[0] - 1, 0, 12.0);
  grid->GetXCoordinates()->Modified();
  check(stage.pixels() != before, "Modified coordinates are noticed.");
}

/// Smooth contents on a grid whose steps grow and shrink, against VTK's GPU ray caster.
void testUnequalStepsAgainstGPU(reference::Checks& check)
{
  stage::Stage stage(200, 190);
  const Size large = { 48, 40, 44 };
  const auto blobs = stage::toImageData(stage::blobsAndTubes(large, 14));
  Axes axes;
  for (int a = 0; a < 3; ++a)
  {
    double at = 0.0;
    for (int n = 0; n < large[a]; ++n)
    {
      axes[a].push_back(at);
      at += 1.0 + 0.5 * std::sin(0.2 * n + a);
    }
  }
  const auto grid = gridOf(axes, VTK_DOUBLE);
  grid->GetPointData()->SetScalars(blobs->GetPointData()->GetScalars());
  auto mapper = vtkSmartPointer<Mapper>::New();
  mapper->SetInputData(grid);
  stage.show(mapper);
  stage.look({ 0.4, -0.3, 0.8 }, { 0.0, 1.0, 0.0 });
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  const auto picture = stage.gray();
  check(warnings.texts.empty(), "Nothing is lost, nothing is said.");
  // The ray caster's own rectilinear grids are off by pixels: it gets an image with half the steps.
  Size fine;
  for (int a = 0; a < 3; ++a)
  {
    fine[a] = static_cast<int>((axes[a].back() - axes[a].front()) / 0.25);
  }
  const auto scalars = noiseArray(VTK_FLOAT, vtkIdType(fine[0]) * fine[1] * fine[2], 1, 1);
  vtkIdType voxel = 0;
  for (int k = 0; k < fine[2]; ++k)
  {
    for (int j = 0; j < fine[1]; ++j)
    {
      for (int i = 0; i < fine[0]; ++i)
      {
        scalars->SetComponent(voxel++, 0,
          valueAt(
            axes, false, grid->GetPointData()->GetScalars(), { 0.25 * i, 0.25 * j, 0.25 * k }));
      }
    }
  }
  const auto image = plainImage(fine, scalars);
  image->SetSpacing(0.25, 0.25, 0.25);
  image->SetOrigin(0.0, 0.0, 0.0);
  const auto rayCaster = stage::gpuRayCaster(image, 0.2);
  stage.show(rayCaster);
  const stage::Likeness likeness(stage.gray(), picture);
  std::cout << "Rectilinear grid: " << likeness.text() << std::endl;
  check(likeness.psnr > 35.0 && likeness.largestShift() < 0.1,
    "Rectilinear grids are the GPU ray caster's.");
  rayCaster->ReleaseGraphicsResources(stage.window);
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

/// One axis that would ask for more voxels than there may be along an axis, or just as many.
void testLimitOfAxis(stage::Stage& stage, reference::Checks& check)
{
  for (bool isTooFine : { true, false })
  {
    const double least = isTooFine ? 20.0 / 16500 : 20.0 / 16300;
    const auto grid =
      gridOf({ std::vector<double>{ 0.0, 10.0, 10.0 + least, 20.0 }, { 0.0, 20.0 }, { 0.0, 20.0 } },
        VTK_DOUBLE);
    grid->GetPointData()->SetScalars(noiseArray(VTK_UNSIGNED_CHAR, 16, 1, 1));
    auto mapper = vtkSmartPointer<Mapper>::New();
    mapper->SetInputData(grid);
    stage.show(mapper);
    stage.look({ 0.0, 0.0, -1.0 }, { 0.0, 1.0, 0.0 });
    const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
    check(!isBlack(stage.pixels()), "A long axis is seen.");
    check(warnings.texts.size() == (isTooFine ? 1 : 0), "A warning if the axis is too long.");
  }
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
      testDescending(stage, check);
      testUnequalSteps(true, stage, check);
      testUnequalSteps(false, stage, check);
      testModifiedCoordinates(stage, check);
    }
    stage.viewAngle = 0.0;
    testLimit(stage, check);
    testLimitOfAxis(stage, check);
  }
  testUnequalStepsAgainstGPU(check);
  return check.exitCode();
}
