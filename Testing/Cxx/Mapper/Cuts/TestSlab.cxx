// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares slabs with clipping planes in the same places. TestWorldView tests thin and infinite
// slabs, TestProjectionProperties refused ones.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkVolume.h"

#include <algorithm>

namespace
{
constexpr int Width = 210;
constexpr int Height = 190;

const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { 0.3, 0.4, -0.8 }, { -0.8, 0.3, 0.4 }, { 0.2, -0.9, 0.3 } };

/// The volume's centre, moved along the view.
stage::Vector placeAlong(stage::Stage& stage, const stage::Vector& direction, double distance)
{
  const double length = vtkMath::Norm(direction.data());
  stage::Vector place;
  for (int a = 0; a < 3; ++a)
  {
    place[a] = stage.volume->GetCenter()[a] + distance / length * direction[a];
  }
  return place;
}

void addPlane(
  vtkVolumeMapper* mapper, const stage::Vector& origin, const stage::Vector& normal, double sign)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(origin.data());
  plane->SetNormal(sign * normal[0], sign * normal[1], sign * normal[2]);
  mapper->AddClippingPlane(plane);
}

void testPlanes(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  // In the world, where the volume is turned, moved and stretched.
  stage.volume->SetOrientation(10.0, 20.0, 30.0);
  stage.volume->SetPosition(5.0, -8.0, 12.0);
  stage.volume->SetScale(1.0, 1.3, 0.8);
  for (const stage::Vector& direction : directions)
  {
    stage.look(direction, up);
    mapper->SetQualityModeToHigh();
    const stage::Pixels whole = stage.pixels();
    for (int mode = 0; mode < 3; ++mode)
    {
      mapper->SetQualityMode(mode);
      for (double distance : { -11.3, 0.0, 4.7 })
      {
        constexpr double thickness = 6.1;
        const stage::Vector centre = placeAlong(stage, direction, distance);
        mapper->SetSlabCenter(centre[0], centre[1], centre[2]);
        mapper->SetSlabThickness(thickness);
        mapper->SlabOn();
        const stage::Pixels slab = stage.pixels();
        mapper->SlabOff();
        addPlane(mapper, placeAlong(stage, direction, distance - 0.5 * thickness), direction, 1.0);
        addPlane(mapper, placeAlong(stage, direction, distance + 0.5 * thickness), direction, -1.0);
        const stage::Pixels planes = stage.pixels();
        mapper->RemoveAllClippingPlanes();
        check(slab == planes, "A slab cuts as two planes do.");
        check(slab != whole, "A slab cuts.");
      }
    }
    mapper->SetQualityModeToHigh();
    check(stage.pixels() == whole, "Without a slab the volume is whole again.");
  }
  stage.volume->SetOrientation(0.0, 0.0, 0.0);
  stage.volume->SetPosition(0.0, 0.0, 0.0);
  stage.volume->SetScale(1.0, 1.0, 1.0);
}

/// Where the volume is ray cast nothing is cut, and that is said.
void testRayCasting(stage::Stage& stage, vtkImageData* image, reference::Checks& check)
{
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.look(directions[0], up);
  mapper->SetBlendModeToComposite();
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  mapper->SlabOn();
  stage.pixels();
  stage.pixels();
  check(mapper->GetLastRenderUsedRayCasting(), "Composite is ray cast.");
  const auto about = std::count_if(warnings.texts.begin(), warnings.texts.end(),
    [](const std::string& text) { return text.find("Slab") != std::string::npos; });
  check(about == 1, "One warning that a ray cast volume has no slab.");
}
}

//------------------------------------------------------------------------------
int TestSlab(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto mapper = stage::splatting(image);
  for (double viewAngle : { 50.0, 0.0 })
  {
    stage.viewAngle = viewAngle;
    stage.show(mapper);
    testPlanes(stage, mapper, check);
  }
  testRayCasting(stage, image, check);
  return check.exitCode();
}
