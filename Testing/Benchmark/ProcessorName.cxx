// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProcessorName.h"

#include <vtksys/SystemInformation.hxx>

#include <fstream>

//------------------------------------------------------------------------------
std::string GetProcessorName()
{
  const std::string key = "model name\t: ";
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line))
  {
    if (line.compare(0, key.size(), key) == 0)
    {
      return line.substr(key.size());
    }
  }
  vtksys::SystemInformation system;
  system.RunCPUCheck();
  return system.GetExtendedProcessorName();
}
