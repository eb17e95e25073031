// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressLine.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <utility>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace
{
bool StderrIsTerminal()
{
#ifdef _WIN32
  return _isatty(_fileno(stderr)) != 0;
#else
  return isatty(fileno(stderr)) != 0;
#endif
}
}

ProgressLine::ProgressLine(std::string what)
  : What(std::move(what)),
    Start(std::chrono::steady_clock::now()),
    IsTerminal(StderrIsTerminal())
{
}

ProgressLine::~ProgressLine()
{
  if (this->ShownPercent >= 0)
  {
    const std::string blanks(this->What.size() + 6, ' ');
    std::fprintf(stderr, "\r%s\r", blanks.c_str());
    std::fflush(stderr);
  }
}

void ProgressLine::Show(double fraction)
{
  const int percent = static_cast<int>(100.0 * std::min(std::max(fraction, 0.0), 1.0));
  if (!this->IsTerminal || percent == this->ShownPercent ||
    std::chrono::steady_clock::now() - this->Start < std::chrono::seconds(1))
  {
    return;
  }
  // stdio and not std::cerr, which is diverted while files are read
  std::fprintf(stderr, "\r%s %3d %%", this->What.c_str(), percent);
  std::fflush(stderr);
  this->ShownPercent = percent;
}
