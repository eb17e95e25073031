// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/Picture.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStdString.h"
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

namespace
{
/**
 * Draw a text in one slice. The position is 0 at the left and the bottom, 1 at the right and the
 * top.
 */
void DrawText(vtkImageData* slices, int slice, const std::string& text, double x, double y)
{
  const int* const size = slices->GetDimensions();
  const int components = slices->GetNumberOfScalarComponents();
  vtkNew<vtkTextProperty> style;
  style->SetFontSize(std::max(8, size[1] / 32));
  vtkNew<vtkImageData> letters;
  int used[2] = { 0, 0 };
  if (text.empty() || !vtkTextRenderer::GetInstance()->RenderString(style, text, letters, used, 72))
  {
    return;
  }
  int extent[6];
  letters->GetExtent(extent);
  const int margin = size[1] / 100 + 1;
  const int left = margin + static_cast<int>(std::lround(x * (size[0] - used[0] - 2 * margin)));
  const int bottom = margin + static_cast<int>(std::lround(y * (size[1] - used[1] - 2 * margin)));
  for (int row = std::max(0, -bottom); row < used[1] && bottom + row < size[1]; ++row)
  {
    for (int column = std::max(0, -left); column < used[0] && left + column < size[0]; ++column)
    {
      const auto* const ink = static_cast<unsigned char*>(
        letters->GetScalarPointer(extent[0] + column, extent[2] + row, 0));
      auto* const pixel =
        static_cast<unsigned char*>(slices->GetScalarPointer(left + column, bottom + row, slice));
      for (int n = 0; n < components; ++n)
      {
        pixel[n] = static_cast<unsigned char>(ink[3] + (255 - ink[3]) * pixel[n] / 255);
      }
    }
  }
}

/**
 * Name the patient's sides in a direction, the nearest first.
 */
std::string NameDirection(const double direction[3])
{
  const char* const names[3] = { "RL", "AP", "FH" };
  const double least = std::sin(vtkMath::RadiansFromDegrees(15.0));
  std::vector<std::pair<double, char>> sides;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (std::fabs(direction[axis]) > least)
    {
      sides.emplace_back(-std::fabs(direction[axis]), names[axis][direction[axis] > 0.0]);
    }
  }
  std::stable_sort(
    sides.begin(), sides.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text;
  for (const auto& side : sides)
  {
    text += side.second;
  }
  return text;
}
}

void DrawLabel(vtkImageData* slices, const std::string& text)
{
  for (int slice = 0; slice < slices->GetDimensions()[2]; ++slice)
  {
    DrawText(slices, slice, text, 0.0, 1.0);
  }
}

void DrawSides(vtkImageData* slices, vtkSplattingMIPProjection* projection)
{
  vtkNew<vtkCamera> camera;
  for (int slice = 0; slice < slices->GetDimensions()[2]; ++slice)
  {
    if (!projection->GetViewCamera(slice, camera))
    {
      continue;
    }
    double up[3], away[3], right[3];
    camera->OrthogonalizeViewUp();
    camera->GetViewUp(up);
    camera->GetDirectionOfProjection(away);
    vtkMath::Cross(away, up, right);
    const double left[3] = { -right[0], -right[1], -right[2] };
    const double down[3] = { -up[0], -up[1], -up[2] };
    DrawText(slices, slice, NameDirection(right), 1.0, 0.5);
    DrawText(slices, slice, NameDirection(left), 0.0, 0.5);
    DrawText(slices, slice, NameDirection(up), 0.5, 1.0);
    DrawText(slices, slice, NameDirection(down), 0.5, 0.0);
  }
}

void DrawScaleBar(vtkImageData* slices, double millimetersPerPixel)
{
  const int* const size = slices->GetDimensions();
  const double most = 0.25 * size[0] * millimetersPerPixel;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  const double length = power * (most >= 5.0 * power ? 5.0 : most >= 2.0 * power ? 2.0 : 1.0);
  const int pixels = static_cast<int>(std::lround(length / millimetersPerPixel));
  const int margin = size[1] / 100 + 1;
  const int thickness = std::max(1, size[1] / 200);
  char text[32];
  std::snprintf(text, sizeof(text), "%g mm", length);
  for (int slice = 0; slice < size[2]; ++slice)
  {
    for (int row = margin; row < margin + thickness; ++row)
    {
      auto* const end =
        static_cast<unsigned char*>(slices->GetScalarPointer(size[0] - margin, row, slice));
      const int bytes = pixels * slices->GetNumberOfScalarComponents();
      std::fill(end - bytes, end, static_cast<unsigned char>(255));
    }
    DrawText(slices, slice, text, 1.0, 3.0 * (margin + thickness) / size[1]);
  }
}

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
