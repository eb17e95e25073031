// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slabs across the view against clipping planes in the same places; and what sliding costs.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

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

void testSliding(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  const stage::Vector& direction = directions[0];
  stage.look(direction, up);
  mapper->SlabOn();
  mapper->SetSlabThickness(5.0);
  stage.window->Render();
  const double time = mapper->GetIndexTime();
  const vtkIdType memory = mapper->GetIndexMemorySize(), before = mapper->GetNumberOfProjections();
  constexpr int steps = 20;
  for (int step = 0; step < steps; ++step)
  {
    const stage::Vector centre = placeAlong(stage, direction, -10.0 + step);
    mapper->SetSlabCenter(centre[0], centre[1], centre[2]);
    stage.window->Render();
  }
  check(mapper->GetNumberOfProjections() - before == steps, "Each place is one projection.");
  check(mapper->GetIndexTime() == time && mapper->GetIndexMemorySize() == memory,
    "Sliding makes no new index.");
  stage.window->Render();
  check(mapper->GetNumberOfProjections() - before == steps, "The same place is none.");
  mapper->SetSlabThickness(1e6);
  const stage::Pixels thick = stage.pixels();
  mapper->SetSlabThickness(std::numeric_limits<double>::infinity());
  check(stage.pixels() == thick, "Endless slabs are thick slabs.");
  const vtkIdType projections = mapper->GetNumberOfProjections();
  mapper->SlabOff();
  check(stage.pixels() == thick, "A thick slab is the whole volume.");
  check(mapper->GetNumberOfProjections() == projections, "What cuts nothing costs nothing.");
}

/// Along an axis, where slices are flat: the shear image of a thin slab is the nearest slice.
void testThinSlab(stage::Stage& stage, reference::Checks& check)
{
  const reference::Volume<std::uint8_t> noise =
    reference::uniformNoise<std::uint8_t>({ 12, 14, 16 }, 3);
  const auto image = stage::toImageData(noise);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToPreview();
  mapper->SlabOn();
  mapper->SetSlabThickness(0.01);
  stage.show(mapper);
  stage.look({ 0.0, 0.0, -1.0 }, { 0.0, 1.0, 0.0 });
  for (const auto& [place, slice] : { std::pair(7.0, 7), { 7.3, 7 }, { 7.7, 8 }, { 0.1, 0 } })
  {
    mapper->SetSlabCenter(3.0, 2.0, place);
    stage.window->Render();
    vtkImageData* const shear = mapper->GetShearImage();
    int wrong = 0;
    for (int j = 0; j < 14; ++j)
    {
      for (int i = 0; i < 12; ++i)
      {
        const int u = i - static_cast<int>(shear->GetOrigin()[0]);
        const int v = j - static_cast<int>(shear->GetOrigin()[1]);
        wrong += shear->GetScalarComponentAsDouble(u, v, 0, 0) != noise.at(i, j, slice);
      }
    }
    check(wrong == 0, "A thin slab at ", place, " shows one slice.");
  }
  mapper->SetSlabCenter(3.0, 2.0, 50.0);
  const stage::Pixels outside = stage.pixels();
  check(std::all_of(outside.begin(), outside.end(), [](unsigned char c) { return c == 0; }),
    "A slab beside the volume shows nothing.");
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

/// However thin a slab is, it shows one slice, as one of half a slice does, and in exact mode the
/// field on a plane: where the volume has nothing but bright voxels, none of the rays that meet it
/// is dark.
void testThinnerSlabs(stage::Stage& stage, int mode, reference::Checks& check)
{
  reference::Volume<std::uint8_t> cube = reference::uniformNoise<std::uint8_t>({ 40, 42, 44 }, 5);
  std::for_each(cube.voxels.begin(), cube.voxels.end(),
    [](std::uint8_t& voxel) { voxel = static_cast<std::uint8_t>(100 + voxel / 2); });
  const auto image = stage::toImageData(cube);
  image->SetOrigin(-700.0, 300.0, 5000.0);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityMode(mode);
  stage.show(mapper);
  mapper->SlabOn();
  for (const stage::Vector& direction : directions)
  {
    stage.look(direction, up);
    for (double distance : { 0.0, 0.37, 3.0, -7.7 })
    {
      const stage::Vector centre = placeAlong(stage, direction, distance);
      mapper->SetSlabCenter(centre[0], centre[1], centre[2]);
      // Voxels are cubes with edges of 1: slices are 1 apart at least, along rays. They differ by
      // up to half of the grays.
      mapper->SetSlabThickness(mode == vtkSplattingMIPVolumeMapper::EXACT ? 2e-3 : 0.5);
      const stage::Pixels expected = stage.pixels();
      check(std::count(expected.begin(), expected.end(), 0) < 3 * Width * Height,
        "A thin slab shows something.");
      for (double thickness : { 1e-300, 1e-30, 1e-10, 1e-7, 1e-3 })
      {
        mapper->SetSlabThickness(thickness);
        const stage::Pixels pixels = stage.pixels();
        int wrong = 0;
        for (std::size_t n = 0; n < pixels.size(); ++n)
        {
          wrong += std::abs(int(pixels[n]) - int(expected[n])) > 1;
        }
        // A pixel or two of the outline may meet the thicker slab only.
        check(wrong <= (mode == vtkSplattingMIPVolumeMapper::EXACT ? 6 : 0),
          "A slab with a thickness of ", std::log10(thickness),
          " powers of ten shows one slice, or a plane; bytes that differ: ", wrong);
      }
    }
  }
}

struct Fault
{
  const char* word;
  double thickness;
  stage::Vector centre;
};

void testBadInput(
  stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  stage.look(directions[0], up);
  const stage::Vector middle = placeAlong(stage, directions[0], 0.0);
  const auto set = [&](double thickness, const stage::Vector& centre)
  {
    mapper->SetSlabThickness(thickness);
    mapper->SetSlabCenter(centre[0], centre[1], centre[2]);
  };
  mapper->SlabOn();
  set(6.0, middle);
  const stage::Pixels expected = stage.pixels();
  const Fault faults[] = { { "thicker", nan, middle }, { "thicker", 0.0, middle },
    { "thicker", -3.0, middle }, { "centre", 6.0, { nan, 0.0, 0.0 } },
    { "centre", 6.0, { 0.0, infinity, 0.0 } } };
  for (const Fault& fault : faults)
  {
    const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
    set(fault.thickness, fault.centre);
    stage.pixels();
    stage.pixels();
    check(errors.texts.size() == 1 && errors.texts[0].find(fault.word) != std::string::npos,
      "One sentence about what is wrong: ", fault.word);
    set(6.0, middle);
    check(stage.pixels() == expected, "Once mended, the picture is as before.");
  }
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  mapper->SlabOff();
  set(nan, { nan, nan, nan });
  stage.pixels();
  check(errors.texts.empty(), "A slab that is off may be anything.");
}
}

//------------------------------------------------------------------------------
int TestSlab(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto mapper = stage::splatting(image);
  check(!mapper->GetSlab() && mapper->GetSlabThickness() == 10.0, "Defaults.");
  for (double viewAngle : { 50.0, 0.0 })
  {
    stage.viewAngle = viewAngle;
    stage.show(mapper);
    testPlanes(stage, mapper, check);
    testSliding(stage, mapper, check);
    testBadInput(stage, mapper, check);
    testThinnerSlabs(stage, vtkSplattingMIPVolumeMapper::HIGH, check);
    testThinnerSlabs(stage, vtkSplattingMIPVolumeMapper::EXACT, check);
  }
  testThinSlab(stage, check);
  testRayCasting(stage, image, check);
  return check.exitCode();
}
