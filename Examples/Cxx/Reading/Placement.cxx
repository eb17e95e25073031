// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Placement.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>

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
  std::string name = vtksys::SystemTools::LowerCase(unit);
  for (const auto& [word, length] : Units)
  {
    if (name == word || name == std::string(word) + "s")
    {
      return length;
    }
  }
  return 0.0;
}
}

void PlaceVolume(Volume& volume, Steps steps, const std::array<double, 3>& origin)
{
  const int* const size = volume.Image->GetDimensions();
  volume.Image->SetExtent(0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1);
  volume.Image->SetOrigin(0.0, 0.0, 0.0);
  volume.Image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  volume.Orientation = vtkSmartPointer<vtkMatrix4x4>::New();
  double spacing[3];
  bool isSized = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    auto& step = steps[axis];
    spacing[axis] = std::hypot(step[0], step[1], step[2]);
    if (!(spacing[axis] > 1e-9 && spacing[axis] < 1e9)) // so that it catches NaN as well
    {
      isSized = false;
      step = {};
      step[axis] = spacing[axis] = 1.0;
    }
    for (int row = 0; row < 3; ++row)
    {
      volume.Orientation->SetElement(row, axis, step[row] / spacing[axis]);
    }
  }
  volume.Image->SetSpacing(spacing);
  if (!isSized)
  {
    volume.Notes.push_back("the file does not say how large voxels are: 1 mm was taken");
    volume.Caution = "voxel size unknown";
    volume.IsInMillimeters = false;
  }
  if (!(std::fabs(volume.Orientation->Determinant()) > 1e-3))
  {
    volume.Orientation->Identity();
    volume.IsOriented = false;
  }
  std::transform(origin.begin(), origin.end(), volume.Origin.begin(),
    [](double place) { return std::isfinite(place) ? place : 0.0; });
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

void ConvertToMillimeters(Volume& volume, const std::string& unit)
{
  const double length = FindMillimeters(unit);
  volume.IsInMillimeters = length > 0.0 && volume.Caution.empty();
  if (length == 1.0)
  {
    return;
  }
  const std::string name = unit.find_first_of("\xC2\xCE\xB5\\") == 0 ? "um" : unit;
  volume.Notes.push_back("the file's unit of length is " + name +
    (length > 0.0 ? "; lengths here are in mm" : ", which is unknown: 1 mm was taken for it"));
  if (length > 0.0)
  {
    const double* const spacing = volume.Image->GetSpacing();
    volume.Image->SetSpacing(spacing[0] * length, spacing[1] * length, spacing[2] * length);
    for (double& place : volume.Origin)
    {
      place *= length;
    }
  }
}
