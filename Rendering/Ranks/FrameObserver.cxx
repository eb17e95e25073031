// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/FrameObserver.h"

#include "vtkCommand.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <utility>

namespace splatting
{
/// Observes one volume in one renderer.
class FrameObserver::Watch
{
public:
  Watch(vtkRenderer* renderer, vtkVolume* volume, const Callback& absent)
    : Renderer(renderer),
      Volume(volume),
      Absent(absent)
  {
    this->Start = renderer->AddObserver(vtkCommand::StartEvent, this, &Watch::StartFrame);
    this->End = renderer->AddObserver(vtkCommand::EndEvent, this, &Watch::EndFrame);
  }
  ~Watch()
  {
    if (this->Renderer)
    {
      this->Renderer->RemoveObserver(this->Start);
      this->Renderer->RemoveObserver(this->End);
    }
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  bool IsOf(const vtkRenderer* renderer, const vtkVolume* volume) const
  {
    return this->Renderer == renderer && this->Volume == volume;
  }
  bool IsOver() const { return !this->Renderer || !this->Volume; }
  void MarkRendered() { this->IsPresent = true; }

private:
  void StartFrame() { this->IsPresent = false; }
  void EndFrame()
  {
    if (!this->IsPresent && this->Volume && this->Renderer->HasViewProp(this->Volume) &&
      !this->Renderer->GetSelector())
    {
      this->Absent(this->Renderer, this->Volume);
    }
  }

  vtkWeakPointer<vtkRenderer> Renderer;
  vtkWeakPointer<vtkVolume> Volume;
  const Callback& Absent;
  unsigned long Start = 0, End = 0;
  bool IsPresent = true;
};

FrameObserver::FrameObserver(Callback absent) : Absent(std::move(absent)) {}

FrameObserver::~FrameObserver() = default;

void FrameObserver::MarkRendered(vtkRenderer* renderer, vtkVolume* volume)
{
  const auto isOver = [](const std::unique_ptr<Watch>& watch) { return watch->IsOver(); };
  this->Watches.erase(
    std::remove_if(this->Watches.begin(), this->Watches.end(), isOver), this->Watches.end());
  const auto watch = std::find_if(this->Watches.begin(), this->Watches.end(),
    [=](const std::unique_ptr<Watch>& w) { return w->IsOf(renderer, volume); });
  if (watch == this->Watches.end())
  {
    this->Watches.push_back(std::make_unique<Watch>(renderer, volume, this->Absent));
  }
  else
  {
    (*watch)->MarkRendered();
  }
}
}
