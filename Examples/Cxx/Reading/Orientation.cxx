// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Orientation.h"

#include <cmath>

vtkSmartPointer<vtkMatrix4x4> MakeOrientation(const double axes[3][3], bool isRAS)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int column = 0; column < 3; ++column)
  {
    const double* axis = axes[column];
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (int row = 0; row < 3; ++row)
    {
      const double sign = isRAS && row < 2 ? -1.0 : 1.0;
      matrix->SetElement(row, column, sign * axis[row] / length);
    }
  }
  if (!(std::fabs(matrix->Determinant()) > 1e-3)) // so that it catches NaN as well
  {
    matrix->Identity();
  }
  return matrix;
}

vtkSmartPointer<vtkMatrix4x4> MakeOrientation(vtkMatrix4x4* columns, bool isRAS)
{
  double axes[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  for (int i = 0; columns && i < 9; ++i)
  {
    axes[i / 3][i % 3] = columns->GetElement(i % 3, i / 3);
  }
  return MakeOrientation(axes, isRAS);
}
