// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOMVolume.h"

#include "ProgressLine.h"
#include "Reading/DICOMFrames.h"
#include "Reading/DICOMSegments.h"
#include "Reading/DICOMSeries.h"
#include "Reading/DICOMValues.h"
#include "Reading/Placement.h"
#include "Reading/Reading.h"
#include "Reading/SliceStack.h"

#include "vtkDICOMMetaData.h"
#include "vtkDataArray.h"
#include "vtkImageCast.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace
{
/**
 * 16-bit integers where they hold the values that there are.
 */
vtkSmartPointer<vtkImageData> Narrow(vtkImageData* image)
{
  double range[2];
  image->GetScalarRange(range);
  if (image->GetScalarType() != VTK_INT || range[0] < VTK_SHORT_MIN ||
    range[1] > VTK_UNSIGNED_SHORT_MAX || (range[0] < 0.0 && range[1] > VTK_SHORT_MAX))
  {
    return image;
  }
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(image);
  cast->SetOutputScalarType(range[1] > VTK_SHORT_MAX ? VTK_UNSIGNED_SHORT : VTK_SHORT);
  cast->Update();
  return cast->GetOutput();
}

/**
 * The frames in their order, each file read once.
 */
vtkSmartPointer<vtkImageData> ReadFrames(const std::vector<DICOMFrame>& frames,
  const std::vector<std::size_t>& order, bool hidesPadding, const QuietReading& quiet,
  std::vector<std::string>& notes)
{
  std::vector<const DICOMFrame*> chosen;
  std::vector<ValueMap> maps;
  for (const std::size_t i : order)
  {
    chosen.push_back(&frames[i]);
    maps.push_back(FindValueMap(frames[i], hidesPadding, notes));
  }
  const SlicePlane& plane = frames[order[0]].Plane;
  const double voxels = double(plane.Size[0]) * plane.Size[1] * order.size();
  CheckMemory(voxels, frames[order[0]].File->Path);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(plane.Size[0]), static_cast<int>(plane.Size[1]),
    static_cast<int>(order.size()));
  image->AllocateScalars(FindScalarType(chosen, maps), frames[order[0]].File->Components);
  std::map<DICOMFile*, std::vector<std::size_t>> slicesOf;
  for (std::size_t slice = 0; slice < order.size(); ++slice)
  {
    slicesOf[frames[order[slice]].File].push_back(slice);
  }
  ProgressLine line("reading slices");
  SliceConverter converter;
  std::size_t done = 0;
  for (const auto& [file, slices] : slicesOf)
  {
    line.Show(double(done) / double(order.size()));
    vtkImageData* const found = ReadPixels(*file, quiet);
    for (const std::size_t slice : slices)
    {
      converter.Convert(found, chosen[slice]->Number, maps[slice], image, static_cast<int>(slice));
    }
    file->Reader->GetOutput()->ReleaseData();
    done += slices.size();
  }
  return Narrow(image);
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
  const double step = grid.Step > 0.0 ? grid.Step : thickness;
  PlaceVolume(volume, MakeSteps(plane, grid.Direction, step), plane.Position);
}

std::vector<SlicePlane> GetPlanes(const std::vector<DICOMFrame>& frames)
{
  std::vector<SlicePlane> planes;
  for (const DICOMFrame& frame : frames)
  {
    planes.push_back(frame.Plane);
  }
  return planes;
}

/**
 * The frames that agree with most others: not a scout among slices.
 */
std::vector<DICOMFrame> ChooseStack(
  const std::vector<DICOMFrame>& frames, std::vector<std::string>& notes)
{
  std::string note;
  std::vector<DICOMFrame> chosen;
  for (const std::size_t i : FindLargestStack(GetPlanes(frames), note))
  {
    chosen.push_back(frames[i]);
  }
  if (!note.empty())
  {
    notes.push_back(note);
  }
  return chosen;
}
}

Volume ReadDICOM(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  Volume volume;
  const auto names = ChooseSeries(path, settings.Series, quiet, volume.Notes, volume.Files);
  const auto files = OpenFiles(names, quiet, volume.Notes);
  if (IsSegmentation(*files.front()))
  {
    CheckChoice(path, "volume", settings.Frame, 1);
    Volume segments = ReadSegments(files, settings.Label, quiet);
    segments.Notes.insert(segments.Notes.begin(), volume.Notes.begin(), volume.Notes.end());
    segments.Files = volume.Files;
    segments.Study = files.front()->Reader->GetMetaData();
    return segments;
  }
  const std::vector<DICOMFrame> frames = ChooseStack(FindFrames(files), volume.Notes);
  const std::vector<SlicePlane> planes = GetPlanes(frames);
  const auto order = ChooseTime(frames, FindPlaces(planes), settings.Frame, volume.Notes);
  const SliceGrid grid = MakeGrid(planes, order);
  volume.Image = ReadFrames(frames, order, settings.HidesPadding, quiet, volume.Notes);
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
