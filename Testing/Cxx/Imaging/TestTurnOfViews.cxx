// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cameras that go round a volume: as vtkCamera and vtkTransform turn them, with pixels that lie as
// far apart as the spacing says.
#include "Input/WorldView.h"
#include "ProjectionTesting.h"
#include "TurnOfViews.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkTransform.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

glm::dvec3 vector(const double* v)
{
  return { v[0], v[1], v[2] };
}

/// With a camera of its own or without, equal steps or not.
TurnSettings anySettings(vtkCamera* camera, reference::Random& random)
{
  TurnSettings settings;
  settings.direction = 3.0 * coretesting::anyDirection(random);
  settings.up = coretesting::anyDirection(random);
  settings.focalPoint = coretesting::anyVector(random, -30.0, 30.0);
  settings.diagonal = random.uniform(5.0, 50.0);
  settings.size.x = random.uniform(1, 90);
  settings.size.y = random.uniform(1, 90);
  settings.views = random.uniform(1, 12);
  settings.angle = random.oneIn(2) ? random.uniform(-400.0, 400.0) : 360.0;
  if (random.oneIn(2))
  {
    settings.axis = 2.0 * coretesting::anyDirection(random);
  }
  if (random.oneIn(2))
  {
    settings.spacing = glm::dvec2(random.uniform(0.1, 3.0));
    settings.spacing.y *= random.oneIn(2) ? 1.0 : random.uniform(0.5, 2.0);
  }
  if (random.oneIn(2))
  {
    const glm::dvec3 eye = settings.focalPoint - 40.0 * glm::normalize(settings.direction);
    camera->SetFocalPoint(&settings.focalPoint.x);
    camera->SetPosition(&eye.x);
    camera->SetViewUp(&settings.up.x);
    camera->SetParallelProjection(random.uniform(0, 1));
    camera->SetParallelScale(random.uniform(3.0, 30.0));
    camera->SetViewAngle(random.uniform(5.0, 90.0));
    camera->SetUseHorizontalViewAngle(random.uniform(0, 1));
    settings.camera = camera;
  }
  return settings;
}

/// Where a view's camera must be: the first one, turned about an axis through its focal point.
void testCamera(Checks& check, const TurnOfViews& turn, const TurnSettings& settings, int view)
{
  vtkNew<vtkCamera> first, found;
  turn.SetCamera(0, first);
  turn.SetCamera(view, found);
  const glm::dvec3 focus = vector(first->GetFocalPoint());
  const glm::dvec3 axis =
    glm::length(settings.axis) > 0.0 ? settings.axis : vector(first->GetViewUp());
  vtkNew<vtkTransform> rotation;
  rotation->Translate(focus.x, focus.y, focus.z);
  rotation->RotateWXYZ(view * settings.angle / settings.views, axis.x, axis.y, axis.z);
  rotation->Translate(-focus.x, -focus.y, -focus.z);
  const double* const eye = rotation->TransformDoublePoint(first->GetPosition());
  check(glm::length(vector(eye) - vector(found->GetPosition())) < 1e-9, "view ", view,
    " has another place");
  const double* const up = rotation->TransformDoubleVector(first->GetViewUp());
  check(glm::length(vector(up) - vector(found->GetViewUp())) < 1e-12, "view ", view,
    " has another view-up");
  check(vector(found->GetFocalPoint()) == focus, "the focal point moves");
  if (glm::length(settings.axis) == 0.0)
  {
    // VTK turns about what is up on the screen.
    first->OrthogonalizeViewUp();
    if (glm::length(vector(first->GetViewUp()) - glm::normalize(axis)) < 1e-9)
    {
      first->Azimuth(view * settings.angle / settings.views);
      check(glm::length(vector(first->GetPosition()) - vector(found->GetPosition())) < 1e-6,
        "view ", view, " is not that of vtkCamera::Azimuth()");
    }
  }
}

/// Of the pixels of a picture that is placed by the turn.
glm::dvec2 spacingOf(const TurnOfViews& turn)
{
  vtkNew<vtkImageData> picture;
  turn.Place(picture);
  return { picture->GetSpacing()[0], picture->GetSpacing()[1] };
}

/// Points of the focal plane that lie steps of pixels from the focal point.
void testPixels(Checks& check, const TurnOfViews& turn, int view, reference::Random& random)
{
  vtkNew<vtkCamera> camera;
  turn.SetCamera(view, camera);
  const glm::dvec3 direction = vector(camera->GetDirectionOfProjection());
  const glm::dvec3 right = glm::normalize(glm::cross(direction, vector(camera->GetViewUp())));
  const glm::dvec2 size(turn.Size());
  const glm::dvec2 steps{ random.uniform(-40.0, 40.0), random.uniform(-40.0, 40.0) };
  const glm::dvec3 point = vector(camera->GetFocalPoint()) + steps.x * spacingOf(turn).x * right +
    steps.y * spacingOf(turn).y * glm::cross(right, direction);
  const glm::dvec4 clip = turn.WorldToClip(view) * glm::dvec4(point, 1.0);
  const glm::dvec2 found = 0.5 * size * glm::dvec2(clip) / clip.w;
  check(glm::length(found - steps) < 1e-6, "view ", view, ": pixel ", steps.x, " ", steps.y,
    " is at ", found.x, " ", found.y);
}

/// Each view once, opposite ones one after the other, the last one last.
void testOrder(Checks& check, const TurnOfViews& turn, double angle)
{
  const std::vector<int> order = turn.Order();
  const int views = turn.Views();
  std::vector<int> seen(views, 0);
  for (const int view : order)
  {
    seen.at(view) += 1;
  }
  check(std::count(seen.begin(), seen.end(), 1) == views && order.back() == views - 1,
    "not each view once, or another one is last");
  for (int n = 0; n + 1 < views && angle == 360.0 && views % 2 == 0; n += 2)
  {
    check(order[n + 1] - order[n] == views / 2, "opposite views are apart");
  }
}

void testScene(Checks& check, reference::Random& random)
{
  vtkNew<vtkCamera> camera;
  const TurnSettings settings = anySettings(camera, random);
  TurnOfViews turn;
  const char* const fault = turn.Set(settings);
  if (!check(!fault, fault ? fault : ""))
  {
    return;
  }
  const int view = random.uniform(0, settings.views - 1);
  testCamera(check, turn, settings, view);
  testPixels(check, turn, view, random);
  testOrder(check, turn, settings.angle);
  vtkNew<vtkImageData> picture;
  turn.Place(picture);
  vtkDataArray* const angles = picture->GetFieldData()->GetArray("ViewAngle");
  check(angles->GetNumberOfTuples() == settings.views &&
      std::abs(angles->GetTuple1(view) - view * settings.angle / settings.views) < 1e-9,
    "another angle");
  const bool isAutomatic = settings.spacing == glm::dvec2(0.0);
  check(isAutomatic || spacingOf(turn) == settings.spacing, "another spacing than was set");
  if (isAutomatic && !settings.camera)
  {
    const int least = std::min(settings.size.x, settings.size.y);
    check(std::abs(spacingOf(turn).x * least - settings.diagonal) < 1e-9 &&
        spacingOf(turn).x == spacingOf(turn).y,
      "the diagonal does not fill the picture");
  }
  check(!isAutomatic || !settings.camera || !camera->GetParallelProjection() ||
      std::abs(spacingOf(turn).y * settings.size.y - 2.0 * camera->GetParallelScale()) < 1e-9,
    "the parallel scale is not half the height");
  TurnSettings bad = settings;
  bad.angle = 0.0;
  check(turn.Set(bad) && turn.Views() == settings.views, "a turn of 0 degrees is taken");
}
}

int TestTurnOfViews(int, char*[])
{
  Checks check;
  reference::forScenes(
    "turns", 1000, [&](int, reference::Random& random) { testScene(check, random); });
  return check.exitCode();
}
