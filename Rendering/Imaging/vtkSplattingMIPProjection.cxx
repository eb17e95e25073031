// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPProjection.h"

#include "AbortCheck.h"
#include "Components/ComponentProjector.h"
#include "Input/ProjectionProperties.h"
#include "Input/ScalarSource.h"
#include "Input/WorldView.h"
#include "LocationArrays.h"
#include "TurnOfViews.h"

#include "vtkAbstractMapper.h"
#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMapper.h" // for VTK_GET_ARRAY_BY_ID
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>
#include <utility>
#include <vector>

using namespace splatting;

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkSplattingMIPProjection);
vtkCxxSetObjectMacro(vtkSplattingMIPProjection, Camera, vtkCamera);

//------------------------------------------------------------------------------
class vtkSplattingMIPProjection::Internals
{
public:
  ScalarChoice ScalarsOf(vtkSplattingMIPProjection* self, vtkDataArray* array, int association,
    vtkImageData* input) const;
  TurnSettings TurnOf(vtkSplattingMIPProjection* self, vtkImageData* input) const;
  void SetOutputGeometry(
    vtkSplattingMIPProjection* self, vtkInformation* input, vtkInformation* output) const;
  std::string Validate(
    vtkSplattingMIPProjection* self, vtkDataArray* array, int association, vtkImageData* input);
  bool ReportProgress(vtkSplattingMIPProjection* self, double done);
  bool PlaceOutput(vtkImageData* output, bool locate);
  void FindViews(vtkSplattingMIPProjection* self);
  void Locate(const splatting::View& view, int n);
  std::string ProjectInput(vtkSplattingMIPProjection* self, vtkImageData* output);
  std::string ProjectViews(vtkSplattingMIPProjection* self, vtkImageData* output);

  ScalarSource Source;
  ComponentProjector Components;
  TurnOfViews Turn;
  splatting::Locator::Arrays Locations; // of the output
  struct ViewOfTurn
  {
    int slice; // of the output
    splatting::View view;
    splatting::ProjectionSettings settings;
  };
  std::vector<ViewOfTurn> Views; // in the order of projection
  int ViewsDone = 0;
  double Reported = 0.0; // progress
};

//------------------------------------------------------------------------------
vtkSplattingMIPProjection::vtkSplattingMIPProjection() : Internal(new Internals)
{
  this->Internal->Components.SetObserver(
    [this](double done) { return this->Internal->ReportProgress(this, done); });
  this->Internal->Components.SetScreenObserver([this](double) { return !isAborted(this); });
}

//------------------------------------------------------------------------------
vtkSplattingMIPProjection::~vtkSplattingMIPProjection()
{
  this->SetCamera(nullptr);
}

//------------------------------------------------------------------------------
vtkMTimeType vtkSplattingMIPProjection::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Camera ? std::max(own, this->Camera->GetMTime()) : own;
}

//------------------------------------------------------------------------------
// Converts the array to process to a mapper's ScalarMode.
ScalarChoice vtkSplattingMIPProjection::Internals::ScalarsOf(
  vtkSplattingMIPProjection* self, vtkDataArray* array, int association, vtkImageData* input) const
{
  ScalarChoice choice;
  choice.vectorMode = self->VectorMode;
  choice.vectorComponent = self->VectorComponent;
  const bool ofCells = association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  vtkDataSetAttributes* const arrays =
    input->GetAttributes(ofCells ? vtkDataObject::CELL : vtkDataObject::POINT);
  for (int n = 0; arrays && n < arrays->GetNumberOfArrays(); ++n)
  {
    if (arrays->GetArray(n) == array)
    {
      choice.scalarMode =
        ofCells ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA;
      choice.arrayAccessMode = VTK_GET_ARRAY_BY_ID;
      choice.arrayId = n;
    }
  }
  return choice;
}

//------------------------------------------------------------------------------
TurnSettings vtkSplattingMIPProjection::Internals::TurnOf(
  vtkSplattingMIPProjection* self, vtkImageData* input) const
{
  TurnSettings turn;
  turn.camera = self->Camera;
  turn.direction = { self->ViewDirection[0], self->ViewDirection[1], self->ViewDirection[2] };
  turn.up = { self->ViewUp[0], self->ViewUp[1], self->ViewUp[2] };
  turn.size = { self->OutputSize[0], self->OutputSize[1] };
  turn.spacing = { self->OutputSpacing[0], self->OutputSpacing[1] };
  turn.views = self->NumberOfViews;
  turn.axis = { self->RotationAxis[0], self->RotationAxis[1], self->RotationAxis[2] };
  turn.angle = self->TotalAngle;
  turn.slab = self->Slab != 0;
  turn.slabCenter = { self->SlabCenter[0], self->SlabCenter[1], self->SlabCenter[2] };
  turn.slabThickness = self->SlabThickness;
  const double* const bounds = input->GetBounds();
  const glm::dvec3 low(bounds[0], bounds[2], bounds[4]), high(bounds[1], bounds[3], bounds[5]);
  turn.focalPoint = self->CenterOnVolume
    ? 0.5 * (low + high)
    : glm::dvec3(self->FocalPoint[0], self->FocalPoint[1], self->FocalPoint[2]);
  turn.diagonal = glm::length(high - low);
  if (!(turn.diagonal > 0.0)) // one voxel
  {
    const double* const spacing = input->GetSpacing();
    turn.diagonal = std::abs(spacing[0]) + std::abs(spacing[1]) + std::abs(spacing[2]);
  }
  return turn;
}

//------------------------------------------------------------------------------
// Validates input and settings. Returns an error message that says what to do, or an empty string.
std::string vtkSplattingMIPProjection::Internals::Validate(
  vtkSplattingMIPProjection* self, vtkDataArray* array, int association, vtkImageData* input)
{
  vtkInformation* const wanted = self->GetInputArrayInformation(0);
  if (!array && wanted->Has(vtkDataObject::FIELD_NAME()))
  {
    return std::string("The input has no numeric array \"") +
      wanted->Get(vtkDataObject::FIELD_NAME()) + "\": choose another with SetInputArrayToProcess.";
  }
  std::string problem =
    this->Source.Examine(input, this->ScalarsOf(self, array, association, input));
  if (problem.empty() && isSingular(this->Source.Grid().indexToPhysical))
  {
    problem = "Spacing and direction matrix flatten the volume: neither may be singular.";
  }
  const char* fault = problem.empty() ? validate(*self) : nullptr;
  if (problem.empty() && !fault)
  {
    fault = this->Turn.Set(this->TurnOf(self, input));
  }
  return fault ? fault : problem;
}

//------------------------------------------------------------------------------
// Reports progress. Returns whether to continue.
bool vtkSplattingMIPProjection::Internals::ReportProgress(
  vtkSplattingMIPProjection* self, double done)
{
  const double share =
    (this->ViewsDone + this->Components.OverallProgress(done)) / std::max(1, this->Turn.Views());
  // At most 100 events in all.
  if (share >= this->Reported + 0.01)
  {
    this->Reported = share;
    self->UpdateProgress(std::min(share, 1.0));
  }
  return !isAborted(self);
}

//------------------------------------------------------------------------------
// Sets the geometry of the output and allocates its arrays. Returns false if there is not enough
// memory.
bool vtkSplattingMIPProjection::Internals::PlaceOutput(vtkImageData* output, bool locate)
{
  vtkDataArray* const scalars = this->Source.Scalars();
  const int type = ScalarSource::AverageVtkType(scalars->GetDataType());
  const int components = this->Source.Components();
  const glm::ivec2& size = this->Turn.Size();
  output->SetExtent(0, size.x - 1, 0, size.y - 1, 0, this->Turn.Views() - 1);
  this->Turn.Place(output);
  // VTK would report it in several messages, or throw. Compilers may remove an unused
  // new-expression, but not a call.
  constexpr std::size_t located = 3 * sizeof(int) + sizeof(float) + 3 * sizeof(double);
  const std::size_t bytes =
    (std::size_t(vtkDataArray::GetDataTypeSize(type)) * components + (locate ? located : 0)) *
    static_cast<std::size_t>(output->GetNumberOfPoints());
  void* const memory = ::operator new(bytes, std::nothrow);
  ::operator delete(memory);
  if (!memory)
  {
    return false;
  }
  output->AllocateScalars(type, components);
  output->GetPointData()->GetScalars()->SetName(scalars->GetName());
  if (locate)
  {
    this->Locations = addLocationArrays(output);
  }
  return true;
}

//------------------------------------------------------------------------------
// Projects a valid input. Returns an error message, or an empty string.
std::string vtkSplattingMIPProjection::Internals::ProjectInput(
  vtkSplattingMIPProjection* self, vtkImageData* output)
{
  this->Components.SetSource(this->Source);
  this->Components.SetBudget(static_cast<std::size_t>(self->IndexMemoryBudget));
  if (const char* const fault =
        this->Components.ValidateVoxels(static_cast<Quality>(self->QualityMode)))
  {
    return fault;
  }
  return this->PlaceOutput(output, self->RecordLocations != 0)
    ? this->ProjectViews(self, output)
    : "There is no memory for the output: choose fewer pixels or views.";
}

//------------------------------------------------------------------------------
// Finds the views of the turn and their settings.
void vtkSplattingMIPProjection::Internals::FindViews(vtkSplattingMIPProjection* self)
{
  const VolumeGrid& grid = this->Source.Grid();
  this->Views.clear();
  for (const int n : this->Turn.Order())
  {
    splatting::View view =
      viewOf(grid, grid.indexToPhysical, this->Turn.WorldToClip(n), this->Turn.Size());
    view.halfSpaces.clear(); // the camera's clipping range is ignored
    if (self->Slab)
    {
      addSlab(view, grid.indexToPhysical, self->SlabCenter, self->SlabThickness);
    }
    if (self->Cropping)
    {
      view.cropping = croppingOf(grid, self->CroppingRegionPlanes, self->CroppingRegionFlags);
    }
    const splatting::ProjectionSettings settings =
      settingsOf(*self, self->QualityMode, view, self->RecordLocations != 0);
    this->Views.push_back({ n, view, settings });
  }
}

//------------------------------------------------------------------------------
// Fills the slices of the output. Returns an error message, or an empty string. After an abort some
// slices are missing.
std::string vtkSplattingMIPProjection::Internals::ProjectViews(
  vtkSplattingMIPProjection* self, vtkImageData* output)
{
  // Observers of progress may change settings. The next update uses those.
  this->FindViews(self);
  const double background = self->BackgroundValue;
  this->ViewsDone = 0;
  this->Reported = 0.0;
  for (const auto& [n, view, settings] : this->Views)
  {
    if (!splatting::isFinite(view))
    {
      return TurnOfViews::Degenerate;
    }
    if (!this->Components.Project(view, settings, settings, {}))
    {
      return TurnOfViews::Degenerate;
    }
    if (!this->Components.IsProjected() || !this->ReportProgress(self, 0.0) ||
      !this->Components.CopyScalars(view, background, output->GetScalarPointer(0, 0, n)))
    {
      return {};
    }
    if (settings.recordLocations && this->Components.HasWinners())
    {
      this->Locate(view, n);
    }
    ++this->ViewsDone;
  }
  return {};
}

//------------------------------------------------------------------------------
// Writes the sample positions of view n, from the last projection.
void vtkSplattingMIPProjection::Internals::Locate(const splatting::View& view, int n)
{
  splatting::Located located;
  located.view = view;
  located.indexToWorld = this->Source.Grid().indexToPhysical;
  this->Components.Describe({}, located);
  vtkNew<vtkCamera> camera;
  this->Turn.SetCamera(n, camera);
  camera->GetPosition(&located.camera.x);
  camera->GetDirectionOfProjection(&located.direction.x);
  const glm::ivec2& size = this->Turn.Size();
  const std::ptrdiff_t first = std::ptrdiff_t(n) * size.x * size.y;
  splatting::Locator::Arrays places = this->Locations;
  places.voxels += 3 * first;
  places.depths += first;
  places.positions += 3 * first;
  splatting::Locator(located).fill({ 0, 0 }, size, places);
}

//------------------------------------------------------------------------------
// Sets the geometry of the output for RequestInformation().
void vtkSplattingMIPProjection::Internals::SetOutputGeometry(
  vtkSplattingMIPProjection* self, vtkInformation* input, vtkInformation* output) const
{
  vtkNew<vtkImageData> volume, picture;
  volume->CopyInformationFromPipeline(input);
  int whole[6] = { 0, -1, 0, -1, 0, -1 };
  input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  volume->SetExtent(whole);
  TurnOfViews turn;
  if (!turn.Set(this->TurnOf(self, volume)))
  {
    turn.Place(picture);
    picture->CopyInformationToPipeline(output);
  }
}

//------------------------------------------------------------------------------
int vtkSplattingMIPProjection::RequestInformation(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkInformation* const info = output->GetInformationObject(0);
  const int whole[6] = { 0, std::clamp(this->OutputSize[0], 1, TurnOfViews::MostPixels) - 1, 0,
    std::clamp(this->OutputSize[1], 1, TurnOfViews::MostPixels) - 1, 0, this->NumberOfViews - 1 };
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole, 6);
  this->Internal->SetOutputGeometry(this, input[0]->GetInformationObject(0), info);
  vtkInformation* const array = this->GetInputArrayFieldInformation(0, input);
  int type = VTK_FLOAT, components = 1;
  if (array && array->Has(vtkDataObject::FIELD_ARRAY_TYPE()))
  {
    type = ScalarSource::AverageVtkType(array->Get(vtkDataObject::FIELD_ARRAY_TYPE()));
  }
  if (array && array->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()) &&
    this->VectorMode == DISABLED)
  {
    components = array->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
  }
  vtkDataObject::SetPointDataActiveScalarInfo(info, type, components);
  return 1;
}

//------------------------------------------------------------------------------
int vtkSplattingMIPProjection::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  // Every pixel may depend on every voxel.
  vtkInformation* const info = input[0]->GetInformationObject(0);
  int whole[6] = { 0, -1, 0, -1, 0, -1 };
  info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), whole, 6);
  return 1;
}

//------------------------------------------------------------------------------
int vtkSplattingMIPProjection::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  Internals& in = *this->Internal;
  vtkImageData* const input = vtkImageData::GetData(inputs[0]);
  vtkImageData* const output = vtkImageData::GetData(outputs);
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* const array = this->GetInputArrayToProcess(0, inputs, association);
  const vtkIdType before = in.Components.NumberOfProjections();
  std::string problem;
  try
  {
    problem = in.Validate(this, array, association, input);
    problem = problem.empty() ? in.ProjectInput(this, output) : problem;
  }
  catch (const std::bad_alloc&)
  {
    in.Source.Clear(VTK_VOID);
    in.Components.Clear();
    problem = ScalarSource::NoMemory;
  }
  this->NumberOfProjections = in.Components.NumberOfProjections() - before;
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
  }
  else if (this->RecordLocations && this->BlendMode == AVERAGE_INTENSITY_BLEND)
  {
    vtkWarningMacro(<< "An average is computed from all samples of a ray, so it has no location: "
                       "choose maxima or minima, or turn RecordLocations off.");
  }
  if (!problem.empty() || in.ViewsDone < in.Turn.Views())
  {
    in.Components.Forget();
    output->Initialize();
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkIdType vtkSplattingMIPProjection::GetIndexMemorySize()
{
  return static_cast<vtkIdType>(
    this->Internal->Source.MemorySize() + this->Internal->Components.MemorySize());
}

//------------------------------------------------------------------------------
const char* vtkSplattingMIPProjection::GetInstructionSet()
{
  return splatting::nameOf(this->Internal->Components.Settings().instructionSet);
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPProjection::GetViewCamera(int view, vtkCamera* camera)
{
  const TurnOfViews& turn = this->Internal->Turn;
  if (!camera || view < 0 || view >= turn.Views() || !this->Internal->Components.IsProjected())
  {
    return false;
  }
  turn.SetCamera(view, camera);
  return true;
}

//------------------------------------------------------------------------------
vtkImageData* vtkSplattingMIPProjection::GetShearImage()
{
  return this->Internal->Components.ShearImageOf(this->Internal->Source);
}

//------------------------------------------------------------------------------
void vtkSplattingMIPProjection::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto onOff = [](vtkTypeBool value) { return value ? "On\n" : "Off\n"; };
  const auto numbers = [&](const char* name, const auto& values)
  {
    const char* before = ": (";
    os << indent << name;
    for (const auto value : values)
    {
      os << before << value;
      before = ", ";
    }
    os << ")\n";
  };
  os << indent << "Camera: " << this->Camera << "\n";
  numbers("ViewDirection", this->ViewDirection);
  numbers("ViewUp", this->ViewUp);
  os << indent << "CenterOnVolume: " << onOff(this->CenterOnVolume);
  numbers("FocalPoint", this->FocalPoint);
  numbers("OutputSize", this->OutputSize);
  numbers("OutputSpacing", this->OutputSpacing);
  os << indent << "NumberOfViews: " << this->NumberOfViews << "\n";
  numbers("RotationAxis", this->RotationAxis);
  os << indent << "TotalAngle: " << this->TotalAngle << "\n";
  os << indent << "BackgroundValue: " << this->BackgroundValue << "\n";
  os << indent << "BlendMode: " << this->BlendMode << "\n";
  numbers("AverageIPScalarRange", this->AverageIPScalarRange);
  os << indent << "QualityMode: " << nameOfQualityMode(this->QualityMode) << "\n";
  os << indent << "Kernel: " << nameOfKernel(this->Kernel) << "\n";
  os << indent << "KernelRadius: " << this->KernelRadius << "\n";
  os << indent << "FootprintSampling: " << this->FootprintSampling << "\n";
  os << indent << "MaximumType: " << nameOfMaximumType(this->MaximumType) << "\n";
  os << indent << "DepthShadingAmbient: " << this->DepthShadingAmbient << "\n";
  os << indent << "DepthShadingChangeRate: " << this->DepthShadingChangeRate << "\n";
  os << indent << "LocalMaximumThreshold: " << this->LocalMaximumThreshold << "\n";
  os << indent << "SignedOrigin: " << this->SignedOrigin << "\n";
  os << indent << "VectorMode: " << nameOfVectorMode(this->VectorMode) << "\n";
  os << indent << "VectorComponent: " << this->VectorComponent << "\n";
  os << indent << "Slab: " << onOff(this->Slab);
  os << indent << "SlabThickness: " << this->SlabThickness << "\n";
  numbers("SlabCenter", this->SlabCenter);
  os << indent << "Cropping: " << onOff(this->Cropping);
  numbers("CroppingRegionPlanes", this->CroppingRegionPlanes);
  os << indent << "CroppingRegionFlags: " << this->CroppingRegionFlags << "\n";
  os << indent << "Acceleration: " << nameOfAcceleration(this->Acceleration) << "\n";
  os << indent << "LineTolerance: " << this->LineTolerance << "\n";
  os << indent << "RecordLocations: " << onOff(this->RecordLocations);
  os << indent << "IndexMemoryBudget: " << this->IndexMemoryBudget << "\n";
  os << indent << "NumberOfProjections: " << this->NumberOfProjections << "\n";
  os << indent << "IndexMemorySize: " << this->GetIndexMemorySize() << "\n";
  os << indent << "InstructionSet: " << this->GetInstructionSet() << "\n";
}
VTK_ABI_NAMESPACE_END
