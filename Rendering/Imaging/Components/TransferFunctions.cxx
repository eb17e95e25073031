// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Components/TransferFunctions.h"

#include "vtkColorTransferFunction.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkSmartPointer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace splatting
{
namespace
{
std::uint32_t premultiplied(
  const float rgb[3], float opacity, float weight, const FinalColor& finalColor)
{
  const float alpha = weight * std::clamp(opacity, 0.0f, 1.0f);
  const float scale = 1.0f / finalColor.window, bias = 0.5f - finalColor.level / finalColor.window;
  unsigned char bytes[4];
  for (int c = 0; c < 3; ++c)
  {
    const float straight = std::clamp(rgb[c], 0.0f, 1.0f) * scale + bias;
    bytes[c] =
      static_cast<unsigned char>(std::clamp(255.0f * alpha * straight, 0.0f, 255.0f) + 0.5f);
  }
  bytes[3] = static_cast<unsigned char>(255.0f * alpha + 0.5f);
  std::uint32_t color;
  std::memcpy(&color, bytes, sizeof(color));
  return color;
}

/// Widens [low, high] by the nodes of a function, which is constant beyond them.
template <class Function>
void addNodes(Function* function, double& low, double& high)
{
  if (function->GetSize() > 0)
  {
    const double* nodes = function->GetRange();
    low = std::min(low, nodes[0]);
    high = std::max(high, nodes[1]);
  }
}

/// The entries of a table lie between the nodes of the functions, within the data. Functions that
/// do not clamp vanish beyond their nodes, so their tables cover all data.
template <class ColorFunction>
void chooseRange(vtkPiecewiseFunction* opacity, ColorFunction* colors, double& low, double& high)
{
  constexpr double largest = std::numeric_limits<float>::max();
  const double dataLow = std::clamp(low, -largest, largest);
  const double dataHigh = std::clamp(high, dataLow, largest);
  low = dataLow;
  high = dataHigh;
  if (opacity->GetClamping() && colors->GetClamping())
  {
    double first = largest, last = -largest;
    addNodes(opacity, first, last);
    addNodes(colors, first, last);
    low = std::clamp(first, dataLow, dataHigh);
    high = std::clamp(last, low, dataHigh);
  }
}

void sample(vtkColorTransferFunction* colors, double low, double high, std::vector<float>& rgb)
{
  colors->GetTable(low, high, static_cast<int>(rgb.size() / 3), rgb.data());
  // VTK makes the last entry black if it coincides with the function's only node.
  double last[3];
  colors->GetColor(high, last);
  std::transform(
    last, last + 3, rgb.end() - 3, [](double value) { return static_cast<float>(value); });
}

void sample(vtkPiecewiseFunction* grays, double low, double high, std::vector<float>& rgb)
{
  for (int c = 0; c < 3; ++c)
  {
    grays->GetTable(low, high, static_cast<int>(rgb.size() / 3), rgb.data() + c, 3);
  }
}

template <class ColorFunction>
ColorTable tabulate(vtkPiecewiseFunction* opacity, ColorFunction* colors, float weight,
  const ScalarRange& range, const FinalColor& finalColor)
{
  double low = range.low, high = range.high;
  chooseRange(opacity, colors, low, high);
  const double wanted = range.integers ? 16.0 * (high - low) + 1.0 : 65536.0;
  const int entries = high > low ? static_cast<int>(std::clamp(wanted, 2.0, 65536.0)) : 1;
  const double end = high > low ? high : low + 1.0; // the functions need a range
  const int sampled = std::max(entries, 2);
  std::vector<float> alpha(sampled), rgb(3 * static_cast<std::size_t>(sampled));
  opacity->GetTable(low, end, sampled, alpha.data());
  sample(colors, low, end, rgb);
  ColorTable table{ low, high, std::vector<std::uint32_t>(entries) };
  for (int e = 0; e < entries; ++e)
  {
    table.colors[e] =
      premultiplied(&rgb[3 * static_cast<std::size_t>(e)], alpha[e], weight, finalColor);
  }
  return table;
}

ColorTable tabulateColors(vtkVolumeProperty* property, int component, vtkPiecewiseFunction* opacity,
  double weight, const ScalarRange& range, const FinalColor& finalColor)
{
  const float share = static_cast<float>(weight);
  return property->GetColorChannels(component) == 1
    ? tabulate(opacity, property->GetGrayTransferFunction(component), share, range, finalColor)
    : tabulate(opacity, property->GetRGBTransferFunction(component), share, range, finalColor);
}

vtkSmartPointer<vtkPiecewiseFunction> constantOne(const ScalarRange& range)
{
  auto one = vtkSmartPointer<vtkPiecewiseFunction>::New();
  one->AddPoint(range.low, 1.0);
  return one;
}
}

bool FinalColor::isValid() const
{
  return std::isfinite(this->level) && std::isfinite(this->window) &&
    std::isfinite(1.0f / this->window) && std::isfinite(this->level / this->window);
}

ColorTable tabulateColors(vtkVolumeProperty* property, int component, double weight,
  const ScalarRange& range, const FinalColor& finalColor)
{
  return tabulateColors(
    property, component, property->GetScalarOpacity(component), weight, range, finalColor);
}

ColorTable tabulateOpaque(
  vtkVolumeProperty* property, const ScalarRange& range, const FinalColor& finalColor)
{
  return tabulateColors(property, 0, constantOne(range), 1.0, range, finalColor);
}

ColorTable tabulateOpacity(vtkVolumeProperty* property, const ScalarRange& range)
{
  return tabulate<vtkPiecewiseFunction>(
    property->GetScalarOpacity(0), constantOne(range), 1.0f, range, {});
}

ColorTable tabulatePrimary(int primary, const FinalColor& finalColor)
{
  const ScalarRange bytes{ 0.0, 255.0, true };
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
  colors->AddRGBPoint(255.0, primary == 0, primary == 1, primary == 2);
  ColorTable table =
    tabulate<vtkColorTransferFunction>(constantOne(bytes), colors, 1.0f, bytes, finalColor);
  // Other components are added to it, so the level must not change their colours.
  for (std::uint32_t& color : table.colors)
  {
    unsigned char rgba[4];
    std::memcpy(rgba, &color, sizeof(color));
    for (int c = 0; c < 3; ++c)
    {
      rgba[c] = c == primary ? rgba[c] : 0;
    }
    std::memcpy(&color, rgba, sizeof(color));
  }
  return table;
}
}
