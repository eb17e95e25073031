// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Components/ComponentColors.h"

#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace splatting
{
namespace
{
/// @param component  one of `components`
ColorTable tableOf(vtkVolumeProperty* property, const FinalColor& finalColor, bool dependent,
  int component, int components, const ScalarRange& scalars)
{
  if (!dependent)
  {
    const double weight = components > 1 ? property->GetComponentWeight(component) : 1.0;
    return tabulateColors(property, component, weight, scalars, finalColor);
  }
  if (component == components - 1)
  {
    return tabulateOpacity(property, scalars);
  }
  return components == 2 ? tabulateOpaque(property, scalars, finalColor)
                         : tabulatePrimary(component, finalColor);
}
}

// The range of the projected values: depth shading can exceed the range of the voxels.
ScalarRange ComponentColors::RangeOf(VolumeIndex& component) const
{
  const VolumeIndex::Range& range = component.range();
  const bool integers = component.volume().type < ScalarType::Float32;
  if (this->Shading[0] >= 0.0 && this->Shading[1] <= 1.0)
  {
    return { range.low, range.high, integers };
  }
  const double low = std::isfinite(range.low) ? range.low : 0.0;
  return { std::min(range.low, low + this->Shading[0] * (range.high - low)),
    std::max(range.high, low + this->Shading[1] * (range.high - low)), integers };
}

void ComponentColors::Update(vtkVolumeProperty* property, const FinalColor& finalColor,
  const ProjectionSettings& settings, const std::vector<VolumeIndex*>& components, bool dependent)
{
  double shading[2] = { 0.0, 1.0 };
  if (settings.reduction == Reduction::DepthShaded)
  {
    const double nearest = settings.ambient + settings.changeRate;
    shading[0] = std::min({ 0.0, settings.ambient, nearest });
    shading[1] = std::max({ 1.0, settings.ambient, nearest });
  }
  if (this->Known && std::equal(shading, shading + 2, this->Shading) &&
    this->Property == property && this->Time == property->GetMTime() && this->Final == finalColor)
  {
    return;
  }
  std::copy(shading, shading + 2, this->Shading);
  const int count = static_cast<int>(components.size());
  this->Tables.resize(components.size());
  for (int c = 0; c < count; ++c)
  {
    this->Tables[c] =
      tableOf(property, finalColor, dependent, c, count, this->RangeOf(*components[c]));
  }
  this->Final = finalColor;
  this->Property = property;
  this->Time = property->GetMTime();
  this->Known = true;
}

double ComponentColors::FloorOfWindow(std::size_t component) const
{
  const ColorTable& table = this->Tables[component];
  const auto last =
    std::adjacent_find(table.colors.begin(), table.colors.end(), std::not_equal_to<>());
  const double steps = std::max<double>(static_cast<double>(table.colors.size()) - 1.0, 1.0);
  const double share =
    last == table.colors.end() ? 1.0 : static_cast<double>(last - table.colors.begin()) / steps;
  return table.low + share * (table.high - table.low);
}
}
