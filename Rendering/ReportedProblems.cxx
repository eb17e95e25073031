// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportedProblems.h"

#include "vtkObject.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>

namespace splatting
{
bool ReportedProblems::Update(vtkRenderer* renderer, vtkVolume* volume, const std::string& problem)
{
  const auto drop = [this](const auto& isOver)
  { this->All.erase(std::remove_if(this->All.begin(), this->All.end(), isOver), this->All.end()); };
  drop([](const Report& c) { return !c.renderer || !c.volume; });
  const bool isKnown = std::any_of(
    this->All.begin(), this->All.end(), [&](const Report& c) { return c.problem == problem; });
  drop([&](const Report& c) { return c.renderer == renderer && c.volume == volume; });
  if (problem.empty())
  {
    return false;
  }
  this->All.push_back({ renderer, volume, problem });
  return !isKnown;
}

void ReportedProblems::Warn(
  vtkObject* source, const std::string& cause, bool holds, const std::string& text)
{
  if (!holds)
  {
    this->Causes.erase(cause);
  }
  else if (this->Causes.insert(cause).second)
  {
    vtkWarningWithObjectMacro(source, << text);
  }
}
}
