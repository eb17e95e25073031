// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/SceneCuts.h"

#include "Cells/CellProjector.h"

#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace splatting
{
namespace
{
/// A rectangle of the viewport that contains all pixels that may show a volume.
Picture areaOf(const View& view)
{
  // In overviews a pixel's area may be half a pixel of the screen and half a shear pixel, which is
  // at most a voxel, outside the faces of voxels.
  View larger = view;
  larger.showsBoxes = true;
  larger.dimensions += 2;
  larger.indexToClip = glm::translate(view.indexToClip, glm::dvec3(-1.0));
  Picture area;
  if (!CellProjector::place(larger, area))
  {
    area.size = view.viewport; // the volume is too small for that, or the view is invalid
  }
  else if (area.size.x > 0)
  {
    constexpr int margin = 2;
    const glm::ivec2 end = glm::min(area.origin + area.size + margin, view.viewport);
    area.origin = glm::max(area.origin - margin, glm::ivec2(0));
    area.size = end - area.origin;
  }
  return area;
}
}

void SceneCuts::Find(const View& view, vtkRenderer* renderer, vtkVolume* volume, bool intermixes,
  const DepthReader& readDepth)
{
  this->Area = areaOf(view);
  this->Seen = renderer->GetSelector()
    ? this->FindLastScene(view, renderer, volume, intermixes)
    : this->ReadSceneDepth(renderer, volume, intermixes, readDepth);
  if (this->Seen)
  {
    this->Seen->indexToClip = view.indexToClip;
    this->Seen->depth.place(view);
  }
}

RayEnds SceneCuts::Get()
{
  return { this->Bounds.Get(), this->Seen ? &this->Seen->depth : nullptr, this->Bounds.Version() };
}

void SceneCuts::Hide(Picture& picture) const
{
  if (this->Seen)
  {
    this->Seen->depth.hide(picture);
  }
}

void SceneCuts::Hide(const Picture& picture, std::vector<int>& voxels) const
{
  Picture seen = picture;
  std::fill(seen.pixels.begin(), seen.pixels.end(), 1u);
  this->Hide(seen);
  for (std::size_t n = 0; n < seen.pixels.size(); ++n)
  {
    if (!seen.pixels[n])
    {
      std::fill_n(&voxels[3 * n], 3, -1);
    }
  }
}

// Passes of a selection draw other depths than frames, so a selection uses the depths of the last
// frame. If no frame has shown this view, as after the camera has moved, there are none.
SceneCuts::Scene* SceneCuts::FindLastScene(
  const View& view, const vtkRenderer* renderer, const vtkVolume* volume, bool intermixes)
{
  const auto scene = std::find_if(this->Scenes.begin(), this->Scenes.end(),
    [&](const Scene& s)
    {
      return s.renderer == renderer && s.volume == volume && s.indexToClip == view.indexToClip &&
        s.depth.isOf(this->Area.origin, this->Area.size);
    });
  return intermixes && scene != this->Scenes.end() ? &*scene : nullptr;
}

// Reads the depths that were rendered before the volume, if there are any.
SceneCuts::Scene* SceneCuts::ReadSceneDepth(
  vtkRenderer* renderer, vtkVolume* volume, bool intermixes, const DepthReader& readDepth)
{
  Scene& scene = this->SceneOf(renderer, volume);
  scene.depth.clear();
  const glm::ivec2& size = this->Area.size;
  // Renderers that keep the depths of a lower layer have depths, too. Render passes do not count
  // the props that they render.
  const bool hasDepths = renderer->GetNumberOfPropsRendered() > 0 ||
    renderer->GetPreserveDepthBuffer() || renderer->GetPass();
  if (!intermixes || !hasDepths || size.x < 1 || size.y < 1)
  {
    return nullptr;
  }
  float* const depths = scene.depth.allocate(this->Area.origin, size);
  const float* const end = depths + std::size_t(size.x) * size.y;
  if (!readDepth(&this->Area.origin.x, &size.x, depths) ||
    std::all_of<const float*>(depths, end, [](float depth) { return depth >= 1.0f; }))
  {
    scene.depth.clear();
    return nullptr;
  }
  return &scene;
}

// The scene of a renderer and a volume. Removes scenes that have not been rendered for long.
SceneCuts::Scene& SceneCuts::SceneOf(const vtkRenderer* renderer, const vtkVolume* volume)
{
  ++this->Frame;
  this->Scenes.erase(std::remove_if(this->Scenes.begin(), this->Scenes.end(),
                       [&](const Scene& s) { return s.lastFrame + FramesKept < this->Frame; }),
    this->Scenes.end());
  auto scene = std::find_if(this->Scenes.begin(), this->Scenes.end(),
    [&](const Scene& s) { return s.renderer == renderer && s.volume == volume; });
  if (scene == this->Scenes.end())
  {
    scene = this->Scenes.insert(scene, Scene{ renderer, volume });
  }
  scene->lastFrame = this->Frame;
  return *scene;
}
}
