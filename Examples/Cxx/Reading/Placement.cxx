// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Placement.h"

#include "Reading/Reading.h"

#include "vtkDataArray.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace
{
/// The micro sign and the Greek letter in UTF-8, the former in Latin-1 and as ImageJ writes it.
const std::pair<const char*, double> Units[] = { { "mm", 1.0 }, { "millimeter", 1.0 },
  { "millimetre", 1.0 }, { "um", 0.001 }, { "\xC2\xB5m", 0.001 }, { "\xCE\xBCm", 0.001 },
  { "\xB5m", 0.001 }, { "\\u00b5m", 0.001 }, { "micron", 0.001 }, { "micrometer", 0.001 },
  { "micrometre", 0.001 }, { "nm", 1e-6 }, { "nanometer", 1e-6 }, { "nanometre", 1e-6 },
  { "cm", 10.0 }, { "centimeter", 10.0 }, { "centimetre", 10.0 }, { "m", 1000.0 },
  { "meter", 1000.0 }, { "metre", 1000.0 }, { "inch", 25.4 }, { "in", 25.4 } };

/// 0 for an unknown unit.
double FindMillimeters(const std::string& unit)
{
  const std::string name = vtksys::SystemTools::LowerCase(unit);
  for (const auto& [word, length] : Units)
  {
    if (name == word || name == std::string(word) + "s")
    {
      return length;
    }
  }
  return 0.0;
}

std::string DescribeUnit(const std::string& unit, double length)
{
  const std::string name = length == 0.001 ? "um" : unit;
  return "the file's unit of length is " + name +
    (length > 0.0 ? "; lengths here are in mm" : ", which is unknown: 1 mm is assumed");
}
}

void PlaceVolume(Volume& volume, Steps steps, std::array<double, 3> origin, const std::string& unit)
{
  const int* const size = volume.Image->GetDimensions();
  volume.Image->SetExtent(0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1);
  volume.Image->SetOrigin(0.0, 0.0, 0.0);
  vtkNew<vtkMatrix3x3> directions;
  const double unitLength = FindMillimeters(unit);
  const double scale = unitLength > 0.0 ? unitLength : 1.0;
  bool isSized = true;
  double spacing[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    auto& step = steps[axis];
    double length = std::hypot(step[0], step[1], step[2]);
    if (!(length > 1e-9 && length < 1e9)) // also if it is NaN
    {
      isSized = false;
      step = {};
      step[axis] = length = 1.0;
    }
    for (int row = 0; row < 3; ++row)
    {
      directions->SetElement(row, axis, step[row] / length);
    }
    spacing[axis] = length * scale;
    volume.Origin[axis] = std::isfinite(origin[axis]) ? origin[axis] * scale : 0.0;
  }
  volume.Image->SetSpacing(spacing);
  volume.IsInMillimeters = isSized && unitLength > 0.0;
  if (!isSized)
  {
    volume.Notes.push_back("the file has no voxel size: 1 mm is assumed");
    AddCaution(volume, "voxel size unknown");
  }
  if (!unit.empty() && unitLength != 1.0)
  {
    volume.Notes.push_back(DescribeUnit(unit, unitLength));
  }
  if (!(std::fabs(directions->Determinant()) > 1e-3))
  {
    directions->Identity();
    volume.IsOriented = false;
  }
  volume.Image->SetDirectionMatrix(directions);
}

void TurnToLPS(Steps& steps, std::array<double, 3>& origin)
{
  for (int row = 0; row < 2; ++row)
  {
    origin[row] = -origin[row];
    for (auto& step : steps)
    {
      step[row] = -step[row];
    }
  }
}

void AddCaution(Volume& volume, const std::string& caution)
{
  volume.Caution += (volume.Caution.empty() ? "" : "\n") + caution;
}

namespace
{
/// Whether no place is farther from an even one than a share of the steps between them.
bool AreEven(const std::vector<double>& places, double tolerance)
{
  const double steps = static_cast<double>(places.size() - 1);
  const double length = places.back() - places.front();
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    const double even = places.front() + length * static_cast<double>(i) / steps;
    if (!(std::fabs(places[i] - even) <= tolerance * std::fabs(length) / steps))
    {
      return false;
    }
  }
  return true;
}
}

std::vector<double> SpaceEvenly(const std::vector<double>& places, double tolerance)
{
  constexpr double MostPlaces = 8.0; // times as many as there are
  constexpr double NearLeast = 1.1;
  std::vector<double> even;
  if (places.size() < 2 || AreEven(places, tolerance))
  {
    even = places;
    return even;
  }
  const double length = places.back() - places.front();
  const double last = static_cast<double>(places.size() - 1);
  double least = std::fabs(length);
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    least = std::min(least, std::fabs(places[i] - places[i - 1]));
  }
  double sum = 0.0, summands = 0.0;
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    const double step = std::fabs(places[i] - places[i - 1]);
    sum += step < NearLeast * least ? step : 0.0;
    summands += step < NearLeast * least ? 1.0 : 0.0;
  }
  const double count = std::max(1.0, std::ceil(std::fabs(length) * summands / sum - 0.1));
  for (std::size_t i = 0; count <= MostPlaces * last && i <= static_cast<std::size_t>(count); ++i)
  {
    even.push_back(places.front() + length * static_cast<double>(i) / count);
  }
  return even;
}

vtkSmartPointer<vtkImageData> Interpolate(vtkImageData* image, int axis,
  const std::vector<double>& places, const std::vector<double>& newPlaces)
{
  constexpr double Near = 1e-6; // so that NaN beside a sample does not reach it
  int size[3];
  image->GetDimensions(size);
  const vtkIdType stride = std::accumulate(size, size + axis, vtkIdType(1), std::multiplies<>());
  const vtkIdType lines = image->GetNumberOfPoints() / size[axis] / stride;
  const vtkIdType count = size[axis];
  size[axis] = static_cast<int>(newPlaces.size());
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetDimensions(size);
  const int components = image->GetNumberOfScalarComponents();
  result->AllocateScalars(FindFloatType(image->GetScalarType()), components);
  vtkDataArray* const from = image->GetPointData()->GetScalars();
  vtkDataArray* const to = result->GetPointData()->GetScalars();
  vtkIdType point = 0;
  for (vtkIdType line = 0; line < lines; ++line)
  {
    vtkIdType i = 0; // the new place is between this one and the next
    for (const double place : newPlaces)
    {
      while (i + 2 < count && std::fabs(places[i + 1] - places[0]) <= std::fabs(place - places[0]))
      {
        ++i;
      }
      const double share = std::clamp((place - places[i]) / (places[i + 1] - places[i]), 0.0, 1.0);
      const vtkIdType below = (line * count + i + (share > 1.0 - Near)) * stride;
      const vtkIdType above = (line * count + i + (share > Near)) * stride;
      for (vtkIdType n = 0; n < stride; ++n, ++point)
      {
        for (int c = 0; c < components; ++c)
        {
          to->SetComponent(point, c,
            (1.0 - share) * from->GetComponent(below + n, c) +
              share * from->GetComponent(above + n, c));
        }
      }
    }
  }
  to->SetName(from->GetName());
  return result;
}
