// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef FrameAttendance_h
#define FrameAttendance_h

#include <functional>
#include <memory>
#include <vector>

class vtkRenderer;
class vtkVolume;

namespace splatting
{
/**
 * Detects frames of a renderer that do not render a volume which earlier frames rendered. A mapper
 * cannot detect them, because it is not called if its volume is invisible or culled.
 */
class FrameAttendance
{
public:
  using Callback = std::function<void(vtkRenderer*, vtkVolume*)>;

  /// @param absent  is called at the end of each frame that has not rendered a volume of the
  ///                renderer; not in the passes of a selector
  explicit FrameAttendance(Callback absent);
  ~FrameAttendance();
  FrameAttendance(const FrameAttendance&) = delete;
  FrameAttendance& operator=(const FrameAttendance&) = delete;

  /// Call it when the current frame of a renderer renders the volume.
  void Attend(vtkRenderer* renderer, vtkVolume* volume);

private:
  class Watch;

  Callback Absent;
  std::vector<std::unique_ptr<Watch>> Watches;
};
}

#endif
