// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperScene.h"

#include "vtkAlgorithmOutput.h"
#include "vtkImageData.h"
#include "vtkImageResize.h"
#include "vtkImageShiftScale.h"
#include "vtkImageShrink3D.h"
#include "vtkMetaImageReader.h"
#include "vtkNew.h"
#include "vtkXMLImageDataReader.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace
{
PaperVolume Copy(vtkImageData* image)
{
  PaperVolume volume;
  std::array<int, 3> size;
  image->GetDimensions(size.data());
  volume.Voxels = reference::Bytes(size);
  const auto* bytes = static_cast<const unsigned char*>(image->GetScalarPointer());
  std::copy_n(bytes, volume.Voxels.voxels.size(), volume.Voxels.voxels.begin());
  const double* spacing = image->GetSpacing();
  volume.Spacing = { spacing[0], spacing[1], spacing[2] };
  return volume;
}

/// Grey levels as the paper had them: the range of the data becomes 0 to 255.
vtkNew<vtkImageShiftScale> MakeBytes(vtkImageData* image)
{
  double range[2];
  image->GetScalarRange(range);
  vtkNew<vtkImageShiftScale> bytes;
  bytes->SetInputData(image);
  bytes->SetShift(-range[0]);
  bytes->SetScale(255.0 / std::max(range[1] - range[0], 1e-300));
  bytes->SetOutputScalarTypeToUnsignedChar();
  bytes->ClampOverflowOn();
  return bytes;
}

PaperDataSet Resample(
  const std::string& name, const std::string& origin, vtkImageData* image, int voxels)
{
  const vtkNew<vtkImageShiftScale> bytes = MakeBytes(image);
  vtkNew<vtkImageResize> fine;
  fine->SetInputConnection(bytes->GetOutputPort());
  fine->SetOutputDimensions(voxels, voxels, voxels);
  fine->Update();
  vtkNew<vtkImageShrink3D> coarse;
  coarse->SetInputConnection(fine->GetOutputPort());
  coarse->SetShrinkFactors(2, 2, 2);
  coarse->MeanOn();
  coarse->Update();
  return { name, origin, { Copy(fine->GetOutput()), Copy(coarse->GetOutput()) } };
}

vtkNew<vtkImageData> MakeVessels(int voxels)
{
  const reference::Bytes phantom = reference::noiseAndVessels(voxels);
  vtkNew<vtkImageData> image;
  image->SetDimensions(voxels, voxels, voxels);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  std::copy(phantom.voxels.begin(), phantom.voxels.end(),
    static_cast<unsigned char*>(image->GetScalarPointer()));
  return image;
}

/// "147x106x104 voxels".
std::string DescribeSize(vtkImageData* image)
{
  const int* size = image->GetDimensions();
  return std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]) +
    " voxels";
}

void AddAorta(std::vector<PaperDataSet>& sets, int voxels)
{
  if (!std::filesystem::is_regular_file(SPLATTINGMIP_AORTA))
  {
    throw std::runtime_error("The report needs " SPLATTINGMIP_AORTA
                             ", which is not there: run it where the sources are that it was built "
                             "from, or build it again.");
  }
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(SPLATTINGMIP_AORTA);
  reader->Update();
  sets.push_back(Resample("aorta",
    "CT angiogram of a stented aorta (" + DescribeSize(reader->GetOutput()) +
      "), in the place of the paper's MRA data.",
    reader->GetOutput(), voxels));
}

void AddUltrasound(std::vector<PaperDataSet>& sets, const std::string& folder, int voxels,
  std::vector<std::string>& notes)
{
  const std::filesystem::path path = std::filesystem::path(folder) / "spine-phantom-ultrasound.mha";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
  {
    notes.push_back("The ultrasound volume was skipped: there is no " + path.filename().string() +
      " in the data folder (`--data=DIR`).");
    return;
  }
  vtkNew<vtkMetaImageReader> reader;
  reader->SetFileName(path.string().c_str());
  reader->Update();
  sets.push_back(Resample("ultrasound",
    "3-D ultrasound of a spine phantom (" + DescribeSize(reader->GetOutput()) +
      "), in the place of the paper's fetus.",
    reader->GetOutput(), voxels));
}

/// The side of the square that holds the volume in every turn about the x or the y axis.
double WindowSide(const glm::dvec3& extent)
{
  return std::max(std::hypot(extent.x, extent.z), std::hypot(extent.y, extent.z));
}
}

//------------------------------------------------------------------------------
std::vector<PaperDataSet> LoadPaperData(
  const std::string& folder, int voxels, std::vector<std::string>& notes)
{
  std::vector<PaperDataSet> sets;
  AddAorta(sets, voxels);
  AddUltrasound(sets, folder, voxels, notes);
  const vtkNew<vtkImageData> vessels = MakeVessels(voxels);
  sets.push_back(Resample("vessels",
    "Phantom of curved vessels in noise; noise is the worst case for line encoding.", vessels,
    voxels));
  return sets;
}

//------------------------------------------------------------------------------
PaperVolume MakeLinePhantom()
{
  return { reference::linePhantom<std::uint8_t>(255), glm::dvec3(1.0) };
}

//------------------------------------------------------------------------------
splatting::View MakePaperView(const PaperVolume& volume, const glm::dvec2& turns, int window,
  double zoom, const glm::dvec2& centre)
{
  splatting::View view;
  const std::array<int, 3>& size = volume.Voxels.size;
  view.dimensions = { size[0], size[1], size[2] };
  view.viewport = { window, window };
  const double scale = 2.0 * zoom / WindowSide(volume.Spacing * glm::dvec3(view.dimensions));
  glm::dmat4 m = glm::translate(glm::dmat4(1.0), glm::dvec3(-zoom * centre, 0.0));
  m = glm::scale(m, glm::dvec3(scale));
  m = glm::rotate(m, glm::radians(turns.x), glm::dvec3(1.0, 0.0, 0.0));
  m = glm::rotate(m, glm::radians(turns.y), glm::dvec3(0.0, 1.0, 0.0));
  m = glm::scale(m, volume.Spacing);
  view.indexToClip = glm::translate(m, -0.5 * glm::dvec3(view.dimensions - 1));
  return view;
}

//------------------------------------------------------------------------------
reference::Rays MakeScreenRays(const splatting::View& view)
{
  const glm::dmat4 clipToIndex = glm::affineInverse(view.indexToClip);
  const glm::dvec2 pixel = 2.0 / glm::dvec2(view.viewport);
  reference::Rays rays;
  rays.width = view.viewport.x;
  rays.height = view.viewport.y;
  rays.origin = glm::dvec3(clipToIndex * glm::dvec4(0.5 * pixel - 1.0, 0.0, 1.0));
  rays.perColumn = glm::dvec3(pixel.x * clipToIndex[0]);
  rays.perRow = glm::dvec3(pixel.y * clipToIndex[1]);
  rays.step = glm::normalize(glm::dvec3(clipToIndex[2]));
  return rays;
}
