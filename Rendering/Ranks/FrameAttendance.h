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
 * Observes the frames of renderers that have rendered a volume, because a mapper is not called
 * where its volume is invisible or culled.
 */
class FrameAttendance
{
public:
  using Callback = std::function<void(vtkRenderer*, vtkVolume*)>;

  /// @param absent  called at the end of each frame that has not rendered a volume which the
  ///                renderer still has; not for the passes of a selector
  explicit FrameAttendance(Callback absent);
  ~FrameAttendance();
  FrameAttendance(const FrameAttendance&) = delete;
  FrameAttendance& operator=(const FrameAttendance&) = delete;

  /// The present frame of a renderer renders the volume.
  void Attend(vtkRenderer* renderer, vtkVolume* volume);

private:
  class Watch;

  Callback Absent;
  std::vector<std::unique_ptr<Watch>> Watches;
};
}

#endif
