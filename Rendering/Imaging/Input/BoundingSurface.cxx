// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/BoundingSurface.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCleanPolyData.h"
#include "vtkFeatureEdges.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTriangleFilter.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace splatting
{
namespace
{
const char* const NoPolygons =
  "The bounding surface has no polygons: add some, or remove the surface with "
  "SetBoundingSurface(nullptr).";
const char* const NoArea =
  "The polygons of the bounding surface have no area: add larger ones, or remove the surface with "
  "SetBoundingSurface(nullptr).";
const char* const NoPlaces =
  "The bounding surface has points that are not finite, or farther away than 1e12 voxels: give it "
  "world coordinates about the volume.";

/// Whether the coordinates of a point are finite and not too large.
bool isNear(const glm::dvec3& p)
{
  // false for NaN
  const glm::dvec3 distance = glm::abs(p);
  return distance.x <= 1e12 && distance.y <= 1e12 && distance.z <= 1e12;
}

/// false if the corners are collinear within the rounding of double coordinates
bool hasArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  const glm::dvec3 largest = glm::max(glm::abs(b - a), glm::abs(c - a));
  const double size = std::max({ largest.x, largest.y, largest.z });
  return size > 0.0 && glm::length(glm::cross((b - a) / size, (c - a) / size)) > 1e-14;
}

/// Whether an edge has a triangle on one side only. Points at the same position are merged, because
/// surfaces with normals have several at their edges.
bool isOpen(vtkPolyData* triangles)
{
  vtkNew<vtkCleanPolyData> merge;
  merge->SetInputData(triangles);
  merge->ToleranceIsAbsoluteOn();
  merge->SetAbsoluteTolerance(0.0);
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(merge->GetOutputPort());
  edges->BoundaryEdgesOn();
  edges->FeatureEdgesOff();
  edges->NonManifoldEdgesOff();
  edges->ManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  return edges->GetOutput()->GetNumberOfCells() > 0;
}
}

const char* BoundingSurface::Update(vtkPolyData* data, const glm::dmat4& worldToIndex)
{
  const vtkMTimeType time = data ? data->GetMTime() : 0;
  const bool sameData = this->Data == data && this->DataTime == time;
  if (sameData && this->WorldToIndex == worldToIndex)
  {
    return this->Fault;
  }
  ++this->NumberOfUpdates;
  this->Data = data;
  this->DataTime = time;
  this->WorldToIndex = worldToIndex;
  if (!sameData)
  {
    this->Open = false;
    this->Points.clear();
    this->Triangles.clear();
    this->Fault = data ? this->MakeTriangles(data) : nullptr;
  }
  if (this->Triangles.empty())
  {
    this->Surface.clear();
    return this->Fault;
  }
  this->Fault = this->MakeSurface();
  return this->Fault;
}

const char* BoundingSurface::MakeTriangles(vtkPolyData* data)
{
  const vtkIdType polygons = data->GetNumberOfPolys() + data->GetNumberOfStrips();
  vtkPoints* const points = data->GetPoints();
  if (polygons < 1 || !points)
  {
    return NoPolygons;
  }
  for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p)
  {
    const double* const x = points->GetPoint(p);
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
    {
      return NoPlaces;
    }
  }
  vtkNew<vtkPolyData> bare; // without attributes, which are not needed
  bare->CopyStructure(data);
  vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(bare);
  filter->PassVertsOff();
  filter->PassLinesOff();
  filter->Update();
  vtkPolyData* const triangles = filter->GetOutput();
  for (vtkIdType p = 0; p < triangles->GetNumberOfPoints(); ++p)
  {
    const double* const x = triangles->GetPoint(p);
    this->Points.emplace_back(x[0], x[1], x[2]);
  }
  const auto cells = vtk::TakeSmartPointer(triangles->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count;
    const vtkIdType* ids;
    cells->GetCurrentCell(count, ids);
    if (count == 3)
    {
      this->Triangles.emplace_back(ids[0], ids[1], ids[2]);
    }
  }
  if (this->Triangles.empty())
  {
    return NoPolygons;
  }
  // Triangles without area may close gaps between others.
  if (std::none_of(this->Triangles.begin(), this->Triangles.end(),
        [this](const glm::ivec3& t)
        { return hasArea(this->Points[t.x], this->Points[t.y], this->Points[t.z]); }))
  {
    this->Points.clear();
    this->Triangles.clear();
    return NoArea;
  }
  this->Open = isOpen(triangles);
  return nullptr;
}

const char* BoundingSurface::MakeSurface()
{
  std::vector<glm::dvec3> places(this->Points.size());
  std::transform(this->Points.begin(), this->Points.end(), places.begin(),
    [this](const glm::dvec3& p) { return glm::dvec3(this->WorldToIndex * glm::dvec4(p, 1.0)); });
  if (!std::all_of(places.begin(), places.end(), isNear))
  {
    this->Surface.clear();
    return NoPlaces;
  }
  this->Surface.reset(std::move(places), this->Triangles);
  return nullptr;
}
}
