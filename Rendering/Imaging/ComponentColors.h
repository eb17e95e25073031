// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ComponentColors_h
#define ComponentColors_h

#include "Projection/Project.h"
#include "TransferFunctions.h"

#include "vtkType.h"

#include <cstddef>
#include <vector>

class vtkVolumeProperty;

namespace splatting
{
/**
 * A property's transfer functions as tables, one for each component of a data set.
 */
class ComponentColors
{
public:
  /**
   * Tabulates the functions for what these settings project, anew if something changed.
   * @param components  their volumes
   * @param dependent   whether the last component is the opacity of the others
   */
  void Update(vtkVolumeProperty* property, const FinalColor& finalColor,
    const ProjectionSettings& settings, const std::vector<VolumeIndex*>& components,
    bool dependent);

  /// The components have changed.
  void Forget() { this->Known = false; }

  const ColorTable& Of(std::size_t component) const { return this->Tables[component]; }
  /// The scalar up to which all have the colour of the lowest.
  double FloorOfWindow(std::size_t component) const;

private:
  ScalarRange RangeOf(VolumeIndex& component) const;

  std::vector<ColorTable> Tables;
  bool Known = false;
  vtkVolumeProperty* Property = nullptr; // only compared
  vtkMTimeType Time = 0;                 // of the property
  FinalColor Final;
  double Shading[2] = { 0.0, 1.0 }; // of all samples, the least and the greatest factor
};
}

#endif
