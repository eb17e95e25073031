// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/VolumeReader.h"

#include "Reading/QuietReading.h"
#include "Reading/Reading.h"
#include "SplatmipAorta.h" // made from aorta-stent.vti by the build
#ifdef SPLATMIP_HAS_DICOM
#include "Reading/DICOM.h"
#endif

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"

#include <vtksys/SystemTools.hxx>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>

namespace
{
/**
 * Compute the luminance of red, green and blue (ITU-R BT.601), or the length of vectors.
 */
vtkSmartPointer<vtkImageData> Combine(vtkImageData* image, bool isLuminance)
{
  constexpr double Weights[3] = { 0.299, 0.587, 0.114 };
  auto combined = vtkSmartPointer<vtkImageData>::New();
  combined->CopyStructure(image);
  combined->AllocateScalars(FindFloatType(image->GetScalarType()), 1);
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
 * Choose or combine values where voxels have several. Hidden voxels remain hidden.
 */
void ChooseComponent(Volume& volume, const std::string& path, const std::string& wanted)
{
  const int components = volume.Image->GetNumberOfScalarComponents();
  const vtkSmartPointer<vtkDataArray> hidden =
    volume.Image->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName());
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
  }
  else
  {
    const int number = std::atoi(wanted.c_str());
    volume.Image =
      ExtractComponent(volume.Image, Choose(path, "component", number, components, volume.Notes));
  }
  if (hidden)
  {
    volume.Image->GetPointData()->AddArray(hidden);
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
#endif

struct VolumeFormat
{
  const char* Name; // the ending
  ReadFunction* Read;
};

constexpr VolumeFormat Formats[] = { { ".vti", ReadVTK }, { ".vtr", ReadVTK }, { ".vtk", ReadVTK },
  { ".mha", ReadMeta }, { ".mhd", ReadMeta }, { ".nrrd", ReadNRRD }, { ".nhdr", ReadNRRD },
  { ".nii", ReadNIFTI }, { ".nii.gz", ReadNIFTI }, { ".hdr", ReadNIFTI }, { ".img", ReadNIFTI },
  { ".hdr.gz", ReadNIFTI }, { ".img.gz", ReadNIFTI }, { ".tif", ReadTIFF }, { ".tiff", ReadTIFF } };

Volume ReadAny(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  std::error_code error;
  const auto* const format = FindByEnding(Formats, vtksys::SystemTools::LowerCase(path));
  ReadFunction* const read = format ? format->Read : nullptr;
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
 * Refuse what no reader can read.
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

#ifndef SPLATMIP_HAS_DICOM
Volume ReadDICOM(const std::string& path, const ReadSettings&, const QuietReading&)
{
  Refuse(path,
    "this build has no DICOM reader; build it with vtk-dicom, or convert the series to .nrrd.");
}
#endif

std::vector<std::string> GetVolumeEndings()
{
  return ListNames(Formats);
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
