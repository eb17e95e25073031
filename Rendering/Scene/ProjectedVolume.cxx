// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ProjectedVolume.h"

#include "Geometry/View.h"
#include "MapperProperties.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkImageData.h"
#include "vtkRenderer.h"
#include "vtkTimerLog.h"
#include "vtkVolume.h"

#include <algorithm>
#include <utility>

namespace splatting
{
void ProjectedVolume::BeginFrame()
{
  this->ProjectionsBefore = this->Projections;
}

void ProjectedVolume::EndFrame(vtkRenderer* renderer, vtkVolume* volume, double seconds)
{
  // Times of frames that reuse a projection, and of what is made once, predict nothing.
  if (this->Projections != this->ProjectionsBefore)
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

// Computes the cuts of a view and, unless it is projected onto the screen, its images. Returns
// false if the view is invalid.
bool ProjectedVolume::FindCuts(vtkSplattingMIPVolumeMapper* mapper, const View& view,
  vtkRenderer* renderer, vtkVolume* volume, const SceneCuts::DepthReader& readDepth,
  const ProjectionSettings& settings)
{
  const double start = vtkTimerLog::GetUniversalTime();
  const bool intermixes = mapper->GetIntermixIntersectingGeometry() != 0;
  bool isValid = true;
  if (this->Components.UsesCells(settings))
  {
    this->Images.clear();
    isValid = this->Cuts.FindOnScreen(view, renderer, volume, intermixes, readDepth);
  }
  else if (ShearWarp::factorise(view, this->Images))
  {
    this->Cuts.Find(view, this->Images, renderer, volume, intermixes, readDepth);
  }
  else
  {
    isValid = false;
  }
  this->CutTime = vtkTimerLog::GetUniversalTime() - start;
  return isValid;
}

// Whether the last projection shows this frame.
bool ProjectedVolume::IsUpToDate(const View& view, const ProjectionSettings& settings) const
{
  if (this->Components.UsesCells(settings))
  {
    return this->Cuts.AreKeptOnScreen(view) && this->Components.IsUpToDate(settings);
  }
  const bool ordered = isOrdered(settings.reduction) || settings.recordLocations ||
    this->Source.AreDependent(); // of equal samples the nearest is located
  return haveSameRays(this->Images, this->ImagesBefore, ordered) && this->Cuts.AreKept() &&
    this->Components.IsUpToDate(settings);
}

bool ProjectedVolume::Project(vtkSplattingMIPVolumeMapper* mapper, const View& view,
  vtkRenderer* renderer, vtkVolume* volume, const SceneCuts::DepthReader& readDepth)
{
  const int mode = this->ChooseMode(mapper, renderer, volume);
  const int usable = std::clamp(this->ModeUsed, mode, mapper->GetQualityMode());
  const ProjectionSettings best = settingsOf(mapper, usable, view);
  std::swap(this->Images, this->ImagesBefore);
  if (!this->FindCuts(mapper, view, renderer, volume, readDepth, best))
  {
    return false;
  }
  const bool isShown = this->IsUpToDate(view, best);
  // If one rank projects, all ranks project.
  if (this->Ranks.AreMany() ? !this->Ranks.Any(!isShown) : isShown)
  {
    return true;
  }
  const ProjectionSettings wanted = settingsOf(mapper, mode, view);
  const bool onScreen = this->Components.UsesCells(wanted);
  if (onScreen != this->Components.UsesCells(best))
  {
    this->FindCuts(mapper, view, renderer, volume, readDepth, wanted);
  }
  const double start = vtkTimerLog::GetUniversalTime();
  this->ShearImageOutput = nullptr;
  const bool isDone = onScreen
    ? this->Components.ProjectOnScreen(view, wanted, this->Cuts.OnScreen())
    : this->Components.Project(this->Images, wanted, this->Cuts.Get());
  if (isDone)
  {
    onScreen ? this->Cuts.KeepOnScreen(view) : this->Cuts.Keep();
    this->TimeToProject = this->CutTime + vtkTimerLog::GetUniversalTime() - start;
    ++this->Projections;
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
  this->ShearImageOutput = nullptr;
}

const ShearWarp* ProjectedVolume::MainImage() const
{
  return this->Components.IsProjected() && !this->Images.empty()
    ? &this->Images[mainImage(this->Images)]
    : nullptr;
}

vtkImageData* ProjectedVolume::ShearImage()
{
  if (!this->MainImage())
  {
    this->ShearImageOutput = nullptr;
  }
  else if (!this->ShearImageOutput)
  {
    this->ShearImageOutput = this->Components.MakeShearImage(this->Images, this->Source);
  }
  return this->ShearImageOutput;
}
}
