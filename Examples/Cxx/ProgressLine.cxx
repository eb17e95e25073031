// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressLine.h"

#include "Reading/Reading.h"

#include "vtkCommand.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

ProgressLine::ProgressLine(const std::string& what, vtkAlgorithm* algorithm)
  : What(MakePrintable(what)),
    Start(std::chrono::steady_clock::now()),
    IsTerminal(isatty(fileno(stderr)) != 0),
    Algorithm(algorithm)
{
  if (algorithm)
  {
    this->Observer =
      algorithm->AddObserver(vtkCommand::ProgressEvent, this, &ProgressLine::ShowProgress);
  }
}

ProgressLine::~ProgressLine()
{
  if (this->Algorithm)
  {
    this->Algorithm->RemoveObserver(this->Observer);
  }
  if (this->ShownPercent >= 0)
  {
    const std::string blanks(this->What.size() + 6, ' ');
    std::fprintf(stderr, "\r%s\r", blanks.c_str());
    std::fflush(stderr);
  }
}

void ProgressLine::ShowProgress(vtkObject*, unsigned long, void* fraction)
{
  this->Show(*static_cast<double*>(fraction));
}

void ProgressLine::Show(double fraction)
{
  const int percent = static_cast<int>(100.0 * std::min(std::max(fraction, 0.0), 1.0));
  if (!this->IsTerminal || percent == this->ShownPercent ||
    std::chrono::steady_clock::now() - this->Start < std::chrono::seconds(1))
  {
    return;
  }
  // std::cerr is redirected while files are read
  std::fprintf(stderr, "\r%s %3d %%", this->What.c_str(), percent);
  std::fflush(stderr);
  this->ShownPercent = percent;
}
