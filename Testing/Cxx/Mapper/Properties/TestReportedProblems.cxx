// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Each reason for a missing frame is told once, as long as some view has it: against a list of what
// each view lacks.
#include "CoreTesting.h"
#include "ReportedProblems.h"

#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"

#include <array>
#include <map>
#include <string>
#include <utility>

namespace
{
using reference::Checks;
using namespace splatting;

void testScene(Checks& check, reference::Random& random)
{
  ReportedProblems reported;
  std::array<vtkSmartPointer<vtkVolume>, 3> volumes;
  const std::array<vtkNew<vtkRenderer>, 2> renderers;
  std::map<std::pair<int, int>, std::string> lacks;
  for (int step = 0; step < 60; ++step)
  {
    const int r = random.uniform(0, 1), v = random.uniform(0, 2);
    if (!volumes[v] || random.oneIn(10))
    {
      volumes[v] = vtkSmartPointer<vtkVolume>::New(); // the old one is gone, with what it lacked
      lacks.erase({ 0, v });
      lacks.erase({ 1, v });
    }
    const char* const problems[] = { "", "", "a", "b", "c" };
    const std::string problem = problems[random.uniform(0, 4)];
    bool isKnown = problem.empty();
    for (const auto& [view, lacked] : lacks)
    {
      isKnown = isKnown || lacked == problem;
    }
    check(reported.Update(renderers[r], volumes[v], problem) == !isKnown, "step ", step, ": '",
      problem, isKnown ? "' is told again" : "' is not told");
    lacks[{ r, v }] = problem;
  }
}
}

int TestReportedProblems(int, char*[])
{
  Checks check;
  reference::forScenes(
    "problems", 200, [&](int, reference::Random& random) { testScene(check, random); });
  return check.exitCode();
}
