// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressLine.h"
#include "Reading/DICOM.h"
#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "vtkDICOMMetaData.h"
#include "vtkImageCast.h"
#include "vtkNew.h"

#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace
{
/// Steps that a slice may be off its even place without interpolation.
constexpr double EvenEnough = 0.1;

/**
 * Convert integers to 16 bits if they hold the values that there are.
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
 * Read the frames in an order, each file once.
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
  std::size_t done = 0;
  for (const auto& [file, slices] : slicesOf)
  {
    line.Show(double(done) / double(order.size()));
    vtkImageData* const found = ReadPixels(*file, quiet);
    for (const std::size_t slice : slices)
    {
      ConvertSlice(found, chosen[slice]->Number, maps[slice], image, static_cast<int>(slice));
    }
    file->Reader->GetOutput()->ReleaseData();
    done += slices.size();
  }
  return Narrow(image);
}

/**
 * Find even places for slices, or refuse them.
 */
std::vector<double> FindEvenPlaces(const SliceLine& line, const std::vector<SlicePlane>& planes,
  const std::vector<std::size_t>& order, std::vector<std::string>& notes)
{
  const auto& places = line.Places;
  const std::vector<double> even = SpaceEvenly(places, EvenEnough);
  if (even == places)
  {
    return even;
  }
  std::size_t least = 1, most = 1; // the slices behind these steps
  const auto step = [&](std::size_t i) { return places[i] - places[i - 1]; };
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    least = step(i) < step(least) ? i : least;
    most = step(i) > step(most) ? i : most;
  }
  const auto describe = [&](std::size_t i)
  { return Describe(planes[order[i - 1]]) + " and " + Describe(planes[order[i]]); };
  std::ostringstream text;
  text << "the slices are " << step(least) << " mm (between " << describe(least) << ") to "
       << step(most) << " mm apart (between " << describe(most) << ")";
  if (even.empty())
  {
    Refuse(planes[order[least]].Name,
      text.str() +
        ", which is too uneven to interpolate; move what does not belong to the volume out of "
        "the folder.");
  }
  text << " and were interpolated to " << even[1] - even[0] << " mm";
  notes.push_back(text.str());
  return even;
}

/**
 * Find the window with which all frames ask to be shown, the first if they give several.
 */
void FindWindow(
  const std::vector<DICOMFrame>& frames, const std::vector<std::size_t>& order, Volume& volume)
{
  std::set<std::pair<double, double>> found;
  for (const std::size_t i : order)
  {
    found.emplace(
      frames[i].Get(DC::WindowWidth).AsDouble(), frames[i].Get(DC::WindowCenter).AsDouble());
  }
  const auto [width, center] = *found.begin();
  if (found.size() == 1 && width > 0.0 && std::isfinite(width) && std::isfinite(center))
  {
    volume.Window = width;
    volume.Level = center;
  }
}

/**
 * Read the largest stack of frames that agree: not a scout among slices.
 */
void ReadStack(
  const DICOMFiles& files, const ReadSettings& settings, const QuietReading& quiet, Volume& volume)
{
  std::string note;
  std::vector<DICOMFrame> frames;
  const std::vector<DICOMFrame> all = FindFrames(files);
  for (const std::size_t i : FindLargestStack(GetPlanes(all), note))
  {
    frames.push_back(all[i]);
  }
  if (!note.empty())
  {
    volume.Notes.push_back(note);
  }
  const std::vector<SlicePlane> planes = GetPlanes(frames);
  const auto order = ChooseTime(frames, FindPlaces(planes), settings.Frame, volume.Notes);
  const SliceLine line = FindLine(planes, order);
  const std::vector<double> even = FindEvenPlaces(line, planes, order, volume.Notes);
  volume.Image = ReadFrames(frames, order, settings.HidesPadding, quiet, volume.Notes);
  if (even != line.Places)
  {
    const SlicePlane& plane = planes[0];
    CheckMemory(double(plane.Size[0]) * plane.Size[1] * even.size(), frames[0].File->Path);
    volume.Image = Interpolate(volume.Image, 2, line.Places, even);
    AddCaution(volume, "slices interpolated");
  }
  FindWindow(frames, order, volume);
  const double thickness = files.front()->Thickness;
  const double step = even.size() > 1 ? even.back() / static_cast<double>(even.size() - 1)
    : thickness > 0.0                 ? thickness
                                      : 1.0;
  volume.IsOriented = true;
  const SlicePlane& first = planes[order[0]];
  PlaceVolume(volume, MakeSteps(first, line.Direction, step), first.Position, "mm");
}
}

Volume ReadDICOM(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  Volume volume;
  const auto names = ChooseSeries(path, settings.Series, quiet, volume.Notes, volume.Files);
  const auto files = OpenFiles(names, quiet, volume.Notes);
  volume.Study = files.front()->Reader->GetMetaData();
  if (IsSegmentation(*files.front()))
  {
    Choose(path, "volume", settings.Frame, 1, volume.Notes);
    ReadSegments(files, settings.Label, quiet, volume);
  }
  else
  {
    ReadStack(files, settings, quiet, volume);
  }
  return volume;
}
