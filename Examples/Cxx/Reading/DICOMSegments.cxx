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
 * Even slices, on each of which frames lie.
 */
struct Grid
{
  Vector3 Normal;
  Vector3 First; // the first pixel of the first slice
  double Step = 0.0;
  vtkIdType Slices = 0;

  double GetHeight(const SlicePlane& plane) const
  {
    return vtkMath::Dot(plane.Position.data(), this->Normal.data()) -
      vtkMath::Dot(this->First.data(), this->Normal.data());
  }

  vtkIdType GetSlice(const SlicePlane& plane) const
  {
    return static_cast<vtkIdType>(std::lround(this->GetHeight(plane) / this->Step));
  }
};

/**
 * Whether a plane is on a slice, with its pixels above those of the first.
 */
bool IsOnGrid(const SlicePlane& plane, const Grid& grid)
{
  const double height = grid.GetHeight(plane), place = height / grid.Step;
  double aside = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    aside = std::hypot(aside, plane.Position[axis] - grid.First[axis] - height * grid.Normal[axis]);
  }
  return std::fabs(place - std::round(place)) < NearEnough &&
    aside < 0.5 * std::min(plane.Spacing[0], plane.Spacing[1]);
}

/**
 * The distance of slices is the one that the file gives, else the least between frames.
 */
Grid FindGrid(const std::vector<SlicePlane>& planes, double thickness, const std::string& path)
{
  std::string note;
  if (FindLargestStack(planes, note).size() != planes.size())
  {
    Refuse(path, "its frames are of different kinds; " + note + ".");
  }
  const auto places = FindPlaces(planes);
  Grid grid;
  grid.First = planes[places.front()[0]].Position;
  vtkMath::Cross(planes[0].Row.data(), planes[0].Column.data(), grid.Normal.data());
  double least = thickness;
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    const double step =
      grid.GetHeight(planes[places[i][0]]) - grid.GetHeight(planes[places[i - 1][0]]);
    least = i == 1 ? step : std::min(least, step);
  }
  for (const double step : { thickness, least })
  {
    grid.Step = step;
    grid.Slices = grid.GetSlice(planes[places.back()[0]]) + 1;
    if (std::all_of(planes.begin(), planes.end(),
          [&](const SlicePlane& plane) { return IsOnGrid(plane, grid); }))
    {
      return grid;
    }
  }
  Refuse(path, "its frames are not evenly above each other; export the segmentation again.");
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
  for (const DICOMFrame& frame : frames)
  {
    planes.push_back(frame.Plane);
  }
  const SlicePlane& plane = planes.front();
  const Grid grid = FindGrid(planes, files.front()->Thickness, path);
  const auto pixels = static_cast<vtkIdType>(plane.Size[0] * plane.Size[1]);
  CheckMemory(double(pixels) * double(grid.Slices), path);
  Volume volume;
  volume.Image = vtkSmartPointer<vtkImageData>::New();
  volume.Image->SetDimensions(int(plane.Size[0]), int(plane.Size[1]), int(grid.Slices));
  volume.Image->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
  vtkDataArray* const labels = volume.Image->GetPointData()->GetScalars();
  labels->Fill(0.0);
  bool isOverlapping = false;
  for (const DICOMFrame& frame : frames)
  {
    vtkDataArray* const stored = ReadPixels(*frame.File, quiet)->GetPointData()->GetScalars();
    const vtkIdType slice = grid.GetSlice(frame.Plane);
    isOverlapping = AddFrame(frame, stored, label, pixels, slice, labels) || isOverlapping;
  }
  volume.IsOriented = volume.IsInMillimeters = volume.HasLabels = true;
  PlaceVolume(volume, MakeSteps(plane, grid.Normal, grid.Step), grid.First);
  volume.Notes.push_back("segments " + JoinWords(names) + " (--label chooses)");
  if (isOverlapping)
  {
    volume.Notes.push_back("segments overlap: the highest number was taken");
  }
  return volume;
}
