// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SceneCuts.h"

#include "vtkRenderer.h"

#include <algorithm>

//------------------------------------------------------------------------------
void SceneCuts::Find(const splatting::View& view, const splatting::ShearWarp& geometry,
  vtkRenderer* renderer, bool intermixes, const DepthReader& readDepth)
{
  this->Present.cropping = view.cropping;
  this->HalfSpaces.clear();
  for (const glm::dvec4& h : view.halfSpaces)
  {
    this->HalfSpaces.push_back(geometry.inPixels(h));
  }
  splatting::ClosedSurface* const surface = this->Bounds.Get();
  if (surface)
  {
    surface->project(geometry);
  }
  this->FindDepth(view, geometry, renderer, intermixes, readDepth);
  this->Present.intervals.find(
    geometry, this->HalfSpaces, surface, this->Depth.empty() ? nullptr : &this->Depth);
}

//------------------------------------------------------------------------------
// The depths of what has been rendered where the volume will be seen, if there is anything.
void SceneCuts::FindDepth(const splatting::View& view, const splatting::ShearWarp& geometry,
  vtkRenderer* renderer, bool intermixes, const DepthReader& readDepth)
{
  splatting::placePicture(geometry, view.viewport, this->Place);
  const glm::ivec2& origin = this->Place.origin;
  const glm::ivec2& size = this->Place.size;
  // Selection is by what is seen: its passes draw other depths than frames.
  if (renderer->GetSelector() && this->DepthOf == renderer && this->Depth.isOf(origin, size))
  {
    this->Depth.place(view, geometry, this->HalfSpaces);
    return;
  }
  this->Depth.clear();
  this->DepthOf = renderer;
  // Renderers that keep the depths of a lower layer have something to intermix with, too.
  if (!intermixes ||
    (renderer->GetNumberOfPropsRendered() < 1 && !renderer->GetPreserveDepthBuffer()) ||
    renderer->GetSelector() || size.x < 1 || size.y < 1)
  {
    return;
  }
  float* const depths = this->Depth.allocate(origin, size);
  const float* const end = depths + std::size_t(size.x) * size.y;
  if (!readDepth(&origin.x, &size.x, depths) ||
    std::all_of<const float*>(depths, end, [](float depth) { return depth >= 1.0f; }))
  {
    this->Depth.clear();
    return;
  }
  this->Depth.place(view, geometry, this->HalfSpaces);
}
