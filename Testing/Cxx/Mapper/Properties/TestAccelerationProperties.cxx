// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Accelerations with a memory budget and with culling; their progress, and their update after the
// data have changed. TestAccelerations compares their pictures.
#include "Stage.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkSplattingMIPVolumeMapper.h"

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
const stage::Vector up = { 0.0, 1.0, 0.0 };
const stage::Vector directions[] = { { -0.8, 0.3, 0.45 }, { 0.3, -0.8, 0.45 },
  { -0.3, 0.4, -0.8 } };

/// What does not fit is not made, with one warning; more room brings it back.
void testBudget(stage::Stage& stage, vtkImageData* image, reference::Checks& check)
{
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToHigh(); // which has chains
  stage.show(mapper);
  stage.look(directions[0], up); // along the first axis
  const stage::Pixels rich = stage.pixels();
  check(mapper->GetIndexMemorySize() > 0, "There is an index.");
  stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  mapper->SetIndexMemoryBudget(0);
  for (int acceleration : { Mapper::AUTO, Mapper::BRICKS, Mapper::LINES, Mapper::SORTED_VOLUME })
  {
    mapper->SetAcceleration(acceleration);
    check(stage.pixels() == rich, "The picture is the same without memory.");
    check(mapper->GetAccelerationUsed() == Mapper::DENSE, "Without memory the walk is dense.");
    check(mapper->GetIndexMemorySize() == 0, "Nothing is held.");
  }
  check(warnings.texts.size() == 1, "The budget is told once.");
  mapper->SetIndexMemoryBudget(vtkTypeInt64(1) << 32);
  mapper->SetAccelerationToLines();
  check(stage.pixels() == rich, "The picture is the same with memory again.");
  check(mapper->GetAccelerationUsed() == Mapper::LINES, "With memory there are chains again.");
  check(warnings.texts.size() == 1, "Nothing to warn of.");
}

/// The index belongs to the data, and is made anew with them only.
void testRenewal(stage::Stage& stage, vtkImageData* image, reference::Checks& check)
{
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  mapper->SetQualityModeToPreview();
  mapper->SetAccelerationToSortedLines();
  int progress = 0;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&progress);
  observer->SetCallback(
    [](vtkObject*, unsigned long, void* count, void*) { ++*static_cast<int*>(count); });
  mapper->AddObserver(vtkCommand::ProgressEvent, observer);
  stage.look(directions[2], up);
  stage.pixels();
  check(progress > 0 && mapper->GetProgress() == 1.0, "Encoding tells its progress to the end.");
  const double made = mapper->GetIndexTime();
  progress = 0;
  stage.look({ -0.2, 0.3, -0.8 }, up);
  const stage::Pixels before = stage.pixels();
  check(progress == 0 && mapper->GetIndexTime() == made, "Another view takes the same index.");
  auto* scalars = image->GetPointData()->GetScalars();
  const double old = scalars->GetComponent(scalars->GetNumberOfTuples() / 2, 0);
  scalars->SetComponent(scalars->GetNumberOfTuples() / 2, 0, 255.0);
  scalars->Modified();
  check(stage.pixels() != before, "A changed voxel is seen.");
  check(progress > 0, "Changed data are encoded anew.");
  scalars->SetComponent(scalars->GetNumberOfTuples() / 2, 0, old);
  scalars->Modified();
  check(stage.pixels() == before, "Changed back.");
}

/// Culling shows the same pixels above the window's lower end, and those below as dark as before.
void testCulling(stage::Stage& stage, vtkImageData* image, reference::Checks& check)
{
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.setGrayRamp(100.0, 200.0);
  stage.look(directions[2], up);
  for (int acceleration : { Mapper::DENSE, Mapper::BRICKS, Mapper::SORTED_VOLUME })
  {
    mapper->SetQualityModeToPreview();
    mapper->SetAcceleration(acceleration);
    mapper->CullBelowWindowOff();
    const stage::Pixels all = stage.pixels();
    mapper->CullBelowWindowOn();
    const stage::Pixels culled = stage.pixels();
    bool brighter = true, same = true;
    for (std::size_t n = 0; n < all.size(); ++n)
    {
      brighter = brighter && culled[n] >= all[n];
      same = same && (all[n] != 0 || culled[n] < 128);
    }
    check(brighter && same, "Edges become brighter, by less than half.");
    check(all != culled, "The test sees the difference.");
  }
  mapper->SetMaximumTypeToSigned();
  const stage::Pixels culled = stage.pixels();
  mapper->CullBelowWindowOff();
  check(stage.pixels() == culled, "Culling leaves signed maxima as they are.");
  stage.setGrayRamp(0.0, 255.0);
}
}

int TestAccelerationProperties(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(160, 150);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 60, 56, 52 }, 12));
  for (double viewAngle : { 50.0, 0.0 })
  {
    stage.viewAngle = viewAngle;
    testRenewal(stage, image, check);
    testCulling(stage, image, check);
  }
  testBudget(stage, image, check);
  return check.exitCode();
}
