// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a rank says of its piece: where it lies, what is wrong, and how it is seen. (What several
// ranks make of it is tested by several.)
#include "ProjectionTesting.h"
#include "Ranks/RankAgreement.h"
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDummyController.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace
{
using reference::Checks;
using namespace splatting;

void testGrid(Checks& check, reference::Random& random)
{
  vtkNew<vtkImageData> image;
  const auto size = coretesting::randomSize(random, 6);
  image->SetDimensions(size[0], size[1], size[2]);
  image->AllocateScalars(VTK_SHORT, 1);
  coretesting::placeAtRandom(image, random, true);
  RankReport report;
  check(report.isEmpty(), "nothing is something");
  report.setGrid(image);
  const double* const direction = image->GetDirectionMatrix()->GetData();
  check(!report.isEmpty() && std::equal(report.extent, report.extent + 6, image->GetExtent()) &&
      std::equal(report.origin, report.origin + 3, image->GetOrigin()) &&
      std::equal(report.spacing, report.spacing + 3, image->GetSpacing()) &&
      std::equal(report.direction, report.direction + 9, direction),
    "the piece lies elsewhere");
  const auto mapper = stage::splatting(image);
  check(pieceOf(mapper) == image.Get(), "the piece is another one");
  const RankReport whole = reportOf(mapper, "");
  check(std::equal(whole.extent, whole.extent + 6, image->GetExtent()) && !whole.problem[0],
    "the report is about another piece: ", whole.problem);
  const std::string sentence(random.uniform(0, 600), 'x');
  report.setProblem(sentence);
  const std::string kept = report.problem;
  check(kept == sentence.substr(0, sizeof(report.problem) - 1), "a sentence of ", sentence.size(),
    " letters has ", kept.size());
}

/// A number that changes with the view, and with nothing else.
void testViews(Checks& check, stage::Stage& stage, reference::Random& random)
{
  const auto image =
    projectiontesting::imageOf(reference::uniformNoise<std::uint8_t>({ 5, 6, 7 }, random));
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  const auto number = [&] { return viewHash(mapper, stage.renderer, stage.volume); };
  const std::uint64_t before = number();
  check(number() == before, "the same view has another number");
  stage.renderer->GetActiveCamera()->Azimuth(random.uniform(1.0, 300.0));
  const std::uint64_t turned = number();
  check(turned != before, "another camera is not noticed");
  stage.volume->SetPosition(0.0, random.uniform(1.0, 2.0), 0.0);
  const std::uint64_t moved = number();
  check(moved != turned, "another place is not noticed");
  mapper->SetVectorComponent(mapper->GetVectorComponent() + 1);
  check(number() != moved, "another component is not noticed");
  stage.volume->SetPosition(0.0, 0.0, 0.0);
}
}

int TestRankReports(int, char*[])
{
  Checks check;
  stage::Stage stage(40, 30);
  vtkNew<vtkDummyController> alone;
  RankAgreement agreement;
  agreement.Use(alone);
  check(!agreement.AreMany() && !agreement.Whole(), "one rank is many");
  reference::forScenes("reports", 40,
    [&](int, reference::Random& random)
    {
      testGrid(check, random);
      testViews(check, stage, random);
    });
  return check.exitCode();
}
