// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Locations/ShownVolume.h"

#include "vtkCommand.h"
#include "vtkRenderWindow.h"

namespace splatting
{
ShownVolume::~ShownVolume()
{
  this->StopObserving();
}

void ShownVolume::Set(vtkRenderer* renderer, vtkVolume* volume)
{
  if (this->ItsRenderer != renderer)
  {
    this->StopObserving();
    this->ItsRenderer = renderer;
    this->Observer = renderer->AddObserver(vtkCommand::StartEvent, this, &ShownVolume::StartFrame);
  }
  this->ItsVolume = volume;
  this->ItsWindow = renderer->GetRenderWindow();
  this->IsViewProp = renderer->HasViewProp(volume) != 0;
  this->IsRendered = true;
}

void ShownVolume::StopObserving()
{
  if (this->ItsRenderer)
  {
    this->ItsRenderer->RemoveObserver(this->Observer);
  }
}

bool ShownVolume::IsShown() const
{
  vtkRenderer* const renderer = this->ItsRenderer;
  vtkVolume* const volume = this->ItsVolume;
  return this->IsRendered && renderer && volume && renderer->GetRenderWindow() &&
    renderer->GetRenderWindow() == this->ItsWindow && volume->GetVisibility() &&
    (!this->IsViewProp || renderer->HasViewProp(volume));
}

void ShownVolume::StartFrame()
{
  // A renderer with a backing store may show its last picture without rendering.
  this->IsRendered = this->IsRendered && this->ItsRenderer->GetBackingStore();
}
}
