// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "View.h"

#include "vtkMath.h"
#include "vtkMatrix3x3.h"

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

namespace
{
/**
 * Get the halves of four diagonals of an image; the other four are their negatives.
 */
std::array<std::array<double, 3>, 4> GetDiagonals(vtkImageData* image)
{
  std::array<std::array<double, 3>, 4> diagonals;
  for (int edge = 0; edge < 4; ++edge)
  {
    double* const diagonal = diagonals[edge].data();
    for (int axis = 0; axis < 3; ++axis)
    {
      diagonal[axis] = 0.5 * (image->GetDimensions()[axis] - 1) * image->GetSpacing()[axis];
    }
    diagonal[1] *= edge & 1 ? -1.0 : 1.0;
    diagonal[2] *= edge & 2 ? -1.0 : 1.0;
    image->GetDirectionMatrix()->MultiplyPoint(diagonal, diagonal);
  }
  return diagonals;
}
}

double GetFittingScale(vtkImageData* image, const ViewSettings& view, vtkTransform* turn)
{
  const double aspect = double(view.Size[0]) / view.Size[1];
  double scale = 0.0;
  for (const auto& diagonal : GetDiagonals(image))
  {
    const double* seen = turn->GetLinearInverse()->TransformDoubleVector(diagonal.data());
    scale = std::max({ scale, std::fabs(seen[2]), std::fabs(seen[0]) / aspect });
  }
  return scale > 0.0 ? 1.1 * scale : 1.0; // room for the label
}

PerspectiveFit FitPerspective(vtkImageData* image, const ViewSettings& view)
{
  double radius = 0.0;
  for (const auto& diagonal : GetDiagonals(image))
  {
    radius = std::max(radius, std::hypot(diagonal[0], diagonal[1], diagonal[2]));
  }
  radius = radius > 0.0 ? radius : 1.0;
  const double half = 0.5 * vtkMath::RadiansFromDegrees(view.Perspective);
  const double aspect = std::min(1.0, double(view.Size[0]) / view.Size[1]);
  return { radius / std::sin(half), radius / std::cos(half) / aspect };
}
