// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/AxisCells.h"

#include "Sampling/ExactSegments.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
/// Farthest outside the volume that cells are told apart.
constexpr int Margin = 4;
}

template <class A>
typename AxisCells<A>::Depths AxisCells<A>::depthsIn(
  double begin, double end, double at, double slope, double reference)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (slope == 0.0)
  {
    return begin <= at && at <= end ? Depths{ -infinity, infinity } : Depths{ infinity, -infinity };
  }
  const double p = reference + (begin - at) / slope, q = reference + (end - at) / slope;
  return { std::min(p, q), std::max(p, q) };
}

template <class A>
void AxisCells<A>::find(const ShearWarp& whole, const ShearWarp& part, int a)
{
  constexpr std::size_t unit = 64;
  const AxisRays& rays = a == 0 ? whole.columns() : whole.rows();
  this->Slices = part.slices();
  this->Count = whole.rayCount()[a];
  this->Size = part.size()[a];
  this->Padded = (this->Count + unit) / unit * unit + unit;
  const std::size_t slices = this->Slices.end - this->Slices.begin;
  this->Cells.resize(slices * this->Padded);
  this->Values.resize(slices * ArrayCount * this->Padded);
  this->Slopes.assign(this->Padded, A(0));
  this->FieldNear.assign(this->Padded, std::numeric_limits<A>::infinity());
  this->FieldFar.assign(this->Padded, -std::numeric_limits<A>::infinity());
  this->Field.resize(this->Count);
  this->Boxes.resize(this->Count);
  const FieldRange range(whole, a);
  for (int n = 0; n < this->Count; ++n)
  {
    const double at = rays.at[n], slope = rays.slope[n];
    this->Field[n] = depthsIn(range.begin, range.end, at, slope, whole.reference());
    this->Boxes[n] = depthsIn(-0.5, whole.size()[a] - 0.5, at, slope, whole.reference());
    this->Slopes[n] = static_cast<A>(slope);
    this->FieldNear[n] = static_cast<A>(this->Field[n][0]);
    this->FieldFar[n] = static_cast<A>(this->Field[n][1]);
  }
  vtkSMPTools::For(this->Slices.begin, this->Slices.end, 8,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType k = begin; k < end; ++k)
      {
        this->findSlice(whole, part, a, static_cast<int>(k));
      }
    });
}

template <class A>
void AxisCells<A>::findSlice(const ShearWarp& whole, const ShearWarp& part, int a, int k)
{
  const AxisRays& rays = a == 0 ? whole.columns() : whole.rows();
  const int slice = k + part.first().z, firstVoxel = part.first()[a];
  const glm::dvec2 faces = whole.faces(slice) - whole.reference();
  std::int32_t* const cells = &this->Cells[std::size_t(k - this->Slices.begin) * this->Padded];
  const auto relative = [slice](double depth)
  { return static_cast<A>(std::clamp(depth - slice, -1.0, 1.0)); };
  for (int n = 0; n < this->Count; ++n)
  {
    const double at = rays.at[n], slope = rays.slope[n];
    const double p = at + slope * faces.x, q = at + slope * faces.y;
    const double low = std::min(p, q), high = std::max(p, q), cell = std::floor(low);
    const double middle = at + slope * (slice - whole.reference());
    cells[n] = static_cast<std::int32_t>(
      std::clamp<double>(cell - firstVoxel, -Margin, this->Size + Margin));
    this->array(k, At)[n] = static_cast<A>(middle - cell);
    // Rays move by a voxel or less: they pass one whole number at most.
    this->array(k, Crossing)[n] =
      cell + 1.0 < high ? static_cast<A>((cell + 1.0 - middle) / slope) : A(2);
    this->array(k, FieldBegin)[n] = relative(this->Field[n][0]);
    this->array(k, FieldEnd)[n] = relative(this->Field[n][1]);
    this->array(k, BoxesBegin)[n] = relative(this->Boxes[n][0]);
    this->array(k, BoxesEnd)[n] = relative(this->Boxes[n][1]);
  }
  // Columns that fill registers are nowhere.
  const std::size_t count = this->Count;
  std::fill(cells + count, cells + this->Padded, count > 0 ? cells[count - 1] : 0);
  const A fill[ArrayCount] = { A(0), A(2), A(1), A(-1), A(1), A(-1) };
  for (int which = 0; which < ArrayCount; ++which)
  {
    std::fill(this->array(k, which) + count, this->array(k, which) + this->Padded, fill[which]);
  }
}

template <class A>
AxisCellArrays<A> AxisCells<A>::slice(int k) const
{
  const std::size_t n = k - this->Slices.begin;
  const A* const values = &this->Values[n * ArrayCount * this->Padded];
  const auto array = [&](int which) { return values + which * this->Padded; };
  return { &this->Cells[n * this->Padded], array(At), this->Slopes.data(), array(Crossing),
    array(FieldBegin), array(FieldEnd), array(BoxesBegin), array(BoxesEnd), this->FieldNear.data(),
    this->FieldFar.data() };
}

template <class A>
Span AxisCells<A>::voxels(const Span& slices, const Span& pixels) const
{
  Span all{ this->Size + Margin, -Margin };
  const int first = pixels.begin, last = std::min(pixels.end, this->Count) - 1;
  for (int k = std::max(slices.begin, this->Slices.begin);
       k < std::min(slices.end, this->Slices.end) && first <= last; ++k)
  {
    // Cells ascend, but for the rounding of rays that meet in the eye.
    const std::int32_t* const cells = this->slice(k).cell;
    all.begin = std::min<int>(all.begin, cells[first] - 1);
    all.end = std::max<int>(all.end, cells[last] + 4);
  }
  return all;
}

template class AxisCells<float>;
template class AxisCells<double>;
}
