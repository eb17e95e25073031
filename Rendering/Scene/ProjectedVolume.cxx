// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ProjectedVolume.h"

#include "Geometry/View.h"
#include "MapperProperties.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkRenderer.h"
#include "vtkTimerLog.h"
#include "vtkVolume.h"

#include <algorithm>

namespace splatting
{
void ProjectedVolume::BeginFrame()
{
  this->ProjectionsBefore = this->NumberOfProjections();
}

void ProjectedVolume::EndFrame(vtkRenderer* renderer, vtkVolume* volume, double seconds)
{
  // Times of frames that reuse a projection, and of what is made once, predict nothing.
  if (this->NumberOfProjections() != this->ProjectionsBefore)
  {
    this->Times.add(
      { renderer, volume }, this->ModeUsed, seconds - (this->IndexTime() - this->IndexTimeBefore));
  }
}

void ProjectedVolume::Prepare(
  vtkSplattingMIPVolumeMapper* mapper, const View& view, vtkVolume* volume)
{
  const vtkIdType version = this->Source.Version();
  if (!this->Ranks.AreMany() && this->Components.SetSource(this->Source))
  {
    this->ForgetTimes(); // data of the same kind take the same time
  }
  this->Components.SetBudget(static_cast<std::size_t>(mapper->GetIndexMemoryBudget()));
  this->Components.SetRanks(this->Ranks.AreMany() ? &this->Ranks : nullptr);
  this->IndexTimeBefore = this->Source.Version() == version ? this->IndexTime() : 0.0;
  this->Components.UpdateColors(volume->GetProperty(),
    { mapper->GetFinalColorWindow(), mapper->GetFinalColorLevel() },
    settingsOf(mapper, vtkSplattingMIPVolumeMapper::PREVIEW, view));
  this->Components.SetCullBelowWindow(mapper->GetCullBelowWindow() != 0);
}

// A selection uses the mode of the visible picture.
int ProjectedVolume::ChooseMode(
  vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume)
{
  const int best = mapper->GetQualityMode();
  const int mode = !mapper->GetAutoAdjustSampleDistances() ? best
    : renderer->GetSelector()
    ? std::min(this->ModeUsed, best)
    : this->Times.choose({ renderer, volume }, best, volume->GetAllocatedRenderTime());
  return this->Ranks.AreMany() ? this->Ranks.Least(mode) : mode;
}

bool ProjectedVolume::Project(vtkSplattingMIPVolumeMapper* mapper, const View& view,
  vtkRenderer* renderer, vtkVolume* volume, const SceneCuts::DepthReader& readDepth)
{
  const int mode = this->ChooseMode(mapper, renderer, volume);
  const double start = vtkTimerLog::GetUniversalTime();
  const int usable = std::clamp(this->ModeUsed, mode, mapper->GetQualityMode());
  const vtkIdType before = this->NumberOfProjections();
  this->Cuts.Find(
    view, renderer, volume, mapper->GetIntermixIntersectingGeometry() != 0, readDepth);
  if (!this->Components.Project(
        view, settingsOf(mapper, usable, view), settingsOf(mapper, mode, view), this->Cuts.Get()))
  {
    return false;
  }
  if (this->NumberOfProjections() != before)
  {
    this->TimeToProject = vtkTimerLog::GetUniversalTime() - start;
    this->ModeUsed = mode;
  }
  return true;
}

int ProjectedVolume::QualityModeUsed() const
{
  return this->Components.IsProjected() ? static_cast<int>(this->Components.Settings().quality)
                                        : this->ModeUsed;
}

void ProjectedVolume::Clear()
{
  this->Source.Clear(VTK_VOID);
  this->Components.Clear();
}
}
