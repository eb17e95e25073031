// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SceneCuts_h
#define SceneCuts_h

#include "Cells/CellProjector.h"
#include "Clipping/Cuts.h"
#include "Clipping/SceneDepth.h"
#include "Input/BoundingSurface.h"

#include "vtkType.h"

#include <glm/mat4x4.hpp>

#include <functional>
#include <vector>

class vtkRenderer;
class vtkVolume;

namespace splatting
{
/**
 * What clipping, cropping, a bounding surface and other things in the scene leave of a volume, and
 * whether that has changed since the last projection.
 */
class SceneCuts
{
public:
  BoundingSurface& Surface() { return this->Bounds; }

  /// Reads the depths of a rectangle of the viewport; false if there are none.
  using DepthReader = std::function<bool(const int origin[2], const int size[2], float* depths)>;

  /**
   * @param intermixes  whether geometry in the scene hides the volume and ends rays in it
   */
  void Find(const View& view, const std::vector<ShearWarp>& images, vtkRenderer* renderer,
    vtkVolume* volume, bool intermixes, const DepthReader& readDepth);

  /// What Find() has found, for each image.
  const std::vector<Cuts>& Get() const { return this->Present; }

  /// The same for projections onto the screen. False if the view is invalid.
  bool FindOnScreen(const View& view, vtkRenderer* renderer, vtkVolume* volume, bool intermixes,
    const DepthReader& readDepth);
  /// What FindOnScreen() has found.
  RayEnds OnScreen();
  /// Whether that, and the view, is what it was when it was last kept.
  bool AreKeptOnScreen(const View& view) const;
  void KeepOnScreen(const View& view);

  /// Whether Get() is what it was when it was last kept.
  bool AreKept() const { return this->Present == this->Kept; }
  /// Keeps the present cuts as those of a projection. Get() has no meaning until the next Find().
  void Keep() { std::swap(this->Present, this->Kept); }
  /// Those that were kept.
  const std::vector<Cuts>& OfProjection() const { return this->Kept; }

  /// Clears the pixels of a picture that other things hide.
  void Hide(Picture& picture) const;

private:
  /// What a renderer's last frame had rendered before a volume was.
  struct Scene
  {
    const vtkRenderer* renderer; // only compared, so that they may be gone
    const vtkVolume* volume;
    vtkTypeInt64 lastFrame = 0;
    glm::dmat4 indexToClip{ 0.0 };
    SceneDepth depth{};
  };
  /// A scene that was not rendered in so many frames is forgotten.
  static constexpr vtkTypeInt64 FramesKept = 64;

  void FindScene(const View& view, vtkRenderer* renderer, vtkVolume* volume, bool intermixes,
    const DepthReader& readDepth);
  Scene* RememberScene(
    const View& view, const vtkRenderer* renderer, const vtkVolume* volume, bool intermixes);
  Scene* LookAtScene(
    vtkRenderer* renderer, vtkVolume* volume, bool intermixes, const DepthReader& readDepth);
  Scene& SceneOf(const vtkRenderer* renderer, const vtkVolume* volume);

  BoundingSurface Bounds;
  std::vector<Cuts> Present, Kept;
  /// Of the last projection onto the screen.
  View KeptView;
  vtkIdType KeptSurface = 0;
  SceneDepth KeptDepth;
  std::vector<Scene> Scenes;
  Scene* Seen = nullptr; // in the present frame, if there is anything
  vtkTypeInt64 Frame = 0;
  Picture Area; // where the volume will be seen
};
}

#endif
