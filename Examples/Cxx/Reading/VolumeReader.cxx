// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/VolumeReader.h"

#include "Reading/ITKVolume.h"
#include "Reading/NIFTIVolume.h"
#include "Reading/QuietReading.h"
#include "Reading/Reading.h"
#include "Reading/TIFFVolume.h"
#include "Reading/VTKVolume.h"
#include "SplatmipAorta.h" // made from aorta-stent.vti by the build
#ifdef SPLATMIP_HAS_DICOM
#include "Reading/DICOMSeries.h"
#include "Reading/DICOMVolume.h"
#endif

#include "vtkDataArray.h"
#include "vtkPointData.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>
#include <stdexcept>

namespace
{
/**
 * Luminance of red, green and blue (ITU-R BT.601), or the length of a vector.
 */
vtkSmartPointer<vtkImageData> Combine(vtkImageData* image, bool isLuminance)
{
  constexpr double Weights[3] = { 0.299, 0.587, 0.114 };
  auto combined = vtkSmartPointer<vtkImageData>::New();
  combined->CopyStructure(image);
  combined->AllocateScalars(image->GetScalarSize() <= 4 ? VTK_FLOAT : VTK_DOUBLE, 1);
  vtkDataArray* const from = image->GetPointData()->GetScalars();
  vtkDataArray* const to = combined->GetPointData()->GetScalars();
  const int components = isLuminance ? 3 : from->GetNumberOfComponents();
  for (vtkIdType i = 0; i < from->GetNumberOfTuples(); ++i)
  {
    double sum = 0.0;
    for (int n = 0; n < components; ++n)
    {
      const double value = from->GetComponent(i, n);
      sum += isLuminance ? Weights[n] * value : value * value;
    }
    to->SetComponent(i, 0, isLuminance ? sum : std::sqrt(sum));
  }
  return combined;
}

/**
 * Make one value of several in each voxel.
 */
void ChooseComponent(Volume& volume, const std::string& path, const std::string& wanted)
{
  const int components = volume.Image->GetNumberOfScalarComponents();
  const bool isLuminance = wanted == "luminance";
  if (isLuminance && components < 3)
  {
    Refuse(path,
      "luminance is of red, green and blue, and voxels have " + std::to_string(components) +
        (components > 1 ? " values" : " value") + "; give another --component.");
  }
  if (isLuminance || wanted == "magnitude")
  {
    volume.Image = Combine(volume.Image, isLuminance);
    volume.Notes.push_back(wanted + " of " + std::to_string(components) + " components");
    return;
  }
  const int number = std::atoi(wanted.c_str());
  CheckChoice(path, "component", number, components);
  if (components > 1)
  {
    volume.Image = ExtractComponent(volume.Image, std::max(number, 1));
    volume.Notes.push_back(DescribeChoice("component", number, components));
  }
}

#ifndef SPLATMIP_HAS_DICOM
bool IsDICOMFile(const std::string&)
{
  return false;
}

std::string ExplainFile(const std::string&)
{
  return "";
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

constexpr VolumeFormat Formats[] = { { ".vti", ReadVTK }, { ".vtr", ReadVTK }, { ".vtk", ReadVTK },
  { ".mha", ReadMeta }, { ".mhd", ReadMeta }, { ".nrrd", ReadNRRD }, { ".nhdr", ReadNRRD },
  { ".nii", ReadNIFTI }, { ".nii.gz", ReadNIFTI }, { ".hdr", ReadNIFTI }, { ".img", ReadNIFTI },
  { ".hdr.gz", ReadNIFTI }, { ".img.gz", ReadNIFTI }, { ".tif", ReadTIFF }, { ".tiff", ReadTIFF } };

/**
 * By the end of the name; nullptr if it is none of those.
 */
ReadFunction ChooseReader(const std::string& path)
{
  const std::string lower = vtksys::SystemTools::LowerCase(path);
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
    const std::string reason = ExplainFile(path);
    Refuse(path,
      !reason.empty() ? reason
                      : "unknown kind of file; give a " + JoinWords(GetVolumeEndings()) +
          " file, or a DICOM file, a DICOMDIR or a folder with DICOM files.");
  }
  if (!isDICOM && settings.Series > 0)
  {
    Refuse(path, "this is not DICOM and has no series; leave --series out.");
  }
  if (settings.Channel > 0 && (isDICOM || read != ReadTIFF))
  {
    Refuse(path, "this is not TIFF and has no channels; leave --channel out.");
  }
  if (!settings.Array.empty() && (isDICOM || read != ReadVTK))
  {
    Refuse(path, "this is no file of VTK and has no arrays; leave --array out.");
  }
  Volume volume = isDICOM ? ReadDICOM(path, settings, quiet) : read(path, settings, quiet);
  ChooseComponent(volume, path, settings.Component);
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
  std::istringstream lines(ReadHead(path));
  for (std::string line; std::getline(lines, line);)
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
  QuietReading quiet;
  Volume volume =
    ReadVTKText(std::string(reinterpret_cast<const char*>(SplatmipAorta), sizeof(SplatmipAorta)),
      "the built-in volume", quiet);
  volume.Name = "aorta-stent (built in)";
  return volume;
}
