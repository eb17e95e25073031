// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"

#include "Scene/VolumeStandIn.h"
#include "vtkOpenGLSplattingMIPVolumeMapper.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkLogger.h"
#include "vtkMultiVolume.h"
#include "vtkObjectFactory.h"
#include "vtkObjectFactoryCollection.h"
#include "vtkOpenGLRenderPass.h"
#include "vtkOutputWindow.h"
#include "vtkRenderer.h"
#include "vtkShaderProperty.h"
#include "vtkVersion.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <string>

using namespace splatting;

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkSplattingMIPGPUVolumeRayCastMapper);

namespace
{
const char* const Replaced = "vtkGPUVolumeRayCastMapper";
const char* const Replacement = "vtkSplattingMIPGPUVolumeRayCastMapper";

int globalQualityMode = vtkSplattingMIPVolumeMapper::EXACT;

VTK_CREATE_CREATE_FUNCTION(vtkSplattingMIPGPUVolumeRayCastMapper);

/// The module's generated factory creates mappers that a program requests by name. This factory
/// replaces other mappers, so it is registered on request only.
class OverrideFactory : public vtkObjectFactory
{
public:
  static OverrideFactory* New();
  vtkTypeMacro(OverrideFactory, vtkObjectFactory);
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "Splats intensity projections"; }

protected:
  OverrideFactory()
  {
    this->RegisterOverride(Replaced, Replacement, this->GetDescription(), 1,
      vtkObjectFactoryCreatevtkSplattingMIPGPUVolumeRayCastMapper);
  }
};
vtkStandardNewMacro(OverrideFactory);

bool hasCode(vtkShaderProperty* shader)
{
  return shader &&
    (shader->HasVertexShaderCode() || shader->HasFragmentShaderCode() ||
      shader->HasGeometryShaderCode() || shader->GetNumberOfShaderReplacements() > 0);
}

/// The first registered factory that can create the replacement, or nullptr.
vtkObjectFactory* registeredFactory()
{
  vtkObjectFactoryCollection* const factories = vtkObjectFactory::GetRegisteredFactories();
  vtkCollectionSimpleIterator place;
  factories->InitTraversal(place);
  while (vtkObjectFactory* const factory = factories->GetNextObjectFactory(place))
  {
    if (factory->HasOverride(Replaced, Replacement))
    {
      return factory;
    }
  }
  return nullptr;
}

/// VTK uses the first factory, and that of its OpenGL classes may be registered already.
void registerFirst(vtkObjectFactory* factory)
{
  vtkObjectFactory::RegisterFactory(factory);
  vtkObjectFactoryCollection* const factories = vtkObjectFactory::GetRegisteredFactories();
  if (factories->GetNumberOfItems() > 1)
  {
    factories->RemoveItem(factory);
    factories->InsertItem(-1, factory);
  }
}
}

//------------------------------------------------------------------------------
void vtkSplattingMIPGPUVolumeRayCastMapper::SetGlobalOverride(bool on)
{
  if (on && !registeredFactory())
  {
    vtkNew<OverrideFactory> factory;
    registerFirst(factory);
  }
  vtkObjectFactory::SetAllEnableFlags(on, Replaced, Replacement);
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPGPUVolumeRayCastMapper::GetGlobalOverride()
{
  vtkObjectFactory* const factory = registeredFactory();
  return factory && factory->GetEnableFlag(Replaced, Replacement);
}

//------------------------------------------------------------------------------
void vtkSplattingMIPGPUVolumeRayCastMapper::SetGlobalQualityMode(int mode)
{
  globalQualityMode =
    std::clamp<int>(mode, vtkSplattingMIPVolumeMapper::PREVIEW, vtkSplattingMIPVolumeMapper::EXACT);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPGPUVolumeRayCastMapper::GetGlobalQualityMode()
{
  return globalQualityMode;
}

//------------------------------------------------------------------------------
vtkSplattingMIPGPUVolumeRayCastMapper::vtkSplattingMIPGPUVolumeRayCastMapper()
  : LastRenderUsedSplatting(false),
    LoggedReason(""),
    StandIn(new splatting::VolumeStandIn)
{
  this->GetSplattingMapper(0);
}

//------------------------------------------------------------------------------
vtkSplattingMIPGPUVolumeRayCastMapper::~vtkSplattingMIPGPUVolumeRayCastMapper() = default;

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper* vtkSplattingMIPGPUVolumeRayCastMapper::GetSplattingMapper(int port)
{
  vtkSmartPointer<vtkOpenGLSplattingMIPVolumeMapper>& mapper =
    this->SplattingMappers[std::clamp(port, 0, this->GetNumberOfInputPorts() - 1)];
  if (!mapper)
  {
    mapper = vtkSmartPointer<vtkOpenGLSplattingMIPVolumeMapper>::New();
    mapper->SetQualityMode(globalQualityMode);
    using Self = vtkSplattingMIPGPUVolumeRayCastMapper;
    mapper->AddObserver(vtkCommand::ErrorEvent, this, &Self::ForwardMessage);
    mapper->AddObserver(vtkCommand::WarningEvent, this, &Self::ForwardMessage);
    mapper->AddObserver(vtkCommand::VolumeMapperRenderProgressEvent, this, &Self::ForwardProgress);
  }
  return mapper;
}

//------------------------------------------------------------------------------
vtkSplattingMIPGPUVolumeRayCastMapper::Parts vtkSplattingMIPGPUVolumeRayCastMapper::PartsOf(
  vtkVolume* vol)
{
  auto* const several = vtkMultiVolume::SafeDownCast(vol);
  if (!several)
  {
    return { { 0, vol } };
  }
  Parts parts;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    vtkVolume* const part =
      this->GetNumberOfInputConnections(port) > 0 ? several->GetVolume(port) : nullptr;
    if (part)
    {
      parts.emplace_back(port, part);
    }
  }
  return parts;
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPGPUVolumeRayCastMapper::ReasonNotToSplat(
  vtkVolume* vol, const Parts& parts)
{
  vtkInformation* const keys = vol->GetPropertyKeys();
  const auto any = [&](bool (*has)(vtkVolume*))
  {
    return std::any_of(
      parts.begin(), parts.end(), [=](const auto& part) { return has(part.second); });
  };
  const struct
  {
    bool holds;
    const char* reason;
  } reasons[] = {
    { this->BlendMode != MAXIMUM_INTENSITY_BLEND && this->BlendMode != MINIMUM_INTENSITY_BLEND,
      "the blend mode is neither maximum nor minimum intensity" },
    { !vol->IsA("vtkMultiVolume") && this->GetInputCount() > 1, "there are several inputs" },
    { any([](vtkVolume* part)
        { return part->GetProperty()->GetTransferFunctionMode() != vtkVolumeProperty::TF_1D; }),
      "the transfer functions are two-dimensional" },
    { hasCode(vol->GetShaderProperty()) ||
        any([](vtkVolume* part) { return hasCode(part->GetShaderProperty()); }),
      "the volume brings shader code" },
    { keys && keys->Has(vtkOpenGLRenderPass::RenderPasses()), "a render pass brings shader code" },
    { this->RenderToImage != 0, "it renders to an image" },
  };
  for (const auto& candidate : reasons)
  {
    if (candidate.holds)
    {
      return candidate.reason;
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
// Setters without a change cost nothing, and the splatting mapper detects which results a change
// invalidates.
void vtkSplattingMIPGPUVolumeRayCastMapper::CopySettings(bool severalInputs)
{
  for (const auto& [port, to] : this->SplattingMappers)
  {
    // Not a connection, because VTK's garbage collector does not detect that both mappers share it.
    to->SetInputDataObject(this->GetInputDataObject(port, 0));
    to->SetBlendMode(this->BlendMode);
    to->SetCropping(this->Cropping && !severalInputs);
    to->SetCroppingRegionPlanes(this->CroppingRegionPlanes);
    to->SetCroppingRegionFlags(this->CroppingRegionFlags);
    to->SetClippingPlanes(this->ClippingPlanes);
    to->SetScalarMode(this->ScalarMode);
    if (this->ArrayAccessMode == VTK_GET_ARRAY_BY_NAME)
    {
      to->SelectScalarArray(this->ArrayName);
    }
    else
    {
      to->SelectScalarArray(this->ArrayId);
    }
    to->SetFinalColorWindow(this->FinalColorWindow);
    to->SetFinalColorLevel(this->FinalColorLevel);
    to->SetAutoAdjustSampleDistances(this->AutoAdjustSampleDistances);
    to->SetMaskInput(port == 0 && this->MaskType == BinaryMaskType ? this->MaskInput : nullptr);
  }
}

//------------------------------------------------------------------------------
// Whether a component has a gray function, which the superclass would replace permanently. Volumes
// of a vtkMultiVolume are excluded.
bool vtkSplattingMIPGPUVolumeRayCastMapper::HasGrays(vtkVolume* vol)
{
  int cells = 0;
  vtkDataArray* const scalars = vol->IsA("vtkMultiVolume")
    ? nullptr
    : vtkAbstractVolumeMapper::GetScalars(this->GetInput(0), this->ScalarMode,
        this->ArrayAccessMode, this->ArrayId, this->ArrayName, cells);
  vtkVolumeProperty* const property = vol->GetProperty();
  const int count = !scalars               ? 0
    : property->GetIndependentComponents() ? scalars->GetNumberOfComponents()
                                           : 1;
  for (int i = 0; i < std::min(count, VTK_MAX_VRCOMP); ++i)
  {
    if (property->GetColorChannels(i) == 1)
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
// The superclass's Render() updates the input and invokes the events.
void vtkSplattingMIPGPUVolumeRayCastMapper::GPURender(vtkRenderer* ren, vtkVolume* vol)
{
  const Parts parts = this->PartsOf(vol);
  for (const auto& part : parts)
  {
    this->GetSplattingMapper(part.first);
  }
  // In all modes, because the splatting mappers would otherwise keep data that are no longer
  // rendered.
  this->CopySettings(vol->IsA("vtkMultiVolume") != 0);
  const char* const reason = this->ReasonNotToSplat(vol, parts);
  if (reason != this->LoggedReason)
  {
    vtkVLogF(vtkLogger::VERBOSITY_1, "%s renders by %s%s%s.", vtkLogIdentifier(this),
      reason ? "vtkOpenGLGPUVolumeRayCastMapper" : "vtkSplattingMIPVolumeMapper",
      reason ? ", because " : "", reason ? reason : "");
    this->LoggedReason = reason;
  }
  this->LastRenderUsedSplatting = !reason;
  if (reason)
  {
    this->Superclass::GPURender(ren, this->HasGrays(vol) ? this->StandIn->Volume(vol, ren) : vol);
    return;
  }
  for (const auto& [port, part] : parts)
  {
    if (part != vol)
    {
      const double count = static_cast<double>(parts.size());
      part->SetAllocatedRenderTime(vol->GetAllocatedRenderTime() / count, ren);
    }
    this->GetSplattingMapper(port)->Render(ren, part);
  }
}

//------------------------------------------------------------------------------
void vtkSplattingMIPGPUVolumeRayCastMapper::ForwardMessage(
  vtkObject*, unsigned long event, void* text)
{
  const char* const message = static_cast<const char*>(text);
  if (this->HasObserver(event))
  {
    this->InvokeEvent(event, text);
  }
  else if (event == vtkCommand::ErrorEvent)
  {
    vtkOutputWindowDisplayErrorText(message);
  }
  else
  {
    vtkOutputWindowDisplayWarningText(message);
  }
}

//------------------------------------------------------------------------------
void vtkSplattingMIPGPUVolumeRayCastMapper::ForwardProgress(
  vtkObject*, unsigned long event, void* done)
{
  if (this->ReportProgress)
  {
    this->InvokeEvent(event, done);
  }
}

//------------------------------------------------------------------------------
void vtkSplattingMIPGPUVolumeRayCastMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  for (const auto& each : this->SplattingMappers)
  {
    each.second->ReleaseGraphicsResources(window);
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

//------------------------------------------------------------------------------
void vtkSplattingMIPGPUVolumeRayCastMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "GlobalOverride: " << (GetGlobalOverride() ? "On" : "Off") << "\n";
  os << indent << "GlobalQualityMode: " << globalQualityMode << "\n";
  os << indent << "LastRenderUsedSplatting: " << (this->LastRenderUsedSplatting ? "Yes" : "No")
     << "\n";
  for (const auto& [port, mapper] : this->SplattingMappers)
  {
    os << indent << "SplattingMapper:" << (port ? " port " + std::to_string(port) : "") << "\n";
    mapper->PrintSelf(os, indent.GetNextIndent());
  }
}
VTK_ABI_NAMESPACE_END
