// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/RenderTimes.h"

#include <algorithm>

namespace splatting
{
RenderTimes::Entry& RenderTimes::find(const View& view)
{
  const auto known = std::find_if(this->Entries.begin(), this->Entries.end(),
    [&](const Entry& entry) { return entry.view == view; });
  if (known != this->Entries.end())
  {
    return *known;
  }
  if (this->Entries.size() == MostViews)
  {
    this->Entries.erase(this->Entries.begin());
  }
  this->Entries.push_back({ view });
  return this->Entries.back();
}

int RenderTimes::choose(const View& view, int wanted, double allocated)
{
  constexpr double spare = 0.8;
  Entry& entry = this->find(view);
  int mode = wanted;
  while (mode > 0 && entry.seconds[mode] > (mode > entry.last ? spare : 1.0) * allocated)
  {
    --mode;
  }
  entry.last = mode;
  return mode;
}

void RenderTimes::add(const View& view, int mode, double seconds)
{
  if (!(seconds > 0.0)) // clocks may be set back
  {
    return;
  }
  Entry& entry = this->find(view);
  if (!entry.begun)
  {
    entry.begun = true;
    return;
  }
  const double before = entry.seconds[mode];
  if (before > 0.0)
  {
    for (double& other : entry.seconds)
    {
      other *= seconds / before;
    }
  }
  entry.seconds[mode] = seconds;
}
}
