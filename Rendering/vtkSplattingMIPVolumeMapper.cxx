// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPVolumeMapper.h"

#include "Input/ProjectionProperties.h"
#include "Locations/LabelEdges.h"
#include "Locations/SampleLocations.h"
#include "Locations/Selection.h"
#include "MapperProperties.h"
#include "Ranks/FrameObserver.h"
#include "ReportedProblems.h"
#include "Scene/ProjectedVolume.h"
#include "Scene/RayCastFallback.h"
#include "Scene/Validation.h"
#include "Scene/ViewOfVolume.h"
#include "TurnOfViews.h"

#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkRayCastImageDisplayHelper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTimerLog.h"
#include "vtkVolume.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string>

using namespace splatting;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSplattingMIPVolumeMapper);
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, Controller, vtkMultiProcessController);

namespace
{
/// Whether a blend mode is splatted; others are ray cast.
bool isProjection(int blendMode)
{
  return blendMode == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND ||
    blendMode == vtkVolumeMapper::MINIMUM_INTENSITY_BLEND ||
    blendMode == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND;
}

/// Sets a pointer during its lifetime, also if exceptions are thrown.
class ScopedWindow
{
public:
  ScopedWindow(vtkRenderWindow*& pointer, vtkRenderWindow* value) : Pointer(pointer)
  {
    pointer = value;
  }
  ~ScopedWindow() { this->Pointer = nullptr; }
  ScopedWindow(const ScopedWindow&) = delete;
  ScopedWindow& operator=(const ScopedWindow&) = delete;

private:
  vtkRenderWindow*& Pointer;
};
}

//------------------------------------------------------------------------------
class vtkSplattingMIPVolumeMapper::Internals
{
public:
  explicit Internals(vtkSplattingMIPVolumeMapper* self)
    : Observer([=](vtkRenderer* renderer, vtkVolume* volume)
        { this->ReportAbsence(self, renderer, volume); })
  {
  }
  void ReleaseMemory();
  void DropRayCaster();
  bool ReportProgress(vtkSplattingMIPVolumeMapper* self, double done);
  bool IsAborted() const;
  void ReportAbsence(vtkSplattingMIPVolumeMapper* self, vtkRenderer* renderer, vtkVolume* volume);

  ReportedProblems Reported;
  vtkRenderWindow* Window = nullptr; // during a render; may abort it

  FrameObserver Observer; // for several ranks
  ProjectedVolume Data;
  SampleLocations Locations{ Data.Source, Data.Components, Data.Cuts };
  splatting::Picture Picture;
  double Shear[2] = { 0.0, 0.0 };

  LabelEdges Labels;
  std::unique_ptr<RayCastFallback> RayCaster; // created on demand, because it takes megabytes
};

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::vtkSplattingMIPVolumeMapper() : Internal(new Internals(this))
{
  ComponentProjector& components = this->Internal->Data.Components;
  components.GetProjector().setProgress([this](double done) { this->UpdateProgress(done); });
  components.SetObserver(
    [this](double done) { return this->Internal->ReportProgress(this, done); });
  components.SetScreenObserver([this](double) { return !this->Internal->IsAborted(); });
}

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::~vtkSplattingMIPVolumeMapper()
{
  this->SetController(nullptr);
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::UpdateWhole()
{
  RankAgreement& ranks = this->Internal->Data.Ranks;
  this->Update();
  if (!ranks.Use(this->GetController()))
  {
    return true;
  }
  RankReport report;
  if (vtkImageData* const piece = pieceOf(this))
  {
    report.setGrid(piece);
  }
  const std::string problem = ranks.AgreeOnGrid(report);
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
  }
  return problem.empty();
}

//------------------------------------------------------------------------------
double* vtkSplattingMIPVolumeMapper::GetBounds()
{
  RankAgreement& ranks = this->Internal->Data.Ranks;
  if (!ranks.Use(this->GetController()))
  {
    return this->Superclass::GetBounds();
  }
  if (!ranks.Whole())
  {
    return nullptr; // volumes without bounds are not culled
  }
  ranks.Whole()->GetBounds(this->Bounds);
  return this->Bounds;
}

//------------------------------------------------------------------------------
// Reports progress. Returns whether to continue.
bool vtkSplattingMIPVolumeMapper::Internals::ReportProgress(
  vtkSplattingMIPVolumeMapper* self, double done)
{
  done = this->Data.Components.OverallProgress(done);
  self->InvokeEvent(vtkCommand::VolumeMapperRenderProgressEvent, &done);
  return !this->IsAborted();
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::Internals::IsAborted() const
{
  return this->Window && this->Window->CheckAbortStatus();
}

//------------------------------------------------------------------------------
// Reports a frame without the volume to the other ranks, which wait.
void vtkSplattingMIPVolumeMapper::Internals::ReportAbsence(
  vtkSplattingMIPVolumeMapper* self, vtkRenderer* renderer, vtkVolume* volume)
{
  if (volume->GetMapper() != self || !this->Data.Ranks.Use(self->GetController()))
  {
    return;
  }
  const std::string problem = this->Data.Ranks.ReportMissingFrame();
  if (this->Reported.Update(renderer, volume, problem))
  {
    vtkErrorWithObjectMacro(self, << problem);
  }
}

//------------------------------------------------------------------------------
// Releases memory, after a frame that ran out of memory.
void vtkSplattingMIPVolumeMapper::Internals::ReleaseMemory()
{
  this->Data.Clear();
  this->Locations.Forget();
  this->Picture = {};
  this->Labels.Clear();
  this->DropRayCaster();
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::Internals::DropRayCaster()
{
  if (this->RayCaster)
  {
    this->RayCaster->ReleaseGraphicsResources(this->Window);
    this->RayCaster = nullptr;
  }
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::Render(vtkRenderer* ren, vtkVolume* vol)
{
  Internals& in = *this->Internal;
  if (in.Window)
  {
    vtkErrorMacro(<< "An observer of this mapper's render events must not render with it.");
    return;
  }
  const ScopedWindow scoped(in.Window, ren->GetRenderWindow());
  this->InvokeEvent(vtkCommand::VolumeMapperRenderStartEvent);
  this->Timer->StartTimer();
  this->LastRenderUsedRayCasting = false;
  in.Data.BeginFrame();
  in.Labels.BeginFrame(this);
  std::string problem;
  try
  {
    in.Locations.BeginFrame(ren);
    if (in.Data.Ranks.Use(this->GetController()))
    {
      in.Observer.MarkRendered(ren, vol);
    }
    problem = loadAndValidate(this, ren, vol, in.Data);
    if (problem.empty())
    {
      problem = this->RenderBySplatting(ren, vol);
    }
  }
  catch (const std::bad_alloc&)
  {
    problem = ScalarSource::NoMemory;
    in.ReleaseMemory();
    if (in.Data.Ranks.AreMany())
    {
      vtkErrorMacro(<< problem);
      throw; // the other ranks wait for this one
    }
  }
  if (in.Reported.Update(ren, vol, problem))
  {
    vtkErrorMacro(<< problem);
  }
  // It would keep the old scalars in memory.
  if (!this->LastRenderUsedRayCasting && !in.Data.Source.HasImage())
  {
    in.DropRayCaster();
  }
  this->Timer->StopTimer();
  this->TimeToDraw = this->Timer->GetElapsedTime();
  in.Data.EndFrame(ren, vol, this->TimeToDraw);
  this->InvokeEvent(vtkCommand::VolumeMapperRenderEndEvent);
}

//------------------------------------------------------------------------------
// Returns an error message, or an empty string.
const char* vtkSplattingMIPVolumeMapper::RenderBySplatting(vtkRenderer* ren, vtkVolume* vol)
{
  Internals& in = *this->Internal;
  ProjectedVolume& data = in.Data;
  splatting::View view = makeView(data.Grid(), vol, ren, this);
  // A window that is not shown yet has no pixels.
  if (view.viewport.x < 1 || view.viewport.y < 1)
  {
    return "";
  }
  if (!splatting::isFinite(view))
  {
    return TurnOfViews::Degenerate;
  }
  in.Reported.Warn(this, "coarse", data.Source.UsesLargerSteps(),
    "The least step of the rectilinear grid is too small for resampling. It is resampled with "
    "larger steps, so that small cells may be lost: extract a part of it.");
  const bool isRayCast = !isProjection(this->BlendMode);
  in.Reported.Warn(this, "ray casting", isRayCast,
    std::string("Rendering by ") +
      (RayCastFallback::IsForGpu(this->BlendMode) ? "vtkGPUVolumeRayCastMapper"
                                                  : "vtkFixedPointVolumeRayCastMapper") +
      ", because the blend mode is no intensity projection.");
  if (isRayCast)
  {
    this->RenderByRayCasting(ren, vol);
    return "";
  }
  if (this->GetSlab())
  {
    addSlab(view, data.Grid(), vol, this->GetSlabCenter(), this->GetSlabThickness());
  }
  in.Reported.Warn(this, "open surface", data.Cuts.Surface().IsOpen(),
    "The bounding surface is not closed: rays that cross it once show nothing. Close it, for "
    "instance with vtkFillHolesFilter.");
  data.Prepare(this, view, vol);
  if (const char* const fault =
        data.Components.ValidateVoxels(static_cast<Quality>(this->GetQualityMode())))
  {
    return fault;
  }
  const auto readDepth = [this, ren](const int origin[2], const int size[2], float* depths)
  { return this->ReadDepth(ren, origin, size, depths); };
  if (!data.Project(this, view, ren, vol, readDepth))
  {
    return TurnOfViews::Degenerate;
  }
  in.Reported.Warn(this, "budget", data.Components.ExceedsBudget(),
    "An index for fast projection does not fit into IndexMemoryBudget (" +
      std::to_string(this->GetIndexMemoryBudget()) +
      " bytes): this volume is projected without it. Raise the budget.");
  if (data.Components.IsProjected() && (!this->DisplayOnRootOnly || data.Ranks.IsRoot()) &&
    data.Components.MakePicture(view, in.Picture))
  {
    data.Cuts.Hide(in.Picture);
    in.Locations.Remember(view, data.Grid(), vol, ren);
    this->DisplayLocated(ren);
  }
  return "";
}

//------------------------------------------------------------------------------
// Displays the picture, coloured by depth if DepthCoding is on, and its depths.
void vtkSplattingMIPVolumeMapper::DisplayLocated(vtkRenderer* ren)
{
  Internals& in = *this->Internal;
  in.Reported.Warn(this, "mean", needsLocations(this) && this->BlendMode == AVERAGE_INTENSITY_BLEND,
    "An average is computed from all samples of a ray, so it has no location, no depth coding, no "
    "label of a sample and no depth: choose another blend mode.");
  if (this->GetDepthCoding() && !ren->GetSelector())
  {
    in.Locations.ColorByDepth(
      in.Picture, this->GetDepthCodingColors(), this->GetDepthCodingRange());
  }
  if (!ren->GetSelector())
  {
    in.Labels.Draw(this, in.Locations, in.Data.Cuts, in.Picture);
  }
  this->DisplayPicture(ren);
  if (this->GetWriteDepth() && !in.Picture.pixels.empty())
  {
    this->DisplayDepths(ren, &in.Picture.origin.x, &in.Picture.size.x,
      in.Locations.ClipDepths(in.Picture, this->GetWriteDepthOpacity()).data());
  }
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::DisplayPicture(vtkRenderer* ren)
{
  splatting::Picture& picture = this->Internal->Picture;
  if (picture.pixels.empty())
  {
    return;
  }
  if (vtkHardwareSelector* const selector = ren->GetSelector())
  {
    drawIdentifiers(selector, picture);
  }
  this->DisplayImage(ren, &picture.origin.x, &picture.size.x,
    reinterpret_cast<const unsigned char*>(picture.pixels.data()));
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::RenderByRayCasting(vtkRenderer* ren, vtkVolume* vol)
{
  Internals& in = *this->Internal;
  // The ray caster's constructor needs an implementation of the display, and does not check it.
  if (!in.RayCaster && !vtkSmartPointer<vtkRayCastImageDisplayHelper>::New())
  {
    vtkErrorMacro(<< "There is no OpenGL for vtkFixedPointVolumeRayCastMapper, which is needed "
                     "because the blend mode is no intensity projection: initialise "
                     "VTK::RenderingVolumeOpenGL2 with vtk_module_autoinit or "
                     "VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2).");
    return;
  }
  in.Reported.Warn(this, "ignored", this->GetSlab() || this->GetBoundingSurface(),
    "Slab and BoundingSurface are ignored by ray casters: choose an intensity projection as the "
    "blend mode.");
  this->LastRenderUsedRayCasting = true;
  vtkImageData* const image = in.Data.Source.Image();
  if (!image)
  {
    return; // no voxel is shown
  }
  const int components = image->GetNumberOfScalarComponents();
  if (in.RayCaster && in.RayCaster->Components != components)
  {
    in.DropRayCaster();
  }
  if (!in.RayCaster)
  {
    in.RayCaster = std::make_unique<RayCastFallback>(components);
  }
  if (ren->GetSelector() && !RayCastFallback::IsForGpu(this->BlendMode))
  {
    in.RayCaster->FindMask(this, image, ren, vol, in.Picture);
    this->DisplayPicture(ren);
  }
  else
  {
    in.RayCaster->Render(this, image, ren, vol);
  }
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::DisplayImage(
  vtkRenderer*, const int*, const int*, const unsigned char*)
{
  vtkErrorMacro(<< "There is no OpenGL to draw with: initialise the module with "
                   "vtk_module_autoinit or VTK_MODULE_INIT(vtkRenderingSplattingMIP).");
}

//------------------------------------------------------------------------------
// DisplayImage() has reported the error.
void vtkSplattingMIPVolumeMapper::DisplayDepths(vtkRenderer*, const int*, const int*, const float*)
{
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::ReadDepth(
  vtkRenderer* ren, const int origin[2], const int size[2], float* depths)
{
  int width, height, left, bottom;
  ren->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  const int x = left + origin[0], y = bottom + origin[1];
  return ren->GetRenderWindow()->GetZbufferData(x, y, x + size[0] - 1, y + size[1] - 1, depths) ==
    VTK_OK;
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  if (this->Internal->RayCaster)
  {
    this->Internal->RayCaster->ReleaseGraphicsResources(window);
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

//------------------------------------------------------------------------------
vtkImageData* vtkSplattingMIPVolumeMapper::GetLocations()
{
  if (!this->GetRecordLocations())
  {
    vtkErrorMacro(<< "There are no locations: call RecordLocationsOn() before the render.");
    return nullptr;
  }
  return this->Internal->Locations.Image();
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::PickWorldPosition(int x, int y, double position[3])
{
  SampleLocations::Sample sample;
  if (!this->Internal->Locations.Pick(x, y, sample))
  {
    return false;
  }
  std::copy(&sample.position.x, &sample.position.x + 3, position);
  return true;
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::PickVoxel(int x, int y, int ijk[3])
{
  SampleLocations::Sample sample;
  if (!this->Internal->Locations.Pick(x, y, sample))
  {
    return false;
  }
  std::copy(&sample.voxel.x, &sample.voxel.x + 3, ijk);
  return true;
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::PickValue(int x, int y)
{
  SampleLocations::Sample sample;
  return this->Internal->Locations.Pick(x, y, sample) ? sample.value
                                                      : std::numeric_limits<double>::quiet_NaN();
}

//------------------------------------------------------------------------------
vtkImageData* vtkSplattingMIPVolumeMapper::GetShearImage()
{
  return this->Internal->Data.Components.ShearImageOf(this->Internal->Data.Source);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetPrincipalAxis()
{
  const splatting::ShearWarp* const image = this->Internal->Data.Components.MainImage();
  return image ? image->principalAxis() : -1;
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::GetShear(double shear[2])
{
  const splatting::ShearWarp* const image = this->Internal->Data.Components.MainImage();
  shear[0] = image ? -image->columns().slope[image->rayCount().x / 2] : 0.0;
  shear[1] = image ? -image->rows().slope[image->rayCount().y / 2] : 0.0;
}

//------------------------------------------------------------------------------
double* vtkSplattingMIPVolumeMapper::GetShear()
{
  this->GetShear(this->Internal->Shear);
  return this->Internal->Shear;
}

//------------------------------------------------------------------------------
vtkIdType vtkSplattingMIPVolumeMapper::GetIndexMemorySize()
{
  const Internals& in = *this->Internal;
  return static_cast<vtkIdType>(in.Data.IndexMemorySize() + in.Labels.MemorySize());
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::GetIndexTime()
{
  return this->Internal->Data.IndexTime();
}

//------------------------------------------------------------------------------
vtkIdType vtkSplattingMIPVolumeMapper::GetNumberOfProjections()
{
  return this->Internal->Data.NumberOfProjections();
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::GetProjectionTime()
{
  return this->Internal->Data.ProjectionTime();
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetInstructionSet()
{
  return splatting::nameOf(this->Internal->Data.Components.Settings().instructionSet);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetAccelerationUsed()
{
  return static_cast<int>(this->Internal->Data.Components.Used());
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetQualityModeUsed()
{
  return this->Internal->Data.QualityModeUsed();
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const double* const shear = this->GetShear();
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "DisplayOnRootOnly: " << (this->DisplayOnRootOnly ? "On\n" : "Off\n");
  os << indent << "QualityModeUsed: " << nameOfQualityMode(this->GetQualityModeUsed()) << "\n";
  os << indent << "AccelerationUsed: " << nameOfAcceleration(this->GetAccelerationUsed()) << "\n";
  os << indent << "LastRenderUsedRayCasting: " << (this->LastRenderUsedRayCasting ? "Yes" : "No")
     << "\n";
  os << indent << "PrincipalAxis: " << this->GetPrincipalAxis() << "\n";
  os << indent << "Shear: (" << shear[0] << ", " << shear[1] << ")\n";
  os << indent << "IndexMemorySize: " << this->GetIndexMemorySize() << "\n";
  os << indent << "IndexTime: " << this->GetIndexTime() << "\n";
  os << indent << "NumberOfProjections: " << this->GetNumberOfProjections() << "\n";
  os << indent << "ProjectionTime: " << this->GetProjectionTime() << "\n";
  os << indent << "InstructionSet: " << this->GetInstructionSet() << "\n";
}
VTK_ABI_NAMESPACE_END
