// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SceneCuts_h
#define SceneCuts_h

#include "Clipping/RayEnds.h"
#include "Clipping/SceneDepth.h"
#include "Display/Picture.h"
#include "Geometry/View.h"
#include "Input/BoundingSurface.h"

#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

#include <glm/mat4x4.hpp>

#include <functional>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkRenderer;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * The cuts of a volume by a bounding surface and by the scene.
 */
class SceneCuts
{
public:
  BoundingSurface& Surface() { return this->Bounds; }

  /// Reads the depths of a rectangle of the viewport; false if there are none.
  using DepthReader = std::function<bool(const int origin[2], const int size[2], float* depths)>;

  /**
   * Finds the cuts of a view.
   * @param intermixes  whether geometry in the scene hides the volume and ends rays in it
   */
  void Find(const View& view, vtkRenderer* renderer, vtkVolume* volume, bool intermixes,
    const DepthReader& readDepth);

  /// What the last Find() has found.
  RayEnds Get();

  /// Clears the pixels of a picture that the scene hides.
  void Hide(Picture& picture) const;
  /// Sets the voxels of these pixels, three numbers for each, to -1.
  void Hide(const Picture& picture, std::vector<int>& voxels) const;

private:
  /// Depths that a renderer's last frame rendered before a volume.
  struct Scene
  {
    const vtkRenderer* renderer; // compared, never dereferenced
    const vtkVolume* volume;
    vtkTypeInt64 lastFrame = 0;
    glm::dmat4 indexToClip{ 0.0 };
    SceneDepth depth{};
  };
  /// Frames after which an unused scene is removed.
  static constexpr vtkTypeInt64 FramesKept = 64;

  Scene* FindLastScene(
    const View& view, const vtkRenderer* renderer, const vtkVolume* volume, bool intermixes);
  Scene* ReadSceneDepth(
    vtkRenderer* renderer, vtkVolume* volume, bool intermixes, const DepthReader& readDepth);
  Scene& SceneOf(const vtkRenderer* renderer, const vtkVolume* volume);

  BoundingSurface Bounds;
  std::vector<Scene> Scenes;
  Scene* Seen = nullptr; // of the current frame, or nullptr
  vtkTypeInt64 Frame = 0;
  Picture Area; // rectangle of the viewport whose depths are read
};
}

#endif
