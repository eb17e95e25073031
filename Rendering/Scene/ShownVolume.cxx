// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ShownVolume.h"

#include "vtkCommand.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

namespace splatting
{
ShownVolume::~ShownVolume()
{
  this->Reset();
}

void ShownVolume::Set(vtkRenderer* renderer, vtkVolume* volume)
{
  if (this->ItsRenderer != renderer)
  {
    this->Reset();
    this->ItsRenderer = renderer;
    this->Observer = renderer->AddObserver(vtkCommand::StartEvent, this, &ShownVolume::StartFrame);
  }
  this->ItsVolume = volume;
  this->Window = renderer->GetRenderWindow();
  this->IsViewProp = renderer->HasViewProp(volume) != 0;
  this->IsRendered = true;
}

void ShownVolume::Reset()
{
  if (this->ItsRenderer)
  {
    this->ItsRenderer->RemoveObserver(this->Observer);
  }
  this->ItsRenderer = nullptr;
  this->ItsVolume = nullptr;
  this->IsRendered = false;
}

bool ShownVolume::IsShown() const
{
  vtkRenderer* const renderer = this->ItsRenderer;
  vtkVolume* const volume = this->ItsVolume;
  return this->IsRendered && renderer && volume && renderer->GetRenderWindow() &&
    renderer->GetRenderWindow() == this->Window && volume->GetVisibility() &&
    (!this->IsViewProp || renderer->HasViewProp(volume));
}

void ShownVolume::StartFrame()
{
  // A renderer with a backing store may show its last picture again and render nothing.
  this->IsRendered = this->IsRendered && this->ItsRenderer->GetBackingStore();
}
}
