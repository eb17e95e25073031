// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a renderer sees a volume: voxels lie where vtkImageData, vtkVolume and vtkRenderer put them
// in the window, in viewports and tiles.
#include "ProjectionTesting.h"
#include "Scene/ViewOfVolume.h"
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

/// A volume anywhere in a part of the window.
void setScene(stage::Stage& stage, vtkImageData* image, reference::Random& random)
{
  const auto size = coretesting::randomSize(random, 9);
  image->SetDimensions(size[0] + 1, size[1] + 1, size[2] + 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  coretesting::placeAtRandom(image, random, true);
  const glm::dvec3 turn = coretesting::anyVector(random, 0.0, 360.0);
  const glm::dvec3 place = coretesting::anyVector(random, -9.0, 9.0);
  stage.volume->SetOrientation(turn.x, turn.y, turn.z);
  stage.volume->SetPosition(place.x, place.y, place.z);
  stage.volume->SetScale(1.0, random.uniform(0.5, 2.0), 1.0);
  const double left = random.uniform(0.0, 0.5), bottom = random.uniform(0.0, 0.5);
  const double right = left + random.uniform(0.2, 0.5), top = bottom + random.uniform(0.2, 0.5);
  stage.renderer->SetViewport(left, bottom, right, top);
  const glm::dvec3 direction = coretesting::anyDirection(random);
  const glm::dvec3 up = coretesting::anyDirection(random);
  stage.viewAngle = random.oneIn(2) ? random.uniform(10.0, 80.0) : 0.0;
  stage.look({ direction.x, direction.y, direction.z }, { up.x, up.y, up.z });
  stage.renderer->GetActiveCamera()->SetParallelProjection(stage.viewAngle == 0.0);
}

void testPoint(Checks& check, stage::Stage& stage, vtkImageData* image, const VolumeGrid& grid,
  vtkVolumeMapper* mapper, reference::Random& random)
{
  int voxel[3];
  const int* const extent = image->GetExtent();
  glm::dvec3 index;
  for (int a = 0; a < 3; ++a)
  {
    voxel[a] = random.uniform(extent[2 * a], extent[2 * a + 1]);
    index[a] = voxel[a] - extent[2 * a];
  }
  double world[4] = { 0.0, 0.0, 0.0, 1.0 };
  image->TransformIndexToPhysicalPoint(voxel, world);
  stage.volume->GetMatrix()->MultiplyPoint(world, world);
  const glm::dvec3 expected(world[0], world[1], world[2]);
  const glm::dvec3 found(indexToWorld(grid, stage.volume) * glm::dvec4(index, 1.0));
  check(glm::length(found - expected) < 1e-9, "a voxel lies elsewhere in the world");
  const glm::dvec3 back(worldToIndex(grid, stage.volume) * glm::dvec4(expected, 1.0));
  check(glm::length(back - index) < 1e-9, "a point of the world lies elsewhere in the volume");
  stage.renderer->SetWorldPoint(world);
  stage.renderer->WorldToDisplay();
  const double* const display = stage.renderer->GetDisplayPoint();
  const splatting::View view = makeView(grid, stage.volume, stage.renderer, mapper);
  const glm::dvec4 clip = view.indexToClip * glm::dvec4(index, 1.0);
  int width, height, left, bottom;
  stage.renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  check(view.viewport == glm::ivec2(width, height), "the viewport has another size");
  // VTK counts a viewport's pixels from where it begins, which is between pixels.
  const double* const viewport = stage.renderer->GetViewport();
  const int* const window = stage.window->GetSize();
  for (int a = 0; a < 2; ++a)
  {
    const double begin = viewport[a] * window[a],
                 part = (viewport[a + 2] - viewport[a]) * window[a];
    const double at = begin + 0.5 * (clip[a] / clip.w + 1.0) * part;
    // Sides of the viewport are rounded to pixels, which changes its aspect.
    check(std::abs(at - display[a]) < 1e-3 + std::abs(at - begin - 0.5 * part) * 0.2, "coordinate ",
      a, " is ", at, ", not ", display[a]);
  }
  check(std::abs(clip.z / clip.w - 2.0 * display[2] + 1.0) < 1e-6, "another depth");
}
}

int TestViewOfVolume(int, char*[])
{
  Checks check;
  stage::Stage stage(311, 207);
  reference::forScenes("renderers", 200,
    [&](int, reference::Random& random)
    {
      vtkNew<vtkImageData> image;
      const auto mapper = stage::splatting(image);
      stage.show(mapper);
      setScene(stage, image, random);
      GridOfDataSet described;
      describeGrid(image, false, described);
      check(!isFlat(described.grid, stage.volume), "a volume is taken to be flat");
      testPoint(check, stage, image, described.grid, mapper, random);
      const auto viewNow = [&]
      { return makeView(described.grid, stage.volume, stage.renderer, mapper); };
      const std::size_t before = viewNow().halfSpaces.size();
      vtkNew<vtkPlane> plane;
      plane->SetOrigin(stage.volume->GetCenter());
      plane->SetNormal(0.3, 0.4, 0.5);
      mapper->AddClippingPlane(plane);
      mapper->CroppingOn();
      mapper->SetCroppingRegionFlags(VTK_CROP_SUBVOLUME);
      check(viewNow().halfSpaces.size() == before + 1 && viewNow().cropping.cuts(),
        "planes or cropping are left out");
      stage.volume->SetScale(1.0, 0.0, 1.0);
      check(isFlat(described.grid, stage.volume), "a flat volume is not noticed");
    });
  return check.exitCode();
}
