// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOMVolume.h"

#include "ProgressLine.h"
#include "Reading/DICOMFrames.h"
#include "Reading/DICOMSeries.h"
#include "Reading/Placement.h"
#include "Reading/Reading.h"
#include "Reading/SliceStack.h"

#include "vtkDICOMMetaData.h"
#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace
{
/**
 * The type that holds the values of all files.
 */
int FindScalarType(const std::vector<DICOMFrame>& frames, const std::vector<std::size_t>& order)
{
  const auto getType = [&](std::size_t i) { return frames[i].File->ScalarType; };
  const int type = getType(order[0]);
  bool isSame = true, isShort = true;
  for (const std::size_t i : order)
  {
    isSame = isSame && getType(i) == type;
    isShort =
      isShort && (getType(i) == VTK_FLOAT || vtkDataArray::GetDataTypeSize(getType(i)) <= 2);
  }
  return isSame ? type : isShort ? VTK_FLOAT : VTK_DOUBLE;
}

/**
 * A frame of a file's image as a slice of a volume.
 */
void CopySlice(vtkImageData* from, int frame, vtkImageData* to, int slice)
{
  const int* const size = to->GetDimensions();
  const vtkIdType count = vtkIdType(size[0]) * size[1];
  vtkDataArray* const source = from->GetPointData()->GetScalars();
  vtkDataArray* const target = to->GetPointData()->GetScalars();
  target->InsertTuples(slice * count, count, frame * count, source); // converts the type, too
}

/**
 * The frames in their order, each file read once.
 */
vtkSmartPointer<vtkImageData> ReadFrames(const std::vector<DICOMFrame>& frames,
  const std::vector<std::size_t>& order, const QuietReading& quiet)
{
  const SlicePlane& plane = frames[order[0]].Plane;
  const double voxels = double(plane.Size[0]) * plane.Size[1] * order.size();
  CheckMemory(voxels, frames[order[0]].File->Path);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(plane.Size[0]), static_cast<int>(plane.Size[1]),
    static_cast<int>(order.size()));
  image->AllocateScalars(FindScalarType(frames, order), frames[order[0]].File->Components);
  std::map<DICOMFile*, std::vector<std::size_t>> slicesOf;
  for (std::size_t slice = 0; slice < order.size(); ++slice)
  {
    slicesOf[frames[order[slice]].File].push_back(slice);
  }
  ProgressLine line("reading slices");
  std::size_t done = 0;
  for (const auto& [file, slices] : slicesOf)
  {
    line.Show(double(done) / double(order.size()));
    vtkImageData* const found = ReadPixels(*file, quiet);
    for (const std::size_t slice : slices)
    {
      CopySlice(found, frames[order[slice]].Number, image, static_cast<int>(slice));
    }
    file->Reader->GetOutput()->ReleaseData();
    done += slices.size();
  }
  return image;
}

/**
 * Slices between others: integers are rounded.
 */
vtkSmartPointer<vtkImageData> Blend(
  vtkImageData* image, const std::vector<std::size_t>& order, const std::vector<SliceBlend>& slices)
{
  const int* const size = image->GetDimensions();
  CheckMemory(double(size[0]) * size[1] * slices.size(), "the volume");
  auto even = vtkSmartPointer<vtkImageData>::New();
  even->SetDimensions(size[0], size[1], static_cast<int>(slices.size()));
  const int components = image->GetNumberOfScalarComponents();
  even->AllocateScalars(image->GetScalarType(), components);
  vtkDataArray* const from = image->GetPointData()->GetScalars();
  vtkDataArray* const to = even->GetPointData()->GetScalars();
  const bool isWhole = image->GetScalarType() != VTK_FLOAT && image->GetScalarType() != VTK_DOUBLE;
  const vtkIdType count = vtkIdType(size[0]) * size[1];
  const auto find = [&](std::size_t plane)
  { return std::find(order.begin(), order.end(), plane) - order.begin(); };
  for (std::size_t k = 0; k < slices.size(); ++k)
  {
    const auto first = count * find(slices[k].First), second = count * find(slices[k].Second);
    const double weight = slices[k].Weight;
    const auto start = count * static_cast<vtkIdType>(k);
    if (weight == 0.0 || weight == 1.0)
    {
      to->InsertTuples(start, count, weight == 0.0 ? first : second, from);
      continue;
    }
    for (vtkIdType i = 0; i < count * components; ++i)
    {
      const vtkIdType point = i / components;
      const int n = static_cast<int>(i % components);
      const double value = (1.0 - weight) * from->GetComponent(first + point, n) +
        weight * from->GetComponent(second + point, n);
      to->SetComponent(start + point, n, isWhole ? std::round(value) : value);
    }
  }
  return even;
}

void Place(Volume& volume, const SlicePlane& plane, const SliceGrid& grid, double thickness)
{
  volume.IsOriented = true;
  volume.IsInMillimeters = true;
  Steps steps;
  for (int row = 0; row < 3; ++row)
  {
    steps[0][row] = plane.Row[row] * plane.Spacing[0];
    steps[1][row] = plane.Column[row] * plane.Spacing[1];
    steps[2][row] = grid.Direction[row] * (grid.Step > 0.0 ? grid.Step : thickness);
  }
  PlaceVolume(volume, steps, plane.Position);
}
}

Volume ReadDICOM(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  Volume volume;
  const auto names = ChooseSeries(path, settings.Series, quiet, volume.Notes, volume.Files);
  const auto files = OpenFiles(names, quiet, volume.Notes);
  const std::vector<DICOMFrame> frames = FindFrames(files);
  std::vector<SlicePlane> planes;
  for (const DICOMFrame& frame : frames)
  {
    planes.push_back(frame.Plane);
  }
  const auto order = ChooseTime(frames, FindPlaces(planes), settings.Frame, volume.Notes);
  const SliceGrid grid = MakeGrid(planes, order);
  volume.Image = ReadFrames(frames, order, quiet);
  if (!grid.Note.empty())
  {
    volume.Image = Blend(volume.Image, order, grid.Slices);
    volume.Notes.push_back(grid.Note);
    volume.Caution = "slices interpolated";
  }
  FindWindow(frames, order, volume.Window, volume.Level);
  Place(volume, planes[order[0]], grid, files.front()->Thickness);
  volume.Study = files.front()->Reader->GetMetaData();
  return volume;
}
