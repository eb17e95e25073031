// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/VolumeReader.h"

#include "Reading/FileHeaders.h"
#include "Reading/NIFTIVolume.h"
#include "Reading/Orientation.h"
#include "Reading/QuietReading.h"
#include "Reading/Reading.h"
#include "SplatmipAorta.h" // made from aorta-stent.vti by the build
#ifdef SPLATMIP_HAS_DICOM
#include "Reading/DICOMSeries.h"
#include "Reading/DICOMVolume.h"
#endif

#include "vtkDataArray.h"
#include "vtkImageExtractComponents.h"
#include "vtkMatrix3x3.h"
#include "vtkMetaImageReader.h"
#include "vtkNew.h"
#include "vtkNrrdReader.h"
#include "vtkPointData.h"
#include "vtkStructuredPointsReader.h"
#include "vtkTIFFReader.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace
{
/**
 * Refuse what VTK's readers of text headers cannot be trusted with.
 */
void CheckHeader(const TextHeader& header, const std::string& path, const QuietReading& quiet)
{
  if (header.IsSplit())
  {
    Refuse(path, "the data are in several files; save the volume as one file.");
  }
  if (header.GetDimension() > 3)
  {
    Refuse(path, "it has more than three dimensions; save one volume of it, or take NIfTI.");
  }
  if (!header.IsSound())
  {
    RefuseDamaged(path, quiet);
  }
}

/**
 * Whether the end of a file is there: VTK's reader does not miss it behind raw data.
 */
bool EndsXML(const std::string& path)
{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::string tail(static_cast<std::size_t>(std::min<std::streamoff>(256, file.tellg())), ' ');
  file.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
  file.read(&tail[0], static_cast<std::streamsize>(tail.size()));
  return tail.find("</VTKFile>") != std::string::npos;
}

/// By which a file's coordinates are multiplied to become the patient's left, back and head.
using Signs = std::array<double, 3>;
constexpr Signs ToLPS = { 1.0, 1.0, 1.0 };

/**
 * Of a space of NRRD; nothing for spaces that do not say how the patient lies.
 */
std::optional<Signs> FindSigns(std::string space)
{
  std::transform(space.begin(), space.end(), space.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::tuple<const char*, const char*, Signs> spaces[] = {
    { "left-posterior-superior", "lps", ToLPS },
    { "left-anterior-superior", "las", { 1.0, -1.0, 1.0 } },
    { "right-anterior-superior", "ras", { -1.0, -1.0, 1.0 } },
  };
  for (const auto& [words, letters, signs] : spaces)
  {
    // "-time" may follow, or "t".
    if (space.rfind(words, 0) == 0 || space.rfind(letters, 0) == 0)
    {
      return signs;
    }
  }
  return std::nullopt;
}

/**
 * VTK's readers for NRRD and MetaImage pass over the directions of the axes: nine numbers in the
 * header, axis after axis.
 */
vtkSmartPointer<vtkMatrix4x4> ParseOrientation(std::string numbers, const Signs& signs = ToLPS)
{
  const std::size_t bracket = numbers.find('('); // NRRD may have "none" before
  numbers.erase(0, bracket == std::string::npos ? 0 : bracket);
  std::replace_if(
    numbers.begin(), numbers.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream stream(numbers);
  double axes[3][3];
  for (int i = 0; i < 9; ++i)
  {
    if (!(stream >> axes[i / 3][i % 3]))
    {
      return vtkSmartPointer<vtkMatrix4x4>::New();
    }
    axes[i / 3][i % 3] *= signs[i % 3];
  }
  return MakeOrientation(axes);
}

/**
 * A place of three numbers, or 0.
 */
std::array<double, 3> ParseOrigin(std::string numbers, const Signs& signs = ToLPS)
{
  std::replace_if(
    numbers.begin(), numbers.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream stream(numbers);
  std::array<double, 3> origin = {};
  stream >> origin[0] >> origin[1] >> origin[2];
  return { signs[0] * origin[0], signs[1] * origin[1], signs[2] * origin[2] };
}

Volume ReadXML(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  CheckFrame(path, settings.Frame, 1);
  if (!EndsXML(path))
  {
    RefuseDamaged(path, quiet);
  }
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  volume.Image = RunReader(reader, path, quiet);
  volume.Image->GetOrigin(volume.Origin.data());
  return volume;
}

Volume ReadLegacy(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  CheckFrame(path, settings.Frame, 1);
  vtkNew<vtkStructuredPointsReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  volume.Image = RunReader(reader, path, quiet);
  volume.Image->GetOrigin(volume.Origin.data());
  return volume;
}

Volume ReadMeta(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  CheckFrame(path, settings.Frame, 1);
  vtkNew<vtkMetaImageReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  const TextHeader header(path);
  CheckHeader(header, path, quiet);
  volume.Image = RunReader(reader, path, quiet, &header);
  volume.Orientation = ParseOrientation(header.Get("TransformMatrix"));
  volume.Origin = ParseOrigin(header.Get("Offset") + header.Get("Position") + header.Get("Origin"));
  volume.IsOriented = !header.Get("TransformMatrix").empty();
  volume.IsInMillimeters = !header.Get("ElementSpacing").empty();
  return volume;
}

Volume ReadNRRD(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  CheckFrame(path, settings.Frame, 1);
  vtkNew<vtkNrrdReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  const TextHeader header(path);
  CheckHeader(header, path, quiet);
  volume.Image = RunReader(reader, path, quiet, &header);
  const std::string space = header.Get("space");
  const std::optional<Signs> signs = FindSigns(space);
  volume.Orientation = ParseOrientation(header.Get("space directions"), signs.value_or(ToLPS));
  volume.Origin = ParseOrigin(header.Get("space origin"), signs.value_or(ToLPS));
  const std::string unit = header.Get("space units");
  volume.IsOriented = signs.has_value();
  volume.IsInMillimeters = !space.empty() && (unit.empty() || unit.find("mm") == 1);
  return volume;
}

/**
 * A stack of pages.
 */
Volume ReadTIFF(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  CheckFrame(path, settings.Frame, 1);
  if (!HasSoundTIFFPages(path))
  {
    RefuseDamaged(path, quiet);
  }
  vtkNew<vtkTIFFReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetOrientationType(4); // the first row first, as in DICOM, wherever it would be shown
  Volume volume;
  volume.Image = RunReader(reader, path, quiet);
  volume.Image->SetSpacing(1.0, 1.0, 1.0);
  volume.Notes.push_back("TIFF does not say how large voxels are and how they lie: cubes of 1 mm, "
                         "pages from the feet on, seen from the feet");
  volume.Caution = "voxel size unknown";
  return volume;
}

/**
 * Move the direction matrix, if the reader set one, from the image to the prop's matrix, and put
 * voxels of size 1 where the file has no size or a useless one.
 */
void FinishGeometry(Volume& volume)
{
  vtkImageData* image = volume.Image;
  if (!volume.Orientation)
  {
    double axes[3][3];
    for (int i = 0; i < 9; ++i)
    {
      axes[i / 3][i % 3] = image->GetDirectionMatrix()->GetElement(i % 3, i / 3);
    }
    volume.Orientation = MakeOrientation(axes);
  }
  image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  image->SetOrigin(0.0, 0.0, 0.0);
  for (double& place : volume.Origin)
  {
    place = std::isfinite(place) ? place : 0.0;
  }
  double spacing[3];
  image->GetSpacing(spacing);
  for (double& length : spacing)
  {
    length = std::fabs(length);
    if (!(length > 1e-9 && length < 1e9))
    {
      length = 1.0;
      volume.Notes.push_back("the file does not say how large voxels are: 1 mm was taken");
      volume.Caution = "voxel size unknown";
      volume.IsInMillimeters = false;
    }
  }
  image->SetSpacing(spacing);
}

/**
 * See that the image has point scalars of one component; choose the first array where there is a
 * choice.
 */
void FinishScalars(Volume& volume, const std::string& path, int component)
{
  vtkPointData* points = volume.Image->GetPointData();
  vtkDataArray* scalars = points->GetScalars() ? points->GetScalars() : points->GetArray(0);
  if (!scalars || scalars->GetDataType() == VTK_BIT || scalars->GetNumberOfComponents() < 1 ||
    scalars->GetNumberOfTuples() != volume.Image->GetNumberOfPoints())
  {
    Refuse(path, "no numeric value at each point; save the volume with point data (scalars).");
  }
  points->SetScalars(scalars);
  const int components = scalars->GetNumberOfComponents();
  CheckComponent(path, component, components);
  if (components > 1)
  {
    vtkNew<vtkImageExtractComponents> one;
    one->SetInputData(volume.Image);
    one->SetComponents(std::max(component, 1) - 1);
    one->Update();
    volume.Image = one->GetOutput();
    volume.Notes.push_back(DescribeComponent(component, components));
  }
}

#ifndef SPLATMIP_HAS_DICOM
bool IsDICOMFile(const std::string&)
{
  return false;
}

Volume ReadDICOM(const std::string& path, const ReadSettings&, const QuietReading&)
{
  Refuse(path,
    "this build has no DICOM reader; build it with vtk-dicom, or convert the series to .nrrd.");
}
#endif

using ReadFunction = Volume (*)(const std::string&, const ReadSettings&, const QuietReading&);

struct VolumeFormat
{
  const char* Ending;
  ReadFunction Read;
};

constexpr VolumeFormat Formats[] = { { ".vti", ReadXML }, { ".vtk", ReadLegacy },
  { ".mha", ReadMeta }, { ".mhd", ReadMeta }, { ".nrrd", ReadNRRD }, { ".nhdr", ReadNRRD },
  { ".nii", ReadNIFTI }, { ".nii.gz", ReadNIFTI }, { ".hdr", ReadNIFTI }, { ".img", ReadNIFTI },
  { ".hdr.gz", ReadNIFTI }, { ".img.gz", ReadNIFTI }, { ".tif", ReadTIFF }, { ".tiff", ReadTIFF } };

/**
 * By the end of the name; nullptr if it is none of those.
 */
ReadFunction ChooseReader(const std::string& path)
{
  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const VolumeFormat& format : Formats)
  {
    const std::string ending = format.Ending;
    if (lower.size() > ending.size() &&
      lower.compare(lower.size() - ending.size(), ending.size(), ending) == 0)
    {
      return format.Read;
    }
  }
  return nullptr;
}

Volume ReadAny(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  std::error_code error;
  const ReadFunction read = ChooseReader(path);
  const bool isDICOM = std::filesystem::is_directory(path, error) || (!read && IsDICOMFile(path));
  if (!isDICOM && !read)
  {
    Refuse(path,
      "unknown kind of file; give a " + JoinWords(GetVolumeEndings()) +
        " file, or a DICOM file, a DICOMDIR or a folder with DICOM files.");
  }
  if (!isDICOM && settings.Series > 0)
  {
    Refuse(path, "this is not DICOM and has no series; leave --series out.");
  }
  Volume volume = isDICOM ? ReadDICOM(path, settings, quiet) : read(path, settings, quiet);
  FinishGeometry(volume);
  FinishScalars(volume, path, isDICOM ? 0 : settings.Component);
  return volume;
}

/**
 * Add the existing files that the lines of a header without data name.
 */
void AddCompanions(const std::string& path, std::vector<std::string>& files)
{
  const std::filesystem::path header(path);
  const std::string ending = vtksys::SystemTools::LowerCase(header.extension().string());
  if (ending != ".mhd" && ending != ".nhdr")
  {
    return;
  }
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);)
  {
    const std::size_t end = line.find_last_not_of(" \t\r") + 1;
    for (std::size_t begin = 0; begin < end; begin = line.find_first_of(" \t:=", begin))
    {
      begin = line.find_first_not_of(" \t:=", begin);
      const std::filesystem::path name(line.substr(begin, end - begin));
      std::error_code error;
      if (std::filesystem::is_regular_file(header.parent_path() / name, error))
      {
        files.push_back((header.parent_path() / name).string());
      }
    }
  }
}

/**
 * Refuse what no reader needs to be asked about.
 */
void CheckFile(const std::string& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error))
  {
    Refuse(path, "no such file or folder; check the spelling and the current folder.");
  }
  if (std::filesystem::is_directory(path, error))
  {
    return;
  }
  if (!std::ifstream(path, std::ios::binary))
  {
    Refuse(path, "the file cannot be opened; check its permissions.");
  }
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) == 0)
  {
    Refuse(path, "the file is empty; get it again or export the volume again.");
  }
}
}

std::vector<std::string> GetVolumeEndings()
{
  std::vector<std::string> endings;
  for (const VolumeFormat& format : Formats)
  {
    endings.emplace_back(format.Ending);
  }
  return endings;
}

Volume ReadVolume(const std::string& path, const ReadSettings& settings)
{
  CheckFile(path);
  try
  {
    QuietReading quiet;
    Volume volume = ReadAny(path, settings, quiet);
    volume.Name = std::filesystem::path(path).filename().string();
    volume.Files.push_back(path);
    AddCompanions(path, volume.Files);
    return volume;
  }
  catch (const std::bad_alloc&)
  {
    Refuse(path, "there is not enough memory for this volume; reduce it first.");
  }
  catch (const std::length_error&)
  {
    Refuse(path, "the header asks for too much; it is damaged.");
  }
}

Volume ReadBuiltInVolume()
{
  const std::string name = "the built-in volume";
  QuietReading quiet;
  vtkNew<vtkXMLImageDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(
    std::string(reinterpret_cast<const char*>(SplatmipAorta), sizeof(SplatmipAorta)));
  Volume volume;
  volume.Image = RunReader(reader, name, quiet);
  FinishGeometry(volume);
  FinishScalars(volume, name, 0);
  volume.Name = "aorta-stent (built in)";
  return volume;
}
