// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the class promises without rendering: factory, defaults, clamping, PrintSelf.
#include "Stage.h"

#include "vtkOpenGLSplattingMIPVolumeMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkObjectFactory.h"
#include "vtkSmartVolumeMapper.h"

#include <set>
#include <sstream>
#include <string>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

void testFactory(reference::Checks& check)
{
  const auto made = vtkSmartPointer<Mapper>::New();
  check(vtkOpenGLSplattingMIPVolumeMapper::SafeDownCast(made) != nullptr,
    "New() gives the mapper that draws with OpenGL.");
  const auto named = vtkSmartPointer<vtkObject>::Take(
    vtkObjectFactory::CreateInstance("vtkSplattingMIPVolumeMapper"));
  check(vtkOpenGLSplattingMIPVolumeMapper::SafeDownCast(named) != nullptr,
    "The object factory gives it by its name, too.");
  check(made->IsA("vtkVolumeMapper") == 1, "It is a volume mapper.");
}

void testDefaults(Mapper* mapper, reference::Checks& check)
{
  check(mapper->GetQualityMode() == Mapper::EXACT, "Default mode is exact.");
  check(mapper->GetKernel() == Mapper::TRILINEAR, "Default kernel is trilinear.");
  check(mapper->GetKernelRadius() == 1.0, "Default radius is 1.");
  check(mapper->GetFootprintSampling() == 0, "Default weights are in closed form.");
  check(mapper->GetBlendMode() == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND,
    "Default blend mode is maximum intensity.");
  check(mapper->GetAcceleration() == Mapper::AUTO, "Default acceleration is automatic.");
  check(mapper->GetAccelerationUsed() == Mapper::DENSE, "A new mapper has used no acceleration.");
  check(mapper->GetLineTolerance() == 0.0, "Default encoding is lossless.");
  check(!mapper->GetCullBelowWindow(), "Default keeps all.");
  check(mapper->GetIndexMemoryBudget() == vtkTypeInt64(1) << 32, "Default budget is 4 GiB.");
  check(mapper->GetVectorMode() == Mapper::DISABLED && mapper->GetVectorComponent() == 0,
    "Default is all components.");
  check(mapper->GetMaskInput() == nullptr, "Default is no mask.");
  check(!mapper->GetSlab() && mapper->GetSlabThickness() == 10.0, "Default is no slab.");
  check(mapper->GetPictureBlending() == Mapper::OVER, "Default blends over.");
  check(mapper->GetAutoAdjustSampleDistances() == 1, "Default adjusts to the time, as VTK does.");
  check(mapper->GetQualityModeUsed() == Mapper::EXACT, "A new mapper has used no other mode.");
  check(mapper->GetFinalColorWindow() == 1.0f && mapper->GetFinalColorLevel() == 0.5f,
    "Default colours are those of the transfer functions.");
  check(!mapper->GetLastRenderUsedRayCasting(), "A new mapper has not cast rays.");
  check(mapper->GetShearImage() == nullptr, "There is no shear image before the first render.");
  check(mapper->GetPrincipalAxis() == -1, "There is no principal axis before the first render.");
  check(mapper->GetNumberOfProjections() == 0, "A new mapper has not projected.");
  check(mapper->GetIndexMemorySize() == 0, "A new mapper holds no copy.");
}

/// Whether setting changes the value to the expected one, and setting it again is no modification.
template <class Set, class Get, class Value>
bool sets(Mapper* mapper, Set set, Get get, Value value, Value expected)
{
  (mapper->*set)(value);
  const vtkMTimeType time = mapper->GetMTime();
  (mapper->*set)(value);
  return (mapper->*get)() == expected && mapper->GetMTime() == time;
}

void testClamping(Mapper* mapper, reference::Checks& check)
{
  for (const auto& [value, expected] :
    { std::pair(0, 0), { 1, 1 }, { 2, 2 }, { 3, 3 }, { -3, 0 }, { 7, 3 } })
  {
    check(sets(mapper, &Mapper::SetQualityMode, &Mapper::GetQualityMode, value, expected),
      "SetQualityMode ", value);
  }
  for (const auto& [value, expected] : { std::pair(2, 2), { 1, 1 }, { -1, 0 }, { 5, 2 } })
  {
    check(sets(mapper, &Mapper::SetPictureBlending, &Mapper::GetPictureBlending, value, expected),
      "SetPictureBlending ", value);
  }
  for (const auto& [value, expected] : { std::pair(0, 0), { 1, 1 }, { -1, 0 }, { 5, 1 } })
  {
    check(
      sets(mapper, &Mapper::SetKernel, &Mapper::GetKernel, value, expected), "SetKernel ", value);
  }
  for (const auto& [value, expected] :
    { std::pair(0.5, 0.5), { 1.25, 1.25 }, { 1.5, 1.5 }, { 0.1, 0.5 }, { 9.0, 1.5 } })
  {
    check(sets(mapper, &Mapper::SetKernelRadius, &Mapper::GetKernelRadius, value, expected),
      "SetKernelRadius ", value);
  }
  for (const auto& [value, expected] :
    { std::pair(0, 0), { 16, 16 }, { 64, 64 }, { -1, 0 }, { 65, 64 } })
  {
    check(
      sets(mapper, &Mapper::SetFootprintSampling, &Mapper::GetFootprintSampling, value, expected),
      "SetFootprintSampling ", value);
  }
}

void testClampingOfAcceleration(Mapper* mapper, reference::Checks& check)
{
  for (const auto& [value, expected] : { std::pair(5, 5), { 2, 2 }, { -1, 0 }, { 6, 5 }, { 0, 0 } })
  {
    check(sets(mapper, &Mapper::SetAcceleration, &Mapper::GetAcceleration, value, expected),
      "SetAcceleration ", value);
  }
  for (const auto& [value, expected] : { std::pair(8.0, 8.0), { 99.0, 64.0 }, { -1.0, 0.0 } })
  {
    check(sets(mapper, &Mapper::SetLineTolerance, &Mapper::GetLineTolerance, value, expected),
      "SetLineTolerance ", value);
  }
  check(sets(mapper, &Mapper::SetIndexMemoryBudget, &Mapper::GetIndexMemoryBudget, vtkTypeInt64(-5),
          vtkTypeInt64(0)),
    "SetIndexMemoryBudget below zero");
}

/// The values are vtkSmartVolumeMapper's.
void testVectorMode(Mapper* mapper, reference::Checks& check)
{
  static_assert(int(Mapper::DISABLED) == int(vtkSmartVolumeMapper::DISABLED) &&
    int(Mapper::MAGNITUDE) == int(vtkSmartVolumeMapper::MAGNITUDE) &&
    int(Mapper::COMPONENT) == int(vtkSmartVolumeMapper::COMPONENT));
  for (const auto& [value, expected] : { std::pair(0, 0), { 1, 1 }, { -7, -1 }, { 2, 1 } })
  {
    check(sets(mapper, &Mapper::SetVectorMode, &Mapper::GetVectorMode, value, expected),
      "SetVectorMode ", value);
  }
  for (const auto& [value, expected] : { std::pair(2, 2), { 3, 3 }, { -1, 0 }, { 4, 3 } })
  {
    check(sets(mapper, &Mapper::SetVectorComponent, &Mapper::GetVectorComponent, value, expected),
      "SetVectorComponent ", value);
  }
  mapper->SetVectorModeToMagnitude();
  check(std::string("magnitude") == mapper->GetVectorModeAsString(), "SetVectorModeToMagnitude");
  mapper->SetVectorModeToComponent();
  check(std::string("component") == mapper->GetVectorModeAsString(), "SetVectorModeToComponent");
  mapper->SetVectorModeToDisabled();
  check(std::string("disabled") == mapper->GetVectorModeAsString(), "SetVectorModeToDisabled");
}

void testNames(Mapper* mapper, reference::Checks& check)
{
  const auto modeIs = [&](int value, const char* name)
  {
    return mapper->GetQualityMode() == value &&
      name == std::string(mapper->GetQualityModeAsString());
  };
  mapper->SetQualityModeToPreview();
  check(modeIs(Mapper::PREVIEW, "preview"), "SetQualityModeToPreview");
  mapper->SetQualityModeToStandard();
  check(modeIs(Mapper::STANDARD, "standard"), "SetQualityModeToStandard");
  mapper->SetQualityModeToHigh();
  check(modeIs(Mapper::HIGH, "high"), "SetQualityModeToHigh");
  mapper->SetQualityModeToExact();
  check(modeIs(Mapper::EXACT, "exact"), "SetQualityModeToExact");
  mapper->SetKernelToCosineBell();
  check(mapper->GetKernel() == Mapper::COSINE_BELL &&
      std::string("cosine bell") == mapper->GetKernelAsString(),
    "SetKernelToCosineBell");
  mapper->SetAccelerationToSortedVolume();
  check(mapper->GetAcceleration() == Mapper::SORTED_VOLUME &&
      std::string("sorted volume") == mapper->GetAccelerationAsString(),
    "SetAccelerationToSortedVolume");
  mapper->SetAccelerationToAuto();
  check(std::string("auto") == mapper->GetAccelerationAsString(), "SetAccelerationToAuto");
  mapper->SetKernelToTrilinear();
  check(mapper->GetKernel() == Mapper::TRILINEAR &&
      std::string("trilinear") == mapper->GetKernelAsString(),
    "SetKernelToTrilinear");
  mapper->SetPictureBlendingToAdd();
  check(std::string("add") == mapper->GetPictureBlendingAsString(), "SetPictureBlendingToAdd");
  mapper->SetPictureBlendingToMaximum();
  check(
    std::string("maximum") == mapper->GetPictureBlendingAsString(), "SetPictureBlendingToMaximum");
  mapper->SetPictureBlendingToOver();
  check(std::string("over") == mapper->GetPictureBlendingAsString(), "SetPictureBlendingToOver");
}

void testPrinting(Mapper* mapper, reference::Checks& check)
{
  std::ostringstream stream;
  mapper->Print(stream);
  const std::string text = stream.str();
  for (const char* variable : { "QualityMode: exact", "Kernel: trilinear",
         "KernelRadius: ", "FootprintSampling: ", "LastRenderUsedRayCasting: ", "PrincipalAxis: ",
         "Shear: ", "IndexMemorySize: ", "NumberOfProjections: ", "ProjectionTime: ",
         "InstructionSet: ", "Acceleration: auto", "AccelerationUsed: dense", "LineTolerance: ",
         "QualityModeUsed: exact", "AutoAdjustSampleDistances: On", "FinalColorWindow: 1",
         "FinalColorLevel: 0.5", "CullBelowWindow: ", "IndexMemoryBudget: ", "IndexTime: ", "Blend",
         "VectorMode: disabled", "VectorComponent: ", "MaskInput: ", "Cropping" })
  {
    check(text.find(variable) != std::string::npos, "PrintSelf names ", variable);
  }
}

/// Ranks compare what PrintPictureSettings() prints. What else the class prints cannot change a
/// picture or is compared by itself.
void testPictureSettings(Mapper* mapper, reference::Checks& check)
{
  std::ostringstream all, some;
  mapper->vtkAbstractSplattingMIPVolumeMapper::PrintSelf(all, vtkIndent());
  mapper->PrintPictureSettings(some, vtkIndent());
  const std::string text = all.str();
  const std::size_t at = text.find(some.str());
  check(at != std::string::npos, "PrintSelf() prints the settings that change pictures.");
  if (at == std::string::npos)
  {
    return;
  }
  std::istringstream rest(text.substr(at + some.str().size()));
  const std::set<std::string> others{ "IndexMemoryBudget", "MaskInput", "BoundingSurface",
    "DepthCodingColors", "LabelInput", "LabelColors" };
  for (std::string line; std::getline(rest, line);)
  {
    check(
      others.count(line.substr(0, line.find(':'))) == 1, "Ranks do not compare the setting ", line);
  }
}
}

//------------------------------------------------------------------------------
int TestMapperContract(int, char*[])
{
  reference::Checks check;
  testFactory(check);
  const auto mapper = vtkSmartPointer<Mapper>::New();
  testDefaults(mapper, check);
  testPrinting(mapper, check);
  testPictureSettings(mapper, check);
  testClamping(mapper, check);
  testClampingOfAcceleration(mapper, check);
  testVectorMode(mapper, check);
  testNames(mapper, check);
  return check.exitCode();
}
