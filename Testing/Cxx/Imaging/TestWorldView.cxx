// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points of a volume and what shows them: by VTK's matrices, planes and cameras, point by point.
#include "Input/WorldView.h"
#include "ProjectionTesting.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

/// A volume somewhere, a camera that sees it, and both matrices.
struct Scene
{
  VolumeGrid grid;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkMatrix4x4> toWorld, toClip;

  explicit Scene(reference::Random& random)
  {
    const double angle = random.uniform(0.0, 6.3);
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), coretesting::anyVector(random, -9.0, 9.0));
    m = glm::rotate(m, angle, coretesting::anyDirection(random));
    for (int a = 0; a < 3; ++a)
    {
      this->grid.dimensions[a] = random.uniform(2, 9);
      this->grid.first[a] = random.uniform(-9.0, 9.0);
      this->grid.spacing[a] = random.uniform(0.5, 2.0) * (!random.oneIn(3) ? 1.0 : -1.0);
    }
    m = glm::scale(m, this->grid.spacing);
    for (int n = 0; n < 16; ++n)
    {
      this->toWorld->SetElement(n / 4, n % 4, m[n % 4][n / 4]);
    }
    const glm::dvec3 middle(m * glm::dvec4(0.5 * glm::dvec3(this->grid.dimensions - 1), 1.0));
    const glm::dvec3 eye = middle + 40.0 * coretesting::anyDirection(random);
    const glm::dvec3 up = coretesting::anyDirection(random);
    this->camera->SetFocalPoint(middle.x, middle.y, middle.z);
    this->camera->SetPosition(eye.x, eye.y, eye.z);
    this->camera->SetViewUp(up.x, up.y, up.z);
    this->camera->SetParallelProjection(random.uniform(0, 1));
    this->camera->SetParallelScale(9.0);
    const double near = random.uniform(25.0, 42.0);
    this->camera->SetClippingRange(near, near + random.uniform(2.0, 20.0));
    this->toClip->DeepCopy(this->camera->GetCompositeProjectionTransformMatrix(1.3, -1.0, 1.0));
  }

  glm::dmat4 world() const { return toGlm(this->toWorld); }
  splatting::View view() const
  {
    return viewOf(this->grid, this->world(), toGlm(this->toClip), { 40, 30 });
  }
  /// Of the volume, or half a voxel beyond.
  glm::dvec3 anyPoint(reference::Random& random) const
  {
    glm::dvec3 point;
    for (int a = 0; a < 3; ++a)
    {
      point[a] = random.uniform(-0.5, this->grid.dimensions[a] - 0.5);
    }
    return point;
  }
  glm::dvec3 inWorld(const glm::dvec3& point) const
  {
    double p[4] = { point.x, point.y, point.z, 1.0 };
    this->toWorld->MultiplyPoint(p, p);
    return { p[0], p[1], p[2] };
  }
};

/// How far a point is inside of all half-spaces, in their own measure.
double inside(const splatting::View& view, const glm::dvec3& point)
{
  double least = 1e300;
  for (const glm::dvec4& h : view.halfSpaces)
  {
    least = std::min(least, glm::dot(h, glm::dvec4(point, 1.0)));
  }
  return least;
}

/// Whether half-spaces say what  says by its sign. Next to a plane both may.
void compare(Checks& check, const splatting::View& view, const glm::dvec3& point, double expected,
  const std::string& name)
{
  check(std::abs(expected) < 1e-9 || (inside(view, point) >= 0.0) == (expected >= 0.0), name,
    ": a point at ", expected, " is at ", inside(view, point));
}

void testMatrices(Checks& check, const Scene& scene, const glm::dvec3& point)
{
  const splatting::View view = scene.view();
  double clip[4] = { 0.0, 0.0, 0.0, 1.0 };
  const glm::dvec3 world = scene.inWorld(point);
  std::copy(&world.x, &world.x + 3, clip);
  scene.toClip->MultiplyPoint(clip, clip);
  const glm::dvec4 found = view.indexToClip * glm::dvec4(point, 1.0);
  for (int a = 0; a < 4; ++a)
  {
    check(std::abs(found[a] - clip[a]) < 1e-9, "clip space: ", found[a], ", not ", clip[a]);
  }
  compare(check, view, point, clip[3] - std::abs(clip[2]), "near and far");
}

void testPlanes(
  Checks& check, const Scene& scene, const glm::dvec3& point, reference::Random& random)
{
  vtkNew<vtkPlaneCollection> planes;
  double least = 1e300;
  for (int n = random.uniform(1, 3); n > 0; --n)
  {
    vtkNew<vtkPlane> plane;
    const glm::dvec3 normal = coretesting::anyDirection(random);
    const glm::dvec3 origin = scene.inWorld(scene.anyPoint(random));
    plane->SetNormal(normal.x, normal.y, normal.z);
    plane->SetOrigin(origin.x, origin.y, origin.z);
    planes->AddItem(plane);
    glm::dvec3 at = scene.inWorld(point);
    least = std::min(least, plane->EvaluateFunction(&at.x));
  }
  splatting::View view = scene.view();
  view.halfSpaces.clear();
  addPlanes(view, scene.world(), planes);
  compare(check, view, point, least, "planes");
}

/// What VTK says of a point's coordinates along the image's axes.
void testCropping(
  Checks& check, const Scene& scene, const glm::dvec3& point, reference::Random& random)
{
  double planes[6];
  const int flags = static_cast<int>(random.bits() & 0x7FFFFFF);
  int region = 0, found = 0;
  const int strides[3] = { 1, 3, 9 };
  for (int a = 0; a < 3; ++a)
  {
    const auto place = [&](double index)
    { return scene.grid.first[a] + scene.grid.spacing[a] * index; };
    const double p = place(random.uniform(-1.0, 9.0)), q = place(random.uniform(-1.0, 9.0));
    planes[2 * a] = std::min(p, q);
    planes[2 * a + 1] = std::max(p, q);
    const double at = place(point[a]);
    region += strides[a] * (at < planes[2 * a] ? 0 : at < planes[2 * a + 1] ? 1 : 2);
  }
  const splatting::Cropping cropping = croppingOf(scene.grid, planes, flags);
  for (int a = 0; a < 3; ++a)
  {
    const glm::dvec2& own = cropping.planes[a];
    found += strides[a] * (point[a] < own[0] ? 0 : point[a] < own[1] ? 1 : 2);
  }
  check((flags >> region & 1) == int(cropping.flags >> found & 1u), "region ", region,
    " is not what it is with the mapper");
}

void testSlab(Checks& check, const Scene& scene, const glm::dvec3& point, reference::Random& random)
{
  const glm::dvec3 centre = scene.inWorld(scene.anyPoint(random));
  const double thickness = random.uniform(0.5, 6.0);
  splatting::View view = scene.view();
  view.halfSpaces.clear();
  addSlab(view, scene.world(), &centre.x, thickness);
  const double* const d = scene.camera->GetDirectionOfProjection();
  const double away = glm::dot(glm::dvec3(d[0], d[1], d[2]), scene.inWorld(point) - centre);
  compare(check, view, point, 0.5 * thickness - std::abs(away), "slab");
  // A thin slab shows its centre, and nothing one slice away. Steps of rays from slice
  // to slice are no longer than the three edges of a voxel.
  const double thin = std::pow(10.0, random.uniform(-300.0, -4.0));
  view.halfSpaces.clear();
  addSlab(view, scene.world(), &centre.x, thin);
  const glm::dvec3 middle(glm::inverse(scene.world()) * glm::dvec4(centre, 1.0));
  check(inside(view, middle) >= 0.0, "a slab of ", thin, " loses its middle");
  const glm::dvec3 edges = glm::abs(scene.grid.spacing);
  check(std::abs(away) < edges.x + edges.y + edges.z || inside(view, point) < 0.0, "a slab of ",
    thin, " shows what is ", away, " away");
  view.halfSpaces.clear();
  addSlab(view, scene.world(), &centre.x, HUGE_VAL);
  check(view.halfSpaces.empty(), "an endless slab cuts");
}
}

int TestWorldView(int, char*[])
{
  Checks check;
  reference::forScenes("world", 1000,
    [&](int, reference::Random& random)
    {
      const Scene scene(random);
      const glm::dvec3 point = scene.anyPoint(random);
      testMatrices(check, scene, point);
      testPlanes(check, scene, point, random);
      testCropping(check, scene, point, random);
      testSlab(check, scene, point, random);
      check(!isSingular(scene.world()), "a volume is taken to be flat");
      glm::dmat4 flat = scene.world();
      const int a = random.uniform(0, 2);
      flat[a] = random.oneIn(2) ? flat[(a + 1) % 3] : glm::dvec4(0.0);
      check(isSingular(flat), "a flat volume is not noticed");
      flat[a][random.uniform(0, 2)] = std::nan("");
      check(isSingular(flat), "NaN is not noticed");
    });
  return check.exitCode();
}
