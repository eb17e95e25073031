// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces that a volume is shown in: a box against clipping planes, a sphere against its equation,
// and surfaces that are none.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkCubeSource.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkStripper.h"
#include "vtkTriangleFilter.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace
{
constexpr int Width = 210;
constexpr int Height = 190;

using Bytes = reference::Volume<std::uint8_t>;

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

vtkSmartPointer<vtkPolyData> sphere(const stage::Vector& centre, double radius, int resolution)
{
  vtkNew<vtkSphereSource> source;
  source->SetCenter(centre[0], centre[1], centre[2]);
  source->SetRadius(radius);
  source->SetThetaResolution(resolution);
  source->SetPhiResolution(resolution);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
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

/// The largest voxel of a ray whose place in the slice's middle is inside the sphere; -1 if none
/// is. `doubt` is set if the radius decides by less than `margin`.
int brightestInside(const Bytes& volume, const reference::ShearView& view,
  const std::array<double, 2>& place, const stage::Vector& centre, double radius, double margin,
  bool& doubt)
{
  static const int axesOf[3][3] = { { 1, 2, 0 }, { 0, 2, 1 }, { 0, 1, 2 } };
  const int* const axes = axesOf[view.axis];
  const int slices = volume.size[axes[2]];
  int brightest = -1;
  doubt = false;
  for (int k = 0; k < slices; ++k)
  {
    const double depth = k - 0.5 * (slices - 1);
    stage::Vector p;
    p[axes[0]] = place[0] - view.shear[0] * depth;
    p[axes[1]] = place[1] - view.shear[1] * depth;
    p[axes[2]] = k;
    const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(p.data(), centre.data()));
    doubt = doubt || std::abs(distance - radius) < margin;
    // Without shear a ray crosses one voxel of each slice.
    const std::array<int, 3> voxel = { static_cast<int>(std::lround(p[0])),
      static_cast<int>(std::lround(p[1])), static_cast<int>(std::lround(p[2])) };
    if (distance < radius && volume.contains(voxel))
    {
      brightest = std::max<int>(brightest, volume.at(voxel));
    }
  }
  return brightest;
}

/// Along each axis, where each ray crosses one voxel of a slice, the preview's shear image is
/// known.
void testSphere(stage::Stage& stage, reference::Checks& check)
{
  const Bytes noise = reference::uniformNoise<std::uint8_t>({ 24, 26, 28 }, 9);
  const auto image = stage::toImageData(noise);
  const auto mapper = stage::splatting(image);
  mapper->SetQualityModeToPreview();
  stage.show(mapper);
  const stage::Vector centre = { 10.3, 14.1, 12.7 };
  constexpr double radius = 8.17;
  constexpr int resolution = 300;
  mapper->SetBoundingSurface(sphere(centre, radius, resolution));
  // Facets lie inside the sphere by up to r (1 - cos(pi / n)) along either angle.
  const double margin = 2.0 * radius * (1.0 - std::cos(vtkMath::Pi() / resolution)) + 1e-9;
  for (int axis = 0; axis < 3; ++axis)
  {
    stage::Vector direction = { 0.0, 0.0, 0.0 };
    direction[axis] = -1.0;
    stage.look(direction, { axis == 1 ? 1.0 : 0.0, axis == 1 ? 0.0 : 1.0, 0.0 });
    stage.window->Render();
    reference::ShearView view;
    view.axis = mapper->GetPrincipalAxis();
    mapper->GetShear(view.shear);
    check(
      view.axis == axis && view.shear[0] == 0.0 && view.shear[1] == 0.0, "A view along an axis.");
    vtkImageData* const shear = mapper->GetShearImage();
    vtkUnsignedCharArray* const ghosts = shear->GetPointGhostArray();
    int wrong = 0, compared = 0, doubtful = 0;
    for (int v = 0; v < shear->GetDimensions()[1]; ++v)
    {
      for (int u = 0; u < shear->GetDimensions()[0]; ++u)
      {
        bool doubt;
        const int expected = brightestInside(noise, view,
          { u + shear->GetOrigin()[0], v + shear->GetOrigin()[1] }, centre, radius, margin, doubt);
        const bool isHidden = (ghosts->GetValue(shear->GetDimensions()[0] * v + u) &
                                vtkDataSetAttributes::HIDDENPOINT) != 0;
        const int value = static_cast<int>(shear->GetScalarComponentAsDouble(u, v, 0, 0));
        doubtful += doubt;
        compared += !doubt && expected >= 0;
        wrong += !doubt && (isHidden ? -1 : value) != expected;
      }
    }
    std::cout << "sphere along " << axis << ": " << compared << " pixels inside, " << doubtful
              << " left out, " << wrong << " wrong" << std::endl;
    check(wrong == 0 && compared > 150 && doubtful < 20, "A sphere cuts as its equation says.");
  }
}

void testReuse(stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  stage.look(directions[0], up);
  const auto surface = sphere({ 30.0, 30.0, 30.0 }, 15.0, 40);
  mapper->SetBoundingSurface(surface);
  const stage::Pixels expected = stage.pixels();
  const vtkIdType before = mapper->GetNumberOfProjections();
  check(stage.pixels() == expected && mapper->GetNumberOfProjections() == before,
    "The same surface costs no projection.");
  surface->GetPoints()->SetPoint(0, 30.0, 30.0, 80.0);
  surface->GetPoints()->Modified();
  check(stage.pixels() != expected && mapper->GetNumberOfProjections() == before + 1,
    "A modified surface is seen.");
  surface->GetPoints()->SetPoint(0, 30.0, 30.0, 45.0);
  surface->GetPoints()->Modified();
  check(stage.pixels() == expected, "And back.");
  stage.volume->SetPosition(6.0, 0.0, 0.0);
  const stage::Pixels moved = stage.pixels();
  mapper->SetBoundingSurface(sphere({ 30.0, 30.0, 30.0 }, 15.0, 40));
  check(stage.pixels() == moved, "The surface stays where it is when the volume moves.");
  mapper->SetBoundingSurface(surface);
  stage.volume->SetPosition(0.0, 0.0, 0.0);
  check(stage.pixels() == expected, "And back again.");
  mapper->SetBoundingSurface(nullptr);
  const stage::Pixels whole = stage.pixels();
  const vtkIdType projections = mapper->GetNumberOfProjections();
  mapper->SetBoundingSurface(sphere({ 30.0, 30.0, 30.0 }, 100.0, 40));
  check(stage.pixels() == whole && mapper->GetNumberOfProjections() == projections,
    "A surface around the volume costs no projection.");
  mapper->SetBoundingSurface(nullptr);
}

struct Fault
{
  const char* word;
  vtkSmartPointer<vtkPolyData> surface;
};

void testBadInput(
  stage::Stage& stage, vtkSplattingMIPVolumeMapper* mapper, reference::Checks& check)
{
  const auto points = vtkSmartPointer<vtkPolyData>::New();
  points->SetPoints(vtkNew<vtkPoints>());
  points->GetPoints()->InsertNextPoint(0.0, 0.0, 0.0);
  const auto odd = cube(box);
  odd->GetPoints()->SetPoint(3, 0.0, vtkMath::Nan(), 0.0);
  const auto far = cube(box);
  far->GetPoints()->SetPoint(3, 0.0, 1e15, 0.0);
  const auto endless = cube(box);
  endless->GetPoints()->SetPoint(3, 0.0, std::numeric_limits<double>::infinity(), 0.0);
  const vtkIdType corners[] = { 0, 0, 0 }, line[] = { 0, 1, 2 };
  const auto point = vtkSmartPointer<vtkPolyData>::New();
  point->SetPoints(points->GetPoints());
  point->SetPolys(vtkNew<vtkCellArray>());
  point->GetPolys()->InsertNextCell(3, corners);
  const auto lines = vtkSmartPointer<vtkPolyData>::New();
  lines->SetPoints(vtkNew<vtkPoints>());
  lines->GetPoints()->InsertNextPoint(0.0, 0.0, 0.0);
  lines->GetPoints()->InsertNextPoint(10.0, 20.0, 30.0);
  lines->GetPoints()->InsertNextPoint(20.0, 40.0, 60.0);
  lines->SetPolys(vtkNew<vtkCellArray>());
  lines->GetPolys()->InsertNextCell(3, line);
  const auto good = cube(box);
  mapper->SetBoundingSurface(good);
  const stage::Pixels expected = stage.pixels();
  for (const Fault& fault : { Fault{ "polygons", vtkSmartPointer<vtkPolyData>::New() },
         { "polygons", points }, { "area", point }, { "area", lines }, { "finite", odd },
         { "finite", far }, { "finite", endless } })
  {
    const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
    mapper->SetBoundingSurface(fault.surface);
    stage.pixels();
    stage.pixels();
    check(errors.texts.size() == 1 && errors.texts[0].find(fault.word) != std::string::npos,
      "One sentence about what is wrong: ", fault.word);
    mapper->SetBoundingSurface(good);
    check(stage.pixels() == expected, "Once mended, the picture is as before.");
  }
  const auto open = cube(box);
  vtkNew<vtkCellArray> faces;
  for (vtkIdType face = 0; face < 5; ++face)
  {
    vtkNew<vtkIdList> ids;
    open->GetCellPoints(face, ids);
    faces->InsertNextCell(ids);
  }
  open->SetPolys(faces);
  const stage::Messages warnings(mapper, vtkCommand::WarningEvent);
  check(stage.pixels() == expected && warnings.texts.empty(), "No warning about closed surfaces.");
  mapper->SetBoundingSurface(open);
  check(stage.pixels() != expected, "An open surface is another one.");
  stage.pixels();
  check(warnings.texts.size() == 1 && warnings.texts[0].find("not closed") != std::string::npos,
    "One warning that the surface is open.");
  mapper->SetBoundingSurface(good);
  check(stage.pixels() == expected, "Once closed, the picture is as before.");
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
    testReuse(stage, mapper, check);
    testBadInput(stage, mapper, check);
  }
  stage.viewAngle = 0.0;
  testSphere(stage, check);
  return check.exitCode();
}
