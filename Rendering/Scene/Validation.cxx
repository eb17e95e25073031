// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Validation.h"

#include "Locations/LabelEdges.h"
#include "MapperProperties.h"
#include "Scene/ProjectedVolume.h"
#include "Scene/ViewOfVolume.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

namespace splatting
{
namespace
{
std::string loadInput(vtkSplattingMIPVolumeMapper* mapper, vtkVolume* volume, ProjectedVolume& data)
{
  if (volume->IsA("vtkMultiVolume"))
  {
    return "A vtkMultiVolume cannot be splatted: give each of its volumes a mapper of its own.";
  }
  if (mapper->GetLabelInput() && data.Ranks.Use(mapper->GetController()))
  {
    return "LabelInput is not supported with several ranks: remove it, or use one rank.";
  }
  ScalarChoice choice;
  choice.scalarMode = mapper->GetScalarMode();
  choice.arrayAccessMode = mapper->GetArrayAccessMode();
  choice.arrayId = mapper->GetArrayId();
  choice.arrayName = mapper->GetArrayName();
  choice.vectorMode = mapper->GetVectorMode();
  choice.vectorComponent = mapper->GetVectorComponent();
  choice.independentComponents = volume->GetProperty()->GetIndependentComponents() != 0;
  choice.mask = mapper->GetMaskInput();
  if (data.Ranks.Use(mapper->GetController()) && !pieceOf(mapper))
  {
    return ""; // a rank may have no piece
  }
  std::string problem = data.Source.Examine(mapper->GetInput(), choice);
  if (problem.empty() && isFlat(data.Source.Grid(), volume))
  {
    problem =
      "Spacing, direction and prop matrix flatten the volume: none of them may be singular.";
  }
  return problem;
}

/// The error of any rank, after each has checked its piece. Collective.
std::string agreeWithRanks(vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer,
  vtkVolume* volume, ProjectedVolume& data, const std::string& problemOfPiece)
{
  RankReport report = reportOf(mapper, problemOfPiece);
  if (!report.problem[0] && !report.isEmpty())
  {
    if (data.Components.SetSource(data.Source))
    {
      data.ForgetTimes();
    }
    describeScalars(data.Components, data.Source, report);
  }
  report.view = viewHash(mapper, renderer, volume);
  std::string problem = data.Ranks.Agree(report);
  if (problem.empty() && report.isEmpty())
  {
    const RankReport& common = data.Ranks.Common();
    data.Source.Clear(common.vtkType);
    data.Components.SetEmpty(
      static_cast<ScalarType>(common.type), static_cast<std::size_t>(common.components));
  }
  return problem;
}

/// The error of the mapper's own properties, for valid input.
std::string validateProperties(
  vtkSplattingMIPVolumeMapper* mapper, vtkVolume* volume, ProjectedVolume& data)
{
  if (const char* const fault = validate(mapper, volume->GetProperty()))
  {
    return fault;
  }
  if (vtkImageData* const labels = mapper->GetLabelInput())
  {
    const std::string problem = validateLabels(labels, data.Grid().dimensions);
    if (!problem.empty())
    {
      return problem;
    }
  }
  if (!data.Ranks.AreMany() && data.Source.AreDependent() &&
    mapper->GetBlendMode() == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND &&
    mapper->GetMaximumType() == vtkSplattingMIPVolumeMapper::SIGNED)
  {
    return "Dependent components have no signed maximum, because the last one is an opacity: set "
           "IndependentComponents of the vtkVolumeProperty, or choose another MaximumType.";
  }
  vtkPolyData* const surface = mapper->GetBoundingSurface();
  const glm::dmat4 toIndex = surface ? worldToIndex(data.Grid(), volume) : glm::dmat4(1.0);
  const char* const fault = data.Cuts.Surface().Update(surface, toIndex);
  return fault ? fault : "";
}
}

std::string loadAndValidate(vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer,
  vtkVolume* volume, ProjectedVolume& data)
{
  std::string problem = loadInput(mapper, volume, data);
  if (data.Ranks.AreMany())
  {
    problem = agreeWithRanks(mapper, renderer, volume, data, problem);
  }
  return problem.empty() ? validateProperties(mapper, volume, data) : problem;
}
}
