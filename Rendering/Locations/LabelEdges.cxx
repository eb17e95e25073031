// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Locations/LabelEdges.h"

#include "Locations/ProjectedLabels.h"
#include "Locations/SampleLocations.h"
#include "vtkAbstractSplattingMIPVolumeMapper.h"

#include "vtkAbstractMapper.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkScalarsToColors.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace
{
/// The point scalars or, without any, the cell scalars.
vtkDataArray* scalarsOf(vtkImageData* labels, bool& onCells)
{
  int cellFlag = 0;
  vtkDataArray* const scalars = vtkAbstractMapper::GetScalars(
    labels, VTK_SCALAR_MODE_DEFAULT, VTK_GET_ARRAY_BY_ID, -1, nullptr, cellFlag);
  onCells = cellFlag == 1;
  return scalars;
}

glm::ivec3 labelSize(vtkImageData* labels, bool onCells)
{
  const int* const points = labels->GetDimensions();
  const int less = onCells ? 1 : 0;
  return { std::max(points[0] - less, 1), std::max(points[1] - less, 1),
    std::max(points[2] - less, 1) };
}

/// The bytes of an opaque pixel.
std::uint32_t colorOf(double label, vtkScalarsToColors* colors)
{
  static const double distinct[6][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0.4, 1 }, { 1, 1, 0 },
    { 1, 0, 1 }, { 0, 1, 1 } };
  double rgb[3];
  if (colors)
  {
    colors->GetColor(label, rgb);
  }
  else
  {
    std::copy_n(distinct[static_cast<int>(std::fmod(std::abs(label) - 1.0, 6.0))], 3, rgb);
  }
  std::uint32_t pixel = 0;
  auto* const rgba = reinterpret_cast<unsigned char*>(&pixel);
  for (int c = 0; c < 3; ++c)
  {
    rgba[c] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(rgb[c], 0.0, 1.0)));
  }
  rgba[3] = 255;
  return pixel;
}

/// @param voxels  i, j and k of the voxel whose label each pixel has; -1: none, label 0
/// @param colors  nullptr: six colours in turn
void drawEdges(splatting::Picture& picture, const std::vector<int>& voxels, vtkImageData* labels,
  vtkScalarsToColors* colors)
{
  bool onCells = false;
  vtkDataArray* const scalars = scalarsOf(labels, onCells);
  const glm::ivec3 size = labelSize(labels, onCells);
  std::vector<double> found(picture.pixels.size(), 0.0);
  for (std::size_t n = 0; n < found.size(); ++n)
  {
    const int* const p = &voxels[3 * n];
    if (p[0] >= 0)
    {
      found[n] = scalars->GetComponent((vtkIdType(p[2]) * size.y + p[1]) * size.x + p[0], 0);
    }
  }
  if (colors)
  {
    colors->Build();
  }
  const int width = picture.size.x, height = picture.size.y;
  const auto labelAt = [&](int x, int y)
  { return x < 0 || y < 0 || x >= width || y >= height ? 0.0 : found[std::size_t(y) * width + x]; };
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      const double label = labelAt(x, y);
      if (label != 0.0 &&
        (label != labelAt(x - 1, y) || label != labelAt(x + 1, y) || label != labelAt(x, y - 1) ||
          label != labelAt(x, y + 1)))
      {
        picture.pixels[std::size_t(y) * width + x] = colorOf(label, colors);
      }
    }
  }
}
}

namespace splatting
{
vtkDataArray* scalarsOfLabels(vtkImageData* labels)
{
  bool onCells = false;
  return scalarsOf(labels, onCells);
}

std::string validateLabels(vtkImageData* labels, const glm::ivec3& size)
{
  bool onCells = false;
  vtkDataArray* const scalars = scalarsOf(labels, onCells);
  if (!scalars || scalars->GetDataType() == VTK_FLOAT || scalars->GetDataType() == VTK_DOUBLE ||
    scalars->GetNumberOfComponents() != 1)
  {
    return "LabelInput must have scalars of an integer type with one component: convert it with "
           "vtkImageCast.";
  }
  if (labelSize(labels, onCells) != size ||
    scalars->GetNumberOfTuples() != vtkIdType(size.x) * size.y * size.z)
  {
    return "LabelInput must have one label for each voxel of the input: give both the same "
           "dimensions.";
  }
  return {};
}

LabelEdges::LabelEdges() = default;

LabelEdges::~LabelEdges() = default;

void LabelEdges::BeginFrame(vtkAbstractSplattingMIPVolumeMapper* mapper)
{
  if (!mapper->GetLabelInput() ||
    mapper->GetLabelMode() == vtkAbstractSplattingMIPVolumeMapper::SAMPLE)
  {
    this->Clear();
  }
}

void LabelEdges::Draw(vtkAbstractSplattingMIPVolumeMapper* mapper, const SampleLocations& locations,
  SceneCuts& cuts, Picture& picture)
{
  vtkImageData* const labels = mapper->GetLabelInput();
  if (!labels)
  {
    return;
  }
  if (mapper->GetLabelMode() == vtkAbstractSplattingMIPVolumeMapper::SAMPLE)
  {
    drawEdges(picture, locations.VoxelsOf(picture), labels, mapper->GetLabelColors());
    return;
  }
  if (!this->Projected)
  {
    this->Projected = std::make_unique<ProjectedLabels>();
  }
  const std::vector<int> voxels = this->Projected->VoxelsOf(picture, labels, locations.LastView(),
    cuts, static_cast<std::size_t>(mapper->GetIndexMemoryBudget()));
  drawEdges(picture, voxels, labels, mapper->GetLabelColors());
}

void LabelEdges::Clear()
{
  this->Projected = nullptr;
}

std::size_t LabelEdges::MemorySize() const
{
  return this->Projected ? this->Projected->MemorySize() : 0;
}
}
