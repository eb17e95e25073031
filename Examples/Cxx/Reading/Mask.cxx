// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Mask.h"

#include "Reading/Reading.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

namespace
{
/// How far voxels of a mask may lie from the volume's, in voxels: files round.
constexpr double Tolerance = 0.1;

/**
 * From voxels to the patient.
 */
vtkSmartPointer<vtkMatrix4x4> MakeIndexToPatient(const Volume& volume)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      matrix->SetElement(row, column,
        volume.Orientation->GetElement(row, column) * volume.Image->GetSpacing()[column]);
    }
    matrix->SetElement(row, 3, volume.Origin[row]);
  }
  return matrix;
}

std::string DescribeGrid(const Volume& volume)
{
  const int* const size = volume.Image->GetDimensions();
  const double* const spacing = volume.Image->GetSpacing();
  char text[256];
  std::snprintf(text, sizeof(text),
    "%d x %d x %d voxels of %.4g x %.4g x %.4g, the first at (%.6g, %.6g, %.6g)", size[0], size[1],
    size[2], spacing[0], spacing[1], spacing[2], volume.Origin[0], volume.Origin[1],
    volume.Origin[2]);
  return text;
}

/**
 * From the volume's voxels to the mask's, in whole numbers: each row has one 1 or -1, and an
 * offset. False if there is no such map.
 */
bool FindVoxelMap(const Volume& volume, const Volume& mask, std::array<std::array<int, 4>, 3>& map)
{
  vtkNew<vtkMatrix4x4> exact, toMask;
  vtkMatrix4x4::Invert(MakeIndexToPatient(mask), toMask);
  vtkMatrix4x4::Multiply4x4(toMask, MakeIndexToPatient(volume), exact);
  const int* const size = volume.Image->GetDimensions();
  const int* const maskSize = mask.Image->GetDimensions();
  for (int row = 0; row < 3; ++row)
  {
    double error = 0.0; // at the farthest corner
    int steps = 0, length = 0;
    for (int column = 0; column < 4; ++column)
    {
      const double element = exact->GetElement(row, column);
      const double whole = std::clamp(std::round(element), -1e6, 1e6);
      map[row][column] = static_cast<int>(whole);
      error += std::fabs(element - whole) * (column < 3 ? size[column] - 1 : 1);
      if (column < 3 && map[row][column] != 0)
      {
        ++steps;
        length = std::abs(map[row][column]) == 1 ? size[column] : 0;
      }
    }
    const auto& axis = map[row];
    const bool isReversed = axis[0] + axis[1] + axis[2] < 0;
    if (!(error < Tolerance) || steps != 1 || length != maskSize[row] ||
      axis[3] != (isReversed ? length - 1 : 0))
    {
      return false;
    }
  }
  return true;
}

/**
 * The labels that a mask has, less 0, for who has asked for another.
 */
std::string ListLabels(vtkDataArray* labels)
{
  std::set<double> found;
  for (vtkIdType i = 0; i < labels->GetNumberOfTuples() && found.size() < 20; ++i)
  {
    const double label = labels->GetComponent(i, 0);
    if (label != 0.0 && std::isfinite(label))
    {
      found.insert(label);
    }
  }
  std::vector<std::string> words;
  for (const double label : found)
  {
    char text[32];
    std::snprintf(text, sizeof(text), "%g", label);
    words.emplace_back(text);
  }
  return words.empty() ? "only 0" : JoinWords(words);
}

/**
 * The array by which VTK hides points.
 */
vtkUnsignedCharArray* GetHiding(vtkImageData* image)
{
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  if (!vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray(name)))
  {
    vtkNew<vtkUnsignedCharArray> hiding;
    hiding->SetName(name);
    hiding->SetNumberOfTuples(image->GetNumberOfPoints());
    hiding->Fill(0);
    image->GetPointData()->AddArray(hiding);
  }
  return vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray(name));
}
}

void ApplyMask(const MaskSettings& settings, Volume& volume)
{
  const Volume mask = ReadVolume(settings.Path, {});
  volume.Files.insert(volume.Files.end(), mask.Files.begin(), mask.Files.end());
  std::array<std::array<int, 4>, 3> map;
  if (!FindVoxelMap(volume, mask, map))
  {
    Refuse(settings.Path,
      "this mask has other voxels than the volume: " + DescribeGrid(mask) +
        ", where the volume has " + DescribeGrid(volume) +
        "; resample the mask to the volume's voxels.");
  }
  vtkDataArray* const labels = mask.Image->GetPointData()->GetScalars();
  vtkUnsignedCharArray* const hiding = GetHiding(volume.Image);
  const int* const size = volume.Image->GetDimensions();
  const int* const maskSize = mask.Image->GetDimensions();
  vtkIdType point = 0, shown = 0;
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i, ++point)
      {
        const auto place = [&](int axis) {
          return vtkIdType(map[axis][0] * i + map[axis][1] * j + map[axis][2] * k + map[axis][3]);
        };
        const double label =
          labels->GetComponent((place(2) * maskSize[1] + place(1)) * maskSize[0] + place(0), 0);
        const bool isShown = settings.Label ? label == settings.Label : label != 0.0;
        shown += isShown;
        if (!isShown)
        {
          hiding->SetValue(point, hiding->GetValue(point) | vtkDataSetAttributes::HIDDENPOINT);
        }
      }
    }
  }
  if (shown == 0)
  {
    Refuse(settings.Path,
      "this mask shows nothing; its labels are " + ListLabels(labels) +
        ", so give one of them as --label.");
  }
  volume.Notes.push_back("the mask shows " + std::to_string(shown) + " of " +
    std::to_string(volume.Image->GetNumberOfPoints()) + " voxels");
}
