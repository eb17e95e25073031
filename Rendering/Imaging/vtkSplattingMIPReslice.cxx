// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplattingMIPReslice.h"

#include "AbortCheck.h"
#include "Cells/CellProjector.h"
#include "Common/Parallel.h"
#include "Input/ScalarSource.h"
#include "Input/WorldView.h"
#include "Volume/VoxelCopies.h"

#include "vtkAbstractTransform.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkImageInterpolator.h"
#include "vtkImageStencilData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkWeakPointer.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>
#include <vector>

using namespace splatting;

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkSplattingMIPReslice);

namespace
{
/// VTK's tolerance of positions, in voxels, and of rounding: VTK_INTERPOLATE_FLOOR_TOL.
constexpr double Tolerance = 0x1p-17;
/// The input is this many voxels larger, so that lines along its sides cross it.
constexpr double Widening = 0x1p-19;

/// Clamps and rounds a value as vtkImageReslice does.
template <class T>
T scalarOf(double value)
{
  if constexpr (std::is_integral_v<T>)
  {
    constexpr T least = std::numeric_limits<T>::lowest(), most = std::numeric_limits<T>::max();
    const double whole = std::floor(value + (0.5 + Tolerance));
    return !(whole > static_cast<double>(least)) ? least
      : whole >= static_cast<double>(most)       ? most
                                                 : static_cast<T>(whole);
  }
  return static_cast<T>(value);
}

/// The voxels with a border beyond the outermost centres.
CellGrid gridOf(const VoxelArray& voxels, double border)
{
  CellGrid grid(voxels, glm::ivec3(0), voxels.dimensions, true);
  for (int a = 0; a < 3; ++a)
  {
    const double beyond = std::max(border, voxels.dimensions[a] == 1 ? 0.5 : Tolerance) + Widening;
    grid.low[a] = -beyond;
    grid.high[a] = voxels.dimensions[a] - 1 + beyond;
  }
  return grid;
}

/// The pixels of a row that a stencil selects.
template <class F>
void forSpans(vtkImageStencilData* stencil, const int extent[6], int y, int z, F&& f)
{
  if (!stencil)
  {
    f(extent[0], extent[1]);
    return;
  }
  int first, last, iterator = 0;
  while (stencil->GetNextExtent(first, last, extent[0], extent[1], y, z, iterator))
  {
    f(first, last);
  }
}
}

//------------------------------------------------------------------------------
class vtkSplattingMIPReslice::Internals
{
public:
  explicit Internals(vtkSplattingMIPReslice* self);

  bool HasSlab() const;
  bool Load(vtkImageData* input);
  bool FindRays(vtkImageData* input, const int whole[6]);
  bool Project(vtkImageData* output);

private:
  struct Component
  {
    std::vector<unsigned char> copy; // if components are interleaved
    VoxelArray voxels;
    VolumeIndex::Range range;
    CellIndex cells;
    CellScreen screen;
  };

  bool IsLoaded(vtkDataArray* scalars, int first, std::size_t count) const;
  splatting::View ViewOf(int z) const;
  bool ReportProgress(double done);
  template <class T>
  void Write(vtkImageData* output, int z, const T*) const;
  template <class T>
  void WriteRow(const int extent[6], int y, int z, T* row) const;

  vtkSplattingMIPReslice* const Self;
  CellProjector Projector;
  std::vector<Component> Components;
  vtkWeakPointer<vtkDataArray> Scalars; // of the components
  vtkMTimeType Time = 0;
  const void* Buffer = nullptr;
  int First = 0;                  // component
  glm::ivec3 Dimensions{ 0 };     // of the input
  glm::dmat4 ToOutput{ 1.0 };     // from indices of the input, 0 first, to those of the output
  glm::ivec2 Corner{ 0 };         // the output's first column and row
  glm::ivec2 Size{ 0 };           // of all its slices
  double Parts = 1.0, Done = 0.0; // projections
  double Reported = 0.0;          // progress
};

//------------------------------------------------------------------------------
vtkSplattingMIPReslice::Internals::Internals(vtkSplattingMIPReslice* self) : Self(self)
{
  this->Projector.observer().setCallback(
    [this](double done) { return this->ReportProgress(done); });
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPReslice::Internals::ReportProgress(double done)
{
  const double share = (this->Done + done) / this->Parts;
  // At most 100 events in all.
  if (share >= this->Reported + 0.01)
  {
    this->Reported = share;
    this->Self->UpdateProgress(std::min(share, 1.0));
  }
  return !isAborted(this->Self);
}

//------------------------------------------------------------------------------
// Whether the properties define slabs that can be exact.
bool vtkSplattingMIPReslice::Internals::HasSlab() const
{
  const vtkSplattingMIPReslice& s = *this->Self;
  const vtkMatrix4x4* const m = s.IndexMatrix;
  return (s.SlabMode == VTK_IMAGE_SLAB_MAX || s.SlabMode == VTK_IMAGE_SLAB_MIN) &&
    s.SlabNumberOfSlices > 1 && s.InterpolationMode == VTK_RESLICE_LINEAR &&
    vtkImageInterpolator::SafeDownCast(s.Interpolator) && !s.Wrap && !s.Mirror &&
    !s.OptimizedTransform && !s.HasConvertScalars && !(s.Border && s.BorderThickness >= 1.0) && m &&
    m->Element[3][0] == 0.0 && m->Element[3][1] == 0.0 && m->Element[3][2] == 0.0 &&
    m->Element[3][3] == 1.0;
}

//------------------------------------------------------------------------------
bool vtkSplattingMIPReslice::Internals::IsLoaded(
  vtkDataArray* scalars, int first, std::size_t count) const
{
  return this->Scalars == scalars && this->Time == scalars->GetMTime() &&
    this->Buffer == componentOf(scalars, first).voxels && this->First == first &&
    this->Components.size() == count;
}

//------------------------------------------------------------------------------
// Finds the voxels of all components. Returns false if they cannot be projected.
bool vtkSplattingMIPReslice::Internals::Load(vtkImageData* input)
{
  vtkDataArray* const scalars = input->GetPointData()->GetScalars();
  const vtkIdType voxels = input->GetNumberOfPoints();
  if (!scalars || voxels < 1 || scalars->GetNumberOfTuples() != voxels ||
    scalars->GetNumberOfComponents() < 1 || !componentOf(scalars, 0).voxels)
  {
    return false;
  }
  const int available = scalars->GetNumberOfComponents();
  const int first = std::clamp(this->Self->Interpolator->GetComponentOffset(), 0, available - 1);
  const int count = this->Self->Interpolator->ComputeNumberOfComponents(available);
  if (!this->IsLoaded(scalars, first, count))
  {
    this->Scalars = nullptr; // in case memory is exhausted
    this->Components.clear();
    this->Components.resize(count);
    for (int c = 0; c < count; ++c)
    {
      Component& component = this->Components[c];
      StridedVoxels from = componentOf(scalars, first + c);
      if (from.stride != 1)
      {
        component.copy.resize(voxels * sizeOf(from.type));
        gather(from, voxels, component.copy.data());
        from.voxels = component.copy.data();
      }
      component.voxels = { from.voxels, from.type, this->Dimensions };
      VolumeIndex index;
      index.setBudget(0); // the range alone
      index.reset(component.voxels);
      component.range = index.range();
    }
    this->Scalars = scalars;
    this->Time = scalars->GetMTime();
    this->Buffer = componentOf(scalars, first).voxels;
    this->First = first;
  }
  const double border = this->Self->Border ? this->Self->BorderThickness : 0.0;
  bool fits = true;
  for (Component& component : this->Components)
  {
    component.voxels.dimensions = this->Dimensions;
    component.cells.update(gridOf(component.voxels, border), component.range);
    fits =
      fits && component.range.magnitude <= mostMagnitude(component.voxels.type, component.range);
  }
  return fits;
}

//------------------------------------------------------------------------------
// Returns false if the output is flat in the input, or the slab is.
// @param whole  extent of the output, so that all parts of it have the same rays
bool vtkSplattingMIPReslice::Internals::FindRays(vtkImageData* input, const int whole[6])
{
  this->Corner = { whole[0], whole[2] };
  this->Size = glm::ivec2(whole[1], whole[3]) - this->Corner + 1;
  const int* const in = input->GetExtent();
  input->GetDimensions(&this->Dimensions.x);
  const glm::dmat4 toInput = glm::translate(glm::dmat4(1.0), -glm::dvec3(in[0], in[2], in[4])) *
    toGlm(this->Self->IndexMatrix);
  this->ToOutput = glm::inverse(toInput);
  const splatting::View view = this->ViewOf(whole[4]);
  const double thickness = (this->Self->SlabNumberOfSlices - 1) *
    std::abs(this->Self->SlabSliceSpacingFraction) * glm::length(glm::dvec3(toInput[2]));
  return isFinite(view) && PixelRays().find(view) && thickness > CellProjector::ShortestRay;
}

//------------------------------------------------------------------------------
// The lines of a slice of the output, whose pixels are those of the view.
splatting::View vtkSplattingMIPReslice::Internals::ViewOf(int z) const
{
  splatting::View view;
  view.dimensions = this->Dimensions;
  view.viewport = this->Size;
  const glm::dmat4 unit(1.0);
  view.indexToClip = glm::translate(unit, glm::dvec3(-1.0, -1.0, 0.0)) *
    glm::scale(unit, glm::dvec3(2.0 / glm::dvec2(this->Size), 1.0)) *
    glm::translate(unit, glm::dvec3(0.5 - glm::dvec2(this->Corner), 0.0)) * this->ToOutput;
  view.showsBoxes = true;
  const double half =
    0.5 * (this->Self->SlabNumberOfSlices - 1) * std::abs(this->Self->SlabSliceSpacingFraction);
  const glm::dvec4 slice = glm::row(this->ToOutput, 2);
  view.halfSpaces.push_back(slice + glm::dvec4(0.0, 0.0, 0.0, half - z));
  view.halfSpaces.push_back(-slice + glm::dvec4(0.0, 0.0, 0.0, half + z));
  return view;
}

//------------------------------------------------------------------------------
// Fills the output. Returns false if it was stopped.
bool vtkSplattingMIPReslice::Internals::Project(vtkImageData* output)
{
  int extent[6];
  output->GetExtent(extent);
  ProjectionSettings settings;
  settings.quality = Quality::Exact;
  settings.reduction =
    this->Self->SlabMode == VTK_IMAGE_SLAB_MIN ? Reduction::Minimum : Reduction::Maximum;
  const glm::ivec2 first(extent[0], extent[2]), last(extent[1], extent[3]);
  const glm::ivec2 part[2] = { first - this->Corner, last - first + 1 };
  this->Parts = double(this->Components.size()) * std::max(extent[5] - extent[4] + 1, 1);
  this->Done = this->Reported = 0.0;
  for (int z = extent[4]; z <= extent[5]; ++z)
  {
    const splatting::View view = this->ViewOf(z);
    for (Component& component : this->Components)
    {
      if (!this->Projector.project(
            component.cells, view, settings, {}, false, part, component.screen))
      {
        return false;
      }
      this->Done += 1.0;
    }
    switch (output->GetScalarType())
    {
      vtkTemplateMacro(this->Write(output, z, static_cast<const VTK_TT*>(nullptr)));
    }
  }
  return true;
}

//------------------------------------------------------------------------------
template <class T>
void vtkSplattingMIPReslice::Internals::Write(vtkImageData* output, int z, const T*) const
{
  const int* const extent = output->GetExtent();
  T* const slice = static_cast<T*>(output->GetScalarPointer(extent[0], extent[2], z));
  const std::ptrdiff_t row = std::ptrdiff_t(this->Components.size()) * (extent[1] - extent[0] + 1);
  parallelFor(extent[2], extent[3] + 1, 16,
    [&](std::ptrdiff_t begin, std::ptrdiff_t end)
    {
      for (std::ptrdiff_t y = begin; y < end; ++y)
      {
        this->WriteRow(extent, static_cast<int>(y), z, slice + (y - extent[2]) * row);
      }
    });
}

//------------------------------------------------------------------------------
template <class T>
void vtkSplattingMIPReslice::Internals::WriteRow(const int extent[6], int y, int z, T* row) const
{
  const std::size_t components = this->Components.size();
  const int width = extent[1] - extent[0] + 1;
  std::vector<unsigned char> isSampled(width); // in any component
  for (std::size_t c = 0; c < components; ++c)
  {
    const double* const color = this->Self->BackgroundColor;
    const T background = scalarOf<T>(c < 4 ? color[c] : 0.0);
    for (int x = 0; x < width; ++x)
    {
      row[x * components + c] = background;
    }
    const CellScreen& screen = this->Components[c].screen;
    const int line = y - this->Corner.y - screen.origin.y;
    if (line < 0 || line >= screen.size.y)
    {
      continue;
    }
    const double shift = this->Self->ScalarShift, scale = this->Self->ScalarScale;
    const auto copy = [&](const auto* values, int first, int last)
    {
      const int left = this->Corner.x + screen.origin.x;
      for (int x = std::max(first, left); x <= std::min(last, left + screen.size.x - 1); ++x)
      {
        const double value = static_cast<double>(values[x - left]);
        if (value == value)
        {
          row[(x - extent[0]) * components + c] = scalarOf<T>((value + shift) * scale);
          isSampled[x - extent[0]] = 1;
        }
      }
    };
    forSpans(this->Self->GetStencil(), extent, y, z,
      [&](int first, int last)
      {
        screen.type == ScalarType::Float32 ? copy(screen.row<float>(line), first, last)
                                           : copy(screen.row<double>(line), first, last);
      });
  }
  if (this->Self->GenerateStencilOutput)
  {
    for (auto end = isSampled.begin(); end != isSampled.end();)
    {
      const auto begin = std::find(end, isSampled.end(), 1);
      end = std::find(begin, isSampled.end(), 0);
      if (begin != end)
      {
        this->Self->GetStencilOutput()->InsertNextExtent(
          extent[0] + static_cast<int>(begin - isSampled.begin()),
          extent[0] + static_cast<int>(end - isSampled.begin()) - 1, y, z);
      }
    }
  }
}

//------------------------------------------------------------------------------
vtkSplattingMIPReslice::vtkSplattingMIPReslice() : Internal(new Internals(this)) {}

//------------------------------------------------------------------------------
vtkSplattingMIPReslice::~vtkSplattingMIPReslice() = default;

//------------------------------------------------------------------------------
int vtkSplattingMIPReslice::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int result = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  if (this->Internal->HasSlab())
  {
    // Slabs of other positions then use the same voxels, and their index.
    vtkInformation* const info = inputs[0]->GetInformationObject(0);
    int whole[6] = { 0, -1, 0, -1, 0, -1 };
    info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), whole, 6);
    if (this->GetNumberOfInputConnections(1) > 0)
    {
      // The superclass requests slices that a stencil of the output does not have.
      int part[6] = { 0, -1, 0, -1, 0, -1 };
      outputs->GetInformationObject(0)->Get(
        vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), part);
      inputs[1]->GetInformationObject(0)->Set(
        vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), part, 6);
    }
  }
  return result;
}

//------------------------------------------------------------------------------
int vtkSplattingMIPReslice::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* const input = vtkImageData::GetData(inputs[0]);
  vtkImageData* const output = vtkImageData::GetData(outputs);
  int whole[6] = { 0, -1, 0, -1, 0, -1 };
  outputs->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  this->SlabIsExact = false;
  bool isFilled = false;
  try
  {
    if (!this->Internal->HasSlab() || !this->Internal->FindRays(input, whole) ||
      !this->Internal->Load(input))
    {
      return this->Superclass::RequestData(request, inputs, outputs);
    }
    this->PrepareImageData(inputs, outputs);
    isFilled = this->Internal->Project(output);
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("There is not enough memory for the slabs: free memory, or choose fewer pixels.");
  }
  this->SlabIsExact = isFilled;
  if (!isFilled)
  {
    output->Initialize();
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkSplattingMIPReslice::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SlabIsExact: " << (this->SlabIsExact ? "Yes\n" : "No\n");
}
VTK_ABI_NAMESPACE_END
