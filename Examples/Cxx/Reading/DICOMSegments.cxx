// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOM.h"

#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "vtkDICOMItem.h"
#include "vtkDICOMSequence.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>

namespace
{
/// Steps that a frame may be off its place.
constexpr double NearEnough = 0.1;

/**
 * List the segments by their numbers and names.
 */
std::vector<std::string> ListSegments(const DICOMFiles& files, std::vector<int>& numbers)
{
  std::vector<std::string> names;
  for (const auto& file : files)
  {
    const vtkDICOMSequence segments = file->Get(DC::SegmentSequence);
    for (std::size_t i = 0; i < segments.GetNumberOfItems(); ++i)
    {
      numbers.push_back(segments.Get(i, DC::SegmentNumber).AsInt());
      names.push_back(std::to_string(numbers.back()) + " (" +
        segments.Get(i, DC::SegmentLabel).AsUTF8String() + ")");
    }
  }
  return names;
}

/**
 * Find the distance of even slices on which all frames lie: the one that the file gives, else the
 * least between frames, or 1 mm if there is one.
 */
double FindStep(const SliceLine& line, double thickness, const std::string& path)
{
  double least = 0.0;
  for (std::size_t i = 1; i < line.Places.size(); ++i)
  {
    const double step = line.Places[i] - line.Places[i - 1];
    least = least > 0.0 && least < step ? least : step;
  }
  for (const double step : { thickness, least > 0.0 ? least : 1.0 })
  {
    if (step > 0.0 &&
      std::all_of(line.Places.begin(), line.Places.end(),
        [step](double place)
        { return std::fabs(place / step - std::round(place / step)) < NearEnough; }))
    {
      return step;
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
  const std::string type = frame.Get(DC::SegmentationType).AsString();
  const int number = frame.Get(DC::ReferencedSegmentNumber).AsInt();
  const double least =
    type == "FRACTIONAL" ? 0.5 * frame.Get(DC::MaximumFractionalValue).AsDouble() : 1.0;
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
  const std::string kind = file.Get(DC::SOPClassUID).AsString();
  return kind == "1.2.840.10008.5.1.4.1.1.66.4" || kind == "1.2.840.10008.5.1.4.1.1.66.7";
}

void ReadSegments(const DICOMFiles& files, int label, const QuietReading& quiet, Volume& volume)
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
  const DICOMFrames frames = FindFrames(files);
  std::vector<std::string> notes;
  if (FindLargestStack(frames, notes).size() != frames.size())
  {
    Refuse(path, "its frames are of different kinds; " + notes.back() + ".");
  }
  const std::vector<DICOMFrames> places = FindPlaces(frames);
  DICOMFrames firsts; // the frames of a place are of different segments
  for (const DICOMFrames& place : places)
  {
    firsts.push_back(place.front());
  }
  const SliceLine line = FindLine(firsts);
  const double step = FindStep(line, files.front()->Thickness, path);
  const auto getSlice = [&](std::size_t i) { return std::lround(line.Places[i] / step); };
  const SlicePlane& first = firsts.front().Plane;
  const vtkIdType slices = getSlice(places.size() - 1) + 1;
  const auto pixels = static_cast<vtkIdType>(first.Size[0] * first.Size[1]);
  CheckMemory(double(pixels) * double(slices), path);
  volume.Image = vtkSmartPointer<vtkImageData>::New();
  volume.Image->SetDimensions(int(first.Size[0]), int(first.Size[1]), int(slices));
  volume.Image->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
  vtkDataArray* const labels = volume.Image->GetPointData()->GetScalars();
  labels->Fill(0.0);
  bool isOverlapping = false;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    for (const DICOMFrame& frame : places[i])
    {
      vtkDataArray* const stored = ReadPixels(*frame.File, quiet)->GetPointData()->GetScalars();
      isOverlapping = AddFrame(frame, stored, label, pixels, getSlice(i), labels) || isOverlapping;
    }
  }
  volume.IsOriented = volume.HasLabels = true;
  PlaceVolume(volume, MakeSteps(first, line.Direction, step), first.Position, "mm");
  volume.Notes.push_back("segments " + JoinWords(names) + " (--label chooses)");
  if (isOverlapping)
  {
    volume.Notes.push_back("segments overlap: the highest number was taken");
  }
}
