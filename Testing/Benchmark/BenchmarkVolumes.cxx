// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkVolumes.h"

#include "Volume.h"

#include "vtkNew.h"
#include "vtkNrrdReader.h"
#include "vtkType.h"
#include "vtkXMLImageDataReader.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

namespace
{
vtkSmartPointer<vtkImageData> MakeVessels(int n)
{
  const reference::Volume<std::uint8_t> phantom = reference::noiseAndVessels(n);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(n, n, n);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  std::copy(phantom.voxels.begin(), phantom.voxels.end(),
    static_cast<unsigned char*>(image->GetScalarPointer()));
  return image;
}

BenchmarkVolume Vessels(int n)
{
  BenchmarkVolume volume;
  volume.Name = "vessels" + std::to_string(n) + "-uint8";
  volume.Load = [=] { return MakeVessels(n); };
  return volume;
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
  std::vector<BenchmarkVolume> volumes = { Vessels(256) };
  AddFile<vtkXMLImageDataReader>(volumes, missing, "aorta-int16", SPLATTINGMIP_AORTA, false);
  AddFile<vtkNrrdReader>(volumes, missing, "lidc0314-int16",
    std::filesystem::path(folder) / "lidc-idri-0314.nrrd", true);
  return volumes;
}

//------------------------------------------------------------------------------
std::vector<BenchmarkVolume> ListQuickVolumes()
{
  return { Vessels(64) };
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
