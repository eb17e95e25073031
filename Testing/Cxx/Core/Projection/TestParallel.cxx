// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The threads that run loops where VTK starts with the backend "Sequential": each number is met
// once, a loop in a loop stays on its thread, and a program's number of threads holds.
#include "CoreTesting.h"

#include "Common/Parallel.h"

#include <vtkSMPTools.h>

#include <atomic>
#include <set>
#include <string>
#include <vector>

using namespace splatting;

namespace
{
void testLoops(reference::Checks& check)
{
  for (const std::ptrdiff_t count : { 0, 1, 7, 1000 })
  {
    for (const std::ptrdiff_t grain : { 0, 1, 3, 2000 })
    {
      std::vector<std::atomic<int>> met(count);
      PerThread<std::ptrdiff_t> sums;
      forInOwnThreads(0, count, grain,
        [&](std::ptrdiff_t first, std::ptrdiff_t last)
        {
          sums.Local() += last - first;
          for (std::ptrdiff_t n = first; n < last; ++n)
          {
            ++met[n];
          }
        });
      std::ptrdiff_t sum = 0, once = 0;
      sums.forAll([&](std::ptrdiff_t part) { sum += part; });
      for (const std::atomic<int>& times : met)
      {
        once += times == 1;
      }
      check(once == count && sum == count, count, " numbers, grain ", grain);
    }
  }
}

void testNestedLoops(reference::Checks& check)
{
  std::atomic<int> moved{ 0 };
  forInOwnThreads(0, 8, 1,
    [&](std::ptrdiff_t, std::ptrdiff_t)
    {
      const std::thread::id outer = std::this_thread::get_id();
      forInOwnThreads(0, 8, 1,
        [&](std::ptrdiff_t, std::ptrdiff_t) { moved += std::this_thread::get_id() != outer; });
    });
  check(moved == 0, "a loop in a loop stays on its thread");
}

void testNumberOfThreads(reference::Checks& check)
{
  vtkSMPTools::Initialize(1);
  check(numberOfOwnThreads() == 1, "one thread");
  vtkSMPTools::Initialize(0);
}
}

int TestParallel(int, char*[])
{
  reference::Checks check;
  testLoops(check);
  testNestedLoops(check);
  testNumberOfThreads(check);
  check(numberOfThreads() >= 1, "there is a thread");
  return check.exitCode();
}
