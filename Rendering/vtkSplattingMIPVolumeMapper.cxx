// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPVolumeMapper.h"

#include "BoundingSurface.h"
#include "Project.h"
#include "RayCastFallback.h"
#include "RenderTimes.h"
#include "SceneDepth.h"
#include "Selection.h"
#include "ShearWarp.h"
#include "TransferFunctions.h"
#include "View.h"
#include "ViewOfVolume.h"
#include "VolumeIndex.h"
#include "Warp.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
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
#include <limits>
#include <set>
#include <string>
#include <vector>

vtkObjectFactoryNewMacro(vtkSplattingMIPVolumeMapper);

namespace
{
const char* const DegenerateCamera =
  "The camera flattens the volume to a line or has no extent: give it a parallel scale above 0 and "
  "a view-up that is not its direction.";
const char* const NoColors =
  "FinalColorWindow and FinalColorLevel give no colours: both must be finite and the window not 0.";

template <class T>
splatting::ScalarType sizedType()
{
  constexpr bool isSigned = std::numeric_limits<T>::is_signed;
  switch (sizeof(T))
  {
    case 1:
      return isSigned ? splatting::ScalarType::Int8 : splatting::ScalarType::UInt8;
    case 2:
      return isSigned ? splatting::ScalarType::Int16 : splatting::ScalarType::UInt16;
    case 4:
      return isSigned ? splatting::ScalarType::Int32 : splatting::ScalarType::UInt32;
    default:
      return isSigned ? splatting::ScalarType::Int64 : splatting::ScalarType::UInt64;
  }
}

/// Float for the types that vtkTemplateMacro does not know, too; they are refused before.
splatting::ScalarType scalarType(int vtkType)
{
  if (vtkType == VTK_DOUBLE)
  {
    return splatting::ScalarType::Float64;
  }
  if (vtkType == VTK_FLOAT)
  {
    return splatting::ScalarType::Float32;
  }
  switch (vtkType)
  {
    vtkTemplateMacro(return sizedType<VTK_TT>());
  }
  return splatting::ScalarType::Float32;
}

int vtkTypeOf(splatting::ScalarType type, int inputType)
{
  if (type == scalarType(inputType))
  {
    return inputType; // keeps char apart from signed char, long from long long
  }
  return type == splatting::ScalarType::Float32 ? VTK_FLOAT : VTK_DOUBLE;
}

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
  void LookAt(vtkDataArray* scalars);
  splatting::ProjectionSettings MakeSettings(vtkSplattingMIPVolumeMapper* self) const;
  bool GoOn(vtkSplattingMIPVolumeMapper* self, double done);
  bool Shows(
    const splatting::ShearWarp& geometry, const splatting::ProjectionSettings& settings) const;
  double FloorOfWindow() const;
  std::string ProblemOfCuts(vtkSplattingMIPVolumeMapper* self, vtkVolume* volume);
  void CaptureDepth(vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren,
    const splatting::View& view, const splatting::ShearWarp& geometry);
  void FindCuts(vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, const splatting::View& view,
    const splatting::ShearWarp& geometry);
  bool Project(
    vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, const splatting::View& view, int mode);
  void UpdateColors(vtkVolumeProperty* property, const FinalColor& finalColor);
  void CopyShearImage(vtkImageData* output) const;

  vtkImageData* Input = nullptr;     // set by Problem(), valid during a render
  vtkDataArray* Scalars = nullptr;   // likewise
  std::string Reported;              // the last problem, so that each is told once
  std::set<std::string> Announced;   // reasons to ray cast that were told
  vtkRenderWindow* Window = nullptr; // which may abort, during a render

  splatting::VolumeIndex Index;
  vtkSmartPointer<vtkDataArray> Contiguous; // a copy, if the scalars are stored in another way
  const vtkDataArray* IndexedScalars = nullptr;
  const void* IndexedBuffer = nullptr;
  vtkMTimeType IndexedTime = 0;
  int ScalarType = VTK_VOID;

  splatting::Projector Projector;
  splatting::ShearWarp Geometry;
  splatting::ProjectionSettings Settings;
  splatting::Acceleration Used = splatting::Acceleration::Dense;
  bool BudgetReported = false;
  splatting::Cuts Cuts, LastCuts;
  std::vector<glm::dvec4> HalfSpaces; // in pixels
  ::BoundingSurface Surface;
  bool OpenSurfaceReported = false;
  splatting::SceneDepth Depth;
  const vtkRenderer* DepthOf = nullptr; // only compared
  splatting::ShearImage Image;
  bool ImageValid = false;
  vtkIdType Projections = 0;
  double ProjectionTime = 0.0;
  splatting::RenderTimes Times;
  double IndexTimeBefore = 0.0; // before what the present frame makes of the index
  double Shear[2] = { 0.0, 0.0 };
  vtkSmartPointer<vtkImageData> ShearImageOutput;

  splatting::ColorTable Colors;
  vtkVolumeProperty* ColoredBy = nullptr;
  vtkMTimeType ColorTime = 0;
  FinalColor ColoredFor;
  bool ColorsValid = false;
  splatting::Warper Warper;
  splatting::Picture Picture;

  std::unique_ptr<RayCastFallback> RayCaster; // made when first needed: it is megabytes large
};

//------------------------------------------------------------------------------
vtkSplattingMIPVolumeMapper::vtkSplattingMIPVolumeMapper()
  : QualityMode(HIGH),
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
}

//------------------------------------------------------------------------------
vtkCxxSetObjectMacro(vtkSplattingMIPVolumeMapper, BoundingSurface, vtkPolyData);

//------------------------------------------------------------------------------
// The gate: a sentence that says why this input cannot be rendered and what to do, or nothing.
std::string vtkSplattingMIPVolumeMapper::Internals::Problem(
  vtkSplattingMIPVolumeMapper* self, vtkVolume* volume)
{
  vtkDataSet* const input = self->GetInput();
  this->Input = vtkImageData::SafeDownCast(input);
  this->Scalars = nullptr;
  if (!input)
  {
    return "There is no input: connect a vtkImageData with SetInputData or SetInputConnection.";
  }
  if (!this->Input)
  {
    return std::string("The input is a ") + input->GetClassName() +
      ", only vtkImageData can be splatted: resample it with vtkResampleToImage.";
  }
  const int* dimensions = this->Input->GetDimensions();
  const vtkIdType points = this->Input->GetNumberOfPoints();
  if (points < 1)
  {
    return "The input has no voxels: its extent is empty.";
  }
  int cellFlag = 0;
  this->Scalars = vtkAbstractMapper::GetScalars(
    this->Input, self->ScalarMode, self->ArrayAccessMode, self->ArrayId, self->ArrayName, cellFlag);
  if (!this->Scalars)
  {
    return "The input has no numeric scalars under the chosen ScalarMode and array: set them on "
           "the "
           "input or choose another with SelectScalarArray.";
  }
  if (cellFlag)
  {
    return "The chosen scalars belong to cells: convert them with vtkCellDataToPointData.";
  }
  if (this->Scalars->GetDataType() == VTK_BIT)
  {
    return "The scalars are bits: convert them with vtkImageCast.";
  }
  if (this->Scalars->GetNumberOfTuples() != points)
  {
    return "The scalars have " + std::to_string(this->Scalars->GetNumberOfTuples()) +
      " tuples for " + std::to_string(points) + " voxels: the two must agree.";
  }
  // Positions in rows, slices and the shear image are counted in int and must be exact in double.
  if (*std::max_element(dimensions, dimensions + 3) > 16384)
  {
    return "The input has more than 16384 voxels along an axis: extract a part of it.";
  }
  if (isFlat(this->Input, volume))
  {
    return "Spacing, direction and prop matrix flatten the volume: none of them may be singular.";
  }
  return {};
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
  if (this->Scalars->GetNumberOfComponents() != 1)
  {
    return "the scalars have several components";
  }
  if (!splatting::isParallel(view))
  {
    return "the camera is perspective";
  }
  return nullptr;
}

//------------------------------------------------------------------------------
// Points the index at the scalars, anew if they changed.
void vtkSplattingMIPVolumeMapper::Internals::LookAt(vtkDataArray* scalars)
{
  const int* dimensions = this->Input->GetDimensions();
  const glm::ivec3 size(dimensions[0], dimensions[1], dimensions[2]);
  // The image's time includes its arrays'. Images may share an array, and an array may be given
  // another buffer without a word.
  const vtkMTimeType time = this->Input->GetMTime();
  const void* const buffer =
    scalars->HasStandardMemoryLayout() ? scalars->GetVoidPointer(0) : nullptr;
  if (this->IndexedScalars == scalars && this->IndexedTime == time &&
    this->IndexedBuffer == buffer && this->Index.volume().dimensions == size)
  {
    return;
  }
  if (this->Index.volume().dimensions != size || this->ScalarType != scalars->GetDataType())
  {
    this->Times.clear(); // those of other sizes; changed data take what the last ones took
  }
  this->IndexedBuffer = buffer;
  this->IndexedScalars = scalars;
  this->IndexedTime = time;
  this->ScalarType = scalars->GetDataType();
  this->Contiguous = nullptr;
  if (!scalars->HasStandardMemoryLayout())
  {
    this->Contiguous.TakeReference(vtkDataArray::CreateDataArray(this->ScalarType));
    this->Contiguous->DeepCopy(scalars);
    scalars = this->Contiguous;
  }
  this->Index.reset({ scalars->GetVoidPointer(0), scalarType(this->ScalarType), size });
  this->ImageValid = false;
  this->ShearImageOutput = nullptr;
  this->ColorsValid = false;
}

//------------------------------------------------------------------------------
splatting::ProjectionSettings vtkSplattingMIPVolumeMapper::Internals::MakeSettings(
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
double vtkSplattingMIPVolumeMapper::Internals::FloorOfWindow() const
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
    self->BoundingSurface ? worldToIndex(this->Input, volume) : glm::dmat4(1.0);
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
bool vtkSplattingMIPVolumeMapper::Internals::Shows(
  const splatting::ShearWarp& geometry, const splatting::ProjectionSettings& settings) const
{
  return this->ImageValid && geometry.sameShear(this->Geometry) &&
    (geometry.reversed() == this->Geometry.reversed() || !isOrdered(settings.reduction)) &&
    this->Cuts == this->LastCuts && settings == this->Settings;
}

//------------------------------------------------------------------------------
// Projects in this mode, unless the last shear image shows the same, or better within what is
// wanted. False if the view has no meaning. There is no valid image after an abort.
bool vtkSplattingMIPVolumeMapper::Internals::Project(
  vtkSplattingMIPVolumeMapper* self, vtkRenderer* ren, const splatting::View& view, int mode)
{
  const splatting::ShearWarp geometry(view);
  splatting::ProjectionSettings settings = this->MakeSettings(self);
  if (!geometry.valid())
  {
    return false;
  }
  const double start = vtkTimerLog::GetUniversalTime();
  this->FindCuts(self, ren, view, geometry);
  settings.quality = std::clamp(this->Settings.quality, static_cast<splatting::Quality>(mode),
    static_cast<splatting::Quality>(self->QualityMode));
  const bool same = this->Shows(geometry, settings);
  this->Geometry = geometry;
  if (same)
  {
    return true;
  }
  settings.quality = static_cast<splatting::Quality>(mode);
  this->ImageValid = false;
  this->ShearImageOutput = nullptr;
  this->Settings = settings;
  const splatting::Acceleration used =
    this->Projector.project(this->Index, geometry, settings, this->Cuts, this->Image);
  if (this->Projector.stopped())
  {
    return true;
  }
  std::swap(this->Cuts, this->LastCuts);
  this->Used = used;
  this->ProjectionTime = vtkTimerLog::GetUniversalTime() - start;
  this->ImageValid = true;
  ++this->Projections;
  return true;
}

//------------------------------------------------------------------------------
// Transfer functions to a table of colours.
void vtkSplattingMIPVolumeMapper::Internals::UpdateColors(
  vtkVolumeProperty* property, const FinalColor& finalColor)
{
  if (this->ColorsValid && this->ColoredBy == property && this->ColorTime == property->GetMTime() &&
    this->ColoredFor == finalColor)
  {
    return;
  }
  const splatting::VolumeIndex::Range& range = this->Index.range();
  const bool integers = this->ScalarType != VTK_FLOAT && this->ScalarType != VTK_DOUBLE;
  this->Colors = tabulateColors(property, range.low, range.high, integers, finalColor);
  this->ColoredFor = finalColor;
  this->ColoredBy = property;
  this->ColorTime = property->GetMTime();
  this->ColorsValid = true;
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
      this->TimeToDraw - (in.Index.time() - in.IndexTimeBefore));
  }
  this->InvokeEvent(vtkCommand::VolumeMapperRenderEndEvent);
  in.Window = nullptr;
}

//------------------------------------------------------------------------------
// Returns what is wrong, or an empty string.
const char* vtkSplattingMIPVolumeMapper::RenderBySplatting(vtkRenderer* ren, vtkVolume* vol)
{
  Internals& in = *this->Internal;
  splatting::View view = makeView(in.Input, vol, ren, this);
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
    addSlab(view, in.Input, vol, this->SlabCenter, this->SlabThickness);
  }
  if (in.Surface.IsOpen() && !in.OpenSurfaceReported)
  {
    vtkWarningMacro(<< "The bounding surface is not closed: rays that cross it once show nothing. "
                       "Close it, for instance with vtkFillHolesFilter.");
  }
  in.OpenSurfaceReported = in.Surface.IsOpen();
  in.LookAt(in.Scalars);
  in.IndexTimeBefore = in.Index.time();
  if (in.Index.setBudget(static_cast<std::size_t>(this->IndexMemoryBudget)))
  {
    in.ImageValid = false; // so that the answer to "what was used" is right
  }
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
  if (in.Index.exceedsBudget() && !in.BudgetReported)
  {
    vtkWarningMacro(<< "An index for fast projection does not fit into IndexMemoryBudget ("
                    << this->IndexMemoryBudget
                    << " bytes): this volume is projected without it. Raise the budget.");
  }
  in.BudgetReported = in.Index.exceedsBudget();
  if (in.ImageValid)
  {
    in.Warper.warp(
      in.Image, in.Geometry, in.Colors, view.viewport, in.Settings.instructionSet, in.Picture);
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
    in.RayCaster->FindMask(this, in.Input, ren, vol, in.Picture);
    this->DisplayPicture(ren);
  }
  else
  {
    in.RayCaster->Render(this, in.Input, ren, vol);
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
  const int type = vtkTypeOf(this->Image.type, this->ScalarType);
  output->SetDimensions(this->Image.width, this->Image.height, 1);
  output->SetOrigin(-this->Geometry.margin().x, -this->Geometry.margin().y, 0.0);
  output->AllocateScalars(type, 1);
  std::memcpy(output->GetScalarPointer(), this->Image.bytes.data(), this->Image.bytes.size());
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(output->GetNumberOfPoints());
  for (int v = 0; v < this->Image.height; ++v)
  {
    for (int u = 0; u < this->Image.width; ++u)
    {
      const vtkIdType pixel = static_cast<vtkIdType>(v) * this->Image.width + u;
      const bool sample = this->Image.covers(u, v) &&
        !std::isnan(output->GetPointData()->GetScalars()->GetComponent(pixel, 0));
      ghosts->SetValue(
        pixel, sample ? 0 : static_cast<unsigned char>(vtkDataSetAttributes::HIDDENPOINT));
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
  const vtkDataArray* const copy = this->Internal->Contiguous;
  const vtkIdType packed =
    copy ? copy->GetNumberOfValues() * const_cast<vtkDataArray*>(copy)->GetDataTypeSize() : 0;
  return static_cast<vtkIdType>(this->Internal->Index.memorySize()) + packed;
}

//------------------------------------------------------------------------------
double vtkSplattingMIPVolumeMapper::GetIndexTime()
{
  return this->Internal->Index.time();
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
  return splatting::nameOf(this->Internal->Settings.instructionSet);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetAccelerationUsed()
{
  return static_cast<int>(this->Internal->Used);
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetAccelerationAsString()
{
  return nameOf(this->Acceleration);
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPVolumeMapper::GetQualityModeAsString()
{
  return nameOfMode(this->QualityMode);
}

//------------------------------------------------------------------------------
int vtkSplattingMIPVolumeMapper::GetQualityModeUsed()
{
  return static_cast<int>(this->Internal->Settings.quality);
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
