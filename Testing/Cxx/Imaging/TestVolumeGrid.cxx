// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where voxels lie: as vtkImageData and vtkRectilinearGrid place their points and cells.
#include "Input/VolumeGrid.h"
#include "ProjectionTesting.h"

#include "vtkCell.h"
#include "vtkDoubleArray.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{
using reference::Checks;
using namespace splatting;

/// A point of a data set, or the middle of a cell's corners.
glm::dvec3 placeOf(vtkDataSet* data, bool cells, vtkIdType n)
{
  glm::dvec3 place(0.0);
  if (!cells)
  {
    data->GetPoint(n, &place.x);
    return place;
  }
  vtkPoints* const corners = data->GetCell(n)->GetPoints();
  for (vtkIdType p = 0; p < corners->GetNumberOfPoints(); ++p)
  {
    const double* const corner = corners->GetPoint(p);
    place += glm::dvec3(corner[0], corner[1], corner[2]) / double(corners->GetNumberOfPoints());
  }
  return place;
}

void testPlaces(Checks& check, vtkDataSet* data, const GridOfDataSet& result)
{
  const glm::ivec3& size = result.grid.dimensions;
  vtkIdType n = 0;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i, ++n)
      {
        const glm::dvec3 found(result.grid.indexToPhysical * glm::dvec4(i, j, k, 1.0));
        const glm::dvec3 expected = placeOf(data, result.grid.cells, n);
        check(glm::length(found - expected) < 1e-11 * (1.0 + glm::length(expected)), "voxel ", i,
          " ", j, " ", k, " lies ", glm::length(found - expected), " off");
      }
    }
  }
  const vtkIdType count = result.grid.cells ? data->GetNumberOfCells() : data->GetNumberOfPoints();
  check(n == count, n, " voxels of ", count);
}

void testImage(Checks& check, reference::Random& random)
{
  vtkNew<vtkImageData> image;
  const auto size = coretesting::randomSize(random, 4);
  image->SetDimensions(size[0], size[1], size[2]);
  coretesting::placeAtRandom(image, random, true);
  const bool cells = random.uniform(0, 1);
  GridOfDataSet result;
  const std::string problem = describeGrid(image, cells, result);
  check(problem.empty() && !result.resampled && !result.coarse && result.grid.cells == cells,
    "an image is refused or changed: ", problem);
  testPlaces(check, image, result);
  for (int a = 0; a < 3; ++a)
  {
    const bool isHalf = cells && size[a] > 1;
    const double first = image->GetExtent()[2 * a] + (isHalf ? 0.5 : 0.0);
    check(result.grid.spacing[a] == image->GetSpacing()[a] &&
        std::abs(result.grid.first[a] - image->GetOrigin()[a] - first * image->GetSpacing()[a]) <
          1e-12,
      "before it is turned the image lies elsewhere along axis ", a);
  }
}

/// Ascending or descending, with equal steps or not.
vtkSmartPointer<vtkDoubleArray> anyCoordinates(bool isEven, reference::Random& random)
{
  auto coordinates = vtkSmartPointer<vtkDoubleArray>::New();
  const double sign = random.sign(), step = random.uniform(0.5, 2.0);
  double at = random.uniform(-20.0, 20.0);
  for (int n = random.uniform(isEven ? 1 : 3, 6); n > 0; --n)
  {
    coordinates->InsertNextValue(at);
    at += sign * step * (isEven ? 1.0 : random.uniform(0.3, 3.0));
  }
  return coordinates;
}

/// Along one axis: from the first point to the last in steps no larger than the least one (but for
/// axes that are taken as they are, with points a thousandth of a step off); each
/// voxel's share tells where it lies; each cell has a voxel within.
void testAxis(Checks& check, const GridOfDataSet& result, int a, vtkDoubleArray* points)
{
  const int last = static_cast<int>(points->GetNumberOfTuples()) - 1;
  const int count = result.grid.dimensions[a];
  const double first = result.grid.indexToPhysical[3][a], step = result.grid.indexToPhysical[a][a];
  const bool cells = result.grid.cells;
  double least = last > 0 ? std::abs(points->GetValue(1) - points->GetValue(0)) : std::abs(step);
  for (int n = 1; n < last; ++n)
  {
    least = std::min(least, std::abs(points->GetValue(n + 1) - points->GetValue(n)));
  }
  check(std::abs(step) < least * 1.0021, "a step of ", step, " where ", least, " is the least");
  const double half = cells && last > 0 ? 0.5 * step : 0.0;
  check(std::abs(first - half - points->GetValue(0)) < 1e-9 &&
      std::abs(first + (count - 1) * step + half - points->GetValue(last)) < 1e-9,
    "axis ", a, " begins or ends elsewhere");
  std::vector<int> seen(std::max(last, 1), 0);
  for (int n = 0; n < count; ++n)
  {
    const int below = result.axes[a].below[n];
    const double at = first + n * step, from = points->GetValue(below);
    const double width = last > 0 ? points->GetValue(below + 1) - from : 1.0;
    const double share = (at - from) / width;
    ++seen[below];
    check(cells ? last == 0 || (share > -1e-9 && share < 1.0 + 1e-9)
                : std::abs(result.axes[a].fraction[n] - share) < 1e-9,
      "voxel ", n, " of axis ", a, " lies ", share, " of the way behind ", below);
  }
  check(!cells || std::count(seen.begin(), seen.end(), 0) == 0, "a cell has no voxel");
}

void testGrid(Checks& check, reference::Random& random)
{
  vtkNew<vtkRectilinearGrid> grid;
  const bool isEven = random.uniform(0, 1), cells = random.uniform(0, 1);
  vtkSmartPointer<vtkDoubleArray> points[3];
  for (auto& axis : points)
  {
    axis = anyCoordinates(isEven, random);
  }
  grid->SetDimensions(int(points[0]->GetNumberOfTuples()), int(points[1]->GetNumberOfTuples()),
    int(points[2]->GetNumberOfTuples()));
  grid->SetXCoordinates(points[0]);
  grid->SetYCoordinates(points[1]);
  grid->SetZCoordinates(points[2]);
  GridOfDataSet result;
  const std::string problem = describeGrid(grid, cells, result);
  check(problem.empty() && !result.coarse && result.resampled == !isEven, "a grid: ", problem);
  if (isEven)
  {
    testPlaces(check, grid, result);
  }
  for (int a = 0; a < 3 && !isEven; ++a)
  {
    testAxis(check, result, a, points[a]);
  }
  const int bad = random.uniform(0, 2);
  points[bad]->InsertNextValue(0.0);
  check(describeGrid(grid, cells, result).find("XYZ"[bad]) != std::string::npos,
    "more coordinates than points are accepted");
  const vtkIdType last = points[bad]->GetNumberOfTuples() - 1; // the one that is too much
  if (last > 1)
  {
    points[bad]->SetNumberOfTuples(last);
    points[bad]->SetValue(last - 1, points[bad]->GetValue(last - 2));
    check(describeGrid(grid, cells, result).find("XYZ"[bad]) != std::string::npos,
      "coordinates that stand still are accepted");
  }
}

vtkSmartPointer<vtkDoubleArray> coordinates(const std::vector<double>& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  for (double value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

/// If a step gives too many voxels, in total or along an axis, it is increased to the limit.
void testLimits(Checks& check)
{
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(4, 4, 4);
  const auto fine = coordinates({ 0.0, 10.0, 10.00001, 20.0 });
  grid->SetXCoordinates(fine);
  grid->SetYCoordinates(fine);
  grid->SetZCoordinates(fine);
  GridOfDataSet result;
  check(describeGrid(grid, true, result).empty() && result.coarse, "tiny steps are no larger");
  const glm::dvec3 size(result.grid.dimensions);
  const double voxels = size.x * size.y * size.z;
  check(voxels > 0.9 * GridOfDataSet::MostResampled && voxels <= GridOfDataSet::MostResampled,
    "tiny steps make ", voxels, " voxels");
  grid->SetDimensions(4, 2, 2);
  grid->SetYCoordinates(coordinates({ 0.0, 20.0 }));
  grid->SetZCoordinates(coordinates({ 0.0, 20.0 }));
  for (const double count : { 16300.0, 16500.0 })
  {
    grid->SetXCoordinates(coordinates({ 0.0, 10.0, 10.0 + 20.0 / count, 20.0 }));
    check(describeGrid(grid, false, result).empty() && result.coarse == (count > 16384.0) &&
        result.grid.dimensions.x <= 16384,
      count, " voxels along an axis become ", result.grid.dimensions.x);
  }
}
}

int TestVolumeGrid(int, char*[])
{
  Checks check;
  reference::forScenes(
    "images", 200, [&](int, reference::Random& random) { testImage(check, random); });
  reference::forScenes(
    "rectilinear grids", 400, [&](int, reference::Random& random) { testGrid(check, random); });
  testLimits(check);
  return check.exitCode();
}
