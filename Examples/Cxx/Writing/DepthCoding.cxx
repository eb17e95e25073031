// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/DepthCoding.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{
/// Find the depth of a point along a camera's direction of projection.
double FindDepth(const double point[3], vtkCamera* camera)
{
  const double* const focus = camera->GetFocalPoint();
  const double offset[3] = { point[0] - focus[0], point[1] - focus[1], point[2] - focus[2] };
  return vtkMath::Dot(offset, camera->GetDirectionOfProjection());
}

std::string DescribePlace(double depth)
{
  char text[64];
  std::snprintf(text, sizeof(text), "%.3g mm %s the middle", std::fabs(depth),
    depth < 0.0 ? "before" : "behind");
  return text;
}
}

DepthRange FindDepthRange(vtkSplattingMIPProjection* projection)
{
  auto* const image = vtkImageData::SafeDownCast(projection->GetInput());
  const int* const size = image->GetDimensions();
  vtkNew<vtkCamera> camera;
  DepthRange range = { 0.0, 0.0 };
  for (int view = 0; projection->GetViewCamera(view, camera); ++view)
  {
    if (projection->GetSlab())
    {
      const double middle = FindDepth(projection->GetSlabCenter(), camera);
      const double half = 0.5 * projection->GetSlabThickness();
      return { middle - half, middle + half };
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      double point[3];
      image->TransformIndexToPhysicalPoint(corner & 1 ? size[0] - 1 : 0,
        corner & 2 ? size[1] - 1 : 0, corner & 4 ? size[2] - 1 : 0, point);
      const double depth = FindDepth(point, camera);
      range = { std::min(range.Near, depth), std::max(range.Far, depth) };
    }
  }
  return range;
}

vtkSmartPointer<vtkImageData> ColorByDepth(
  vtkImageData* bytes, vtkSplattingMIPProjection* projection, const DepthRange& range)
{
  auto colors = vtkSmartPointer<vtkImageData>::New();
  colors->CopyStructure(bytes);
  colors->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto* const from = static_cast<unsigned char*>(bytes->GetScalarPointer());
  auto* to = static_cast<unsigned char*>(colors->GetScalarPointer());
  vtkDataArray* const places = projection->GetOutput()->GetPointData()->GetArray("Position");
  const int* const size = bytes->GetDimensions();
  const vtkIdType pixels = vtkIdType(size[0]) * size[1];
  vtkNew<vtkCamera> camera;
  for (vtkIdType p = 0; p < bytes->GetNumberOfPoints(); ++p, to += 3)
  {
    if (p % pixels == 0)
    {
      projection->GetViewCamera(static_cast<int>(p / pixels), camera);
    }
    double place[3];
    places->GetTuple(p, place);
    const double depth = FindDepth(place, camera);
    const double length = range.Far > range.Near ? range.Far - range.Near : 1.0;
    const double share = std::isnan(depth) ? 0.0 : (depth - range.Near) / length;
    const double hsv[3] = { 2.0 / 3.0 * std::clamp(share, 0.0, 1.0), 1.0, from[p] / 255.0 };
    double rgb[3];
    vtkMath::HSVToRGB(hsv, rgb);
    std::transform(rgb, rgb + 3, to,
      [](double c) { return static_cast<unsigned char>(std::lround(255.0 * c)); });
  }
  return colors;
}

std::string DescribeHues(const DepthRange& range, bool isInMillimeters)
{
  return isInMillimeters
    ? "red: " + DescribePlace(range.Near) + "\nblue: " + DescribePlace(range.Far)
    : "red: near, green: in the middle\nblue: far";
}
