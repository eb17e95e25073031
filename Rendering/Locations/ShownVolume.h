// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ShownVolume_h
#define ShownVolume_h

#include "vtkRenderer.h" // for the weak pointer
#include "vtkSplattingMIPNamespace.h"
#include "vtkVolume.h"
#include "vtkWeakPointer.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkRenderWindow;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Whether the last frame of a renderer shows a volume. Observes the renderer, because the mapper of
 * an invisible, removed or culled volume is not called.
 */
class ShownVolume
{
public:
  ShownVolume() = default;
  ~ShownVolume();
  ShownVolume(const ShownVolume&) = delete;
  ShownVolume& operator=(const ShownVolume&) = delete;

  /// Call it when the current frame of a renderer shows the volume.
  void Set(vtkRenderer* renderer, vtkVolume* volume);
  /// The frame no longer shows the volume.
  void Drop() { this->IsRendered = false; }

  const vtkRenderer* Renderer() const { return this->ItsRenderer; }
  /// May be deleted: compare it only.
  const vtkRenderWindow* Window() const { return this->ItsWindow; }

  /// Whether later frames of the renderer also showed the volume. Returns false if renderer or
  /// volume was deleted, if the volume was removed from the renderer or the renderer from its
  /// window, or if the volume is invisible.
  bool IsShown() const;

private:
  void StopObserving();
  void StartFrame();

  vtkWeakPointer<vtkRenderer> ItsRenderer;
  vtkWeakPointer<vtkVolume> ItsVolume;
  const vtkRenderWindow* ItsWindow = nullptr;
  unsigned long Observer = 0;
  bool IsViewProp = false; // false for a part of another prop
  bool IsRendered = false;
};
}

#endif
