// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkVolumes.h"

#include "Volume.h"

#include "vtkNIFTIImageReader.h"
#include "vtkNew.h"
#include "vtkNrrdReader.h"
#include "vtkType.h"
#include "vtkTypeTraits.h"
#include "vtkXMLImageDataReader.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

namespace
{
/// The phantom's bytes v become slope * v + offset.
template <class T>
vtkSmartPointer<vtkImageData> MakeVessels(int n, double slope = 1.0, double offset = 0.0)
{
  const reference::Volume<std::uint8_t> phantom = reference::noiseAndVessels(n);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(n, n, n);
  image->AllocateScalars(vtkTypeTraits<T>::VTK_TYPE_ID, 1);
  std::transform(phantom.voxels.begin(), phantom.voxels.end(),
    static_cast<T*>(image->GetScalarPointer()),
    [=](std::uint8_t value) { return static_cast<T>(slope * value + offset); });
  return image;
}

template <class T>
BenchmarkVolume Vessels(int n, const std::string& type, double slope = 1.0, double offset = 0.0)
{
  BenchmarkVolume volume;
  volume.Name = "vessels" + std::to_string(n) + "-" + type;
  volume.Load = [=] { return MakeVessels<T>(n, slope, offset); };
  return volume;
}

/// Nothing but noise, in which nothing can be left out.
vtkSmartPointer<vtkImageData> MakeNoise(int n)
{
  const auto noise = reference::uniformNoise<std::uint8_t>({ n, n, n }, 1, 0, 255);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(n, n, n);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  std::copy(noise.voxels.begin(), noise.voxels.end(),
    static_cast<unsigned char*>(image->GetScalarPointer()));
  return image;
}

template <class Reader>
vtkSmartPointer<vtkImageData> ReadVolume(const std::string& file)
{
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->ShallowCopy(reader->GetOutput());
  // vtkFixedPointVolumeRayCastMapper ignores directions: everybody gets to see the same.
  image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  return image->GetScalarPointer() ? image : nullptr;
}

template <class Reader>
void AddFile(std::vector<BenchmarkVolume>& volumes, std::vector<std::string>& missing,
  const std::string& name, const std::filesystem::path& path, bool isBig)
{
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
  {
    missing.push_back(name + " (" + path.string() + ")");
    return;
  }
  BenchmarkVolume volume;
  volume.Name = name;
  volume.Load = [file = path.string()] { return ReadVolume<Reader>(file); };
  volume.IsBig = isBig;
  volumes.push_back(volume);
}
}

//------------------------------------------------------------------------------
std::vector<BenchmarkVolume> ListVolumes(
  const std::string& folder, std::vector<std::string>& missing)
{
  std::vector<BenchmarkVolume> volumes = { Vessels<unsigned char>(128, "uint8"),
    Vessels<unsigned char>(256, "uint8"), Vessels<short>(256, "int16", 8.0, -1024.0),
    Vessels<float>(256, "float", 1.0 / 255.0), Vessels<unsigned char>(512, "uint8") };
  volumes[2].ForAllMappers = volumes[3].ForAllMappers = false;
  volumes[4].IsBig = true;
  BenchmarkVolume noise;
  noise.Name = "noise256-uint8";
  noise.Load = [] { return MakeNoise(256); };
  noise.ForAllMappers = false;
  volumes.push_back(noise);
  AddFile<vtkXMLImageDataReader>(volumes, missing, "aorta-int16", SPLATTINGMIP_AORTA, false);
  AddFile<vtkNIFTIImageReader>(
    volumes, missing, "ch2better-uint8", "/usr/share/mricron/templates/ch2better.nii.gz", true);
  AddFile<vtkNrrdReader>(volumes, missing, "lidc0314-int16",
    std::filesystem::path(folder) / "lidc-idri-0314.nrrd", true);
  return volumes;
}

//------------------------------------------------------------------------------
std::vector<BenchmarkVolume> ListQuickVolumes()
{
  return { Vessels<unsigned char>(64, "uint8") };
}

//------------------------------------------------------------------------------
vtkImageData* LoadVolume(const BenchmarkVolume& volume)
{
  static std::string name;
  static vtkSmartPointer<vtkImageData> image;
  if (name != volume.Name)
  {
    image = nullptr; // before the next one takes its memory
    image = volume.Load();
    name = volume.Name;
  }
  return image;
}
