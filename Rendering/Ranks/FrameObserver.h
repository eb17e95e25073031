// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef FrameObserver_h
#define FrameObserver_h

#include "vtkSplattingMIPNamespace.h"

#include <functional>
#include <memory>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkRenderer;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * Detects frames of a renderer that do not render a volume which earlier frames rendered. A mapper
 * cannot detect them, because it is not called if its volume is invisible or culled.
 */
class FrameObserver
{
public:
  using Callback = std::function<void(vtkRenderer*, vtkVolume*)>;

  /// @param absent  is called at the end of each frame that has not rendered a volume of the
  ///                renderer; not in the passes of a selector
  explicit FrameObserver(Callback absent);
  ~FrameObserver();
  FrameObserver(const FrameObserver&) = delete;
  FrameObserver& operator=(const FrameObserver&) = delete;

  /// Call it when the current frame of a renderer renders the volume.
  void MarkRendered(vtkRenderer* renderer, vtkVolume* volume);

private:
  class Watch;

  Callback Absent;
  std::vector<std::unique_ptr<Watch>> Watches;
};
}

#endif
