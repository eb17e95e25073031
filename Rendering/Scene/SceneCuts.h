// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SceneCuts_h
#define SceneCuts_h

#include "Cells/CellProjector.h"
#include "Clipping/Cuts.h"
#include "Clipping/SceneDepth.h"
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
 * The cuts of a volume by clipping, cropping, a bounding surface and the scene, and whether they
 * have changed since the last projection.
 */
class SceneCuts
{
public:
  BoundingSurface& Surface() { return this->Bounds; }

  /// Reads the depths of a rectangle of the viewport; false if there are none.
  using DepthReader = std::function<bool(const int origin[2], const int size[2], float* depths)>;

  /**
   * Computes the cuts of all images of a view.
   * @param intermixes  whether geometry in the scene hides the volume and ends rays in it
   */
  void Find(const View& view, const std::vector<ShearWarp>& images, vtkRenderer* renderer,
    vtkVolume* volume, bool intermixes, const DepthReader& readDepth);

  /// As Find(), in the scene of the last Find() or FindOnScreen(), for other images of its view.
  void FindFor(const View& view, const std::vector<ShearWarp>& images, std::vector<Cuts>& cuts);

  /// The cuts of each image, from Find().
  const std::vector<Cuts>& Get() const { return this->Present; }

  /// As Find(), for projections onto the screen. Returns false if the view is invalid.
  bool FindOnScreen(const View& view, vtkRenderer* renderer, vtkVolume* volume, bool intermixes,
    const DepthReader& readDepth);
  /// The cuts from FindOnScreen().
  RayEnds OnScreen();
  /// Whether these cuts and the view equal those of KeepOnScreen().
  bool AreKeptOnScreen(const View& view) const;
  void KeepOnScreen(const View& view);

  /// Whether Get() equals the cuts of Keep().
  bool AreKept() const { return this->Present == this->Kept; }
  /// Stores the current cuts as those of a projection. Get() is invalid until the next Find().
  void Keep() { std::swap(this->Present, this->Kept); }
  /// The cuts of Keep().
  const std::vector<Cuts>& OfProjection() const { return this->Kept; }

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

  void FindScene(const View& view, vtkRenderer* renderer, vtkVolume* volume, bool intermixes,
    const DepthReader& readDepth);
  Scene* FindLastScene(
    const View& view, const vtkRenderer* renderer, const vtkVolume* volume, bool intermixes);
  Scene* ReadSceneDepth(
    vtkRenderer* renderer, vtkVolume* volume, bool intermixes, const DepthReader& readDepth);
  Scene& SceneOf(const vtkRenderer* renderer, const vtkVolume* volume);

  BoundingSurface Bounds;
  std::vector<Cuts> Present, Kept;
  /// Of the last projection onto the screen.
  View KeptView;
  vtkIdType KeptSurface = 0;
  SceneDepth KeptDepth;
  std::vector<Scene> Scenes;
  Scene* Seen = nullptr; // of the current frame, or nullptr
  vtkTypeInt64 Frame = 0;
  Picture Area; // rectangle of the viewport that shows the volume
};
}

#endif
