// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The surface that a volume is shown in, as it is taken from vtkPolyData: what is refused, what is
// open, and that a change of data or place is noticed.
#include "CutScenes.h"
#include "Input/BoundingSurface.h"
#include "ProjectionTesting.h"

#include "vtkCellArray.h"
#include "vtkCubeSource.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSphereSource.h"

#include <glm/vector_relational.hpp>

#include <cmath>
#include <string>

namespace
{
using reference::Checks;
using namespace splatting;

vtkSmartPointer<vtkPolyData> sphere(const glm::dvec3& centre, double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetCenter(centre.x, centre.y, centre.z);
  source->SetRadius(radius);
  source->SetThetaResolution(40);
  source->SetPhiResolution(40);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
}

/// The slices of each ray that are inside of a sphere in index space. Facets are flatter than the
/// sphere by less than a fiftieth of its radius.
void testSphere(Checks& check, BoundingSurface& surface, const glm::dvec3& centre, double radius,
  reference::Random& random)
{
  const std::array<int, 3> size{ 20, 20, 20 };
  const splatting::ShearWarp geometry(coretesting::randomView(size, random));
  splatting::RayIntervals intervals;
  intervals.find(geometry, {}, surface.Get(), nullptr);
  if (!check(!intervals.empty(), "a surface cuts nothing"))
  {
    return;
  }
  for (int v = 0; v < geometry.rayCount().y; ++v)
  {
    for (int u = 0; u < geometry.rayCount().x; ++u)
    {
      for (int k = 0; k < geometry.size().z; ++k)
      {
        glm::dvec3 point;
        point[geometry.axes()[0]] = geometry.onRay(u, v, k).x;
        point[geometry.axes()[1]] = geometry.onRay(u, v, k).y;
        point[geometry.axes()[2]] = k;
        if (glm::any(glm::greaterThan(glm::abs(point - 9.5), glm::dvec3(9.5))))
        {
          continue; // not in the volume
        }
        const double distance = glm::length(point - centre) / radius;
        const bool isIn = k >= intervals.first(v)[u] && k <= intervals.last(v)[u];
        // Where no middle of a slice is inside the nearest slice is shown.
        const bool isNearest = isIn && intervals.first(v)[u] == intervals.last(v)[u];
        check((distance < 1.0 && distance > 0.98) || isNearest || isIn == (distance < 1.0),
          "a place at ", distance, " radii is ", isIn ? "inside" : "outside");
      }
    }
  }
}

bool isRefused(const char* fault, const std::string& word)
{
  return fault && std::string(fault).find(word) != std::string::npos;
}

void testScene(Checks& check, reference::Random& random)
{
  BoundingSurface surface;
  check(!surface.Update(nullptr, glm::dmat4(1.0)) && !surface.Get(), "no surface is one");
  const glm::dvec3 middle = coretesting::anyVector(random, 7.0, 12.0);
  const double radius = random.uniform(2.0, 6.0);
  const auto ball = sphere(middle, radius);
  check(!surface.Update(ball, glm::dmat4(1.0)) && surface.Get() && !surface.IsOpen(),
    "a sphere is refused or open");
  testSphere(check, surface, middle, radius, random);
  const glm::dvec3 way = coretesting::anyVector(random, -2.0, 2.0);
  surface.Update(ball, glm::translate(glm::dmat4(1.0), way));
  testSphere(check, surface, middle + way, radius, random);
  ball->GetPoints()->SetPoint(0, NAN, 0.0, 0.0);
  ball->Modified();
  check(isRefused(surface.Update(ball, glm::dmat4(1.0)), "not finite"), "NaN is taken");
  check(isRefused(surface.Update(ball, glm::dmat4(1.0)), "not finite"), "NaN is taken later");
  ball->ShallowCopy(sphere(middle, radius));
  check(!surface.Update(ball, glm::dmat4(1.0)) && surface.Get(), "a mended surface is refused");
  check(isRefused(surface.Update(ball, glm::scale(glm::dmat4(1.0), glm::dvec3(1e12))), "1e12"),
    "a surface that is too far away is taken");
  ball->GetPolys()->ReplaceCellAtId(0, 3, std::vector<vtkIdType>{ 0, 0, 0 }.data());
  ball->Modified();
  check(!surface.Update(ball, glm::dmat4(1.0)) && surface.IsOpen(), "a hole is not noticed");
  vtkNew<vtkCubeSource> cube; // whose sides share no points
  cube->Update();
  check(!surface.Update(cube->GetOutput(), glm::dmat4(1.0)) && !surface.IsOpen(),
    "points in the same place are not one");
  const vtkIdType line[] = { 0, 1, 1 };
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(3, line);
  ball->SetPolys(lines);
  check(isRefused(surface.Update(ball, glm::dmat4(1.0)), "no area"), "lines are a surface");
  ball->SetPolys(nullptr);
  check(isRefused(surface.Update(ball, glm::dmat4(1.0)), "no polygons"), "points are a surface");
}
}

int TestSurfaceTriangles(int, char*[])
{
  Checks check;
  reference::forScenes(
    "surfaces", 40, [&](int, reference::Random& random) { testScene(check, random); });
  return check.exitCode();
}
