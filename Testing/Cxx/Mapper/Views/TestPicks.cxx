// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Picks look along one ray: they are the same whether locations were recorded or not, and what the
// arrays of all locations say. In each of several viewports they are what they are in that alone.
#include "CoreTesting.h"
#include "Stage.h"
#include "Volume.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace
{
constexpr int Width = 70;
constexpr int Height = 60;

struct Pick
{
  bool has = false;
  std::array<double, 3> position{ 1.0, 2.0, 3.0 };
  std::array<int, 3> voxel{ -1, -1, -1 };
  double value = 0.0;

  bool operator==(const Pick& other) const
  {
    return this->has == other.has && this->position == other.position &&
      this->voxel == other.voxel && std::memcmp(&this->value, &other.value, sizeof(double)) == 0;
  }
};

std::string toText(const Pick& pick)
{
  std::ostringstream text;
  text << (pick.has ? "voxel " : "no voxel ") << pick.voxel[0] << " " << pick.voxel[1] << " "
       << pick.voxel[2] << " at " << pick.position[0] << " " << pick.position[1] << " "
       << pick.position[2] << ", " << pick.value;
  return text.str();
}

/// Of a viewport. Empty if the three answers do not say alike whether there is a sample.
std::vector<Pick> pickAll(vtkSplattingMIPVolumeMapper* mapper, int left = 0)
{
  std::vector<Pick> picks;
  for (int y = 1; y < Height; y += 5)
  {
    for (int x = left; x < left + Width; x += 3)
    {
      Pick pick;
      pick.has = mapper->PickWorldPosition(x, y, pick.position.data());
      pick.value = mapper->PickValue(x, y);
      if (mapper->PickVoxel(x, y, pick.voxel.data()) != pick.has ||
        (pick.value == pick.value) != pick.has)
      {
        return {};
      }
      picks.push_back(pick);
    }
  }
  return picks;
}

/// All that locations depend on.
void chooseAtRandom(
  vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image, int n, reference::Random& random)
{
  mapper->SetQualityMode(n % 4);
  mapper->SetKernel(random.uniform(0, 1));
  mapper->SetBlendMode(!random.oneIn(3) ? vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND
                                        : vtkVolumeMapper::MINIMUM_INTENSITY_BLEND);
  stage::chooseSamples(mapper, image, random);
  mapper->SetCullBelowWindow(random.uniform(0, 1));
  mapper->SetFinalColorLevel(random.oneIn(2) ? 0.5 : 0.9);
  mapper->SetFinalColorWindow(0.2);
  mapper->RemoveAllClippingPlanes();
  if (random.oneIn(2))
  {
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(image->GetCenter());
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
    plane->SetNormal(x, y, 1.0);
    mapper->AddClippingPlane(plane);
  }
}

/// Whether picks are what arrays say, and in PREVIEW values those of voxels.
bool areRecorded(
  vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image, const std::vector<Pick>& picks)
{
  vtkImageData* const locations = mapper->GetLocations();
  vtkDataArray* const voxels = locations->GetPointData()->GetArray("Voxel");
  vtkDataArray* const positions = locations->GetPointData()->GetArray("Position");
  const bool isShaded = mapper->GetBlendMode() == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND &&
    mapper->GetMaximumType() == vtkSplattingMIPVolumeMapper::DEPTH_SHADED;
  bool same = true;
  std::size_t n = 0;
  for (int y = 1; y < Height; y += 5)
  {
    for (int x = 0; x < Width; x += 3)
    {
      const Pick& pick = picks[n++];
      const vtkIdType at = vtkIdType(y) * Width + x;
      same = same && pick.has == (voxels->GetComponent(at, 0) >= 0.0);
      for (int c = 0; pick.has && c < 3; ++c)
      {
        same = same && pick.voxel[c] == voxels->GetComponent(at, c) &&
          pick.position[c] == positions->GetComponent(at, c);
      }
      if (pick.has && mapper->GetQualityMode() == 0 && !isShaded)
      {
        const int* const first = image->GetExtent();
        same = same &&
          pick.value ==
            image->GetScalarComponentAsDouble(
              pick.voxel[0] + first[0], pick.voxel[1] + first[2], pick.voxel[2] + first[4], 0);
      }
    }
  }
  return same;
}

/// One mapper in two viewports of a window.
void testViewports(reference::Checks& check)
{
  coretesting::Sightings picked;
  reference::forScenes("viewports", 40,
    [&](int n, reference::Random& random)
    {
      const auto image =
        stage::toImageData(reference::uniformNoise<std::uint8_t>({ 30, 26, 34 }, random));
      const auto mapper = stage::splatting(image);
      stage::Stage stage(2 * Width, Height);
      stage.show(mapper);
      chooseAtRandom(mapper, image, n, random);
      mapper->SetRecordLocations(random.uniform(0, 1));
      vtkNew<vtkRenderer> second;
      second->AddVolume(stage.volume);
      stage.window->AddRenderer(second);
      vtkRenderer* const renderers[] = { stage.renderer, second };
      for (int side : { 1, 0 }) // as the first one's camera is set in between
      {
        // Some see the same projection, some an overview.
        stage.viewAngle = random.oneIn(2) ? 40.0 : 0.0;
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        stage.look({ x, y, 1.0 }, { 0.1, 1.0, 0.2 }, !random.oneIn(3) ? 0.8 : 2.5);
        renderers[side]->SetViewport(0.5 * side, 0.0, 0.5 + 0.5 * side, 1.0);
        renderers[side]->GetActiveCamera()->DeepCopy(stage.renderer->GetActiveCamera());
        renderers[side]->ResetCameraClippingRange();
      }
      std::vector<Pick> alone[2];
      for (int side = 0; side < 2; ++side)
      {
        renderers[side]->DrawOn();
        renderers[1 - side]->DrawOff();
        stage.window->Render();
        alone[side] = pickAll(mapper, side * Width);
        picked.add(std::any_of(
          alone[side].begin(), alone[side].end(), [](const Pick& pick) { return pick.has; }));
      }
      for (int first = 0; first < 2; ++first)
      {
        renderers[0]->DrawOn();
        renderers[1]->DrawOn();
        stage.window->Render();
        for (int side : { first, 1 - first })
        {
          check(!alone[side].empty() && pickAll(mapper, side * Width) == alone[side],
            "Picks in viewport ", side, " of scene ", n, ", mode ", mapper->GetQualityMode(),
            ", are the same beside another viewport.");
        }
      }
      stage.volume->VisibilityOff();
      second->Render();
      stage.volume->VisibilityOn();
      const std::vector<Pick> hidden = pickAll(mapper, Width);
      check(std::none_of(hidden.begin(), hidden.end(), [](const Pick& pick) { return pick.has; }),
        "Nothing is picked in a viewport that no longer shows the volume.");
      check(pickAll(mapper) == alone[0], "Picks in the other viewport stay the same.");
      mapper->SetInputData(stage::toImageData(reference::constant<std::uint8_t>({ 9, 8, 7 }, 50)));
      second->Render();
      const std::vector<Pick> old = pickAll(mapper);
      check(std::none_of(old.begin(), old.end(), [](const Pick& pick) { return pick.has; }),
        "Nothing is picked of data that are no longer there.");
    });
  check(picked.areEnough(0.5), "Samples are picked in viewports.");
}
}

//------------------------------------------------------------------------------
int TestPicks(int, char*[])
{
  reference::Checks check;
  testViewports(check);
  coretesting::Sightings picked;
  reference::forScenes("picks", 48,
    [&](int n, reference::Random& random)
    {
      // Few values: ties are common.
      const auto image =
        stage::toImageData(reference::uniformNoise<std::uint8_t>({ 30, 26, 34 }, random, 0, 60));
      coretesting::placeAtRandom(image, random, false);
      const auto mapper = stage::splatting(image);
      stage::Stage stage(Width, Height);
      stage.show(mapper);
      stage.viewAngle = random.oneIn(2) ? 40.0 : 0.0;
      chooseAtRandom(mapper, image, n, random);
      const stage::Vector direction{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
        random.uniform(-1.0, 1.0) };
      stage.look(direction, { 0.1, 1.0, 0.2 }, random.uniform(0.6, 1.2));
      stage.window->Render();
      const vtkIdType projections = mapper->GetNumberOfProjections();
      const std::vector<Pick> alone = pickAll(mapper);
      check(mapper->GetNumberOfProjections() == projections, "Picks project no frame.");
      mapper->RecordLocationsOn();
      stage.window->Render();
      const std::vector<Pick> recorded = pickAll(mapper);
      const std::string scene =
        " of scene " + std::to_string(n) + ", mode " + std::to_string(mapper->GetQualityMode());
      const auto differ =
        std::mismatch(alone.begin(), alone.end(), recorded.begin(), recorded.end());
      check(!alone.empty() && alone == recorded, "Picks", scene,
        " are the same with recorded locations and without: ",
        toText(differ.first == alone.end() ? Pick() : *differ.first), ", ",
        toText(differ.second == recorded.end() ? Pick() : *differ.second));
      check(areRecorded(mapper, image, recorded), "Picks", scene, " are what arrays say.");
      picked.add(
        std::any_of(alone.begin(), alone.end(), [](const Pick& pick) { return pick.has; }));
    });
  check(picked.areEnough(0.5), "Samples are picked.");
  std::cout << "samples are picked in " << picked << std::endl;
  return check.exitCode();
}
