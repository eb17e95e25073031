// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/Blanking.h"

#include "Common/Parallel.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>

namespace splatting
{
namespace
{
using Size = std::array<vtkIdType, 3>;

vtkIdType count(const Size& size)
{
  return size[0] * size[1] * size[2];
}

/// Points, or cells, along each axis.
Size sizeOf(vtkDataSet* data, bool cells)
{
  vtkImageData* const image = vtkImageData::SafeDownCast(data);
  const int* const points =
    image ? image->GetDimensions() : vtkRectilinearGrid::SafeDownCast(data)->GetDimensions();
  Size size;
  for (int a = 0; a < 3; ++a)
  {
    size[a] = cells ? std::max(points[a] - 1, 1) : points[a];
  }
  return size;
}

vtkUnsignedCharArray* ghosts(vtkDataSetAttributes* attributes)
{
  return vtkUnsignedCharArray::SafeDownCast(
    attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
}

/// The mask's point scalars or, without any, its cell scalars.
vtkUnsignedCharArray* maskScalars(vtkImageData* mask, bool& onCells)
{
  int cellFlag = 0;
  vtkDataArray* const scalars = vtkAbstractMapper::GetScalars(
    mask, VTK_SCALAR_MODE_DEFAULT, VTK_GET_ARRAY_BY_ID, -1, nullptr, cellFlag);
  onCells = cellFlag == 1;
  return vtkUnsignedCharArray::SafeDownCast(scalars);
}

/// The flags if any of them has the bit, else nullptr.
vtkUnsignedCharArray* withBit(vtkUnsignedCharArray* flags, unsigned char bit)
{
  if (!flags)
  {
    return nullptr;
  }
  const unsigned char* const begin = flags->GetPointer(0);
  const bool found = std::any_of(begin, begin + flags->GetNumberOfValues(),
    [bit](unsigned char flag) { return (flag & bit) != 0; });
  return found ? flags : nullptr;
}

/// Calls body(voxel, i, j, k) for all voxels.
template <class Body>
void forVoxels(const Size& size, Body&& body)
{
  parallelFor(0, size[1] * size[2], 64,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType row = first; row < last; ++row)
      {
        for (vtkIdType i = 0; i < size[0]; ++i)
        {
          body(row * size[0] + i, i, row % size[1], row / size[1]);
        }
      }
    });
}

void hideOwn(const unsigned char* flags, unsigned char bit, std::vector<unsigned char>& hidden)
{
  for (std::size_t voxel = 0; voxel < hidden.size(); ++voxel)
  {
    hidden[voxel] |= flags[voxel] & bit;
  }
}

/// The first and the last of the cells (points) that touch point (cell) n along an axis.
std::array<vtkIdType, 2> neighbours(vtkIdType n, bool ofCell, vtkIdType most)
{
  return ofCell ? std::array<vtkIdType, 2>{ n, std::min(n + 1, most - 1) }
                : std::array<vtkIdType, 2>{ std::max<vtkIdType>(n - 1, 0), std::min(n, most - 1) };
}

/// Whether one of a cell's points, or all of a point's cells, have the bit.
bool isHiddenByOthers(const unsigned char* flags, unsigned char bit, const Size& others, bool cells,
  vtkIdType i, vtkIdType j, vtkIdType k)
{
  const auto x = neighbours(i, cells, others[0]);
  const auto y = neighbours(j, cells, others[1]);
  const auto z = neighbours(k, cells, others[2]);
  for (int n = 0; n < 8; ++n)
  {
    const vtkIdType other = (z[(n >> 2) & 1] * others[1] + y[(n >> 1) & 1]) * others[0] + x[n & 1];
    if (((flags[other] & bit) != 0) == cells)
    {
      return cells;
    }
  }
  return !cells;
}
}

std::string problemOfBlanking(vtkDataSet* data, bool cells, vtkImageData* mask)
{
  vtkUnsignedCharArray* const points = ghosts(data->GetPointData());
  vtkUnsignedCharArray* const cellGhosts = ghosts(data->GetCellData());
  if ((points && points->GetNumberOfValues() != count(sizeOf(data, false))) ||
    (cellGhosts && cellGhosts->GetNumberOfValues() != count(sizeOf(data, true))))
  {
    return "The vtkGhostType array must have one value for each point or cell.";
  }
  if (!mask)
  {
    return {};
  }
  bool onCells = false;
  vtkUnsignedCharArray* const scalars = maskScalars(mask, onCells);
  if (!scalars || scalars->GetNumberOfComponents() != 1)
  {
    return "The mask must have scalars of type unsigned char with one component: convert it with "
           "vtkImageCast.";
  }
  const Size size = sizeOf(mask, onCells);
  if (size != sizeOf(data, cells) || scalars->GetNumberOfValues() != count(size))
  {
    return "The mask must have one scalar for each voxel of the input: give both the same "
           "dimensions.";
  }
  return {};
}

std::vector<unsigned char> findBlanked(vtkDataSet* data, bool cells, vtkImageData* mask)
{
  constexpr unsigned char hiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
  constexpr unsigned char hiddenCell = vtkDataSetAttributes::HIDDENCELL;
  vtkUnsignedCharArray* const points = withBit(ghosts(data->GetPointData()), hiddenPoint);
  vtkUnsignedCharArray* const cellGhosts = withBit(ghosts(data->GetCellData()), hiddenCell);
  if (!points && !cellGhosts && !mask)
  {
    return {};
  }
  const Size size = sizeOf(data, cells);
  std::vector<unsigned char> hidden(static_cast<std::size_t>(count(size)), 0);
  vtkUnsignedCharArray* const own = cells ? cellGhosts : points;
  vtkUnsignedCharArray* const others = cells ? points : cellGhosts;
  if (own)
  {
    hideOwn(own->GetPointer(0), cells ? hiddenCell : hiddenPoint, hidden);
  }
  if (others)
  {
    const unsigned char* const flags = others->GetPointer(0);
    const unsigned char bit = cells ? hiddenPoint : hiddenCell;
    const Size otherSize = sizeOf(data, !cells);
    forVoxels(size,
      [&](vtkIdType voxel, vtkIdType i, vtkIdType j, vtkIdType k)
      { hidden[voxel] |= isHiddenByOthers(flags, bit, otherSize, cells, i, j, k); });
  }
  if (mask)
  {
    bool onCells = false;
    const unsigned char* const inside = maskScalars(mask, onCells)->GetPointer(0);
    forVoxels(size,
      [&](vtkIdType voxel, vtkIdType, vtkIdType, vtkIdType)
      { hidden[voxel] |= inside[voxel] == 0; });
  }
  const bool isAny =
    std::any_of(hidden.begin(), hidden.end(), [](unsigned char flag) { return flag != 0; });
  return isAny ? hidden : std::vector<unsigned char>{};
}
}
