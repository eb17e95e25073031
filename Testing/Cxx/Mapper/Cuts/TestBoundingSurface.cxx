// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bounding surfaces: compares a box with clipping planes, and tests messages about invalid
// surfaces. TestSurfaceTriangles tests spheres and all refused surfaces.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkCubeSource.h"
#include "vtkImageData.h"
#include "vtkPlane.h"
#include "vtkPolyData.h"
#include "vtkStripper.h"
#include "vtkTriangleFilter.h"
#include "vtkVolume.h"

namespace
{
constexpr int Width = 210;
constexpr int Height = 190;

const stage::Vector up = { 0.1, 1.0, 0.05 };
const stage::Vector directions[] = { { 0.3, 0.4, -0.8 }, { -0.8, 0.3, 0.4 }, { 0.2, -0.9, 0.3 } };
/// In the world. No ray of the shear images meets a slice's middle there.
const double box[6] = { 12.37, 41.13, 9.71, 33.29, 20.43, 47.61 };

vtkSmartPointer<vtkPolyData> cube(const double bounds[6])
{
  vtkNew<vtkCubeSource> source;
  source->SetBounds(bounds);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
}

vtkSmartPointer<vtkPolyData> strips(vtkPolyData* polygons)
{
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(polygons);
  vtkNew<vtkStripper> stripper;
  stripper->SetInputConnection(triangles->GetOutputPort());
  stripper->Update();
  return stripper->GetOutput();
}

void addPlanes(vtkVolumeMapper* mapper, const double bounds[6])
{
  for (int side = 0; side < 6; ++side)
  {
    vtkNew<vtkPlane> plane;
    double origin[3] = { 0.0, 0.0, 0.0 }, normal[3] = { 0.0, 0.0, 0.0 };
    origin[side / 2] = bounds[side];
    normal[side / 2] = side % 2 ? -1.0 : 1.0;
    plane->SetOrigin(origin);
    plane->SetNormal(normal);
    mapper->AddClippingPlane(plane);
  }
}

void testBox(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  const auto polygons = cube(box);
  const auto stripped = strips(polygons);
  check(stripped->GetNumberOfStrips() > 0, "There are strips.");
  stage.volume->SetOrientation(10.0, -5.0, 20.0);
  stage.volume->SetScale(1.0, 1.2, 0.9);
  for (const stage::Vector& direction : directions)
  {
    stage.look(direction, up);
    mapper->SetQualityModeToHigh();
    const stage::Pixels whole = stage.pixels();
    for (int mode = 0; mode < 3; ++mode)
    {
      mapper->SetQualityMode(mode);
      addPlanes(mapper, box);
      const stage::Pixels planes = stage.pixels();
      mapper->RemoveAllClippingPlanes();
      mapper->SetBoundingSurface(polygons);
      check(stage.pixels() == planes, "A box cuts as six planes do.");
      mapper->SetBoundingSurface(stripped);
      check(stage.pixels() == planes, "Strips cut as polygons do.");
      mapper->SetBoundingSurface(nullptr);
      check(planes != whole, "A box cuts.");
    }
    mapper->SetQualityModeToHigh();
    check(stage.pixels() == whole, "Without a surface the volume is whole again.");
  }
  stage.volume->SetOrientation(0.0, 0.0, 0.0);
  stage.volume->SetScale(1.0, 1.0, 1.0);
}

void testMessages(
  stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  const auto good = cube(box);
  mapper->SetBoundingSurface(good);
  const stage::Pixels expected = stage.pixels();
  const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
  mapper->SetBoundingSurface(vtkNew<vtkPolyData>());
  stage.pixels();
  stage.pixels();
  check(errors.texts.size() == 1 && errors.texts[0].find("polygons") != std::string::npos,
    "One sentence about a surface without polygons.");
  mapper->SetBoundingSurface(good);
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  check(stage.pixels() == expected && warnings.texts.empty(), "No warning about closed surfaces.");
  const auto open = cube(box);
  vtkNew<vtkCellArray> faces;
  for (vtkIdType face = 0; face < 5; ++face)
  {
    vtkNew<vtkIdList> ids;
    open->GetCellPoints(face, ids);
    faces->InsertNextCell(ids);
  }
  open->SetPolys(faces);
  mapper->SetBoundingSurface(open);
  check(stage.pixels() != expected, "An open surface is another one.");
  stage.pixels();
  check(warnings.texts.size() == 1 && warnings.texts[0].find("not closed") != std::string::npos,
    "One warning that the surface is open.");
  mapper->SetBoundingSurface(nullptr);
}
}

//------------------------------------------------------------------------------
int TestBoundingSurface(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(Width, Height);
  const auto image = stage::toImageData(stage::blobsAndTubes({ 64, 56, 60 }, 40));
  const auto mapper = stage::splatting(image);
  for (double viewAngle : { 0.0, 50.0 })
  {
    stage.viewAngle = viewAngle;
    stage.show(mapper);
    testBox(stage, mapper, check);
    testMessages(stage, mapper, check);
  }
  return check.exitCode();
}
