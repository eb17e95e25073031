// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Mask.h"

#include "Reading/Reading.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>

namespace
{
/// Voxels by which equal voxels of mask and volume may differ, because files round.
constexpr double Tolerance = 0.1;

/**
 * Make the matrix from voxels to the patient.
 */
vtkSmartPointer<vtkMatrix4x4> MakeIndexToPatient(const Volume& volume)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  matrix->DeepCopy(volume.Image->GetIndexToPhysicalMatrix());
  for (int row = 0; row < 3; ++row)
  {
    matrix->SetElement(row, 3, volume.Origin[row]);
  }
  return matrix;
}
}

void ApplyMask(const MaskSettings& settings, Volume& volume)
{
  ReadSettings read;
  read.Label = settings.Label;
  const Volume mask = ReadVolume(settings.Path, read);
  volume.Files.insert(volume.Files.end(), mask.Files.begin(), mask.Files.end());
  vtkNew<vtkMatrix4x4> toMask; // from the volume's voxels
  vtkMatrix4x4::Invert(MakeIndexToPatient(mask), toMask);
  vtkMatrix4x4::Multiply4x4(toMask, MakeIndexToPatient(volume), toMask);
  vtkDataArray* const labels = mask.Image->GetPointData()->GetScalars();
  int size[3];
  volume.Image->GetDimensions(size);
  const int* const maskSize = mask.Image->GetDimensions();
  vtkUnsignedCharArray* const hidden = volume.Image->AllocatePointGhostArray();
  bool areSame = volume.Image->GetNumberOfPoints() == mask.Image->GetNumberOfPoints();
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
        for (int axis = 2; axis >= 0; --axis)
        {
          const double whole = std::round(place[axis]);
          const bool isInside = index >= 0 && whole >= 0.0 && whole < maskSize[axis];
          areSame = areSame && isInside && std::fabs(place[axis] - whole) < Tolerance;
          index = isInside ? index * maskSize[axis] + vtkIdType(whole) : -1;
        }
        const double label = index >= 0 ? labels->GetComponent(index, 0) : 0.0;
        if (settings.Label ? label == settings.Label : label != 0.0)
        {
          ++shown;
        }
        else
        {
          hidden->SetValue(point, hidden->GetValue(point) | vtkDataSetAttributes::HIDDENPOINT);
        }
      }
    }
  }
  if (shown == 0)
  {
    Refuse(settings.Path, "this mask shows nothing of the volume; give another --label or --mask.");
  }
  if (!areSame)
  {
    volume.Notes.push_back("the mask has other voxels than the volume: the nearest were taken");
  }
  volume.Notes.push_back(
    "the mask shows " + std::to_string(shown) + " of " + std::to_string(point) + " voxels");
}
