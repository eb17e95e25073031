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
 * Read slices, each file once.
 */
vtkSmartPointer<vtkImageData> ReadSlices(const DICOMFrames& slices, bool hidesPadding,
  const QuietReading& quiet, std::vector<std::string>& notes)
{
  std::vector<ValueMap> maps;
  std::map<DICOMFile*, std::vector<std::size_t>> slicesOf;
  for (const DICOMFrame& slice : slices)
  {
    slicesOf[slice.File].push_back(maps.size());
    maps.push_back(FindValueMap(slice, hidesPadding, notes));
  }
  const SlicePlane& plane = slices[0].Plane;
  CheckMemory(double(plane.Size[0]) * plane.Size[1] * slices.size(), slices[0].File->Path);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(plane.Size[0]), static_cast<int>(plane.Size[1]),
    static_cast<int>(slices.size()));
  image->AllocateScalars(FindScalarType(slices, maps), slices[0].File->Components);
  ProgressLine line("reading slices");
  std::size_t done = 0;
  for (const auto& [file, numbers] : slicesOf)
  {
    line.Show(double(done) / double(slices.size()));
    vtkImageData* const found = ReadPixels(*file, quiet);
    for (const std::size_t n : numbers)
    {
      ConvertSlice(found, slices[n].Number, maps[n], image, static_cast<int>(n));
    }
    file->Reader->GetOutput()->ReleaseData();
    done += numbers.size();
  }
  return Narrow(image);
}

/**
 * Find even places for slices, or refuse them.
 */
std::vector<double> FindEvenPlaces(
  const SliceLine& line, const DICOMFrames& slices, std::vector<std::string>& notes)
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
  { return Describe(slices[i - 1].Plane) + " and " + Describe(slices[i].Plane); };
  std::ostringstream text;
  text << "the slices are " << step(least) << " mm (between " << describe(least) << ") to "
       << step(most) << " mm apart (between " << describe(most) << ")";
  if (even.empty())
  {
    Refuse(slices[least].Plane.Name,
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
void FindWindow(const DICOMFrames& slices, Volume& volume)
{
  std::set<std::pair<double, double>> found;
  for (const DICOMFrame& slice : slices)
  {
    found.emplace(slice.Get(DC::WindowWidth).AsDouble(), slice.Get(DC::WindowCenter).AsDouble());
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
  const DICOMFrames stack = FindLargestStack(FindFrames(files), volume.Notes);
  const DICOMFrames slices = ChooseTime(FindPlaces(stack), settings.Frame, volume.Notes);
  const SliceLine line = FindLine(slices);
  const std::vector<double> even = FindEvenPlaces(line, slices, volume.Notes);
  volume.Image = ReadSlices(slices, settings.HidesPadding, quiet, volume.Notes);
  const SlicePlane& first = slices[0].Plane;
  if (even != line.Places)
  {
    CheckMemory(double(first.Size[0]) * first.Size[1] * even.size(), slices[0].File->Path);
    volume.Image = Interpolate(volume.Image, 2, line.Places, even);
    AddCaution(volume, "slices interpolated");
  }
  FindWindow(slices, volume);
  const double thickness = files.front()->Thickness;
  const double step = even.size() > 1 ? even.back() / static_cast<double>(even.size() - 1)
    : thickness > 0.0                 ? thickness
                                      : 1.0;
  volume.IsOriented = true;
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
