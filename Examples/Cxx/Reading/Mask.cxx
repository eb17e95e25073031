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
 * From the volume's voxels to the mask's.
 */
vtkSmartPointer<vtkMatrix4x4> FindVoxelMap(const Volume& volume, const Volume& mask)
{
  auto toMask = vtkSmartPointer<vtkMatrix4x4>::New();
  vtkMatrix4x4::Invert(MakeIndexToPatient(mask), toMask);
  vtkMatrix4x4::Multiply4x4(toMask, MakeIndexToPatient(volume), toMask);
  return toMask;
}

/**
 * Whether both have the same voxels: corners are corners, in any order.
 */
bool HaveSameVoxels(vtkMatrix4x4* toMask, const int size[3], const int maskSize[3])
{
  for (int corner = 0; corner < 8; ++corner)
  {
    double place[4] = { corner & 1 ? size[0] - 1.0 : 0.0, corner & 2 ? size[1] - 1.0 : 0.0,
      corner & 4 ? size[2] - 1.0 : 0.0, 1.0 };
    toMask->MultiplyPoint(place, place);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double end = 2.0 * place[axis] < maskSize[axis] - 1 ? 0.0 : maskSize[axis] - 1.0;
      if (!(std::fabs(place[axis] - end) < Tolerance))
      {
        return false;
      }
    }
  }
  return vtkIdType(size[0]) * size[1] * size[2] ==
    vtkIdType(maskSize[0]) * maskSize[1] * maskSize[2];
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
  ReadSettings read;
  read.Label = settings.Label;
  const Volume mask = ReadVolume(settings.Path, read);
  volume.Files.insert(volume.Files.end(), mask.Files.begin(), mask.Files.end());
  const auto toMask = FindVoxelMap(volume, mask);
  vtkDataArray* const labels = mask.Image->GetPointData()->GetScalars();
  vtkUnsignedCharArray* const hiding = GetHiding(volume.Image);
  const int* const size = volume.Image->GetDimensions();
  const int* const maskSize = mask.Image->GetDimensions();
  if (!HaveSameVoxels(toMask, size, maskSize))
  {
    volume.Notes.push_back("the mask has other voxels than the volume: " + DescribeGrid(mask) +
      ", where the volume has " + DescribeGrid(volume) + "; the nearest were taken");
  }
  vtkIdType point = 0, shown = 0;
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i, ++point)
      {
        double place[4] = { double(i), double(j), double(k), 1.0 };
        toMask->MultiplyPoint(place, place);
        vtkIdType index = 0;
        for (int axis = 2; axis >= 0 && index >= 0; --axis)
        {
          const double whole = std::round(place[axis]);
          const bool isInside = whole >= 0.0 && whole < maskSize[axis];
          index = isInside ? index * maskSize[axis] + vtkIdType(whole) : -1;
        }
        const double label = index >= 0 ? labels->GetComponent(index, 0) : 0.0;
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
      "this mask shows nothing of the volume; its labels are " + ListLabels(labels) +
        ", so give one of them as --label.");
  }
  volume.Notes.push_back("the mask shows " + std::to_string(shown) + " of " +
    std::to_string(volume.Image->GetNumberOfPoints()) + " voxels");
}
