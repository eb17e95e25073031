// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOMSegments.h"

#include "Reading/Placement.h"
#include "Reading/Reading.h"
#include "Reading/SliceStack.h"

#include "vtkDICOMItem.h"
#include "vtkDICOMMetaData.h"
#include "vtkDICOMSequence.h"
#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>

namespace
{
/// Steps that a frame may be off its place.
constexpr double NearEnough = 0.1;

vtkDICOMValue Get(const DICOMFrame& frame, vtkDICOMTag tag)
{
  return frame.File->Reader->GetMetaData()->Get(0, frame.Number, tag);
}

/**
 * The numbers of segments, with the names that the files give.
 */
std::vector<std::string> ListSegments(
  const std::vector<std::unique_ptr<DICOMFile>>& files, std::vector<int>& numbers)
{
  std::vector<std::string> names;
  for (const auto& file : files)
  {
    const vtkDICOMSequence segments = file->Reader->GetMetaData()->Get(DC::SegmentSequence);
    for (std::size_t i = 0; i < segments.GetNumberOfItems(); ++i)
    {
      std::string name = segments.Get(i, DC::SegmentLabel).AsString();
      std::replace_if(
        name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
      numbers.push_back(segments.Get(i, DC::SegmentNumber).AsInt());
      names.push_back(std::to_string(numbers.back()) + " (" + name + ")");
    }
  }
  return names;
}

/**
 * The distance of slices of which each frame's place is a multiple: the one that the file gives,
 * else the least.
 */
double FindStep(const std::vector<double>& heights, double thickness, const std::string& path)
{
  double least = heights.size() > 1 ? heights.back() - heights.front() : thickness;
  for (std::size_t i = 1; i < heights.size(); ++i)
  {
    least = std::min(least, heights[i] - heights[i - 1]);
  }
  for (const double step : { thickness, least })
  {
    if (std::all_of(heights.begin(), heights.end(),
          [&](double height)
          {
            const double place = (height - heights.front()) / step;
            return std::fabs(place - std::round(place)) < NearEnough;
          }))
    {
      return step;
    }
  }
  Refuse(path, "its frames are not evenly spaced; export the segmentation again.");
}

/**
 * Enter a frame into its slice of labels. Returns whether it overlaps with other segments.
 */
bool AddFrame(const DICOMFrame& frame, vtkDataArray* stored, int label, vtkIdType pixels,
  vtkIdType slice, vtkDataArray* labels)
{
  const std::string type = Get(frame, DC::SegmentationType).AsString();
  const int number = Get(frame, DC::ReferencedSegmentNumber).AsInt();
  const double least =
    type == "FRACTIONAL" ? 0.5 * Get(frame, DC::MaximumFractionalValue).AsDouble() : 1.0;
  bool isOverlapping = false;
  for (vtkIdType i = 0; i < pixels; ++i)
  {
    const double value = stored->GetComponent(frame.Number * pixels + i, 0);
    const double found = type == "LABELMAP" ? value : value >= least ? number : 0.0;
    const double known = labels->GetComponent(slice * pixels + i, 0);
    if (found > 0.0 && (label == 0 || found == label))
    {
      isOverlapping = isOverlapping || (known != 0.0 && known != found);
      labels->SetComponent(slice * pixels + i, 0, std::max(found, known));
    }
  }
  return isOverlapping;
}
}

bool IsSegmentation(const DICOMFile& file)
{
  const std::string kind = file.Reader->GetMetaData()->Get(DC::SOPClassUID).AsString();
  return kind == "1.2.840.10008.5.1.4.1.1.66.4" || kind == "1.2.840.10008.5.1.4.1.1.66.7";
}

Volume ReadSegments(
  const std::vector<std::unique_ptr<DICOMFile>>& files, int label, const QuietReading& quiet)
{
  const std::string& path = files.front()->Path;
  std::vector<int> numbers;
  const auto names = ListSegments(files, numbers);
  if (label != 0 && std::find(numbers.begin(), numbers.end(), label) == numbers.end())
  {
    Refuse(path,
      "there is no segment " + std::to_string(label) + " here, only " + JoinWords(names) +
        "; give another --label.");
  }
  const std::vector<DICOMFrame> frames = FindFrames(files);
  std::vector<SlicePlane> planes;
  std::vector<double> heights;
  const SlicePlane& plane = frames.front().Plane;
  Vector3 normal;
  vtkMath::Cross(plane.Row.data(), plane.Column.data(), normal.data());
  for (const DICOMFrame& frame : frames)
  {
    planes.push_back(frame.Plane);
  }
  std::string note;
  if (FindLargestStack(planes, note).size() != planes.size())
  {
    Refuse(path, "its frames are of different kinds; " + note + ".");
  }
  const auto places = FindPlaces(planes);
  for (const auto& place : places)
  {
    heights.push_back(vtkMath::Dot(planes[place[0]].Position.data(), normal.data()));
  }
  const double step = FindStep(heights, files.front()->Thickness, path);
  const auto slices = std::lround((heights.back() - heights.front()) / step) + 1;
  CheckMemory(double(plane.Size[0]) * double(plane.Size[1]) * double(slices), path);
  Volume volume;
  volume.Image = vtkSmartPointer<vtkImageData>::New();
  volume.Image->SetDimensions(int(plane.Size[0]), int(plane.Size[1]), int(slices));
  volume.Image->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
  vtkDataArray* const labels = volume.Image->GetPointData()->GetScalars();
  labels->Fill(0.0);
  const auto pixels = static_cast<vtkIdType>(plane.Size[0] * plane.Size[1]);
  bool isOverlapping = false;
  for (const DICOMFrame& frame : frames)
  {
    vtkDataArray* const stored = ReadPixels(*frame.File, quiet)->GetPointData()->GetScalars();
    const double height = vtkMath::Dot(frame.Plane.Position.data(), normal.data());
    const auto slice = static_cast<vtkIdType>(std::lround((height - heights.front()) / step));
    isOverlapping = AddFrame(frame, stored, label, pixels, slice, labels) || isOverlapping;
  }
  Steps steps;
  for (int row = 0; row < 3; ++row)
  {
    steps[0][row] = plane.Row[row] * plane.Spacing[0];
    steps[1][row] = plane.Column[row] * plane.Spacing[1];
    steps[2][row] = normal[row] * step;
  }
  volume.IsOriented = volume.IsInMillimeters = volume.HasLabels = true;
  PlaceVolume(volume, steps, planes[places.front()[0]].Position);
  volume.Notes.push_back("segments " + JoinWords(names) + " (--label chooses)");
  if (isOverlapping)
  {
    volume.Notes.push_back("segments overlap: the highest number was taken");
  }
  return volume;
}
