// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mapper's properties as the projection takes them: what matters is passed on, and what has no
// meaning is refused.
#include "CoreTesting.h"
#include "MapperProperties.h"
#include "WideViews.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <string>

using reference::Checks;
using namespace splatting;

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;

/// What has no meaning is refused, and nothing else.
void testRefusals(Mapper* mapper, Checks& check)
{
  vtkNew<vtkVolumeProperty> property;
  mapper->SetBlendModeToMaximumIntensity();
  const auto fault = [&] { return validate(mapper, property); };
  const auto refuses = [&](const std::string& word)
  {
    const char* const sentence = fault();
    return sentence && std::string(sentence).find(word) != std::string::npos;
  };
  check(!fault(), "defaults are refused");
  mapper->SlabOn();
  mapper->SetSlabThickness(0.0);
  check(refuses("SlabThickness"), "a slab without thickness is taken");
  mapper->SlabOff();
  vtkNew<vtkPlane> plane;
  mapper->AddClippingPlane(plane);
  check(!fault(), "a plane is refused");
  plane->SetOrigin(0.0, NAN, 0.0);
  check(refuses("plane"), "a plane without place is taken");
  mapper->RemoveAllClippingPlanes();
  mapper->SetBlendMode(vtkVolumeMapper::SLICE_BLEND);
  check(refuses("SetSliceFunction"), "no slice is taken");
  property->SetSliceFunction(plane);
  check(!fault(), "a slice is refused");
  mapper->SetBlendModeToMaximumIntensity();
}

/// What matters is passed on.
void testSettings(Mapper* mapper, Checks& check)
{
  const auto settings = [&](int mode)
  { return settingsOf(mapper, mode, coretesting::magnifiedView()); };
  const auto changes = [&](int mode, auto change)
  {
    const auto before = settings(mode);
    change();
    return !(settings(mode) == before);
  };
  check(changes(Mapper::HIGH, [&] { mapper->SetKernelToCosineBell(); }), "the kernel");
  check(changes(Mapper::HIGH, [&] { mapper->SetKernelRadius(0.7); }), "the kernel's radius");
  check(!changes(Mapper::PREVIEW, [&] { mapper->SetKernelRadius(0.8); }), "an idle radius");
  check(changes(Mapper::PREVIEW, [&] { mapper->SetAccelerationToLines(); }), "the acceleration");
  check(changes(Mapper::PREVIEW, [&] { mapper->SetLineTolerance(3.0); }), "the tolerance");
  // Each of these needs to know where samples lie.
  check(changes(Mapper::HIGH, [&] { mapper->RecordLocationsOn(); }), "locations");
  check(!changes(Mapper::HIGH, [&] { mapper->DepthCodingOn(); }), "locations twice");
  mapper->RecordLocationsOff();
  check(changes(Mapper::HIGH, [&] { mapper->DepthCodingOff(); }), "the depth's colours");
  check(changes(Mapper::HIGH, [&] { mapper->WriteDepthOn(); }), "the depth buffer");
  check(changes(Mapper::HIGH, [&] { mapper->SetMaximumTypeToDepthShaded(); }), "shading");
  check(changes(Mapper::HIGH, [&] { mapper->SetDepthShadingAmbient(0.9); }), "the ambient");
  check(changes(Mapper::HIGH, [&] { mapper->SetDepthShadingChangeRate(0.1); }), "the rate");
  check(changes(Mapper::HIGH, [&] { mapper->SetMaximumTypeToLocal(); }), "local maxima");
  check(changes(Mapper::HIGH, [&] { mapper->SetLocalMaximumThreshold(7.0); }), "the threshold");
  check(changes(Mapper::HIGH, [&] { mapper->SetMaximumTypeToSigned(); }), "signed maxima");
  check(changes(Mapper::HIGH, [&] { mapper->SetSignedOrigin(7.0); }), "the origin");
  check(changes(Mapper::HIGH, [&] { mapper->SetBlendModeToAverageIntensity(); }), "averages");
  check(changes(Mapper::HIGH, [&] { mapper->SetAverageIPScalarRange(2.0, 5.0); }), "the range");
  check(changes(Mapper::HIGH, [&] { mapper->SetFootprintSampling(9); }), "the footprint");
}
}

int TestMapperProperties(int, char*[])
{
  Checks check;
  vtkNew<Mapper> mapper;
  testRefusals(mapper, check);
  testSettings(mapper, check);
  return check.exitCode();
}
