// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PeakMemory.h"

#include <algorithm>
#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace
{
/// A line such as "VmRSS:  1234 kB", in megabytes; negative if it is not there.
double ReadStatus(const std::string& key)
{
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
  {
    double kibibytes = 0.0;
    if (word == key && status >> kibibytes)
    {
      return kibibytes * 1024e-6;
    }
  }
  return -1.0;
}
}

//------------------------------------------------------------------------------
PeakMemory::PeakMemory()
{
#ifdef __GLIBC__
  malloc_trim(0); // what is free but still resident would hide as much growth
#endif
  std::ofstream("/proc/self/clear_refs") << "5"; // proc(5): the peak becomes the present size
  this->Start = ReadStatus("VmRSS:");
}

//------------------------------------------------------------------------------
double PeakMemory::GetGrowth() const
{
  const double peak = ReadStatus("VmHWM:");
  return this->Start < 0.0 || peak < 0.0 ? -1.0 : std::max(0.0, peak - this->Start);
}
