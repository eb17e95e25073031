// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "View.h"

#include <algorithm>
#include <cmath>

vtkSmartPointer<vtkTransform> MakeViewTurn(const ViewSettings& view, double azimuth)
{
  auto turn = vtkSmartPointer<vtkTransform>::New();
  turn->RotateZ(azimuth);
  turn->RotateX(-view.Elevation);
  turn->RotateY(view.Roll);
  return turn;
}

double GetFittingScale(
  const double box[6], vtkMatrix4x4* orientation, const ViewSettings& view, vtkTransform* turn)
{
  const double aspect = double(view.Size[0]) / view.Size[1];
  double scale = 0.0;
  for (int edge = 0; edge < 4; ++edge)
  {
    // Half the diagonals of the box; the other four mirror these.
    double diagonal[4] = { 0.5 * (box[1] - box[0]), 0.5 * (box[3] - box[2]),
      0.5 * (box[5] - box[4]), 0.0 };
    diagonal[1] *= edge & 1 ? -1.0 : 1.0;
    diagonal[2] *= edge & 2 ? -1.0 : 1.0;
    orientation->MultiplyPoint(diagonal, diagonal);
    const double* seen = turn->GetLinearInverse()->TransformDoubleVector(diagonal);
    scale = std::max({ scale, std::fabs(seen[2]), std::fabs(seen[0]) / aspect });
  }
  return scale > 0.0 ? 1.1 * scale : 1.0; // a rim for the label
}
