// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ScalarSource.h"

#include "Input/Blanking.h"

#include "vtkAbstractMapper.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkTimerLog.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace splatting
{
namespace
{
template <class T>
ScalarType sizedType()
{
  constexpr bool isSigned = std::numeric_limits<T>::is_signed;
  switch (sizeof(T))
  {
    case 1:
      return isSigned ? ScalarType::Int8 : ScalarType::UInt8;
    case 2:
      return isSigned ? ScalarType::Int16 : ScalarType::UInt16;
    case 4:
      return isSigned ? ScalarType::Int32 : ScalarType::UInt32;
    default:
      return isSigned ? ScalarType::Int64 : ScalarType::UInt64;
  }
}

/// Whether an array stores its components separately. VTK 9.3 to 9.6 may interleave them, at once
/// or at the first GetVoidPointer(), without changing its type.
template <class T>
bool isSeparate(vtkSOADataArrayTemplate<T>* array)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0) &&                                            \
  VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 7, 0)
  struct Storage : vtkSOADataArrayTemplate<T>
  {
    static bool isSeparate(vtkSOADataArrayTemplate<T>* array)
    {
      return array->*(&Storage::StorageType) == Storage::SOA;
    }
  };
  return Storage::isSeparate(array);
#else
  return array != nullptr;
#endif
}

template <class T>
StridedVoxels componentOfType(vtkDataArray* array, int component)
{
  const ScalarType type = scalarTypeOfVtk(array->GetDataType());
  auto* const structure = vtkSOADataArrayTemplate<T>::SafeDownCast(array);
  if (structure && isSeparate(structure))
  {
    return { structure->GetComponentArrayPointer(component), type, 1 };
  }
  const bool isInterleaved = structure || array->HasStandardMemoryLayout();
  return { isInterleaved ? array->GetVoidPointer(component) : nullptr, type,
    array->GetNumberOfComponents() };
}

std::ptrdiff_t count(const glm::ivec3& size)
{
  return std::ptrdiff_t(size.x) * size.y * size.z;
}

/// The latest time of the data set and its contents.
vtkMTimeType timeOf(vtkDataSet* input)
{
  vtkMTimeType time = input->GetMTime();
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(input))
  {
    for (vtkDataArray* coordinates :
      { grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates() })
    {
      time = std::max(time, coordinates ? coordinates->GetMTime() : 0);
    }
  }
  return time;
}

/// The error of the data set, except for its arrays and geometry.
std::string validateDataSet(vtkDataSet* input)
{
  if (!input)
  {
    return "There is no input: connect a vtkImageData with SetInputData or SetInputConnection.";
  }
  if (!vtkImageData::SafeDownCast(input) && !vtkRectilinearGrid::SafeDownCast(input))
  {
    return std::string("The input is a ") + input->GetClassName() +
      ", only vtkImageData and vtkRectilinearGrid can be splatted: resample it with "
      "vtkResampleToImage.";
  }
  if (input->GetNumberOfPoints() < 1)
  {
    return "The input has no voxels: its extent is empty.";
  }
  return {};
}

/// The voxels of one of several components, in an array of T. NaN is replaced by the least number.
/// Returns false if all are NaN.
template <class T>
bool interleave(const VoxelArray& volume, int component, int components, T* out)
{
  const T* const in = static_cast<const T*>(volume.voxels);
  const std::ptrdiff_t n = count(volume.dimensions);
  bool found = false;
  T filler = T(0);
  for (std::ptrdiff_t voxel = 0; voxel < n; ++voxel)
  {
    const T value = in[voxel];
    if (value == value && (value < filler || !found))
    {
      filler = value;
      found = true;
    }
  }
  for (std::ptrdiff_t voxel = 0; voxel < n; ++voxel)
  {
    const T value = in[voxel];
    out[voxel * components + component] = value == value ? value : filler;
  }
  return found;
}

/// Whether one of the contiguous values is NaN.
bool hasNaN(vtkDataArray* scalars)
{
  return dispatch(scalarTypeOfVtk(scalars->GetDataType()),
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const T* const begin = static_cast<const T*>(scalars->GetVoidPointer(0));
      return !std::is_integral_v<T> &&
        std::any_of(
          begin, begin + scalars->GetNumberOfValues(), [](T value) { return value != value; });
    });
}
}

ScalarType scalarTypeOfVtk(int vtkType)
{
  if (vtkType == VTK_DOUBLE)
  {
    return ScalarType::Float64;
  }
  if (vtkType == VTK_FLOAT)
  {
    return ScalarType::Float32;
  }
  switch (vtkType)
  {
    vtkTemplateMacro(return sizedType<VTK_TT>());
  }
  return ScalarType::Float32;
}

StridedVoxels componentOf(vtkDataArray* array, int component)
{
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return componentOfType<VTK_TT>(array, component));
  }
  return { nullptr, ScalarType::Float32, 1 };
}

const char* const ScalarSource::NoMemory = "There is not enough memory to project this volume: "
                                           "free memory, lower IndexMemoryBudget, or show "
                                           "a part of the volume or fewer components.";

ScalarSource::ScalarSource() = default;

ScalarSource::~ScalarSource() = default;

bool ScalarSource::Key::operator==(const Key& other) const
{
  return this->input == other.input && this->time == other.time && this->scalars == other.scalars &&
    this->buffer == other.buffer && this->vectorMode == other.vectorMode &&
    this->vectorComponent == other.vectorComponent && this->cells == other.cells &&
    this->independent == other.independent && this->mask == other.mask &&
    this->maskTime == other.maskTime;
}

// Sets choices without effect to the same value, so that their changes are ignored.
void ScalarSource::Key::DropIdle()
{
  constexpr int all = ScalarChoice::Disabled;
  constexpr int one = ScalarChoice::Component;
  const bool isSingle = this->scalars->GetNumberOfComponents() == 1;
  if (isSingle && !(this->vectorMode == one && this->vectorComponent > 0)) // which is an error
  {
    this->vectorMode = all;
  }
  this->vectorComponent = this->vectorMode == one ? this->vectorComponent : 0;
  this->independent = this->independent || isSingle || this->vectorMode != all;
}

void* ScalarSource::Copy::Allocate(std::ptrdiff_t voxels, ScalarType type)
{
  this->size = static_cast<std::size_t>(voxels) * sizeOf(type);
  this->bytes.reset(new unsigned char[this->size]);
  return this->bytes.get();
}

std::string ScalarSource::Examine(vtkDataSet* input, const ScalarChoice& choice)
{
  Key key;
  std::string problem = validateDataSet(input);
  if (problem.empty())
  {
    problem = this->FindScalars(input, choice, key);
  }
  if (problem.empty() && key == this->Examined)
  {
    return problem;
  }
  this->StandIn = nullptr; // releases the old scalars
  this->StandInCopy = nullptr;
  if (problem.empty())
  {
    problem = this->CheckComponents(key);
  }
  if (problem.empty())
  {
    problem = problemOfBlanking(input, key.cells, key.mask);
  }
  if (problem.empty())
  {
    problem = describeGrid(input, key.cells, this->Layout);
  }
  this->Examined = problem.empty() ? key : Key{};
  return problem;
}

// Finds the chosen array. Returns an error message, or an empty string.
std::string ScalarSource::FindScalars(vtkDataSet* input, const ScalarChoice& choice, Key& key) const
{
  int cellFlag = 0;
  vtkDataArray* const scalars = vtkAbstractMapper::GetScalars(
    input, choice.scalarMode, choice.arrayAccessMode, choice.arrayId, choice.arrayName, cellFlag);
  if (!scalars)
  {
    return "The input has no numeric scalars under the chosen ScalarMode and array: set them on "
           "the input or choose another with SelectScalarArray.";
  }
  if (cellFlag == 2)
  {
    return "The chosen array is field data, which belongs to neither points nor cells: choose "
           "another ScalarMode.";
  }
  if (scalars->GetDataType() == VTK_BIT)
  {
    return "The scalars are bits: convert them with vtkImageCast.";
  }
  const bool cells = cellFlag == 1;
  const vtkIdType voxels = cells ? input->GetNumberOfCells() : input->GetNumberOfPoints();
  if (scalars->GetNumberOfTuples() != voxels)
  {
    return "The scalars have " + std::to_string(scalars->GetNumberOfTuples()) + " tuples for " +
      std::to_string(voxels) + (cells ? " cells" : " points") + ": the two must agree.";
  }
  // The image's time includes that of its arrays. Images may share an array, and an array may get
  // another buffer without a change of its time.
  key = { input, timeOf(input), scalars, componentOf(scalars, 0).voxels, choice.vectorMode,
    choice.vectorComponent, cells, choice.independentComponents, choice.mask,
    choice.mask ? choice.mask->GetMTime() : 0 };
  key.DropIdle();
  return {};
}

// Finds the projected components. Returns an error message, or an empty string.
std::string ScalarSource::CheckComponents(const Key& key)
{
  const int available = key.scalars->GetNumberOfComponents();
  if (available < 1)
  {
    return "The scalars have no components: set their number to 1.";
  }
  this->Dependent = false;
  this->NumberOfComponents = 1;
  if (key.vectorMode == ScalarChoice::Component && key.vectorComponent >= available)
  {
    return "VectorComponent is " + std::to_string(key.vectorComponent) + ", but the scalars have " +
      std::to_string(available) + " components: choose one that is less.";
  }
  if (key.vectorMode != ScalarChoice::Disabled || available == 1)
  {
    return {};
  }
  if (available > 4 || (!key.independent && available == 3))
  {
    return "The scalars have " + std::to_string(available) +
      " components. Only 1 to 4 independent or 2 or 4 dependent ones can be projected: choose "
      "their magnitude or one of them with SetVectorMode.";
  }
  if (!key.independent && available == 4 && key.scalars->GetDataType() != VTK_UNSIGNED_CHAR)
  {
    return "Four dependent components are red, green, blue and opacity, which must be unsigned "
           "char: convert them with vtkImageCast, or make them independent.";
  }
  this->Dependent = !key.independent;
  this->NumberOfComponents = available;
  return {};
}

bool ScalarSource::IsMagnitude() const
{
  return this->Examined.vectorMode == ScalarChoice::Magnitude &&
    this->Examined.scalars->GetNumberOfComponents() > 1;
}

// The projected components, or those of the projected magnitude.
std::vector<StridedVoxels> ScalarSource::ChosenComponents()
{
  vtkDataArray* scalars = this->Examined.scalars;
  if (!componentOf(scalars, 0).voxels)
  {
    this->Packed.TakeReference(vtkDataArray::CreateDataArray(this->VtkType));
    this->Packed->DeepCopy(scalars);
    scalars = this->Packed;
  }
  const int available = scalars->GetNumberOfComponents();
  const bool one = this->Examined.vectorMode == ScalarChoice::Component;
  const int first = one ? this->Examined.vectorComponent : 0;
  std::vector<StridedVoxels> components;
  for (int c = first; c < (one ? first + 1 : available); ++c)
  {
    components.push_back(componentOf(scalars, c));
  }
  return components;
}

VoxelArray ScalarSource::MakeVolume(
  StridedVoxels voxels, const std::vector<unsigned char>& hidden, Copy& copy) const
{
  const std::ptrdiff_t given = count(this->Layout.dimensions);
  if (!hidden.empty())
  {
    const ScalarType type = averageType(voxels.type);
    void* const shown = copy.Allocate(given, type);
    hide(voxels, hidden.data(), given, shown);
    voxels = { shown, type, 1 };
  }
  if (this->Layout.resampled)
  {
    const bool cells = this->Layout.grid.cells;
    const ScalarType type = cells ? voxels.type : averageType(voxels.type);
    Copy even;
    void* const resampled = even.Allocate(count(this->Layout.grid.dimensions), type);
    (cells ? resampleCells : resamplePoints)(
      voxels, this->Layout.dimensions, this->Layout.axes, resampled);
    copy = std::move(even);
    voxels = { resampled, type, 1 };
  }
  if (voxels.stride != 1)
  {
    void* const gathered = copy.Allocate(given, voxels.type);
    gather(voxels, given, gathered);
    voxels = { gathered, voxels.type, 1 };
  }
  return { voxels.voxels, voxels.type, this->Layout.grid.dimensions };
}

void ScalarSource::Update()
{
  if (this->Volumed == this->Examined)
  {
    return;
  }
  const double start = vtkTimerLog::GetUniversalTime();
  this->Volumed = {};
  this->Volumes.clear();
  this->Copies.clear();
  this->Packed = nullptr;
  this->VtkType = this->Examined.scalars->GetDataType();
  const std::vector<unsigned char> hidden =
    findBlanked(this->Examined.input, this->Examined.cells, this->Examined.mask);
  std::vector<StridedVoxels> components = this->ChosenComponents();
  Copy lengths;
  if (this->IsMagnitude())
  {
    const std::ptrdiff_t voxels = count(this->Layout.dimensions);
    const ScalarType type = averageType(components.front().type);
    magnitude(components, voxels, lengths.Allocate(voxels, type));
    components = { { lengths.bytes.get(), type, 1 } };
  }
  for (const StridedVoxels& component : components)
  {
    Copy copy;
    this->Volumes.push_back(this->MakeVolume(component, hidden, copy));
    // A magnitude that needs no further copy is kept.
    this->Copies.push_back(copy.bytes ? std::move(copy) : std::move(lengths));
  }
  this->Volumed = this->Examined;
  this->Lender = this->Examined.scalars;
  this->LenderTime = this->Lender->GetMTime();
  ++this->NumberOfUpdates;
  this->Seconds = vtkTimerLog::GetUniversalTime() - start;
}

bool ScalarSource::HasVolumes() const
{
  vtkDataArray* const scalars = this->Lender;
  const bool isKept = scalars && scalars->GetMTime() == this->LenderTime;
  const int first =
    this->Volumed.vectorMode == ScalarChoice::Component ? this->Volumed.vectorComponent : 0;
  for (std::size_t c = 0; c < this->Volumes.size(); ++c)
  {
    const VoxelArray& volume = this->Volumes[c];
    const int component = first + static_cast<int>(c);
    const bool isCopy = this->Copies[c].bytes || this->Packed;
    if (!isCopy &&
      !(isKept && scalars->GetNumberOfTuples() == count(volume.dimensions) &&
        component < scalars->GetNumberOfComponents() &&
        componentOf(scalars, component).voxels == volume.voxels))
    {
      return false;
    }
  }
  return true;
}

void ScalarSource::Clear(int vtkType)
{
  this->Examined = this->Volumed = this->Imaged = {};
  this->Volumes.clear();
  this->Copies.clear();
  this->Packed = nullptr;
  this->Lender = nullptr;
  this->StandIn = nullptr;
  this->StandInCopy = nullptr;
  this->VtkType = vtkType;
}

int ScalarSource::VtkTypeOf(ScalarType type) const
{
  if (type == scalarTypeOfVtk(this->VtkType))
  {
    return this->VtkType; // distinguishes char from signed char, and long from long long
  }
  return type == ScalarType::Float32 ? VTK_FLOAT : VTK_DOUBLE;
}

int ScalarSource::AverageVtkType(int vtkType)
{
  const ScalarType type = averageType(scalarTypeOfVtk(vtkType));
  return type == ScalarType::Float32 ? VTK_FLOAT : VTK_DOUBLE;
}

// Whether the chosen array is projected as it is, contiguous and without NaN. Ray casters do not
// exclude NaN. They read the buffer from several threads, and arrays with other layouts would
// create it there.
bool ScalarSource::IsInputArray() const
{
  const bool isPart = this->Examined.vectorMode == ScalarChoice::Component &&
    this->Examined.scalars->GetNumberOfComponents() > 1;
  return !isPart && !this->IsMagnitude() && !this->Layout.resampled &&
    this->Examined.scalars->HasStandardMemoryLayout() &&
    findBlanked(this->Examined.input, this->Examined.cells, this->Examined.mask).empty() &&
    !hasNaN(this->Examined.scalars);
}

// nullptr if no voxel has a number
vtkSmartPointer<vtkDataArray> ScalarSource::InterleavedVolumes() const
{
  const int components = static_cast<int>(this->Volumes.size());
  const auto array = vtkSmartPointer<vtkDataArray>::Take(
    vtkDataArray::CreateDataArray(this->VtkTypeOf(this->Volumes.front().type)));
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(count(this->Layout.grid.dimensions));
  bool found = false;
  for (int c = 0; c < components; ++c)
  {
    dispatch(this->Volumes[c].type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        T* const values = static_cast<T*>(array->GetVoidPointer(0));
        found |= interleave(this->Volumes[c], c, components, values);
      });
  }
  return found ? array : nullptr;
}

vtkImageData* ScalarSource::Image()
{
  if (!this->StandIn || !(this->Imaged == this->Examined))
  {
    this->MakeImage();
  }
  return this->StandIn->GetPointData()->GetScalars() ? this->StandIn.Get() : nullptr;
}

// Makes an image without scalars if no voxel is visible, so that this result is kept, too.
void ScalarSource::MakeImage()
{
  const VolumeGrid& grid = this->Layout.grid;
  const glm::ivec3 last = grid.dimensions - 1;
  glm::ivec3 first(0);
  this->StandIn = vtkSmartPointer<vtkImageData>::New();
  if (auto* const image = vtkImageData::SafeDownCast(this->Examined.input))
  {
    // Cropping refers to the image's axes, so extent and direction are kept.
    const int* const extent = image->GetExtent();
    first = { extent[0], extent[2], extent[4] };
    this->StandIn->SetDirectionMatrix(image->GetDirectionMatrix());
  }
  const glm::dvec4 origin = grid.indexToPhysical * glm::dvec4(-glm::dvec3(first), 1.0);
  this->StandIn->SetExtent(
    first.x, first.x + last.x, first.y, first.y + last.y, first.z, first.z + last.z);
  this->StandIn->SetOrigin(origin.x, origin.y, origin.z);
  this->StandIn->SetSpacing(grid.spacing.x, grid.spacing.y, grid.spacing.z);
  this->StandInCopy = nullptr;
  this->Imaged = {};
  vtkDataArray* scalars = this->Examined.scalars;
  if (!this->IsInputArray())
  {
    this->Update();
    this->StandInCopy = this->InterleavedVolumes();
    scalars = this->StandInCopy;
  }
  this->StandIn->GetPointData()->SetScalars(scalars);
  this->Imaged = this->Examined;
}

std::size_t ScalarSource::MemorySize() const
{
  std::size_t size = 0;
  for (const Copy& copy : this->Copies)
  {
    size += copy.size;
  }
  for (vtkDataArray* array : { this->Packed.Get(), this->StandInCopy.Get() })
  {
    size +=
      array ? static_cast<std::size_t>(array->GetNumberOfValues()) * array->GetDataTypeSize() : 0;
  }
  return size;
}
}
