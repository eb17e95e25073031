// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ComponentColors_h
#define ComponentColors_h

#include "Components/TransferFunctions.h"
#include "Splat/Projection/Project.h"

#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

#include <cstddef>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkVolumeProperty;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * The colour tables of all components, from a property's transfer functions.
 */
class ComponentColors
{
public:
  /**
   * Makes the tables for the values that these settings project, if anything has changed.
   * @param components  their volumes
   * @param dependent   whether the last component is the opacity of the others
   */
  void Update(vtkVolumeProperty* property, const FinalColor& finalColor,
    const ProjectionSettings& settings, const std::vector<VolumeIndex*>& components,
    bool dependent);

  /// Call it if the components have changed.
  void Forget() { this->Known = false; }

  const ColorTable& Of(std::size_t component) const { return this->Tables[component]; }
  /// The largest scalar such that all scalars up to it have the colour of the lowest.
  double FloorOfWindow(std::size_t component) const;

private:
  ScalarRange RangeOf(VolumeIndex& component) const;

  std::vector<ColorTable> Tables;
  bool Known = false;
  vtkVolumeProperty* Property = nullptr; // compared only
  vtkMTimeType Time = 0;                 // of the property
  FinalColor Final;
  double Shading[2] = { 0.0, 1.0 }; // the least and the greatest factor of samples
};
}

#endif
