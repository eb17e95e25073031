// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOM.h"

#include "ProgressLine.h"
#include "Reading/Reading.h"

#include "vtkDICOMItem.h"
#include "vtkDICOMMetaData.h"
#include "vtkDICOMSequence.h"
#include "vtkInformation.h"
#include "vtkMath.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

namespace
{
/// Elements by which frames at the same place are distinguished, in the order of preference.
const struct
{
  vtkDICOMTag Tag;
  const char* Name;
} TimeTags[] = { { DC::TemporalPositionIdentifier, "temporal position" },
  { DC::TemporalPositionIndex, "temporal position" }, { DC::TriggerTime, "trigger time" },
  { DC::NominalCardiacTriggerDelayTime, "trigger delay" }, { DC::EchoTime, "echo time" },
  { DC::EffectiveEchoTime, "echo time" }, { DC::DiffusionBValue, "b value" },
  { DC::AcquisitionNumber, "acquisition" }, { DC::AcquisitionTime, "acquisition time" },
  { DC::ContentTime, "time" }, { DC::ImageType, "image type" }, { DC::SOPInstanceUID, "object" },
  { DC::InstanceNumber, "instance number" }, { DC::DimensionIndexValues, "dimension index" } };

/**
 * Get as many finite numbers as asked for, or none.
 */
std::vector<double> GetNumbers(const vtkDICOMValue& value, std::size_t count)
{
  if (value.GetNumberOfValues() != count)
  {
    return {};
  }
  std::vector<double> numbers(count);
  value.GetValues(numbers.data(), count);
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })
    ? numbers
    : std::vector<double>();
}

int GetNumberOfFrames(const DICOMFile& file)
{
  return std::max(1, file.Get(DC::NumberOfFrames).AsInt());
}

double GetLength(const DICOMFile& file, vtkDICOMTag tag)
{
  const double length = std::fabs(file.Get(tag).AsDouble());
  return std::isfinite(length) ? length : 0.0;
}

std::unique_ptr<DICOMFile> OpenFile(const std::string& path, const QuietReading& quiet)
{
  auto file = std::make_unique<DICOMFile>();
  file->Path = path;
  file->Reader = vtkSmartPointer<vtkDICOMReader>::New();
  file->Reader->SetFileName(path.c_str());
  file->Reader->SortingOff();
  file->Reader->AutoRescaleOff(); // which clamps values to 16 bits
  file->Reader->SetMemoryRowOrderToFileNative();
  file->Reader->UpdateInformation();
  vtkDICOMMetaData* const elements = file->Reader->GetMetaData();
  // zeros behind the pixels are parsed as elements of group 0
  if (HasFailed(file->Reader.Get(), quiet) || elements->Begin() == elements->End() ||
    elements->Begin()->GetTag().GetGroup() == 0)
  {
    RefuseDamaged(path, quiet.GetReason());
  }
  if (elements->Get(DC::PhotometricInterpretation).AsString() == "PALETTE COLOR")
  {
    Refuse(path,
      "its values are indices of a palette (PALETTE COLOR); convert it to RGB, for example with "
      "gdcmimg or dcmtk's dcmj2pnm.");
  }
  if (elements->Get(DC::ImageType).AsString().find("MOSAIC") != std::string::npos)
  {
    Refuse(path,
      "this picture is a mosaic, with the slices of a volume side by side; convert the series "
      "with dcm2niix.");
  }
  const int bits = elements->Get(DC::BitsStored).AsInt();
  const int high =
    std::min(elements->Get(DC::HighBit).AsInt(), elements->Get(DC::BitsAllocated).AsInt() - 1);
  file->Shift = bits > 0 ? std::max(0, high + 1 - bits) : 0;
  if (file->Shift > 0)
  {
    elements->Set(DC::BitsStored, high + 1); // the reader keeps the lowest bits
  }
  vtkInformation* const info = file->Reader->GetOutputInformation(0);
  file->ScalarType = vtkImageData::GetScalarType(info);
  file->Components = vtkImageData::GetNumberOfScalarComponents(info);
  const double spacing = GetLength(*file, DC::SpacingBetweenSlices);
  const double thickness = GetLength(*file, DC::SliceThickness);
  file->Thickness = spacing > 0.0 ? spacing : thickness;
  return file;
}

/**
 * Find how far the frames of a dose, or of nuclear medicine, lie from the position that the file
 * gives for all. Returns nothing if the file does not say.
 */
std::vector<Vector3> FindOffsets(const DICOMFile& file, const Vector3& normal)
{
  const auto count = static_cast<std::size_t>(GetNumberOfFrames(file));
  std::vector<Vector3> offsets;
  std::vector<double> heights = GetNumbers(file.Get(DC::GridFrameOffsetVector), count);
  Vector3 direction = normal;
  if (!heights.empty() && heights[0] != 0.0) // not offsets, but the patient's z
  {
    const double first = heights[0];
    std::for_each(heights.begin(), heights.end(), [first](double& height) { height -= first; });
    direction = { 0.0, 0.0, 1.0 };
  }
  if (heights.empty())
  {
    heights = GetNumbers(file.Get(DC::SliceVector), count);
    const double step = file.Get(DC::SpacingBetweenSlices).AsDouble(); // may be negative
    heights = step == 0.0 ? std::vector<double>() : heights;
    std::for_each(
      heights.begin(), heights.end(), [step](double& height) { height = (height - 1.0) * step; });
  }
  for (const double height : heights)
  {
    offsets.push_back({ height * direction[0], height * direction[1], height * direction[2] });
  }
  return offsets;
}

/**
 * Get position or orientation of a frame; in nuclear medicine they are those of the detector.
 */
std::vector<double> GetPlaneNumbers(
  const DICOMFile& file, int frame, vtkDICOMTag tag, std::size_t count)
{
  const std::vector<double> numbers = GetNumbers(file.Get(tag, frame), count);
  const vtkDICOMSequence detectors = file.Get(DC::DetectorInformationSequence, frame);
  return numbers.empty() && detectors.GetNumberOfItems() > 0
    ? GetNumbers(detectors.Get(0, tag), count)
    : numbers;
}

SlicePlane FindPlane(const DICOMFile& file, int frame)
{
  SlicePlane plane;
  const int count = GetNumberOfFrames(file);
  plane.Name = file.Path + (count > 1 ? ", frame " + std::to_string(frame + 1) : "");
  const auto position = GetPlaneNumbers(file, frame, DC::ImagePositionPatient, 3);
  const auto axes = GetPlaneNumbers(file, frame, DC::ImageOrientationPatient, 6);
  const auto spacing = GetNumbers(file.Get(DC::PixelSpacing, frame), 2);
  if (position.empty() || axes.empty())
  {
    Refuse(plane.Name,
      "this picture has no position in the patient; give a CT or MR series, or choose another "
      "one.");
  }
  if (spacing.empty() || !(spacing[0] > 0.0) || !(spacing[1] > 0.0))
  {
    Refuse(plane.Name, "this slice has no pixel size (PixelSpacing); export the series again.");
  }
  std::copy_n(position.begin(), 3, plane.Position.begin());
  std::copy_n(axes.begin(), 3, plane.Row.begin());
  std::copy_n(axes.begin() + 3, 3, plane.Column.begin());
  const double lengths[2] = { vtkMath::Normalize(plane.Row.data()),
    vtkMath::Normalize(plane.Column.data()) };
  if (!(std::fabs(lengths[0] - 1.0) < 0.01 && std::fabs(lengths[1] - 1.0) < 0.01 &&
        std::fabs(vtkMath::Dot(plane.Row.data(), plane.Column.data())) < 0.01))
  {
    Refuse(plane.Name,
      "this slice has rows and columns that are not at right angles (ImageOrientationPatient); "
      "export the series again.");
  }
  plane.Spacing = { spacing[1], spacing[0] }; // DICOM gives the distance of rows first
  plane.Size = { static_cast<std::size_t>(file.Get(DC::Columns).AsUnsignedInt()),
    static_cast<std::size_t>(file.Get(DC::Rows).AsUnsignedInt()) };
  return plane;
}

/**
 * Refuse frames without positions of their own, such as those of a film.
 */
void CheckFrames(const DICOMFile& file, const std::vector<Vector3>& offsets)
{
  const int count = GetNumberOfFrames(file);
  const vtkDICOMValue groups = file.Get(DC::PerFrameFunctionalGroupsSequence);
  const bool isPlaced = groups.GetNumberOfValues() == static_cast<std::size_t>(count);
  if (count > 1 && offsets.empty() && !isPlaced)
  {
    Refuse(file.Path,
      "its " + std::to_string(count) +
        " frames have no positions, such as those of a film; give a CT or MR series, or choose "
        "another one.");
  }
}

/**
 * Compares text of one or several numbers.
 */
struct IsLess
{
  bool operator()(const std::string& a, const std::string& b) const
  {
    std::istringstream first(a), second(b);
    std::string x, y;
    while (std::getline(first, x, '\\') && std::getline(second, y, '\\'))
    {
      const double difference = std::atof(x.c_str()) - std::atof(y.c_str());
      if (difference != 0.0)
      {
        return difference < 0.0;
      }
    }
    return a < b;
  }
};

/// Frames at a place by the values of a tag.
using Sorted = std::map<std::string, const DICOMFrame*, IsLess>;

/**
 * Sort frames by a tag. Returns nothing if the tag does not distinguish them.
 */
Sorted SortByTag(const DICOMFrames& place, vtkDICOMTag tag)
{
  Sorted sorted;
  for (const DICOMFrame& frame : place)
  {
    const vtkDICOMValue value = frame.Get(tag);
    if (value.IsValid())
    {
      sorted.emplace(value.AsString(), &frame);
    }
  }
  return sorted.size() == place.size() ? sorted : Sorted();
}

/**
 * Choose the frame of a number at each place, in the order of a tag, or none if the tag does not
 * distinguish them. It must have the same values at all places unless ranks are enough.
 */
DICOMFrames ChooseByTag(
  const std::vector<DICOMFrames>& places, vtkDICOMTag tag, int number, bool areRanksEnough)
{
  DICOMFrames slices;
  const Sorted first = SortByTag(places[0], tag);
  for (const auto& place : places)
  {
    const Sorted sorted = SortByTag(place, tag);
    const bool isSame = std::equal(sorted.begin(), sorted.end(), first.begin(), first.end(),
      [](const auto& a, const auto& b) { return a.first == b.first; });
    if (sorted.empty() || !(isSame || areRanksEnough))
    {
      return {};
    }
    slices.push_back(*std::next(sorted.begin(), number)->second);
  }
  return slices;
}

/**
 * Refuse places with different numbers of frames.
 */
void CheckCounts(const std::vector<DICOMFrames>& places)
{
  const auto [least, most] = std::minmax_element(
    places.begin(), places.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (least->size() < most->size())
  {
    const auto describe = [&](const DICOMFrames& place)
    {
      return std::to_string(place.size()) + (place.size() > 1 ? " slices at " : " slice at ") +
        "the place of " + Describe(place.back().Plane);
    };
    Refuse(most->front().Plane.Name,
      "there are " + describe(*most) + ", and " + describe(*least) +
        "; move what does not belong to the volume out of the folder, or choose another series.");
  }
}
}

vtkDICOMValue DICOMFile::Get(vtkDICOMTag tag, int frame) const
{
  return this->Reader->GetMetaData()->Get(0, frame, tag);
}

DICOMFiles OpenFiles(
  const std::vector<std::string>& paths, const QuietReading& quiet, std::vector<std::string>& notes)
{
  DICOMFiles files;
  std::map<std::string, std::string> first; // the path by the identifier of the object
  std::string copy;
  ProgressLine line("reading headers");
  for (std::size_t i = 0; i < paths.size(); ++i)
  {
    line.Show(double(i) / double(paths.size()));
    auto file = OpenFile(paths[i], quiet);
    const auto known = first.emplace(file->Get(DC::SOPInstanceUID).AsString(), paths[i]).first;
    if (known->second != paths[i] && !vtksys::SystemTools::FilesDiffer(known->second, paths[i]))
    {
      copy = paths[i];
      continue;
    }
    files.push_back(std::move(file));
  }
  if (!copy.empty())
  {
    notes.push_back(std::to_string(paths.size() - files.size()) +
      " files are copies of others and were left out, such as " + copy);
  }
  return files;
}

DICOMFrames FindFrames(const DICOMFiles& files)
{
  DICOMFrames frames;
  for (const auto& file : files)
  {
    if (file->Components != files.front()->Components)
    {
      Refuse(file->Path,
        "this picture has " + std::to_string(file->Components) + " values per pixel, and " +
          files.front()->Path + " has " + std::to_string(files.front()->Components) +
          "; move what does not belong to the volume out of the folder.");
    }
    std::vector<Vector3> offsets;
    for (int number = 0; number < GetNumberOfFrames(*file); ++number)
    {
      SlicePlane plane = FindPlane(*file, number);
      if (number == 0)
      {
        Vector3 normal;
        vtkMath::Cross(plane.Row.data(), plane.Column.data(), normal.data());
        offsets = FindOffsets(*file, normal);
        CheckFrames(*file, offsets);
      }
      for (int axis = 0; axis < 3 && !offsets.empty(); ++axis)
      {
        plane.Position[axis] += offsets[number][axis];
      }
      frames.push_back({ file.get(), number, plane });
    }
  }
  return frames;
}

DICOMFrames ChooseTime(
  const std::vector<DICOMFrames>& places, int number, std::vector<std::string>& notes)
{
  CheckCounts(places);
  const auto count = static_cast<int>(places[0].size());
  number = Choose(places[0][0].File->Path, "volume", number, count, notes);
  for (const bool areRanksEnough : { false, true })
  {
    for (const auto& [tag, name] : TimeTags)
    {
      const bool isRanked = tag != DC::ImageType && tag != DC::SOPInstanceUID;
      const DICOMFrames slices = count > 1 && (isRanked || !areRanksEnough)
        ? ChooseByTag(places, tag, number - 1, areRanksEnough)
        : DICOMFrames();
      if (!slices.empty())
      {
        notes.back() += ", " +
          (areRanksEnough ? std::string("by the order of ") + name + " at each place"
                          : name + (" " + slices[0].Get(tag).AsString()));
        return slices;
      }
    }
  }
  if (count > 1)
  {
    Refuse(places[0][0].Plane.Name,
      "there are " + std::to_string(count) + " slices at each place, here also " +
        places[0][1].Plane.Name +
        ", and no element distinguishes them; move one set out of the folder.");
  }
  DICOMFrames slices;
  for (const DICOMFrames& place : places)
  {
    slices.push_back(place[0]);
  }
  return slices;
}

vtkImageData* ReadPixels(DICOMFile& file, const QuietReading& quiet)
{
  file.Reader->Update();
  vtkImageData* const image = file.Reader->GetOutput();
  if (HasFailed(file.Reader.Get(), quiet) || image->GetNumberOfPoints() < 1)
  {
    RefuseDamaged(file.Path, quiet.GetReason());
  }
  return image;
}
