// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPVolumeMapper.h"

#include "BoundingSurface.h"
#include "Project.h"
#include "RayCastFallback.h"
#include "RenderTimes.h"
#include "ScalarSource.h"
#include "SceneDepth.h"
#include "Selection.h"
#include "ShearWarp.h"
#include "TransferFunctions.h"
#include "View.h"
#include "ViewOfVolume.h"
#include "VolumeIndex.h"
#include "Warp.h"

#include "vtkCommand.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkRayCastImageDisplayHelper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTimerLog.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <vector>

vtkObjectFactoryNewMacro(vtkSplattingMIPVolumeMapper);
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, MaskInput, vtkImageData);

namespace
{
const char* const DegenerateCamera =
  "The camera flattens the volume to a line or has no extent: give it a parallel scale above 0 and "
  "a view-up that is not its direction.";
const char* const NoColors =
  "FinalColorWindow and FinalColorLevel give no colours: both must be finite and the window not 0.";

const char* nameOfMode(int mode)
{
  static const char* const names[] = { "preview", "standard", "high" };
  return names[mode];
}

splatting::Reduction reductionOf(int blendMode, int maximumType)
{
  switch (blendMode)
  {
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return splatting::Reduction::Minimum;
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      return splatting::Reduction::Mean;
    default:
      return maximumType == vtkSplattingMIPVolumeMapper::DEPTH_SHADED
        ? splatting::Reduction::DepthShaded
        : maximumType == vtkSplattingMIPVolumeMapper::LOCAL ? splatting::Reduction::Local
                                                            : splatting::Reduction::Maximum;
  }
}

/// Whether it matters which end of a ray is nearest to the viewer.
bool isOrdered(splatting::Reduction reduction)
{
  return reduction == splatting::Reduction::DepthShaded || reduction == splatting::Reduction::Local;
}

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
  const char* ReasonToRayCast(
    vtkSplattingMIPVolumeMapper* self, vtkVolume* volume, const splatting::View& view);
  void LookAtVolumes();
  bool SetBudget(std::size_t bytes);
  bool ExceedsBudget() const;
  double IndexTime() const;
  bool GoOn(vtkSplattingMIPVolumeMapper* self, double done);
  bool Shows(vtkSplattingMIPVolumeMapper* self, const splatting::ShearWarp& geometry,
    splatting::Quality quality) const;
  std::string ProblemOfCuts(vtkSplattingMIPVolumeMapper* self, vtkVolume* volume);
  void CaptureDepth(vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren,
    const splatting::View& view, const splatting::ShearWarp& geometry);
  void FindCuts(vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, const splatting::View& view,
    const splatting::ShearWarp& geometry);
  bool Project(
    vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, const splatting::View& view, int mode);
  void UpdateColors(vtkVolumeProperty* property, const FinalColor& finalColor);
  void Warp(const splatting::View& view);
  void CopyShearImage(vtkImageData* output) const;

  std::string Reported;              // the last problem, so that each is told once
  std::set<std::string> Announced;   // reasons to ray cast that were told
  vtkRenderWindow* Window = nullptr; // which may abort, during a render

  ScalarSource Source;
  vtkIdType IndexedVersion = 0; // of the source

  /// One for each component that is projected.
  struct Channel
  {
    splatting::VolumeIndex Index;
    splatting::ColorTable Colors;
    splatting::ProjectionSettings Settings;
    splatting::ShearImage Image;
    splatting::Acceleration Used = splatting::Acceleration::Dense;

    splatting::ProjectionSettings MakeSettings(vtkSplattingMIPVolumeMapper* self) const;
    double FloorOfWindow() const;
  };
  std::vector<Channel> Channels = std::vector<Channel>(1);
  std::size_t Projected = 0; // of these in the present frame

  splatting::Projector Projector;
  splatting::ShearWarp Geometry;
  bool BudgetReported = false;
  splatting::Cuts Cuts, LastCuts;
  std::vector<glm::dvec4> HalfSpaces; // in pixels
  ::BoundingSurface Surface;
  bool OpenSurfaceReported = false;
  splatting::SceneDepth Depth;
  const vtkRenderer* DepthOf = nullptr; // only compared
  bool ImageValid = false;
  vtkIdType Projections = 0;
  double ProjectionTime = 0.0;
  splatting::RenderTimes Times;
  double IndexTimeBefore = 0.0; // before what the present frame makes of the index
  double Shear[2] = { 0.0, 0.0 };
  vtkSmartPointer<vtkImageData> ShearImageOutput;

  vtkVolumeProperty* ColoredBy = nullptr;
  vtkMTimeType ColorTime = 0;
  FinalColor ColoredFor;
  bool ColorsValid = false;
  splatting::Warper Warper;
  splatting::Picture Picture;
  splatting::Picture Layer; // of one component

  std::unique_ptr<RayCastFallback> RayCaster; // made when first needed: it is megabytes large
};

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::vtkSplattingMIPVolumeMapper()
  : VectorMode(DISABLED),
    VectorComponent(0),
    MaskInput(nullptr),
    QualityMode(HIGH),
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
    Acceleration(AUTO),
    LineTolerance(0.0),
    EliminateInvisible(false),
    CullBelowWindow(false),
    IndexMemoryBudget(vtkTypeInt64(1) << 32),
    AutoAdjustSampleDistances(1),
    FinalColorWindow(1.0f),
    FinalColorLevel(0.5f),
    LastRenderUsedRayCasting(false),
    Internal(new Internals)
{
  this->Internal->Projector.setProgress([this](double done) { this->UpdateProgress(done); });
  this->Internal->Projector.setWatch(
    [this](double done) { return this->Internal->GoOn(this, done); });
  this->BlendMode = MAXIMUM_INTENSITY_BLEND;
}

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::~vtkSplattingMIPVolumeMapper()
{
  this->SetBoundingSurface(nullptr);
  this->SetMaskInput(nullptr);
}

//------------------------------------------------------------------------------
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, BoundingSurface, vtkPolyData);

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
  std::string problem = this->Source.Examine(self->GetInput(), choice);
  if (problem.empty() && isFlat(this->Source.Grid(), volume))
  {
    problem =
      "Spacing, direction and prop matrix flatten the volume: none of them may be singular.";
  }
  return problem;
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::Internals::ReasonToRayCast(
  vtkSplattingMIPVolumeMapper* self, vtkVolume*, const splatting::View& view)
{
  if (self->BlendMode != MAXIMUM_INTENSITY_BLEND && self->BlendMode != MINIMUM_INTENSITY_BLEND &&
    self->BlendMode != AVERAGE_INTENSITY_BLEND)
  {
    return "the blend mode is no intensity projection";
  }
  if (this->Source.AreDependent())
  {
    return "the scalars have several components that are dependent";
  }
  if (!splatting::isParallel(view))
  {
    return "the camera is perspective";
  }
  return nullptr;
}

//------------------------------------------------------------------------------
// Points the indices at the volumes, anew if these changed.
void vtkSplattingMIPVolumeMapper::Internals::LookAtVolumes()
{
  this->Source.Update();
  if (this->IndexedVersion == this->Source.Version())
  {
    return;
  }
  const splatting::VoxelArray before = this->Channels.front().Index.volume();
  const splatting::VoxelArray now = this->Source.Volume(0);
  const std::size_t components = this->Source.Components();
  if (before.dimensions != now.dimensions || before.type != now.type ||
    this->Channels.size() != components)
  {
    this->Times.clear(); // those of other sizes; changed data take what the last ones took
  }
  this->IndexedVersion = this->Source.Version();
  this->Channels.resize(components);
  for (std::size_t c = 0; c < components; ++c)
  {
    this->Channels[c].Index.reset(this->Source.Volume(static_cast<int>(c)));
  }
  this->ImageValid = false;
  this->ShearImageOutput = nullptr;
  this->ColorsValid = false;
}

//------------------------------------------------------------------------------
// Every component gets the same share. Returns whether the budget changed.
bool vtkSplattingMIPVolumeMapper::Internals::SetBudget(std::size_t bytes)
{
  bool changed = false;
  for (Channel& channel : this->Channels)
  {
    changed = channel.Index.setBudget(bytes / this->Channels.size()) || changed;
  }
  return changed;
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPVolumeMapper::Internals::ExceedsBudget() const
{
  return std::any_of(this->Channels.begin(), this->Channels.end(),
    [](const Channel& channel) { return channel.Index.exceedsBudget(); });
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::Internals::IndexTime() const
{
  double seconds = this->Source.Time();
  for (const Channel& channel : this->Channels)
  {
    seconds += channel.Index.time();
  }
  return seconds;
}

//------------------------------------------------------------------------------
splatting::ProjectionSettings vtkSplattingMIPVolumeMapper::Internals::Channel::MakeSettings(
  vtkSplattingMIPVolumeMapper* self) const
{
  splatting::ProjectionSettings settings;
  settings.quality = static_cast<splatting::Quality>(self->QualityMode);
  settings.reduction = reductionOf(self->BlendMode, self->MaximumType);
  settings.ambient = self->DepthShadingAmbient;
  settings.changeRate = self->DepthShadingChangeRate;
  settings.threshold = self->LocalMaximumThreshold;
  settings.meanLow = self->AverageIPScalarRange[0];
  settings.meanHigh = self->AverageIPScalarRange[1];
  settings.kernel = { self->Kernel == COSINE_BELL ? splatting::Reconstruction::CosineBell
                                                  : splatting::Reconstruction::Hat,
    self->KernelRadius };
  settings.footprintSampling = self->FootprintSampling;
  settings.acceleration = static_cast<splatting::Acceleration>(self->Acceleration);
  settings.lineTolerance = self->LineTolerance;
  settings.eliminateInvisible = self->EliminateInvisible;
  if (self->CullBelowWindow)
  {
    settings.floor = this->FloorOfWindow();
  }
  return settings;
}

//------------------------------------------------------------------------------
// The scalar up to which all have the colour of the lowest.
double vtkSplattingMIPVolumeMapper::Internals::Channel::FloorOfWindow() const
{
  const std::vector<std::uint32_t>& colors = this->Colors.colors;
  const auto last = std::adjacent_find(colors.begin(), colors.end(), std::not_equal_to<>());
  const double steps = std::max<double>(static_cast<double>(colors.size()) - 1.0, 1.0);
  const double share =
    last == colors.end() ? 1.0 : static_cast<double>(last - colors.begin()) / steps;
  return this->Colors.low + share * (this->Colors.high - this->Colors.low);
}

//------------------------------------------------------------------------------
// Tells how much of the projection is done and whether the window wants the rest.
bool vtkSplattingMIPVolumeMapper::Internals::GoOn(vtkSplattingMIPVolumeMapper* self, double done)
{
  const double projected = static_cast<double>(this->Projected);
  done = (projected + done) / static_cast<double>(this->Channels.size());
  self->InvokeEvent(vtkCommand::VolumeMapperRenderProgressEvent, &done);
  return !this->Window || !this->Window->CheckAbortStatus();
}

//------------------------------------------------------------------------------
// As Problem(): of slab and bounding surface, once the input is known to be good.
std::string vtkSplattingMIPVolumeMapper::Internals::ProblemOfCuts(
  vtkSplattingMIPVolumeMapper* self, vtkVolume* volume)
{
  const double* const centre = self->SlabCenter;
  if (self->Slab && !(self->SlabThickness > 0.0))
  {
    return "The slab is not thicker than 0: give it a SlabThickness in world units.";
  }
  if (self->Slab && !std::all_of(centre, centre + 3, [](double x) { return std::isfinite(x); }))
  {
    return "The slab's centre is not finite: set SlabCenter to a point of the world.";
  }
  const glm::dmat4 toIndex =
    self->BoundingSurface ? worldToIndex(this->Source.Grid(), volume) : glm::dmat4(1.0);
  const char* const fault = this->Surface.Update(self->BoundingSurface, toIndex);
  return fault ? fault : "";
}

//------------------------------------------------------------------------------
// The depths of what has been rendered where the volume will be seen, if there is anything.
void vtkSplattingMIPVolumeMapper::Internals::CaptureDepth(vtkSplattingMIPVolumeMapper* self,
  vtkRenderer* ren, const splatting::View& view, const splatting::ShearWarp& geometry)
{
  splatting::placePicture(geometry, view.viewport, this->Picture);
  const glm::ivec2& origin = this->Picture.origin;
  const glm::ivec2& size = this->Picture.size;
  // Selection is by what is seen: its passes draw other depths than frames.
  if (ren->GetSelector() && this->DepthOf == ren && this->Depth.isOf(origin, size))
  {
    this->Depth.place(view, geometry, this->HalfSpaces);
    return;
  }
  this->Depth.clear();
  this->DepthOf = ren;
  // Renderers that keep the depths of a lower layer have something to intermix with, too.
  if (!self->IntermixIntersectingGeometry ||
    (ren->GetNumberOfPropsRendered() < 1 && !ren->GetPreserveDepthBuffer()) || ren->GetSelector() ||
    size.x < 1 || size.y < 1)
  {
    return;
  }
  float* const depths = this->Depth.allocate(origin, size);
  const float* const end = depths + std::size_t(size.x) * size.y;
  if (!self->ReadDepth(ren, &origin.x, &size.x, depths) ||
    std::all_of<const float*>(depths, end, [](float depth) { return depth >= 1.0f; }))
  {
    this->Depth.clear();
    return;
  }
  this->Depth.place(view, geometry, this->HalfSpaces);
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::Internals::FindCuts(vtkSplattingMIPVolumeMapper* self,
  vtkRenderer* ren, const splatting::View& view, const splatting::ShearWarp& geometry)
{
  this->Cuts.cropping = view.cropping;
  this->HalfSpaces.clear();
  for (const glm::dvec4& h : view.halfSpaces)
  {
    this->HalfSpaces.push_back(geometry.inPixels(h));
  }
  splatting::ClosedSurface* const surface = this->Surface.Get();
  if (surface)
  {
    surface->project(geometry);
  }
  this->CaptureDepth(self, ren, view, geometry);
  this->Cuts.intervals.find(
    geometry, this->HalfSpaces, surface, this->Depth.empty() ? nullptr : &this->Depth);
}

//------------------------------------------------------------------------------
// Whether the last shear image is what this asks for; the cuts are found already.
bool vtkSplattingMIPVolumeMapper::Internals::Shows(vtkSplattingMIPVolumeMapper* self,
  const splatting::ShearWarp& geometry, splatting::Quality quality) const
{
  const bool turned = geometry.reversed() != this->Geometry.reversed();
  return this->ImageValid && geometry.sameShear(this->Geometry) && this->Cuts == this->LastCuts &&
    std::all_of(this->Channels.begin(), this->Channels.end(),
      [=](const Channel& channel)
      {
        splatting::ProjectionSettings settings = channel.MakeSettings(self);
        settings.quality = quality;
        return settings == channel.Settings && !(turned && isOrdered(settings.reduction));
      });
}

//------------------------------------------------------------------------------
// Projects in this mode, unless the last shear image shows the same, or better within what is
// wanted. False if the view has no meaning. There is no valid image after an abort.
bool vtkSplattingMIPVolumeMapper::Internals::Project(
  vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, const splatting::View& view, int mode)
{
  const splatting::ShearWarp geometry(view);
  if (!geometry.valid())
  {
    return false;
  }
  const double start = vtkTimerLog::GetUniversalTime();
  this->FindCuts(self, ren, view, geometry);
  const bool same = this->Shows(self, geometry,
    std::clamp(this->Channels.front().Settings.quality, static_cast<splatting::Quality>(mode),
      static_cast<splatting::Quality>(self->QualityMode)));
  this->Geometry = geometry;
  if (same)
  {
    return true;
  }
  this->ImageValid = false;
  this->ShearImageOutput = nullptr;
  for (this->Projected = 0; this->Projected < this->Channels.size(); ++this->Projected)
  {
    Channel& channel = this->Channels[this->Projected];
    channel.Settings = channel.MakeSettings(self);
    channel.Settings.quality = static_cast<splatting::Quality>(mode);
    const splatting::Acceleration used =
      this->Projector.project(channel.Index, geometry, channel.Settings, this->Cuts, channel.Image);
    if (this->Projector.stopped())
    {
      return true;
    }
    channel.Used = used;
  }
  std::swap(this->Cuts, this->LastCuts);
  this->ProjectionTime = vtkTimerLog::GetUniversalTime() - start;
  this->ImageValid = true;
  ++this->Projections;
  return true;
}

//------------------------------------------------------------------------------
// Transfer functions to tables of colours.
void vtkSplattingMIPVolumeMapper::Internals::UpdateColors(
  vtkVolumeProperty* property, const FinalColor& finalColor)
{
  if (this->ColorsValid && this->ColoredBy == property && this->ColorTime == property->GetMTime() &&
    this->ColoredFor == finalColor)
  {
    return;
  }
  const int components = static_cast<int>(this->Channels.size());
  for (int c = 0; c < components; ++c)
  {
    Channel& channel = this->Channels[c];
    const splatting::VolumeIndex::Range& range = channel.Index.range();
    const double weight = components > 1 ? property->GetComponentWeight(c) : 1.0;
    channel.Colors = tabulateColors(property, c, weight, range.low, range.high,
      channel.Index.volume().type < splatting::ScalarType::Float32, finalColor);
  }
  this->ColoredFor = finalColor;
  this->ColoredBy = property;
  this->ColorTime = property->GetMTime();
  this->ColorsValid = true;
}

//------------------------------------------------------------------------------
// Every component by itself; their colours add up.
void vtkSplattingMIPVolumeMapper::Internals::Warp(const splatting::View& view)
{
  for (Channel& channel : this->Channels)
  {
    const bool first = &channel == &this->Channels.front();
    this->Warper.warp(channel.Image, this->Geometry, channel.Colors, view.viewport,
      channel.Settings.instructionSet, first ? this->Picture : this->Layer);
    if (!first)
    {
      splatting::addSaturated(this->Layer, this->Picture);
    }
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
  in.Window = ren->GetRenderWindow();
  const vtkIdType projections = in.Projections;
  this->InvokeEvent(vtkCommand::VolumeMapperRenderStartEvent);
  this->Timer->StartTimer();
  this->LastRenderUsedRayCasting = false;
  std::string problem = in.Problem(this, vol);
  if (problem.empty())
  {
    problem = in.ProblemOfCuts(this, vol);
  }
  if (problem.empty())
  {
    problem = this->RenderBySplatting(ren, vol);
  }
  // Told once, not in every frame.
  if (!problem.empty() && problem != in.Reported)
  {
    vtkErrorMacro(<< problem);
  }
  in.Reported = problem;
  this->Timer->StopTimer();
  this->TimeToDraw = this->Timer->GetElapsedTime();
  // Frames that re-use an image say nothing about the next ones, nor does what is made once.
  if (in.Projections != projections)
  {
    in.Times.add({ ren, vol }, this->GetQualityModeUsed(),
      this->TimeToDraw - (in.IndexTime() - in.IndexTimeBefore));
  }
  this->InvokeEvent(vtkCommand::VolumeMapperRenderEndEvent);
  in.Window = nullptr;
}

//------------------------------------------------------------------------------
// Returns what is wrong, or an empty string.
const char* vtkSplattingMIPVolumeMapper::RenderBySplatting(vtkRenderer* ren, vtkVolume* vol)
{
  Internals& in = *this->Internal;
  splatting::View view = makeView(in.Source.Grid(), vol, ren, this);
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
    return DegenerateCamera;
  }
  if (const char* reason = in.ReasonToRayCast(this, vol, view))
  {
    this->RenderByRayCasting(ren, vol, reason);
    return "";
  }
  if (this->Slab)
  {
    addSlab(view, in.Source.Grid(), vol, this->SlabCenter, this->SlabThickness);
  }
  if (in.Surface.IsOpen() && !in.OpenSurfaceReported)
  {
    vtkWarningMacro(<< "The bounding surface is not closed: rays that cross it once show nothing. "
                       "Close it, for instance with vtkFillHolesFilter.");
  }
  in.OpenSurfaceReported = in.Surface.IsOpen();
  const vtkIdType version = in.IndexedVersion;
  in.LookAtVolumes();
  if (in.SetBudget(static_cast<std::size_t>(this->IndexMemoryBudget)))
  {
    in.ImageValid = false; // so that the answer to "what was used" is right
  }
  in.IndexTimeBefore = in.IndexedVersion == version ? in.IndexTime() : 0.0;
  in.UpdateColors(vol->GetProperty(), finalColor);
  // Selection is by what is seen.
  const int mode = !this->AutoAdjustSampleDistances ? this->QualityMode
    : ren->GetSelector()
    ? std::min(this->GetQualityModeUsed(), this->QualityMode)
    : in.Times.choose({ ren, vol }, this->QualityMode, vol->GetAllocatedRenderTime());
  if (!in.Project(this, ren, view, mode))
  {
    return DegenerateCamera;
  }
  if (in.ExceedsBudget() && !in.BudgetReported)
  {
    vtkWarningMacro(<< "An index for fast projection does not fit into IndexMemoryBudget ("
                    << this->IndexMemoryBudget
                    << " bytes): this volume is projected without it. Raise the budget.");
  }
  in.BudgetReported = in.ExceedsBudget();
  if (in.ImageValid)
  {
    in.Warp(view);
    in.Depth.hide(in.Picture);
    this->DisplayPicture(ren);
  }
  return "";
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
void vtkSplattingMIPVolumeMapper::RenderByRayCasting(
  vtkRenderer* ren, vtkVolume* vol, const char* reason)
{
  Internals& in = *this->Internal;
  if (in.Announced.insert(reason).second)
  {
    vtkWarningMacro(<< "Rendering by vtkFixedPointVolumeRayCastMapper, because " << reason << ".");
  }
  if (!in.RayCaster)
  {
    // Its constructor needs an implementation of the display and does not ask whether there is one.
    if (!vtkSmartPointer<vtkRayCastImageDisplayHelper>::New())
    {
      vtkErrorMacro(<< "There is no OpenGL for vtkFixedPointVolumeRayCastMapper, which is needed "
                       "because "
                    << reason
                    << ": initialise VTK::RenderingVolumeOpenGL2 with vtk_module_autoinit or "
                       "VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2).");
      return;
    }
    in.RayCaster = std::make_unique<RayCastFallback>();
  }
  if ((this->Slab || this->BoundingSurface) && in.Announced.insert("slab").second)
  {
    vtkWarningMacro(<< "Slab and BoundingSurface cut nothing where a volume is ray cast: use a "
                       "parallel projection.");
  }
  if (ren->GetSelector())
  {
    in.RayCaster->FindMask(this, in.Source.Image(), ren, vol, in.Picture);
    this->DisplayPicture(ren);
  }
  else
  {
    in.RayCaster->Render(this, in.Source.Image(), ren, vol);
  }
  this->LastRenderUsedRayCasting = true;
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::DisplayImage(
  vtkRenderer*, const int*, const int*, const unsigned char*)
{
  vtkErrorMacro(<< "There is no OpenGL to draw with: initialise the module with "
                   "vtk_module_autoinit or VTK_MODULE_INIT(vtkRenderingSplattingMIP).");
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
void vtkSplattingMIPVolumeMapper::Internals::CopyShearImage(vtkImageData* output) const
{
  const splatting::ShearImage& first = this->Channels.front().Image;
  const std::size_t components = this->Channels.size(), size = splatting::sizeOf(first.type);
  output->SetDimensions(first.width, first.height, 1);
  output->SetOrigin(-this->Geometry.margin().x, -this->Geometry.margin().y, 0.0);
  output->AllocateScalars(this->Source.VtkTypeOf(first.type), static_cast<int>(components));
  const std::size_t pixels = static_cast<std::size_t>(output->GetNumberOfPoints());
  auto* const scalars = static_cast<unsigned char*>(output->GetScalarPointer());
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(output->GetNumberOfPoints());
  ghosts->Fill(vtkDataSetAttributes::HIDDENPOINT);
  for (std::size_t c = 0; c < components; ++c)
  {
    const splatting::ShearImage& image = this->Channels[c].Image;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      std::memcpy(
        scalars + (pixel * components + c) * size, image.bytes.data() + pixel * size, size);
      const int u = static_cast<int>(pixel % image.width),
                v = static_cast<int>(pixel / image.width);
      const vtkIdType id = static_cast<vtkIdType>(pixel);
      if (image.covers(u, v) &&
        !std::isnan(output->GetPointData()->GetScalars()->GetComponent(id, static_cast<int>(c))))
      {
        ghosts->SetValue(id, 0);
      }
    }
  }
  output->GetPointData()->AddArray(ghosts);
}

//------------------------------------------------------------------------------
vtkImageData* vtkSplattingMIPVolumeMapper::GetShearImage()
{
  Internals& in = *this->Internal;
  if (in.ImageValid && !in.ShearImageOutput)
  {
    in.ShearImageOutput = vtkSmartPointer<vtkImageData>::New();
    in.CopyShearImage(in.ShearImageOutput);
  }
  return in.ShearImageOutput;
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetPrincipalAxis()
{
  return this->Internal->ImageValid ? this->Internal->Geometry.principalAxis() : -1;
}

//------------------------------------------------------------------------------
void vtkSplattingMIPVolumeMapper::GetShear(double shear[2])
{
  shear[0] = this->Internal->Geometry.shear().x;
  shear[1] = this->Internal->Geometry.shear().y;
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
  std::size_t size = this->Internal->Source.MemorySize();
  for (const Internals::Channel& channel : this->Internal->Channels)
  {
    size += channel.Index.memorySize();
  }
  return static_cast<vtkIdType>(size);
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
  return splatting::nameOf(this->Internal->Channels.front().Settings.instructionSet);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetAccelerationUsed()
{
  return static_cast<int>(this->Internal->Channels.front().Used);
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
  return static_cast<int>(this->Internal->Channels.front().Settings.quality);
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
  os << indent << "Acceleration: " << this->GetAccelerationAsString() << "\n";
  os << indent << "AccelerationUsed: " << nameOf(this->GetAccelerationUsed()) << "\n";
  os << indent << "LineTolerance: " << this->LineTolerance << "\n";
  os << indent << "EliminateInvisible: " << (this->EliminateInvisible ? "On" : "Off") << "\n";
  os << indent << "CullBelowWindow: " << (this->CullBelowWindow ? "On" : "Off") << "\n";
  os << indent << "IndexMemoryBudget: " << this->IndexMemoryBudget << "\n";
  os << indent << "LastRenderUsedRayCasting: " << (this->LastRenderUsedRayCasting ? "Yes" : "No")
     << "\n";
  os << indent << "PrincipalAxis: " << this->GetPrincipalAxis() << "\n";
  os << indent << "Shear: " << this->GetShear()[0] << ", " << this->GetShear()[1] << "\n";
  os << indent << "IndexMemorySize: " << this->GetIndexMemorySize() << "\n";
  os << indent << "IndexTime: " << this->GetIndexTime() << "\n";
  os << indent << "NumberOfProjections: " << this->GetNumberOfProjections() << "\n";
  os << indent << "ProjectionTime: " << this->GetProjectionTime() << "\n";
  os << indent << "InstructionSet: " << this->GetInstructionSet() << "\n";
}
