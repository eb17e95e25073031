// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProjectedVolume_h
#define ProjectedVolume_h

#include "Common/RenderTimes.h"
#include "Components/ComponentProjector.h"
#include "Input/ScalarSource.h"
#include "Ranks/RankAgreement.h"
#include "Scene/SceneCuts.h"

#include "vtkSplattingMIPNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * A mapper's data and its last projection. Decides in which quality mode a frame projects.
 */
class ProjectedVolume
{
public:
  RankAgreement Ranks;
  ScalarSource Source;
  ComponentProjector Components;
  SceneCuts Cuts;

  /// The voxel grid; with several ranks that of the whole.
  const VolumeGrid& Grid() const
  {
    return this->Ranks.AreMany() ? this->Ranks.Grid() : this->Source.Grid();
  }

  /// Call them before and after a frame.
  /// @param seconds  the time of the frame
  void BeginFrame();
  void EndFrame(vtkRenderer* renderer, vtkVolume* volume, double seconds);

  /// Discards frame times, after a change of the components.
  void ForgetTimes() { this->Times.clear(); }

  /// Makes indices and colours.
  void Prepare(vtkSplattingMIPVolumeMapper* mapper, const View& view, vtkVolume* volume);

  /**
   * Projects in the chosen mode. Does nothing if the last projection shows the same in this mode,
   * or in a better one up to QualityMode. There is no projection after an abort.
   * @return  false if the view is invalid
   */
  bool Project(vtkSplattingMIPVolumeMapper* mapper, const View& view, vtkRenderer* renderer,
    vtkVolume* volume, const SceneCuts::DepthReader& readDepth);

  /// Releases all memory, after a frame that ran out of memory.
  void Clear();

  /// See the mapper's methods of these names.
  vtkIdType NumberOfProjections() const { return this->Components.NumberOfProjections(); }
  int QualityModeUsed() const;
  double ProjectionTime() const { return this->TimeToProject; }
  double IndexTime() const { return this->Source.Time() + this->Components.Time(); }
  std::size_t IndexMemorySize() const
  {
    return this->Source.MemorySize() + this->Components.MemorySize();
  }

private:
  int ChooseMode(vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume);

  vtkIdType ProjectionsBefore = 0; // before this frame
  int ModeUsed = 3;                // in the last complete projection
  double TimeToProject = 0.0;
  RenderTimes Times;
  double IndexTimeBefore = 0.0; // before this frame
};
}

#endif
