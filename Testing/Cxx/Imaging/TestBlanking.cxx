// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hidden voxels as VTK's own functions for points and cells find them, one by one.
#include "Input/Blanking.h"
#include "ProjectionTesting.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkRectilinearGrid.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace
{
using reference::Checks;
using namespace splatting;

/// An image, or a rectilinear grid of the same size.
vtkSmartPointer<vtkDataSet> anyDataSet(const std::array<int, 3>& size, reference::Random& random)
{
  if (random.oneIn(2))
  {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(size[0], size[1], size[2]);
    return image;
  }
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetDimensions(size[0], size[1], size[2]);
  vtkNew<vtkDoubleArray> coordinates[3];
  for (int a = 0; a < 3; ++a)
  {
    for (int n = 0; n < size[a]; ++n)
    {
      coordinates[a]->InsertNextValue(n);
    }
  }
  grid->SetXCoordinates(coordinates[0]);
  grid->SetYCoordinates(coordinates[1]);
  grid->SetZCoordinates(coordinates[2]);
  return grid;
}

/// Flags of which many have a bit, and some have others, which hide nothing.
vtkSmartPointer<vtkUnsignedCharArray> anyFlags(
  vtkIdType count, unsigned char bit, reference::Random& random)
{
  auto flags = vtkSmartPointer<vtkUnsignedCharArray>::New();
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  const int often = random.uniform(1, 3);
  reference::Random many = random.fork();
  for (vtkIdType n = 0; n < count; ++n)
  {
    const bool has = many.chance(often / 4.0);
    const bool isDuplicate = many.uniform(0, 1);
    flags->InsertNextValue(static_cast<unsigned char>((has ? bit : 0) | (isDuplicate ? 1 : 0)));
  }
  return flags;
}

bool has(vtkUnsignedCharArray* flags, vtkIdType n, unsigned char bit)
{
  return flags && (flags->GetValue(n) & bit);
}

/// By the cells that VTK says use a point, and the points that a cell uses.
bool isHidden(vtkDataSet* data, bool cells, vtkIdType n)
{
  vtkUnsignedCharArray *const ofPoints = data->GetPointGhostArray(),
                              *const ofCells = data->GetCellGhostArray();
  constexpr auto hiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
  constexpr auto hiddenCell = vtkDataSetAttributes::HIDDENCELL;
  vtkNew<vtkIdList> others;
  if (cells)
  {
    data->GetCellPoints(n, others);
    bool any = has(ofCells, n, hiddenCell);
    for (vtkIdType m = 0; m < others->GetNumberOfIds(); ++m)
    {
      any = any || has(ofPoints, others->GetId(m), hiddenPoint);
    }
    return any;
  }
  data->GetPointCells(n, others);
  bool all = true;
  for (vtkIdType m = 0; m < others->GetNumberOfIds(); ++m)
  {
    all = all && has(ofCells, others->GetId(m), hiddenCell);
  }
  return has(ofPoints, n, hiddenPoint) || all;
}

void testScene(Checks& check, reference::Random& random)
{
  const auto data =
    anyDataSet({ random.uniform(2, 5), random.uniform(2, 5), random.uniform(1, 5) }, random);
  if (random.oneIn(2))
  {
    data->GetPointData()->AddArray(
      anyFlags(data->GetNumberOfPoints(), vtkDataSetAttributes::HIDDENPOINT, random));
  }
  if (random.oneIn(2))
  {
    data->GetCellData()->AddArray(
      anyFlags(data->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL, random));
  }
  const bool cells = random.uniform(0, 1), hasMask = random.uniform(0, 1);
  const vtkIdType count = cells ? data->GetNumberOfCells() : data->GetNumberOfPoints();
  vtkNew<vtkImageData> mask;
  int size[3];
  vtkImageData* const image = vtkImageData::SafeDownCast(data);
  image ? image->GetDimensions(size) : vtkRectilinearGrid::SafeDownCast(data)->GetDimensions(size);
  // A mask of cells has the dimensions of their points or of the cells.
  const bool onCells = cells && random.oneIn(2);
  for (int a = 0; a < 3 && cells && !onCells; ++a)
  {
    size[a] = std::max(size[a] - 1, 1);
  }
  mask->SetDimensions(size);
  const auto inside = anyFlags(count, 255, random);
  (onCells ? static_cast<vtkDataSetAttributes*>(mask->GetCellData()) : mask->GetPointData())
    ->SetScalars(inside);
  vtkImageData* const used = hasMask ? mask.Get() : nullptr;
  check(problemOfBlanking(data, cells, used).empty(), problemOfBlanking(data, cells, used));
  const std::vector<unsigned char> found = findBlanked(data, cells, used);
  bool any = false;
  for (vtkIdType n = 0; n < count; ++n)
  {
    const bool expected = isHidden(data, cells, n) || (hasMask && inside->GetValue(n) == 0);
    any = any || expected;
    check((!found.empty() && found[n] != 0) == expected, cells ? "cell " : "point ", n,
      expected ? " is not hidden" : " is hidden");
  }
  check(found.empty() == !any, "flags only where something is hidden");
  inside->InsertNextValue(1);
  check(problemOfBlanking(data, cells, mask).find("mask") != std::string::npos,
    "a mask of another size is accepted");
  data->GetPointData()->AddArray(
    anyFlags(data->GetNumberOfPoints() + 1, vtkDataSetAttributes::HIDDENPOINT, random));
  check(problemOfBlanking(data, cells, nullptr).find("vtkGhostType") != std::string::npos,
    "too many flags are accepted");
}
}

int TestBlanking(int, char*[])
{
  Checks check;
  reference::forScenes(
    "blanking", 400, [&](int, reference::Random& random) { testScene(check, random); });
  return check.exitCode();
}
