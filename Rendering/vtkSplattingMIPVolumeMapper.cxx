// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPVolumeMapper.h"

#include "Common/RenderTimes.h"
#include "Complaints.h"
#include "ComponentProjector.h"
#include "Geometry/View.h"
#include "MapperSettings.h"
#include "Ranks/RankAgreement.h"
#include "ScalarSource.h"
#include "Scene/RayCastFallback.h"
#include "Scene/SceneCuts.h"
#include "Scene/Selection.h"
#include "Scene/ViewOfVolume.h"
#include "Scene/WinnerLocations.h"
#include "TurnOfViews.h"

#include "vtkCommand.h"
#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkRayCastImageDisplayHelper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkSmartPointer.h"
#include "vtkTimerLog.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <set>
#include <string>

using namespace splatting;

vtkObjectFactoryNewMacro(vtkSplattingMIPVolumeMapper);
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, MaskInput, vtkImageData);
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, Controller, vtkMultiProcessController);

namespace
{
const char* const NoColors =
  "FinalColorWindow and FinalColorLevel give no colours: both must be finite and the window not 0.";

/// Whether a blend mode is splatted; others are ray cast.
bool isProjection(int blendMode)
{
  return blendMode == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND ||
    blendMode == vtkVolumeMapper::MINIMUM_INTENSITY_BLEND ||
    blendMode == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND;
}

const char* nameOfMode(int mode)
{
  static const char* const names[] = { "preview", "standard", "high", "exact" };
  return names[mode];
}

/// Sets a pointer for as long as this lives, whatever is thrown.
class During
{
public:
  During(vtkRenderWindow*& pointer, vtkRenderWindow* value) : Pointer(pointer) { pointer = value; }
  ~During() { this->Pointer = nullptr; }
  During(const During&) = delete;
  During& operator=(const During&) = delete;

private:
  vtkRenderWindow*& Pointer;
};

const char* nameOf(int acceleration)
{
  static const char* const names[] = { "auto", "dense", "bricks", "lines", "sorted lines",
    "sorted volume" };
  return names[acceleration];
}
}

//------------------------------------------------------------------------------
class vtkSplattingMIPVolumeMapper::Internals
{
public:
  std::string Problem(vtkSplattingMIPVolumeMapper* self, vtkVolume* volume);
  std::string ProblemOfSettings(vtkSplattingMIPVolumeMapper* self, vtkVolume* volume);
  std::string ProblemOfRanks(
    vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, vtkVolume* volume, std::string problem);
  const VolumeGrid& Grid() const
  {
    return this->Ranks.AreMany() ? this->Ranks.Grid() : this->Source.Grid();
  }
  void WarnOfIgnored(vtkSplattingMIPVolumeMapper* self);
  void GiveBack();
  void DropRayCaster();
  bool GoOn(vtkSplattingMIPVolumeMapper* self, double done);
  bool AreAsBefore(bool ordered) const;
  bool HasImage() const { return this->Components.IsProjected() && !this->Images.empty(); }
  double IndexTime() const { return this->Source.Time() + this->Components.Time(); }
  bool Factorise(vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, vtkVolume* vol,
    const splatting::View& view, const splatting::ProjectionSettings& settings);
  bool Project(vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, vtkVolume* vol,
    const splatting::View& view, int mode);

  Complaints Reported;
  std::set<std::string> Announced;   // what ray casting leads to, and was told
  bool BudgetReported = false;       // as in: since it was no problem
  bool OpenSurfaceReported = false;  // likewise
  vtkRenderWindow* Window = nullptr; // which may abort, during a render

  RankAgreement Ranks;
  ScalarSource Source;
  ComponentProjector Components;
  SceneCuts Cuts;
  std::vector<splatting::ShearWarp> Images, ImagesBefore; // of the last frame and the one before
  WinnerLocations Locations{ Components, Cuts, Images };
  splatting::Picture Picture;

  vtkIdType Projections = 0;
  int QualityModeUsed = EXACT; // in the last projection that was not aborted
  double ProjectionTime = 0.0;
  double CutTime = 0.0; // of it, to find what cuts the present images
  splatting::RenderTimes Times;
  double IndexTimeBefore = 0.0; // before what the present frame makes of the index
  double Shear[2] = { 0.0, 0.0 };
  vtkSmartPointer<vtkImageData> ShearImageOutput;

  std::unique_ptr<RayCastFallback> RayCaster; // made when first needed: it is megabytes large
};

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::vtkSplattingMIPVolumeMapper()
  : VectorMode(DISABLED),
    VectorComponent(0),
    MaskInput(nullptr),
    Controller(nullptr),
    DisplayOnRootOnly(false),
    QualityMode(EXACT),
    Kernel(TRILINEAR),
    KernelRadius(1.0),
    MaximumType(GLOBAL),
    DepthShadingAmbient(0.3),
    DepthShadingChangeRate(0.7),
    LocalMaximumThreshold(0.0),
    Slab(false),
    SlabThickness(10.0),
    SlabCenter{ 0.0, 0.0, 0.0 },
    BoundingSurface(nullptr),
    IntermixIntersectingGeometry(1),
    FootprintSampling(0),
    ShearImageSampling(SAMPLING_OF_MODE),
    Acceleration(AUTO),
    LineTolerance(0.0),
    EliminateInvisible(false),
    CullBelowWindow(false),
    IndexMemoryBudget(vtkTypeInt64(1) << 32),
    AutoAdjustSampleDistances(1),
    FinalColorWindow(1.0f),
    FinalColorLevel(0.5f),
    LastRenderUsedRayCasting(false),
    RecordLocations(false),
    DepthCoding(false),
    DepthCodingColors(nullptr),
    DepthCodingRange{ 0.0, 0.0 },
    WriteDepth(false),
    WriteDepthOpacity(0.5),
    Internal(new Internals)
{
  splatting::Projector& projector = this->Internal->Components.GetProjector();
  projector.setProgress([this](double done) { this->UpdateProgress(done); });
  projector.setWatch([this](double done) { return this->Internal->GoOn(this, done); });
  this->BlendMode = MAXIMUM_INTENSITY_BLEND;
}

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::~vtkSplattingMIPVolumeMapper()
{
  this->SetDepthCodingColors(nullptr);
  this->SetBoundingSurface(nullptr);
  this->SetMaskInput(nullptr);
  this->SetController(nullptr);
}

//------------------------------------------------------------------------------
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, BoundingSurface, vtkPolyData);
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, DepthCodingColors, vtkScalarsToColors);

//------------------------------------------------------------------------------
// The gate: a sentence that says why this input cannot be rendered and what to do, or nothing.
std::string vtkSplattingMIPVolumeMapper::Internals::Problem(
  vtkSplattingMIPVolumeMapper* self, vtkVolume* volume)
{
  if (volume->IsA("vtkMultiVolume"))
  {
    return "A vtkMultiVolume cannot be splatted: give each of its volumes a mapper of its own.";
  }
  ScalarChoice choice;
  choice.scalarMode = self->ScalarMode;
  choice.arrayAccessMode = self->ArrayAccessMode;
  choice.arrayId = self->ArrayId;
  choice.arrayName = self->ArrayName;
  choice.vectorMode = self->VectorMode;
  choice.vectorComponent = self->VectorComponent;
  choice.independentComponents = volume->GetProperty()->GetIndependentComponents() != 0;
  choice.mask = self->MaskInput;
  if (this->Ranks.Use(self->Controller) && !pieceOf(self))
  {
    return ""; // a rank may hold nothing
  }
  std::string problem = this->Source.Examine(self->GetInput(), choice);
  if (problem.empty() && isFlat(this->Source.Grid(), volume))
  {
    problem =
      "Spacing, direction and prop matrix flatten the volume: none of them may be singular.";
  }
  return problem;
}

//------------------------------------------------------------------------------
// As Problem(), what any rank has to say, once each has looked at its piece. Collective.
std::string vtkSplattingMIPVolumeMapper::Internals::ProblemOfRanks(
  vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, vtkVolume* volume, std::string problem)
{
  RankReport report = reportOf(self, problem);
  if (!report.problem[0] && !report.isEmpty())
  {
    if (this->Components.LookAt(this->Source))
    {
      this->Times.clear();
    }
    describeScalars(this->Components, this->Source, report);
  }
  report.view = viewNumber(self, ren, volume);
  problem = this->Ranks.Agree(report);
  if (problem.empty() && report.isEmpty())
  {
    this->Source.HoldNothing(this->Ranks.Common().vtkType);
    this->Components.LookAtNothing(static_cast<splatting::ScalarType>(this->Ranks.Common().type),
      static_cast<std::size_t>(this->Ranks.Common().components));
  }
  return problem;
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::UpdateWhole()
{
  RankAgreement& ranks = this->Internal->Ranks;
  this->Update();
  if (!ranks.Use(this->Controller))
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
  RankAgreement& ranks = this->Internal->Ranks;
  if (!ranks.Use(this->Controller))
  {
    return this->Superclass::GetBounds();
  }
  if (!ranks.Whole())
  {
    return nullptr; // what has no bounds is not culled
  }
  ranks.Whole()->GetBounds(this->Bounds);
  return this->Bounds;
}

//------------------------------------------------------------------------------
// Tells how much of the projection is done and whether the window wants the rest.
bool vtkSplattingMIPVolumeMapper::Internals::GoOn(vtkSplattingMIPVolumeMapper* self, double done)
{
  done = this->Components.ShareOfAll(done);
  self->InvokeEvent(vtkCommand::VolumeMapperRenderProgressEvent, &done);
  return !this->Window || !this->Window->CheckAbortStatus();
}

//------------------------------------------------------------------------------
// As Problem(): of the mapper's own settings, once the input is known to be good.
std::string vtkSplattingMIPVolumeMapper::Internals::ProblemOfSettings(
  vtkSplattingMIPVolumeMapper* self, vtkVolume* volume)
{
  if (const char* const fault = faultOfSettings(self, volume->GetProperty()))
  {
    return fault;
  }
  const glm::dmat4 toIndex =
    self->BoundingSurface ? worldToIndex(this->Grid(), volume) : glm::dmat4(1.0);
  const char* const fault = this->Cuts.Surface().Update(self->BoundingSurface, toIndex);
  return fault ? fault : "";
}

//------------------------------------------------------------------------------
// Whether this frame's rays are the last one's, and come from the same side where that matters.
bool vtkSplattingMIPVolumeMapper::Internals::AreAsBefore(bool ordered) const
{
  return std::equal(this->Images.begin(), this->Images.end(), this->ImagesBefore.begin(),
    this->ImagesBefore.end(),
    [=](const splatting::ShearWarp& a, const splatting::ShearWarp& b)
    { return a.sameShear(b) && (!ordered || a.reversed() == b.reversed()); });
}

//------------------------------------------------------------------------------
// The images of a view and what cuts them; false if it has no meaning.
bool vtkSplattingMIPVolumeMapper::Internals::Factorise(vtkSplattingMIPVolumeMapper* self,
  vtkRenderer* ren, vtkVolume* vol, const splatting::View& view,
  const splatting::ProjectionSettings& settings)
{
  const double start = vtkTimerLog::GetUniversalTime();
  if (!splatting::ShearWarp::factorise(view, this->Images, settings.sampling, settings.meets))
  {
    return false;
  }
  this->Cuts.Find(view, this->Images, ren, vol, self->IntermixIntersectingGeometry != 0,
    [=](const int origin[2], const int size[2], float* depths)
    { return self->ReadDepth(ren, origin, size, depths); });
  this->CutTime = vtkTimerLog::GetUniversalTime() - start;
  return true;
}

//------------------------------------------------------------------------------
// Projects in this mode, unless the last shear image shows the same, or better within what is
// wanted. False if the view has no meaning. There is no image after an abort.
bool vtkSplattingMIPVolumeMapper::Internals::Project(vtkSplattingMIPVolumeMapper* self,
  vtkRenderer* ren, vtkVolume* vol, const splatting::View& view, int mode)
{
  const int usable = std::clamp(this->QualityModeUsed, mode, self->QualityMode);
  const splatting::ProjectionSettings best = projectionSettings(self, usable, view);
  std::swap(this->Images, this->ImagesBefore);
  if (!this->Factorise(self, ren, vol, view, best))
  {
    return false;
  }
  const bool ordered = splatting::isOrdered(best.reduction) || best.keepWinners ||
    this->Source.AreDependent(); // the nearest of equal samples wins
  const bool isShown =
    this->AreAsBefore(ordered) && this->Cuts.AreKept() && this->Components.Shows(best);
  // Where one rank projects all do.
  if (this->Ranks.AreMany() ? !this->Ranks.Any(!isShown) : isShown)
  {
    return true;
  }
  const splatting::ProjectionSettings wanted = projectionSettings(self, mode, view);
  if (wanted.sampling != best.sampling || wanted.meets != best.meets)
  {
    this->Factorise(self, ren, vol, view, wanted);
  }
  const double start = vtkTimerLog::GetUniversalTime();
  this->ShearImageOutput = nullptr;
  if (this->Components.Project(this->Images, wanted, this->Cuts.Get()))
  {
    this->Cuts.Keep();
    this->ProjectionTime = this->CutTime + vtkTimerLog::GetUniversalTime() - start;
    ++this->Projections;
    this->QualityModeUsed = mode;
  }
  return true;
}

//------------------------------------------------------------------------------
// What is set but means nothing where rays are cast.
void vtkSplattingMIPVolumeMapper::Internals::WarnOfIgnored(vtkSplattingMIPVolumeMapper* self)
{
  if ((self->Slab || self->BoundingSurface) && this->Announced.insert("ignored").second)
  {
    vtkWarningWithObjectMacro(self,
      << "Slab and BoundingSurface mean nothing where a volume is ray cast: it is shown without "
         "them.");
  }
}

//------------------------------------------------------------------------------
// Holds nothing, after a frame that there was no memory for.
void vtkSplattingMIPVolumeMapper::Internals::GiveBack()
{
  this->Source.HoldNothing(VTK_VOID);
  this->Components.HoldNothing();
  this->Picture = {};
  this->ShearImageOutput = nullptr;
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
  const During during(in.Window, ren->GetRenderWindow());
  const vtkIdType projections = in.Projections;
  this->InvokeEvent(vtkCommand::VolumeMapperRenderStartEvent);
  this->Timer->StartTimer();
  this->LastRenderUsedRayCasting = false;
  in.Locations.Forget();
  std::string problem;
  try
  {
    problem = in.Problem(this, vol);
    if (in.Ranks.AreMany())
    {
      problem = in.ProblemOfRanks(this, ren, vol, problem);
    }
    if (problem.empty())
    {
      problem = in.ProblemOfSettings(this, vol);
    }
    if (problem.empty())
    {
      problem = this->RenderBySplatting(ren, vol);
    }
  }
  catch (const std::bad_alloc&)
  {
    problem = ScalarSource::NoMemory;
    in.GiveBack();
    if (in.Ranks.AreMany())
    {
      vtkErrorMacro(<< problem);
      throw; // the other ranks wait for this one
    }
  }
  if (in.Reported.Update(ren, vol, problem))
  {
    vtkErrorMacro(<< problem);
  }
  // The old scalars would stay in memory with it.
  if (!this->LastRenderUsedRayCasting && !in.Source.HasImage())
  {
    in.DropRayCaster();
  }
  this->Timer->StopTimer();
  this->TimeToDraw = this->Timer->GetElapsedTime();
  // Frames that re-use an image say nothing about the next ones, nor does what is made once.
  if (in.Projections != projections)
  {
    in.Times.add({ ren, vol }, this->GetQualityModeUsed(),
      this->TimeToDraw - (in.IndexTime() - in.IndexTimeBefore));
  }
  this->InvokeEvent(vtkCommand::VolumeMapperRenderEndEvent);
}

//------------------------------------------------------------------------------
// Returns what is wrong, or an empty string.
const char* vtkSplattingMIPVolumeMapper::RenderBySplatting(vtkRenderer* ren, vtkVolume* vol)
{
  Internals& in = *this->Internal;
  splatting::View view = makeView(in.Grid(), vol, ren, this);
  // Nothing can be seen in a window that is not shown yet.
  if (view.viewport.x < 1 || view.viewport.y < 1)
  {
    return "";
  }
  const FinalColor finalColor = { this->FinalColorWindow, this->FinalColorLevel };
  if (!finalColor.isValid())
  {
    return NoColors;
  }
  if (!splatting::isFinite(view))
  {
    return TurnOfViews::Degenerate;
  }
  if (in.Source.IsCoarse() && in.Announced.insert("coarse").second)
  {
    vtkWarningMacro(<< "The rectilinear grid is resampled to larger steps than its least, which is "
                       "too small for that: small cells may be lost. Extract a part of it.");
  }
  if (!isProjection(this->BlendMode))
  {
    this->RenderByRayCasting(ren, vol);
    return "";
  }
  if (this->Slab)
  {
    addSlab(view, in.Grid(), vol, this->SlabCenter, this->SlabThickness);
  }
  const bool isOpen = in.Cuts.Surface().IsOpen();
  if (isOpen && !in.OpenSurfaceReported)
  {
    vtkWarningMacro(<< "The bounding surface is not closed: rays that cross it once show nothing. "
                       "Close it, for instance with vtkFillHolesFilter.");
  }
  in.OpenSurfaceReported = isOpen;
  const vtkIdType version = in.Source.Version();
  if (!in.Ranks.AreMany() && in.Components.LookAt(in.Source))
  {
    in.Times.clear(); // changed data of the same kind take what the last ones took
  }
  in.Components.SetBudget(static_cast<std::size_t>(this->IndexMemoryBudget));
  in.Components.SetRanks(in.Ranks.AreMany() ? &in.Ranks : nullptr);
  in.IndexTimeBefore = in.Source.Version() == version ? in.IndexTime() : 0.0;
  in.Components.UpdateColors(
    vol->GetProperty(), finalColor, projectionSettings(this, PREVIEW, view));
  in.Components.SetCullBelowWindow(this->CullBelowWindow);
  // Selection is by what is seen.
  int mode = !this->AutoAdjustSampleDistances ? this->QualityMode
    : ren->GetSelector()
    ? std::min(this->GetQualityModeUsed(), this->QualityMode)
    : in.Times.choose({ ren, vol }, this->QualityMode, vol->GetAllocatedRenderTime());
  mode = in.Ranks.AreMany() ? in.Ranks.Least(mode) : mode;
  if (!in.Project(this, ren, vol, view, mode))
  {
    return TurnOfViews::Degenerate;
  }
  const bool exceeds = in.Components.ExceedsBudget();
  if (exceeds && !in.BudgetReported)
  {
    vtkWarningMacro(<< "An index for fast projection does not fit into IndexMemoryBudget ("
                    << this->IndexMemoryBudget
                    << " bytes): this volume is projected without it. Raise the budget.");
  }
  in.BudgetReported = exceeds;
  if (in.Components.IsProjected())
  {
    in.Components.FindRim(in.Images, in.Cuts.OfProjection(), view);
  }
  if (in.Components.IsProjected() && (!this->DisplayOnRootOnly || in.Ranks.IsRoot()))
  {
    in.Components.Warp(in.Images, view, in.Picture);
    in.Cuts.Hide(in.Picture);
    in.Locations.Remember(view, in.Grid(), vol, ren);
    this->DisplayLocated(ren);
  }
  return "";
}

//------------------------------------------------------------------------------
// The picture, in the colours of depths if they are wanted, and depths.
void vtkSplattingMIPVolumeMapper::DisplayLocated(vtkRenderer* ren)
{
  Internals& in = *this->Internal;
  const bool wanted = this->RecordLocations || this->DepthCoding || this->WriteDepth;
  if (wanted && this->BlendMode == AVERAGE_INTENSITY_BLEND && in.Announced.insert("mean").second)
  {
    vtkWarningMacro(<< "Averages are of all samples of a ray, so that there are no locations of "
                       "one, no depth coding and no depths: choose another blend mode.");
  }
  if (this->DepthCoding && !ren->GetSelector())
  {
    in.Locations.ColorByDepth(in.Picture, this->DepthCodingColors, this->DepthCodingRange);
  }
  this->DisplayPicture(ren);
  if (this->WriteDepth && !in.Picture.pixels.empty())
  {
    this->DisplayDepths(ren, &in.Picture.origin.x, &in.Picture.size.x,
      in.Locations.ClipDepths(in.Picture, this->WriteDepthOpacity).data());
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
  const bool isForGpu = RayCastFallback::IsForGpu(this->BlendMode);
  if (in.Announced.insert("ray casting").second)
  {
    vtkWarningMacro(<< "Rendering by "
                    << (isForGpu ? "vtkGPUVolumeRayCastMapper" : "vtkFixedPointVolumeRayCastMapper")
                    << ", because the blend mode is no intensity projection.");
  }
  // The ray caster's constructor needs an implementation of the display and does not ask whether
  // there is one.
  if (!in.RayCaster && !vtkSmartPointer<vtkRayCastImageDisplayHelper>::New())
  {
    vtkErrorMacro(<< "There is no OpenGL for vtkFixedPointVolumeRayCastMapper, which is needed "
                     "because the blend mode is no intensity projection: initialise "
                     "VTK::RenderingVolumeOpenGL2 with vtk_module_autoinit or "
                     "VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2).");
    return;
  }
  in.WarnOfIgnored(this);
  this->LastRenderUsedRayCasting = true;
  vtkImageData* const image = in.Source.Image();
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
  if (ren->GetSelector() && !isForGpu)
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
// DisplayImage() has said that there is nothing to draw with.
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
  if (!this->RecordLocations)
  {
    vtkErrorMacro(<< "There are no locations: call RecordLocationsOn() before the render.");
    return nullptr;
  }
  return this->Internal->Locations.Image();
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::PickWorldPosition(int x, int y, double position[3])
{
  WinnerLocations::Sample sample;
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
  WinnerLocations::Sample sample;
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
  WinnerLocations::Sample sample;
  return this->Internal->Locations.Pick(x, y, sample) ? sample.value
                                                      : std::numeric_limits<double>::quiet_NaN();
}

//------------------------------------------------------------------------------
vtkImageData* vtkSplattingMIPVolumeMapper::GetShearImage()
{
  Internals& in = *this->Internal;
  if (!in.HasImage())
  {
    in.ShearImageOutput = nullptr;
  }
  else if (!in.ShearImageOutput)
  {
    in.ShearImageOutput = vtkSmartPointer<vtkImageData>::New();
    const std::size_t n = mainImage(in.Images);
    in.Components.CopyImage(
      n, in.Images[n], in.Source.VtkTypeOf(in.Components.ImageType()), in.ShearImageOutput);
  }
  return in.ShearImageOutput;
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetPrincipalAxis()
{
  const Internals& in = *this->Internal;
  return in.HasImage() ? in.Images[mainImage(in.Images)].principalAxis() : -1;
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::GetShear(double shear[2])
{
  const Internals& in = *this->Internal;
  shear[0] = shear[1] = 0.0;
  if (in.HasImage())
  {
    const splatting::ShearWarp& image = in.Images[mainImage(in.Images)];
    shear[0] = -image.columns().slope[image.rayCount().x / 2];
    shear[1] = -image.rows().slope[image.rayCount().y / 2];
  }
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
  return static_cast<vtkIdType>(
    this->Internal->Source.MemorySize() + this->Internal->Components.MemorySize());
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::GetIndexTime()
{
  return this->Internal->IndexTime();
}

//------------------------------------------------------------------------------
vtkIdType vtkSplattingMIPVolumeMapper::GetNumberOfProjections()
{
  return this->Internal->Projections;
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::GetProjectionTime()
{
  return this->Internal->ProjectionTime;
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetInstructionSet()
{
  return splatting::nameOf(this->Internal->Components.Settings().instructionSet);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetAccelerationUsed()
{
  return static_cast<int>(this->Internal->Components.Used());
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetAccelerationAsString()
{
  return nameOf(this->Acceleration);
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetVectorModeAsString()
{
  switch (this->VectorMode)
  {
    case MAGNITUDE:
      return "magnitude";
    case COMPONENT:
      return "component";
    default:
      return "disabled";
  }
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetQualityModeAsString()
{
  return nameOfMode(this->QualityMode);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetQualityModeUsed()
{
  return this->Internal->QualityModeUsed;
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetMaximumTypeAsString()
{
  switch (this->MaximumType)
  {
    case DEPTH_SHADED:
      return "depth shaded";
    case LOCAL:
      return "local";
    default:
      return "global";
  }
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetKernelAsString()
{
  return this->Kernel == COSINE_BELL ? "cosine bell" : "trilinear";
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "VectorMode: " << this->GetVectorModeAsString() << "\n";
  os << indent << "VectorComponent: " << this->VectorComponent << "\n";
  os << indent << "MaskInput: ";
  this->MaskInput ? os << this->MaskInput << "\n" : os << "(none)\n";
  os << indent << "Controller: ";
  this->Controller ? os << this->Controller << "\n" : os << "(none)\n";
  os << indent << "DisplayOnRootOnly: " << (this->DisplayOnRootOnly ? "On" : "Off") << "\n";
  os << indent << "QualityMode: " << this->GetQualityModeAsString() << "\n";
  os << indent << "QualityModeUsed: " << nameOfMode(this->GetQualityModeUsed()) << "\n";
  os << indent << "AutoAdjustSampleDistances: " << (this->AutoAdjustSampleDistances ? "On" : "Off")
     << "\n";
  os << indent << "FinalColorWindow: " << this->FinalColorWindow << "\n";
  os << indent << "FinalColorLevel: " << this->FinalColorLevel << "\n";
  os << indent << "Kernel: " << this->GetKernelAsString() << "\n";
  os << indent << "KernelRadius: " << this->KernelRadius << "\n";
  os << indent << "MaximumType: " << this->GetMaximumTypeAsString() << "\n";
  os << indent << "DepthShadingAmbient: " << this->DepthShadingAmbient << "\n";
  os << indent << "DepthShadingChangeRate: " << this->DepthShadingChangeRate << "\n";
  os << indent << "LocalMaximumThreshold: " << this->LocalMaximumThreshold << "\n";
  os << indent << "Slab: " << (this->Slab ? "On" : "Off") << "\n";
  os << indent << "SlabThickness: " << this->SlabThickness << "\n";
  os << indent << "SlabCenter: " << this->SlabCenter[0] << ", " << this->SlabCenter[1] << ", "
     << this->SlabCenter[2] << "\n";
  os << indent << "BoundingSurface: " << this->BoundingSurface << "\n";
  os << indent
     << "IntermixIntersectingGeometry: " << (this->IntermixIntersectingGeometry ? "On" : "Off")
     << "\n";
  os << indent << "FootprintSampling: " << this->FootprintSampling << "\n";
  os << indent << "ShearImageSampling: ";
  switch (this->ShearImageSampling)
  {
    case SAMPLING_OF_MODE:
      os << "of the mode\n";
      break;
    case AUTOMATIC_SAMPLING:
      os << "automatic\n";
      break;
    default:
      os << this->ShearImageSampling << "\n";
  }
  os << indent << "Acceleration: " << this->GetAccelerationAsString() << "\n";
  os << indent << "AccelerationUsed: " << nameOf(this->GetAccelerationUsed()) << "\n";
  os << indent << "LineTolerance: " << this->LineTolerance << "\n";
  os << indent << "EliminateInvisible: " << (this->EliminateInvisible ? "On" : "Off") << "\n";
  os << indent << "CullBelowWindow: " << (this->CullBelowWindow ? "On" : "Off") << "\n";
  os << indent << "IndexMemoryBudget: " << this->IndexMemoryBudget << "\n";
  os << indent << "LastRenderUsedRayCasting: " << (this->LastRenderUsedRayCasting ? "Yes" : "No")
     << "\n";
  os << indent << "RecordLocations: " << (this->RecordLocations ? "On" : "Off") << "\n";
  os << indent << "DepthCoding: " << (this->DepthCoding ? "On" : "Off") << "\n";
  os << indent << "DepthCodingColors: " << this->DepthCodingColors << "\n";
  os << indent << "DepthCodingRange: " << this->DepthCodingRange[0] << ", "
     << this->DepthCodingRange[1] << "\n";
  os << indent << "WriteDepth: " << (this->WriteDepth ? "On" : "Off") << "\n";
  os << indent << "WriteDepthOpacity: " << this->WriteDepthOpacity << "\n";
  os << indent << "PrincipalAxis: " << this->GetPrincipalAxis() << "\n";
  os << indent << "Shear: " << this->GetShear()[0] << ", " << this->GetShear()[1] << "\n";
  os << indent << "IndexMemorySize: " << this->GetIndexMemorySize() << "\n";
  os << indent << "IndexTime: " << this->GetIndexTime() << "\n";
  os << indent << "NumberOfProjections: " << this->GetNumberOfProjections() << "\n";
  os << indent << "ProjectionTime: " << this->GetProjectionTime() << "\n";
  os << indent << "InstructionSet: " << this->GetInstructionSet() << "\n";
}
