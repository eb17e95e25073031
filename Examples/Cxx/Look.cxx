// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Look.h"

#include "Reading/Reading.h"

#include "vtkDataArray.h"
#include "vtkNamedColors.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSplattingMIPProjection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace
{
struct ColorPoint
{
  double Position, Red, Green, Blue;
};

struct NamedColormap
{
  std::string Name;
  std::vector<ColorPoint> Points;
};

const std::vector<NamedColormap> Colormaps = {
  { "gray", { { 0, 0, 0, 0 }, { 1, 1, 1, 1 } } },
  { "inverted", { { 0, 1, 1, 1 }, { 1, 0, 0, 0 } } },
  { "hot", { { 0, 0, 0, 0 }, { 0.375, 1, 0, 0 }, { 0.75, 1, 1, 0 }, { 1, 1, 1, 1 } } },
  { "bone",
    { { 0, 0, 0, 0 }, { 0.375, 0.33, 0.33, 0.45 }, { 0.75, 0.66, 0.78, 0.78 }, { 1, 1, 1, 1 } } },
  { "cold-hot",
    { { 0, 0.6, 1, 1 }, { 0.25, 0, 0.3, 1 }, { 0.5, 0, 0, 0 }, { 0.75, 1, 0.3, 0 },
      { 1, 1, 1, 0.6 } } },
};

/// Number of samples from which the window is chosen.
constexpr vtkIdType FewVoxels = 1000000;

/**
 * Sample about so many values, evenly spread over the volume. Returns the finite ones.
 */
std::vector<double> SampleValues(vtkDataArray* scalars, vtkIdType voxels)
{
  const vtkIdType count = scalars->GetNumberOfTuples();
  const vtkIdType step = std::max<vtkIdType>(1, count / voxels);
  std::vector<double> values;
  for (vtkIdType i = 0; i < count; i += step)
  {
    const double value = scalars->GetComponent(i, 0);
    if (std::isfinite(value))
    {
      values.push_back(value);
    }
  }
  return values;
}

/**
 * The same, or of all values if most are not finite. Throws std::runtime_error if none is finite.
 */
std::vector<double> SampleFiniteValues(vtkImageData* image)
{
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  std::vector<double> values = SampleValues(scalars, FewVoxels);
  if (values.empty())
  {
    values = SampleValues(scalars, scalars->GetNumberOfTuples());
  }
  if (values.empty())
  {
    throw std::runtime_error("the volume has no finite value; export it again.");
  }
  return values;
}

double GetQuantile(std::vector<double>& values, double fraction)
{
  const auto place =
    values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}
}

vtkSmartPointer<vtkColorTransferFunction> MakeColors(const LookSettings& look)
{
  const double low = look.Level - 0.5 * look.Window;
  auto colors = vtkSmartPointer<vtkColorTransferFunction>::New();
  if (!look.Color.empty())
  {
    vtkNew<vtkNamedColors> names;
    const vtkColor3d color = names->GetColor3d(look.Color);
    colors->AddRGBPoint(low, 0.0, 0.0, 0.0);
    colors->AddRGBPoint(low + look.Window, color.GetRed(), color.GetGreen(), color.GetBlue());
    return colors;
  }
  const auto map = std::find_if(Colormaps.begin(), Colormaps.end(),
    [&](const NamedColormap& other) { return other.Name == look.Colormap; });
  for (const ColorPoint& point : map->Points)
  {
    colors->AddRGBPoint(low + point.Position * look.Window, point.Red, point.Green, point.Blue);
  }
  return colors;
}

vtkSmartPointer<vtkColorTransferFunction> MakePalette(const LookSettings& look)
{
  return MakeColors({ 255.0, 127.5, look.Colormap, look.Color });
}

std::vector<std::string> GetColormapNames()
{
  return ListNames(Colormaps);
}

void ChooseWindowLevel(vtkImageData* image, int blendMode, double& window, double& level)
{
  std::vector<double> values = SampleFiniteValues(image);
  const bool isMinimum = blendMode == vtkSplattingMIPProjection::MINIMUM_INTENSITY_BLEND;
  const bool isMean = blendMode == vtkSplattingMIPProjection::AVERAGE_INTENSITY_BLEND;
  double low = GetQuantile(values, isMinimum ? 0.0005 : isMean ? 0.05 : 0.5);
  double high = GetQuantile(values, isMinimum ? 0.5 : isMean ? 0.95 : 0.9995);
  if (!(low < high))
  {
    low = *std::min_element(values.begin(), values.end());
    high = *std::max_element(values.begin(), values.end());
  }
  window = low < high ? high - low : 1.0;
  level = low < high ? 0.5 * (low + high) : low;
}

void ChooseSignedWindow(vtkImageData* image, double origin, double& window, double& level)
{
  std::vector<double> distances = SampleFiniteValues(image);
  for (double& distance : distances)
  {
    distance = std::abs(distance - origin);
  }
  double half = GetQuantile(distances, 0.9995);
  if (!(half > 0.0))
  {
    half = *std::max_element(distances.begin(), distances.end());
  }
  window = half > 0.0 ? 2.0 * half : 1.0;
  level = origin;
}
