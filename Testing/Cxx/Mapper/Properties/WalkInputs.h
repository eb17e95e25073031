// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Data sets for random walks: small, of all kinds that can be splatted, in guarded memory.
 */
#ifndef WalkInputs_h
#define WalkInputs_h

#include "GuardedArrays.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace walktesting
{
/// Points "first" and "second", cells "third", and a mask for the points.
struct Input
{
  vtkSmartPointer<vtkDataSet> data;
  vtkSmartPointer<vtkImageData> mask;
};

inline std::array<double, 3> anyPoint(reference::Random& random, double low, double high)
{
  std::array<double, 3> point;
  for (double& x : point)
  {
    x = random.uniform(low, high);
  }
  return point;
}

/// How values are distributed.
struct Distribution
{
  double low, high;
  double keeps;      ///< how often a voxel is as the one before
  double exponent;   ///< of what is uniform in [0, 1]
  double withoutOne; ///< how often a voxel has no number, or an infinite one
};

inline Distribution anyDistribution(int type, reference::Random& random)
{
  constexpr double keeps[] = { 0.0, 0.0, 0.7, 0.98 };
  constexpr double exponents[] = { 1.0, 4.0, 12.0 };
  Distribution d{ 0.0, 100.0, 0.0, 1.0, 0.0 };
  d.keeps = keeps[random.uniform(0, 3)];
  d.exponent = exponents[random.uniform(0, 2)];
  const bool isSigned = type != VTK_UNSIGNED_CHAR && type != VTK_UNSIGNED_SHORT &&
    type != VTK_UNSIGNED_INT && type != VTK_UNSIGNED_LONG;
  if (isSigned && random.oneIn(3))
  {
    d.low = -60.0;
  }
  if (random.oneIn(4) && vtkDataArray::GetDataTypeSize(type) > 1)
  {
    d.high = 1000.0;
  }
  if ((type == VTK_FLOAT || type == VTK_DOUBLE) && random.oneIn(3))
  {
    d.withoutOne = random.oneIn(2) ? 0.002 : 0.2;
  }
  return d;
}

/// Gives some tuples other values.
inline void fill(vtkDataArray* array, const Distribution& d, vtkIdType first, vtkIdType last,
  reference::Random& random)
{
  reference::Random many = random.fork();
  for (int c = 0; c < array->GetNumberOfComponents(); ++c)
  {
    double value = d.low;
    for (vtkIdType n = first; n < last; ++n)
    {
      if (many.chance(1.0 - d.keeps))
      {
        value = d.low + (d.high - d.low) * std::pow(many.uniform(0.0, 1.0), d.exponent);
      }
      double given = value;
      if (d.withoutOne > 0.0 && many.chance(d.withoutOne))
      {
        given = many.oneIn(4) ? std::numeric_limits<double>::infinity() : vtkMath::Nan();
      }
      array->SetComponent(n, c, given);
    }
  }
}

inline int anyType(reference::Random& random)
{
  constexpr int types[] = { VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_UNSIGNED_CHAR,
    VTK_SHORT, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG,
    VTK_UNSIGNED_LONG, VTK_FLOAT, VTK_FLOAT, VTK_DOUBLE };
  return types[random.uniform(0, 13)];
}

inline vtkSmartPointer<vtkDataArray> anyArray(
  const char* name, vtkIdType tuples, reference::Random& random)
{
  constexpr int numbers[] = { 1, 1, 1, 1, 2, 3, 4 };
  const int components = numbers[random.uniform(0, 6)], type = anyType(random);
  vtkSmartPointer<vtkDataArray> array;
  if (type == VTK_SHORT && random.oneIn(3))
  {
    array = separateGuardedArray<short>(tuples, components, random);
  }
  else
  {
    array = guardedArray(type, tuples, components, random);
  }
  fill(array, anyDistribution(type, random), 0, tuples, random);
  array->SetName(name);
  return array;
}

/// Flags one in so many points or cells.
inline void flagSome(vtkDataArray* flags, int value, int times, reference::Random& random)
{
  reference::Random many = random.fork();
  for (vtkIdType n = 0; n < flags->GetNumberOfTuples(); ++n)
  {
    flags->SetComponent(n, 0, many.oneIn(times) ? value : 0);
  }
}

inline void addGhosts(
  vtkDataSetAttributes* data, vtkIdType count, int value, reference::Random& random)
{
  const auto ghosts = guardedArray(VTK_UNSIGNED_CHAR, count, 1, random);
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  flagSome(ghosts, value, 9, random);
  data->AddArray(ghosts);
}

inline std::array<int, 3> anySize(reference::Random& random)
{
  std::array<int, 3> size;
  for (int& length : size)
  {
    length = random.oneIn(8) ? random.uniform(1, 3)
      : random.oneIn(6)      ? random.uniform(20, 70)
                             : random.uniform(4, 19);
  }
  // Thousands of walks are to take minutes.
  const int longest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  size[(longest + 1) % 3] = std::min(size[(longest + 1) % 3], 19);
  size[(longest + 2) % 3] = std::min(size[(longest + 2) % 3], 19);
  return size;
}

/// Another extent, spacing, origin and direction.
inline void placeAnywhere(vtkImageData* image, reference::Random& random)
{
  const auto spacing = anyPoint(random, 0.5, 1.5), origin = anyPoint(random, -6.0, 6.0);
  image->SetSpacing(spacing.data());
  image->SetOrigin(origin.data());
  vtkNew<vtkMatrix3x3> direction;
  if (random.oneIn(3))
  {
    vtkNew<vtkTransform> turn;
    const auto axis = anyPoint(random, 0.1, 1.0);
    turn->RotateWXYZ(random.uniform(0.0, 360.0), axis.data());
    for (int n = 0; n < 9; ++n)
    {
      direction->SetElement(n / 3, n % 3, turn->GetMatrix()->GetElement(n / 3, n % 3));
    }
  }
  image->SetDirectionMatrix(direction);
}

inline vtkSmartPointer<vtkDataSet> anyImage(
  const std::array<int, 3>& size, reference::Random& random)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  for (int a = 0; a < 3; ++a)
  {
    extent[2 * a] = random.oneIn(2) ? 0 : random.uniform(-5, 5);
    extent[2 * a + 1] = extent[2 * a] + size[a] - 1;
  }
  image->SetExtent(extent);
  placeAnywhere(image, random);
  return image;
}

/// With equal steps or without.
inline vtkSmartPointer<vtkDataSet> anyGrid(
  const std::array<int, 3>& size, reference::Random& random)
{
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetDimensions(size.data());
  for (int a = 0; a < 3; ++a)
  {
    vtkNew<vtkDoubleArray> places;
    double place = random.uniform(-20.0, 20.0);
    const double step = random.uniform(0.5, 1.5);
    const bool isEqual = random.oneIn(2);
    for (int n = 0; n < size[a]; ++n)
    {
      places->InsertNextValue(place);
      place += step * (isEqual ? 1.0 : random.uniform(0.6, 1.4));
    }
    a == 0     ? grid->SetXCoordinates(places)
      : a == 1 ? grid->SetYCoordinates(places)
               : grid->SetZCoordinates(places);
  }
  return grid;
}

inline Input anyInput(bool gridsToo, reference::Random& random)
{
  const std::array<int, 3> size = anySize(random);
  Input input;
  input.data = gridsToo && random.oneIn(6) ? anyGrid(size, random) : anyImage(size, random);
  const vtkIdType points = input.data->GetNumberOfPoints(), cells = input.data->GetNumberOfCells();
  input.data->GetPointData()->SetScalars(anyArray("first", points, random));
  input.data->GetPointData()->AddArray(anyArray("second", points, random));
  input.data->GetCellData()->SetScalars(anyArray("third", cells, random));
  if (random.oneIn(8))
  {
    addGhosts(input.data->GetPointData(), points, vtkDataSetAttributes::HIDDENPOINT, random);
  }
  if (random.oneIn(8))
  {
    addGhosts(input.data->GetCellData(), cells, vtkDataSetAttributes::HIDDENCELL, random);
  }
  input.mask = vtkSmartPointer<vtkImageData>::New();
  input.mask->SetDimensions(size.data());
  const auto mask = guardedArray(VTK_UNSIGNED_CHAR, points, 1, random);
  flagSome(mask, 255, 2, random);
  input.mask->GetPointData()->SetScalars(mask);
  return input;
}

/// Changes what is in the data set, and says so; buffers may be replaced without a word where
/// `silently`. Returns what was done.
inline std::string changeInPlace(const Input& input, bool silently, reference::Random& random)
{
  vtkDataSetAttributes* const points = input.data->GetPointData();
  vtkDataSetAttributes* const cells = input.data->GetCellData();
  vtkDataArray* const arrays[] = { points->GetArray("first"), points->GetArray("second"),
    cells->GetArray("third") };
  vtkDataArray* const array = arrays[random.uniform(0, 2)];
  const vtkIdType count = array->GetNumberOfTuples();
  const Distribution d = anyDistribution(array->GetDataType(), random);
  switch (random.uniform(0, 4))
  {
    case 0: // some voxels
    {
      const vtkIdType first = random.uniform<vtkIdType>(0, count);
      fill(array, d, first, std::min<vtkIdType>(first + 40, count), random);
      array->Modified();
      return "voxels of " + std::string(array->GetName());
    }
    case 1: // all, and the data set says so
      fill(array, d, 0, count, random);
      input.data->Modified();
      return "all voxels of " + std::string(array->GetName());
    case 2:
      if (array->HasStandardMemoryLayout())
      {
        giveBuffer(array, count, random);
        fill(array, d, 0, count, random);
        if (!silently)
        {
          array->Modified();
        }
      }
      return "the buffer of " + std::string(array->GetName());
    case 3:
      if (vtkDataArray* const ghosts = points->GetArray(vtkDataSetAttributes::GhostArrayName()))
      {
        flagSome(ghosts, vtkDataSetAttributes::HIDDENPOINT, 9, random);
        ghosts->Modified();
      }
      flagSome(input.mask->GetPointData()->GetScalars(), 255, 2, random);
      input.mask->GetPointData()->GetScalars()->Modified();
      return "hidden voxels and mask";
    default:
      if (auto* const image = vtkImageData::SafeDownCast(input.data))
      {
        placeAnywhere(image, random);
      }
      return "place of the image";
  }
}
}

#endif
