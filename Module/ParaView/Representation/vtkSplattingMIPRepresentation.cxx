// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPRepresentation.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommunicator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODVolume.h"
#include "vtkPVRenderView.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkRenderWindow.h"
#include "vtkScalarsToColors.h"
#include "vtkSplattingMIPVolumeMapper.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <utility>
#include <vector>

// ParaView does not initialise modules of plugins. This registers the object factory of the
// mapper's display.
VTK_MODULE_INIT(vtkRenderingSplattingMIP)

namespace
{
constexpr int largestComponent = 3; // of vtkSplattingMIPVolumeMapper::SetVectorComponent()

// The only volume in the input, or nullptr and an error message.
vtkDataSet* findVolume(vtkDataObject* input, std::string& problem)
{
  std::vector<vtkDataSet*> volumes;
  for (vtkDataSet* part : vtkCompositeDataSet::GetDataSets(input))
  {
    if (vtkImageData::SafeDownCast(part) || vtkRectilinearGrid::SafeDownCast(part))
    {
      volumes.push_back(part);
    }
  }
  if (volumes.size() != 1)
  {
    problem = "Splatting MIP shows one image at a time, but its input has " +
      std::to_string(volumes.size()) + ": extract one block, or resample all to one image.";
    return nullptr;
  }
  return volumes.front();
}

// The piece without marks of duplicate voxels. The superclass would remove these ghost layers,
// which were requested.
vtkSmartPointer<vtkDataSet> keptWhole(vtkDataSet* piece)
{
  vtkSmartPointer<vtkDataSet> whole = vtk::TakeSmartPointer(piece->NewInstance());
  whole->ShallowCopy(piece);
  for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const attributes = whole->GetAttributes(type);
    auto* const ghosts = vtkUnsignedCharArray::SafeDownCast(
      attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
    if (!ghosts)
    {
      continue;
    }
    constexpr unsigned char duplicate = vtkDataSetAttributes::DUPLICATEPOINT;
    static_assert(duplicate == static_cast<int>(vtkDataSetAttributes::DUPLICATECELL));
    vtkNew<vtkUnsignedCharArray> kept;
    kept->DeepCopy(ghosts);
    unsigned char any = 0;
    for (vtkIdType n = 0; n < kept->GetNumberOfValues(); ++n)
    {
      kept->SetValue(n, kept->GetValue(n) & static_cast<unsigned char>(~duplicate));
      any |= kept->GetValue(n);
    }
    attributes->RemoveArray(ghosts->GetName());
    if (any)
    {
      attributes->AddArray(kept);
    }
  }
  return whole;
}

bool isInteractive(vtkInformation* request)
{
  // ParaView requests 5 frames a second in interactive renders, and 0.002 in still ones.
  auto view = vtkPVRenderView::SafeDownCast(request->Get(vtkPVView::VIEW()));
  return view && view->GetRenderWindow()->GetDesiredUpdateRate() > 1.0;
}
}

vtkStandardNewMacro(vtkSplattingMIPRepresentation);

vtkSplattingMIPRepresentation::vtkSplattingMIPRepresentation()
  : QualityMode(vtkSplattingMIPVolumeMapper::EXACT),
    InteractiveQualityMode(AUTOMATIC)
{
  this->VolumeMapper.TakeReference(vtkSplattingMIPVolumeMapper::New());
  if (vtkMultiProcessController* const ranks = this->GetSeveralRanks())
  {
    vtkSplattingMIPVolumeMapper* mapper = this->GetSplattingMapper();
    mapper->SetController(ranks);
    // A compositor blends the pictures of the ranks.
    mapper->DisplayOnRootOnlyOn();
    mapper->IntermixIntersectingGeometryOff();
  }
}

vtkSplattingMIPRepresentation::~vtkSplattingMIPRepresentation() = default;

void vtkSplattingMIPRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "QualityMode: " << this->QualityMode << "\n";
  os << indent << "InteractiveQualityMode: " << this->InteractiveQualityMode << "\n";
  os << indent << "InteractiveRender: " << this->InteractiveRender << "\n";
  os << indent << "OpacityArrayIsUsable: " << this->OpacityArrayIsUsable << "\n";
  os << indent << "InputProblem: " << this->InputProblem << "\n";
  os << indent << "ArrayProblem: " << this->ArrayProblem << "\n";
  os << indent << "GrayProperty:\n";
  this->GrayProperty->PrintSelf(os, indent.GetNextIndent());
  os << indent << "VolumeMapper:\n";
  this->VolumeMapper->PrintSelf(os, indent.GetNextIndent());
}

vtkSplattingMIPVolumeMapper* vtkSplattingMIPRepresentation::GetSplattingMapper()
{
  return static_cast<vtkSplattingMIPVolumeMapper*>(this->VolumeMapper.Get());
}

// The controller of this process and other ranks; nullptr if there are none.
vtkMultiProcessController* vtkSplattingMIPRepresentation::GetSeveralRanks()
{
  vtkMultiProcessController* const all = vtkMultiProcessController::GetGlobalController();
  return all && all->GetNumberOfProcesses() > 1 ? all : nullptr;
}

int vtkSplattingMIPRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int result = this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
  const auto ghosts = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS();
  for (int i = 0; this->GetSeveralRanks() && i < inputVector[0]->GetNumberOfInformationObjects();
       ++i)
  {
    // As many as high mode needs, so that a change of the mode requests no others.
    vtkInformation* const info = inputVector[0]->GetInformationObject(i);
    info->Set(ghosts, std::max(info->Get(ghosts), 2));
  }
  return result;
}

void vtkSplattingMIPRepresentation::SetProjection(int projection)
{
  vtkSplattingMIPVolumeMapper* mapper = this->GetSplattingMapper();
  mapper->SetBlendMode(projection == MINIMUM ? vtkVolumeMapper::MINIMUM_INTENSITY_BLEND
      : projection == AVERAGE                ? vtkVolumeMapper::AVERAGE_INTENSITY_BLEND
                                             : vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND);
  mapper->SetMaximumType(projection == DEPTH_SHADED ? vtkSplattingMIPVolumeMapper::DEPTH_SHADED
      : projection == LOCAL                         ? vtkSplattingMIPVolumeMapper::LOCAL
      : projection == SIGNED                        ? vtkSplattingMIPVolumeMapper::SIGNED
                                                    : vtkSplattingMIPVolumeMapper::GLOBAL);
}

void vtkSplattingMIPRepresentation::SetKernel(int kernel)
{
  this->GetSplattingMapper()->SetKernel(kernel);
}

void vtkSplattingMIPRepresentation::SetKernelRadius(double radius)
{
  this->GetSplattingMapper()->SetKernelRadius(radius);
}

void vtkSplattingMIPRepresentation::SetDepthShadingAmbient(double ambient)
{
  this->GetSplattingMapper()->SetDepthShadingAmbient(ambient);
}

void vtkSplattingMIPRepresentation::SetDepthShadingChangeRate(double rate)
{
  this->GetSplattingMapper()->SetDepthShadingChangeRate(rate);
}

void vtkSplattingMIPRepresentation::SetLocalMaximumThreshold(double threshold)
{
  this->GetSplattingMapper()->SetLocalMaximumThreshold(threshold);
}

void vtkSplattingMIPRepresentation::SetSignedOrigin(double origin)
{
  this->GetSplattingMapper()->SetSignedOrigin(origin);
}

void vtkSplattingMIPRepresentation::SetSlab(bool slab)
{
  this->GetSplattingMapper()->SetSlab(slab);
}

void vtkSplattingMIPRepresentation::SetSlabThickness(double thickness)
{
  this->GetSplattingMapper()->SetSlabThickness(thickness);
}

void vtkSplattingMIPRepresentation::SetSlabCenter(double x, double y, double z)
{
  this->GetSplattingMapper()->SetSlabCenter(x, y, z);
}

void vtkSplattingMIPRepresentation::SetAcceleration(int acceleration)
{
  this->GetSplattingMapper()->SetAcceleration(acceleration);
}

void vtkSplattingMIPRepresentation::SetLineTolerance(double tolerance)
{
  this->GetSplattingMapper()->SetLineTolerance(tolerance);
}

void vtkSplattingMIPRepresentation::SetCullBelowWindow(bool cull)
{
  this->GetSplattingMapper()->SetCullBelowWindow(cull);
}

void vtkSplattingMIPRepresentation::SetIndexMemoryBudget(int mebibytes)
{
  this->GetSplattingMapper()->SetIndexMemoryBudget(vtkTypeInt64(mebibytes) << 20);
}

// Reports an error when it appears, not in every frame.
void vtkSplattingMIPRepresentation::Complain(std::string& last, const std::string& problem)
{
  if (!problem.empty() && problem != last)
  {
    vtkErrorMacro(<< problem);
  }
  last = problem;
}

int vtkSplattingMIPRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (request == vtkPVView::REQUEST_RENDER())
  {
    this->InteractiveRender = isInteractive(inInfo);
  }
  return this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
}

// Why there is no separate opacity array, or an empty string. The superclass does not check this.
std::string vtkSplattingMIPRepresentation::CheckOpacityArray(vtkDataSet* volume)
{
  const int association = this->OpacityArrayFieldAssociation;
  const bool isOfGrid = association == vtkDataObject::POINT || association == vtkDataObject::CELL;
  vtkDataArray* opacity = isOfGrid
    ? volume->GetAttributes(association)->GetArray(this->OpacityArrayName.c_str())
    : nullptr;
  if (!opacity)
  {
    return "There is no array \"" + this->OpacityArrayName +
      "\" to take opacity from: choose one of the input's point or cell arrays.";
  }
  vtkDataArray* color = this->GetInputArrayToProcess(0, volume);
  if (!color)
  {
    return "Opacity from an array of its own needs an array to colour by: choose one.";
  }
  if (color->GetNumberOfTuples() != opacity->GetNumberOfTuples())
  {
    return "The arrays for colour and for opacity must both belong to points, or both to cells.";
  }
  if (color->GetNumberOfComponents() != 1 && color->GetNumberOfComponents() != 3)
  {
    return "Opacity from an array of its own goes with colour from 1 or 3 components, not from " +
      std::to_string(color->GetNumberOfComponents()) + ".";
  }
  return {};
}

int vtkSplattingMIPRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (inputVector[0]->GetNumberOfInformationObjects() != 1)
  {
    return this->Superclass::RequestData(request, inputVector, outputVector);
  }
  std::string problem;
  vtkInformation* inputInfo = inputVector[0]->GetInformationObject(0);
  vtkSmartPointer<vtkDataSet> volume =
    findVolume(inputInfo->Get(vtkDataObject::DATA_OBJECT()), problem);
  if (!volume)
  {
    volume = vtkSmartPointer<vtkImageData>::New();
  }
  if (this->GetSeveralRanks())
  {
    volume = keptWhole(volume);
  }
  const bool wantsOpacityArray = this->UseSeparateOpacityArray;
  if (wantsOpacityArray && problem.empty())
  {
    problem = this->CheckOpacityArray(volume);
  }
  this->Complain(this->InputProblem, problem);

  // The superclass gets the volume itself, without the composite data.
  vtkNew<vtkInformation> volumeInfo;
  volumeInfo->Copy(inputInfo);
  volumeInfo->Set(vtkDataObject::DATA_OBJECT(), volume);
  vtkNew<vtkInformationVector> volumes;
  volumes->Append(volumeInfo);
  vtkInformationVector* volumeVector[] = { volumes };
  this->OpacityArrayIsUsable = wantsOpacityArray && problem.empty();
  this->UseSeparateOpacityArray = this->OpacityArrayIsUsable;
  const int result = this->Superclass::RequestData(request, volumeVector, outputVector);
  this->UseSeparateOpacityArray = wantsOpacityArray;
  return result;
}

// The array of the mapper. Without an array to colour by, sets it to the active scalars or else the
// first array.
vtkDataArray* vtkSplattingMIPRepresentation::FindScalars(vtkDataSet* volume, bool isColored)
{
  vtkVolumeMapper* mapper = this->VolumeMapper;
  if (isColored)
  {
    int cellFlag = 0;
    return vtkAbstractMapper::GetScalars(volume, mapper->GetScalarMode(),
      mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), cellFlag);
  }
  const std::pair<vtkDataSetAttributes*, int> attributes[] = {
    { volume->GetPointData(), VTK_SCALAR_MODE_USE_POINT_FIELD_DATA },
    { volume->GetCellData(), VTK_SCALAR_MODE_USE_CELL_FIELD_DATA }
  };
  for (const bool active : { true, false })
  {
    for (const auto& [data, mode] : attributes)
    {
      for (int i = 0; i < data->GetNumberOfArrays(); ++i)
      {
        vtkDataArray* array = data->GetArray(i);
        const bool isGhosts = array == data->GetGhostArray();
        if (array && !isGhosts && (!active || array == data->GetScalars()))
        {
          mapper->SetScalarMode(mode);
          mapper->SelectScalarArray(i);
          return array;
        }
      }
    }
  }
  return nullptr;
}

// Sets opaque gray functions over the range of the scalars.
void vtkSplattingMIPRepresentation::ShowInGray(const double rangeOfScalars[2], int components)
{
  double range[2] = { rangeOfScalars[0], rangeOfScalars[1] };
  if (!(range[0] < range[1]))
  {
    range[0] = range[0] <= range[1] ? range[0] : 0.0; // one value, or none
    range[1] = range[0] + 1.0;
  }
  vtkColorTransferFunction* colors = this->GrayProperty->GetRGBTransferFunction();
  if (colors->GetSize() != 2 || colors->GetRange()[0] != range[0] ||
    colors->GetRange()[1] != range[1])
  {
    colors->RemoveAllPoints();
    colors->AddRGBPoint(range[0], 0.0, 0.0, 0.0);
    colors->AddRGBPoint(range[1], 1.0, 1.0, 1.0);
    vtkPiecewiseFunction* opacity = this->GrayProperty->GetScalarOpacity();
    opacity->RemoveAllPoints();
    opacity->AddPoint(range[0], 1.0);
  }
  this->GetSplattingMapper()->SetVectorMode(components == 1
      ? vtkSplattingMIPVolumeMapper::DISABLED
      : vtkSplattingMIPVolumeMapper::MAGNITUDE);
}

// Selects the component or magnitude of the colour map. Returns an error message, or an empty
// string.
std::string vtkSplattingMIPRepresentation::SelectComponents(vtkDataArray* scalars)
{
  vtkSplattingMIPVolumeMapper* mapper = this->GetSplattingMapper();
  if (scalars->GetNumberOfComponents() == 1 || !this->Property->GetIndependentComponents())
  {
    mapper->SetVectorMode(vtkSplattingMIPVolumeMapper::DISABLED);
    return {};
  }
  vtkColorTransferFunction* colors = this->Property->GetRGBTransferFunction();
  if (colors->GetVectorMode() != vtkScalarsToColors::COMPONENT)
  {
    mapper->SetVectorMode(vtkSplattingMIPVolumeMapper::MAGNITUDE);
    return {};
  }
  mapper->SetVectorMode(vtkSplattingMIPVolumeMapper::COMPONENT);
  mapper->SetVectorComponent(colors->GetVectorComponent());
  if (colors->GetVectorComponent() > largestComponent)
  {
    return "Splatting MIP shows one of the first four components: choose one of these, or the "
           "magnitude.";
  }
  return {};
}

void vtkSplattingMIPRepresentation::UpdateMapperParameters()
{
  // The superclass requires arrays for opacity and colour that may be missing.
  const bool wantsOpacityArray = this->UseSeparateOpacityArray;
  this->UseSeparateOpacityArray = this->OpacityArrayIsUsable;
  this->Superclass::UpdateMapperParameters();
  this->UseSeparateOpacityArray = wantsOpacityArray;

  vtkSplattingMIPVolumeMapper* mapper = this->GetSplattingMapper();
  const bool isAutomatic = this->InteractiveQualityMode == AUTOMATIC;
  mapper->SetAutoAdjustSampleDistances(isAutomatic);
  mapper->SetQualityMode(
    this->InteractiveRender && !isAutomatic ? this->InteractiveQualityMode : this->QualityMode);

  auto volume = vtkDataSet::SafeDownCast(mapper->GetDataSetInput());
  if (!volume && this->GetSeveralRanks())
  {
    vtkNew<vtkImageData> nothing;
    mapper->SetInputDataObject(nothing);
    volume = nothing; // owned by the mapper
  }
  if (!volume)
  {
    // A client without data gets an empty input, and draws at most the outline.
    mapper->RemoveAllInputs();
    this->Actor->SetVisibility(true);
    return;
  }
  const char* name = mapper->GetArrayName();
  const bool isColored = name && name[0];
  vtkDataArray* scalars = this->FindScalars(volume, isColored);
  this->Actor->SetProperty(isColored ? this->Property : this->GrayProperty);
  std::string problem;
  if (scalars && isColored)
  {
    problem = this->SelectComponents(scalars);
  }
  else if (scalars && !this->GetSeveralRanks())
  {
    const int components = scalars->GetNumberOfComponents();
    double range[2];
    scalars->GetFiniteRange(range, components == 1 ? 0 : -1);
    this->ShowInGray(range, components);
  }
  else if (!scalars && volume->GetNumberOfPoints() > 0)
  {
    problem = isColored
      ? "The input has no array \"" + std::string(name) + "\": choose another one."
      : "The input has no array that Splatting MIP could show.";
  }
  this->Complain(this->ArrayProblem, problem);
  this->Actor->SetVisibility(scalars && problem.empty());
  if (this->GetSeveralRanks())
  {
    this->ShowWithOthers(volume, scalars, isColored, !problem.empty());
  }
}

// Agrees with other ranks on whether to show the volume, its bounds, and its range in gray.
void vtkSplattingMIPRepresentation::ShowWithOthers(
  vtkDataSet* volume, vtkDataArray* scalars, bool isColored, bool isWrong)
{
  vtkMultiProcessController* const ranks = this->GetSeveralRanks();
  constexpr double far = VTK_DOUBLE_MAX;
  // Least range, negative greatest one, components of ranks with scalars, and whether there is no
  // error.
  double here[4] = { far, far, -1.0, isWrong ? 0.0 : 1.0 }, all[4];
  if (scalars && volume->GetNumberOfPoints() > 0)
  {
    const int components = scalars->GetNumberOfComponents();
    double range[2];
    scalars->GetFiniteRange(range, components == 1 ? 0 : -1);
    here[0] = range[0];
    here[1] = -range[1];
    here[2] = -components;
  }
  ranks->AllReduce(here, all, 4, vtkCommunicator::MIN_OP);
  const bool isShown = all[3] > 0.0 && all[0] < far;
  this->Actor->SetVisibility(isShown);
  if (isShown && !isColored)
  {
    const double range[2] = { all[0], -all[1] };
    this->ShowInGray(range, static_cast<int>(-all[2]));
  }
  if (isShown)
  {
    this->GetSplattingMapper()->UpdateWhole();
  }
}
