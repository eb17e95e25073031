// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The factory override: off by default, on and off with one call, whatever else is registered; and
// VTK's own mappers of mappers, which then show what the splatting mapper shows, bit for bit.
#include "Stage.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkExtractVOI.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMultiBlockVolumeMapper.h"
#include "vtkObjectFactory.h"
#include "vtkObjectFactoryCollection.h"
#include "vtkPointData.h"
#include "vtkRayCastImageDisplayHelper.h"
#include "vtkRenderer.h"
#include "vtkSmartVolumeMapper.h"
#include "vtkVersion.h"
#include "vtkVolume.h"

namespace
{
using Override = vtkSplattingMIPGPUVolumeRayCastMapper;
const stage::Vector oblique = { 0.3, 0.4, -0.8 };
const stage::Vector up = { 0.0, 1.0, 0.1 };
const std::string VtksOwn = "vtkOpenGLGPUVolumeRayCastMapper";
const std::string Ours = "vtkSplattingMIPGPUVolumeRayCastMapper";

std::string given()
{
  return vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New()->GetClassName();
}

int numberOfFactories()
{
  return vtkObjectFactory::GetRegisteredFactories()->GetNumberOfItems();
}

/// A program's own override: counts how often it is asked.
class CountingFactory : public vtkObjectFactory
{
public:
  static CountingFactory* New();
  vtkTypeMacro(CountingFactory, vtkObjectFactory);
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "counts"; }
  static int count;

protected:
  CountingFactory()
  {
    this->RegisterOverride("vtkGPUVolumeRayCastMapper", VtksOwn.c_str(), "counts", 1,
      []() -> vtkObject*
      {
        ++count;
        return vtkOpenGLGPUVolumeRayCastMapper::New();
      });
  }
};
int CountingFactory::count = 0;
vtkStandardNewMacro(CountingFactory);

void testSwitch(reference::Checks& check)
{
  check(!Override::GetGlobalOverride() && given() == VtksOwn, "Off by default.");
  const int factories = numberOfFactories();
  for (int time = 0; time < 2; ++time)
  {
    Override::GlobalOverrideOn();
    check(Override::GetGlobalOverride() && given() == Ours, "On.");
    Override::SetGlobalOverride(true);
    check(numberOfFactories() == factories + 1, "One more factory, however often it is on.");
    Override::GlobalOverrideOff();
    check(!Override::GetGlobalOverride() && given() == VtksOwn, "Off.");
  }
  Override::GlobalOverrideOn();
  vtkObjectFactory::SetAllEnableFlags(0, "vtkGPUVolumeRayCastMapper", Ours.c_str());
  check(!Override::GetGlobalOverride() && given() == VtksOwn, "Off by VTK's own means.");
  Override::GlobalOverrideOff();
}

void testGlobalQualityMode(reference::Checks& check)
{
  const auto qualityOfNew = []()
  { return vtkSmartPointer<Override>::New()->GetSplattingMapper()->GetQualityMode(); };
  check(qualityOfNew() == vtkSplattingMIPVolumeMapper::EXACT, "Exact by default.");
  for (const auto& [mode, expected] :
    { std::pair(1, 1), { 0, 0 }, { -1, 0 }, { 2, 2 }, { 4, 3 }, { 3, 3 } })
  {
    Override::SetGlobalQualityMode(mode);
    check(Override::GetGlobalQualityMode() == expected && qualityOfNew() == expected,
      "Quality mode ", mode, ".");
  }
  check(vtkSmartPointer<vtkSplattingMIPVolumeMapper>::New()->GetQualityMode() ==
      vtkSplattingMIPVolumeMapper::EXACT,
    "Only of this class.");
}

void testOtherOverrides(vtkImageData* image, reference::Checks& check)
{
  Override::GlobalOverrideOn();
  const auto mapper = stage::splatting(image);
  check(mapper->IsA("vtkOpenGLSplattingMIPVolumeMapper"), "The module's other override.");
  check(
    vtkSmartPointer<vtkRayCastImageDisplayHelper>::New()->IsA("vtkOpenGLRayCastImageDisplayHelper"),
    "VTK's other overrides.");
  const auto direct = vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New();
  check(direct->GetClassName() == VtksOwn, "VTK's class by its own name.");

  vtkNew<CountingFactory> programs;
  vtkObjectFactory::RegisterFactory(programs);
  vtkObjectFactory::GetRegisteredFactories()->RemoveItem(programs);
  vtkObjectFactory::GetRegisteredFactories()->InsertItem(-1, programs);
  check(given() == VtksOwn && CountingFactory::count == 1, "Who comes later may come first.");
  // What the splatting mapper leaves to the GPU's ray caster is rendered by VTK's own class, not by
  // what the factory gives: that could hand it back.
  CountingFactory::count = 0;
  stage::Stage stage(60, 50);
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  mapper->SetBlendModeToAdditive();
  stage.show(mapper);
  stage.look(oblique, up);
  stage.pixels();
  check(mapper->GetLastRenderUsedRayCasting() && warnings.texts.size() == 1, "Additive: ray cast.");
  check(CountingFactory::count == 0, "Without asking the factory.");
  vtkObjectFactory::UnRegisterFactory(programs);
  Override::GlobalOverrideOff();
}

/// The picture of a mapper of mappers with its protected part in sight.
class SmartMapper : public vtkSmartVolumeMapper
{
public:
  static SmartMapper* New();
  vtkTypeMacro(SmartMapper, vtkSmartVolumeMapper);
  using vtkSmartVolumeMapper::GetGPUMapper;
};
vtkStandardNewMacro(SmartMapper);

/// Of what a smart mapper uses, or nullptr.
vtkSplattingMIPVolumeMapper* splatterOf(SmartMapper* mapper)
{
  auto* const gpu = Override::SafeDownCast(mapper->GetGPUMapper());
  return gpu ? gpu->GetSplattingMapper() : nullptr;
}

stage::Pixels shown(stage::Stage& stage, vtkVolumeMapper* mapper, int blendMode)
{
  mapper->SetBlendMode(blendMode);
  stage.show(mapper);
  stage.look(oblique, up);
  return stage.pixels();
}

constexpr int Maximum = vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND;
constexpr int Minimum = vtkVolumeMapper::MINIMUM_INTENSITY_BLEND;
constexpr int Average = vtkVolumeMapper::AVERAGE_INTENSITY_BLEND;
constexpr int Composite = vtkVolumeMapper::COMPOSITE_BLEND;

void testSmartMapper(vtkImageData* image, reference::Checks& check)
{
  Override::GlobalOverrideOff();
  vtkNew<vtkSmartVolumeMapper> before;
  before->SetInputData(image);
  Override::GlobalOverrideOn();
  vtkNew<SmartMapper> smart;
  smart->SetInputData(image);
  Override::GlobalOverrideOff();

  stage::Stage stage(150, 120);
  const auto splatting = stage::splatting(image);
  for (int mode : { Maximum, Composite, Minimum, Average, Maximum })
  {
    const bool isSplatted = mode == Maximum || mode == Minimum;
    const std::string name = "Smart mapper, blend mode " + std::to_string(mode);
    const stage::Pixels vtks = shown(stage, before, mode);
    const stage::Pixels picture = shown(stage, smart, mode);
    const stage::Pixels expected = isSplatted ? shown(stage, splatting, mode) : vtks;
    check(picture == expected, name, ": the picture.");
    check((vtks != picture) == isSplatted, name, ": VTK's own is another where it is splatted.");
    check(smart->GetLastUsedRenderMode() == vtkSmartVolumeMapper::GPURenderMode, name,
      ": the smart mapper takes its GPU mapper.");
  }
  smart->SetRequestedRenderModeToGPU();
  check(shown(stage, smart, Maximum) == shown(stage, splatting, Maximum), "GPU mode.");
  smart->SetRequestedRenderModeToRayCast();
  before->SetRequestedRenderModeToRayCast();
  check(shown(stage, smart, Maximum) == shown(stage, before, Maximum),
    "What asks for the CPU's ray caster gets it.");
}

/// All that this class of VTK does with its input, in every frame, makes nothing anew.
void testSmartMapperKeepsIndex(vtkImageData* image, reference::Checks& check)
{
  Override::GlobalOverrideOn();
  vtkNew<SmartMapper> smart;
  Override::GlobalOverrideOff();
  smart->SetInputData(image);
  smart->SetBlendModeToMaximumIntensity();
  vtkSplattingMIPVolumeMapper* const splatting = splatterOf(smart);
  stage::Stage stage(80, 80);
  stage.show(smart);
  stage.look(oblique, up);
  stage.pixels();
  const double indexTime = splatting->GetIndexTime();
  const vtkIdType projections = splatting->GetNumberOfProjections();
  check(projections == 1, "One projection.");
  for (int frame = 0; frame < 3; ++frame)
  {
    stage.setGrayRamp(20.0, 200.0 + frame);
    stage.pixels();
  }
  check(splatting->GetNumberOfProjections() == projections, "Colours project nothing.");
  stage.renderer->GetActiveCamera()->Azimuth(3.0);
  stage.pixels();
  check(splatting->GetNumberOfProjections() == projections + 1, "A turn projects once.");
  check(splatting->GetIndexTime() == indexTime, "The index is made once.");
}

/// The smart mapper computes magnitudes by itself.
void testVectorModes(vtkImageData* image, reference::Checks& check)
{
  vtkNew<vtkImageData> vectors;
  vectors->CopyStructure(image);
  vectors->AllocateScalars(VTK_FLOAT, 3);
  vtkDataArray* const array = vectors->GetPointData()->GetScalars();
  array->SetName("vectors");
  for (vtkIdType n = 0; n < array->GetNumberOfValues(); ++n)
  {
    const double value = image->GetPointData()->GetScalars()->GetComponent(n / 3, 0);
    array->SetComponent(n / 3, n % 3, n % 3 == 1 ? 0.5 * value : double((n * 7919) % 97));
  }
  Override::GlobalOverrideOn();
  vtkNew<SmartMapper> smart;
  Override::GlobalOverrideOff();
  smart->SetInputData(vectors);
  smart->SelectScalarArray("vectors");
  smart->SetScalarModeToUsePointFieldData();
  smart->SetVectorMode(vtkSmartVolumeMapper::MAGNITUDE);
  const auto splatting = stage::splatting(vectors);
  splatting->SetVectorModeToMagnitude();
  stage::Stage stage(100, 90);
  check(shown(stage, smart, Maximum) == shown(stage, splatting, Maximum), "Magnitudes.");
  smart->SetVectorMode(vtkSmartVolumeMapper::COMPONENT);
  smart->SetVectorComponent(1);
  splatting->SetVectorModeToComponent();
  splatting->SetVectorComponent(1);
  check(shown(stage, smart, Maximum) == shown(stage, splatting, Maximum), "A component.");
}

vtkSmartPointer<vtkImageData> part(vtkImageData* image, int first, int last)
{
  vtkNew<vtkExtractVOI> extract;
  extract->SetInputData(image);
  int extent[6];
  image->GetExtent(extent);
  extract->SetVOI(first, last, extent[2], extent[3], extent[4], extent[5]);
  extract->Update();
  return extract->GetOutput();
}

/// Blocks are blended one over the other, from back to front, whatever the mapper.
void testMultiBlockMapper(vtkImageData* image, reference::Checks& check)
{
  const int middle = image->GetDimensions()[0] / 2;
  const auto right = part(image, middle, image->GetDimensions()[0] - 1);
  const auto left = part(image, 0, middle);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, left);
  blocks->SetBlock(1, right);
  Override::GlobalOverrideOn();
  vtkNew<vtkMultiBlockVolumeMapper> mapper;
  mapper->SetInputDataObject(blocks);
  stage::Stage stage(150, 120);
  const stage::Pixels picture = shown(stage, mapper, Maximum);
  Override::GlobalOverrideOff();

  stage.show(stage::splatting(right)); // x grows away from the viewer
  vtkNew<vtkVolume> front;
  front->SetMapper(stage::splatting(left));
  front->SetProperty(stage.property);
  stage.renderer->AddVolume(front);
  check(stage.pixels() == picture, "Two blocks.");
  front->VisibilityOff();
  check(stage.pixels() != picture, "Both of them are seen.");
}

/// Bright things in one half, dark ones in the other.
vtkSmartPointer<vtkImageData> blobsAndHoles()
{
  auto volume = stage::blobsAndTubes({ 48, 40, 44 }, 25);
  for (std::size_t n = 0; n < volume.voxels.size(); ++n)
  {
    const std::uint8_t voxel = volume.voxels[n];
    volume.voxels[n] = static_cast<std::uint8_t>(n % 48 < 24 ? voxel : 255 - voxel);
  }
  return stage::toImageData(volume);
}
}

//------------------------------------------------------------------------------
int TestGlobalOverride(int, char*[])
{
  reference::Checks check;
  const auto image = blobsAndHoles();
  testSwitch(check);
  testGlobalQualityMode(check);
  testOtherOverrides(image, check);
  testSmartMapper(image, check);
  testSmartMapperKeepsIndex(image, check);
  testVectorModes(image, check);
  testMultiBlockMapper(image, check);
  return check.exitCode();
}
