// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ShownVolume_h
#define ShownVolume_h

#include "vtkRenderer.h" // for the weak pointer
#include "vtkVolume.h"
#include "vtkWeakPointer.h"

class vtkRenderWindow;

namespace splatting
{
/**
 * Whether the last frame of a renderer shows a volume. Observes the renderer, because a volume that
 * is invisible, removed or culled is not rendered and cannot report that itself.
 */
class ShownVolume
{
public:
  ShownVolume() = default;
  ~ShownVolume();
  ShownVolume(const ShownVolume&) = delete;
  ShownVolume& operator=(const ShownVolume&) = delete;

  /// The present frame of a renderer shows the volume.
  void Set(vtkRenderer* renderer, vtkVolume* volume);
  /// It no longer does.
  void Drop() { this->IsRendered = false; }

  const vtkRenderer* Renderer() const { return this->ItsRenderer; }
  /// Only to be compared: it may be deleted.
  const vtkRenderWindow* Window() const { return this->ItsWindow; }

  /// Whether the renderer has rendered no frame without the volume since, and both still exist, are
  /// in their place and visible.
  bool IsShown() const;

private:
  void StopObserving();
  void StartFrame();

  vtkWeakPointer<vtkRenderer> ItsRenderer;
  vtkWeakPointer<vtkVolume> ItsVolume;
  const vtkRenderWindow* ItsWindow = nullptr;
  unsigned long Observer = 0;
  bool IsViewProp = false; // not a part of another prop
  bool IsRendered = false;
};
}

#endif
