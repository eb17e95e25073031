// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOM.h"

#include "vtkMath.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace
{
/// Pixels by which planes at the same place may differ.
constexpr double SamePlace = 0.01;

/// Pixels by which the corners of a slice may be off: less than a projection resolves.
constexpr double HalfPixel = 0.5;

double Dot(const Vector3& a, const Vector3& b)
{
  return vtkMath::Dot(a.data(), b.data());
}

Vector3 Subtract(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Vector3 GetNormal(const SlicePlane& plane)
{
  Vector3 normal;
  vtkMath::Cross(plane.Row.data(), plane.Column.data(), normal.data());
  return normal;
}

double GetPixel(const SlicePlane& plane)
{
  return std::min(plane.Spacing[0], plane.Spacing[1]);
}

/**
 * Get the degrees between the axes of planes.
 */
double GetAngle(const SlicePlane& a, const SlicePlane& b)
{
  return vtkMath::DegreesFromRadians(
    std::max(vtkMath::AngleBetweenVectors(a.Row.data(), b.Row.data()),
      vtkMath::AngleBetweenVectors(a.Column.data(), b.Column.data())));
}

bool HaveSameOrientation(const SlicePlane& a, const SlicePlane& b)
{
  const double reach = std::hypot(a.Size[0] * a.Spacing[0], a.Size[1] * a.Spacing[1]);
  return vtkMath::RadiansFromDegrees(GetAngle(a, b)) * reach < HalfPixel * GetPixel(a);
}

bool HaveSameSpacing(const SlicePlane& a, const SlicePlane& b)
{
  const auto isSame = [&](int axis)
  {
    return std::fabs(a.Spacing[axis] - b.Spacing[axis]) * a.Size[axis] <
      HalfPixel * a.Spacing[axis];
  };
  return isSame(0) && isSame(1);
}

std::string DescribePixels(const SlicePlane& plane)
{
  std::ostringstream text;
  text << plane.Size[0] << " x " << plane.Size[1] << " pixels of " << plane.Spacing[0] << " x "
       << plane.Spacing[1] << " mm";
  return text.str();
}
}

std::string Describe(const SlicePlane& plane)
{
  std::ostringstream text;
  text << plane.Name << " at (" << plane.Position[0] << ", " << plane.Position[1] << ", "
       << plane.Position[2] << ") mm";
  return text.str();
}

std::array<Vector3, 3> MakeSteps(const SlicePlane& plane, const Vector3& direction, double step)
{
  std::array<Vector3, 3> steps;
  for (int row = 0; row < 3; ++row)
  {
    steps[0][row] = plane.Row[row] * plane.Spacing[0];
    steps[1][row] = plane.Column[row] * plane.Spacing[1];
    steps[2][row] = direction[row] * step;
  }
  return steps;
}

DICOMFrames FindLargestStack(const DICOMFrames& frames, std::vector<std::string>& notes)
{
  std::vector<DICOMFrames> kinds;
  for (const DICOMFrame& frame : frames)
  {
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
      [&](const DICOMFrames& other)
      {
        const SlicePlane& first = other.front().Plane;
        return HaveSameOrientation(first, frame.Plane) && first.Size == frame.Plane.Size &&
          HaveSameSpacing(first, frame.Plane);
      });
    (kind == kinds.end() ? *kinds.insert(kind, DICOMFrames()) : *kind).push_back(frame);
  }
  const auto usual = std::max_element(
    kinds.begin(), kinds.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const auto odd = usual == kinds.begin() ? kinds.end() - 1 : kinds.begin();
  if (kinds.size() > 1)
  {
    const SlicePlane& plane = odd->front().Plane;
    const SlicePlane& first = usual->front().Plane;
    std::ostringstream text;
    text << "only the largest stack is shown; " << frames.size() - usual->size() << " of "
         << frames.size() << " slices do not fit, such as " << Describe(plane) << " with "
         << DescribePixels(plane) << ", whose axes differ by " << GetAngle(plane, first)
         << " degrees; the others have " << DescribePixels(first);
    notes.push_back(text.str());
  }
  return *usual;
}

std::vector<DICOMFrames> FindPlaces(const DICOMFrames& frames)
{
  const SlicePlane& first = frames[0].Plane;
  const Vector3 normal = GetNormal(first);
  const auto getHeight = [&](const DICOMFrame& frame) { return Dot(frame.Plane.Position, normal); };
  DICOMFrames sorted = frames;
  std::stable_sort(sorted.begin(), sorted.end(),
    [&](const DICOMFrame& a, const DICOMFrame& b) { return getHeight(a) < getHeight(b); });
  std::vector<DICOMFrames> places;
  double last = 0.0;
  for (const DICOMFrame& frame : sorted)
  {
    if (places.empty() || getHeight(frame) - last > SamePlace * GetPixel(first))
    {
      places.emplace_back();
    }
    places.back().push_back(frame);
    last = getHeight(frame);
  }
  return places;
}

SliceLine FindLine(const DICOMFrames& slices)
{
  const SlicePlane &first = slices.front().Plane, &last = slices.back().Plane;
  const Vector3 normal = GetNormal(first);
  SliceLine line = { Subtract(last.Position, first.Position), {} };
  if (!(Dot(line.Direction, normal) > 0.0)) // a single place
  {
    line.Direction = normal;
  }
  vtkMath::Normalize(line.Direction.data());
  const SlicePlane* farthest = &first;
  double most = 0.0;
  for (const DICOMFrame& slice : slices)
  {
    Vector3 aside = Subtract(slice.Plane.Position, first.Position);
    line.Places.push_back(Dot(aside, normal) / Dot(line.Direction, normal));
    for (int axis = 0; axis < 3; ++axis)
    {
      aside[axis] -= line.Places.back() * line.Direction[axis];
    }
    farthest = vtkMath::Norm(aside.data()) > most ? &slice.Plane : farthest;
    most = std::max(most, vtkMath::Norm(aside.data()));
  }
  if (most > HalfPixel * GetPixel(first))
  {
    std::ostringstream text;
    text
      << Describe(*farthest) << ": this slice is shifted sideways by " << most
      << " mm against the line from " << Describe(first) << " to " << Describe(last)
      << "; move what does not belong to the volume out of the folder, or choose another series.";
    throw std::runtime_error(text.str());
  }
  return line;
}
