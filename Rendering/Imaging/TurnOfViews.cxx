// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TurnOfViews.h"

#include "Input/WorldView.h"

#include "vtkCamera.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace splatting
{
namespace
{
bool isFinite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isDirection(const glm::dvec3& v)
{
  return isFinite(v) && glm::length(v) > 0.0;
}

/// Rotates counterclockwise about an axis of length 1 [Rodrigues].
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double radians)
{
  const double c = std::cos(radians), s = std::sin(radians);
  return c * v + s * glm::cross(axis, v) + (1.0 - c) * glm::dot(axis, v) * axis;
}

glm::dvec3 vector(const double* v)
{
  return { v[0], v[1], v[2] };
}

/// Returns an error message, or nullptr.
const char* validate(const TurnSettings& s)
{
  const bool automatic = s.spacing == glm::dvec2(0.0);
  const struct
  {
    bool holds;
    const char* sentence;
  } problems[] = {
    { s.size.x < 1 || s.size.y < 1 || std::max(s.size.x, s.size.y) > TurnOfViews::MostPixels,
      "OutputSize is invalid: set both numbers of pixels to 1 to 16384." },
    { !automatic &&
        !(s.spacing.x > 0.0 && s.spacing.y > 0.0 && std::isfinite(s.spacing.x + s.spacing.y)),
      "OutputSpacing is invalid: set both to world units above 0, or both to 0 for "
      "automatic." },
    { !isFinite(s.axis),
      "RotationAxis is not finite: set it to a direction of the world, or to 0, 0, 0 for "
      "view-up." },
    { !std::isfinite(s.angle) || s.angle == 0.0,
      "TotalAngle is invalid: set it to degrees other than 0." },
    { !s.camera && !isDirection(s.direction),
      "ViewDirection is no direction: set it to finite numbers that are not all 0." },
    { !s.camera &&
        !(glm::length(glm::cross(s.direction, s.up)) >
          1e-9 * glm::length(s.direction) * glm::length(s.up)),
      "ViewUp is no direction across the view: set it to one that is not along ViewDirection." },
    { !s.camera && !isFinite(s.focalPoint),
      "FocalPoint is not finite: set it to a point of the world." },
    { s.camera && s.camera->GetUseExplicitProjectionTransformMatrix(),
      "The camera has an explicit projection matrix, which has no scale: turn that off." },
  };
  for (const auto& problem : problems)
  {
    if (problem.holds)
    {
      return problem.sentence;
    }
  }
  return nullptr;
}
}

const char* const TurnOfViews::Degenerate =
  "The camera flattens the volume to a line or has no extent: set its parallel scale or "
  "its view angle above 0, and a view-up that is not parallel to its direction.";

const char* TurnOfViews::Set(const TurnSettings& settings)
{
  if (const char* const fault = validate(settings))
  {
    return fault;
  }
  this->Settings = settings;
  this->Settings.camera = nullptr; // it need not outlive this call
  if (settings.camera)
  {
    this->First->DeepCopy(settings.camera);
  }
  else
  {
    this->PlaceCamera();
  }
  this->ScaleCamera();
  return std::isfinite(this->Settings.spacing.x) && this->Settings.spacing.x > 0.0 ? nullptr
                                                                                   : Degenerate;
}

// Makes a parallel camera outside the volume, if there is no camera.
void TurnOfViews::PlaceCamera()
{
  const vtkNew<vtkCamera> plain;
  this->First->DeepCopy(plain);
  const glm::dvec3& focus = this->Settings.focalPoint;
  const glm::dvec3 eye = focus - this->Settings.diagonal * glm::normalize(this->Settings.direction);
  this->First->SetFocalPoint(focus.x, focus.y, focus.z);
  this->First->SetPosition(eye.x, eye.y, eye.z);
  this->First->SetViewUp(this->Settings.up.x, this->Settings.up.y, this->Settings.up.z);
  this->First->ParallelProjectionOn();
  if (this->Settings.spacing == glm::dvec2(0.0))
  {
    this->Settings.spacing =
      glm::dvec2(this->Settings.diagonal / std::min(this->Settings.size.x, this->Settings.size.y));
  }
}

// Applies the spacing, or computes it from the camera.
void TurnOfViews::ScaleCamera()
{
  vtkCamera* const camera = this->First;
  const glm::dvec2 size(this->Settings.size);
  glm::dvec2& spacing = this->Settings.spacing;
  this->Aspect = size.x / size.y;
  const double distance = camera->GetDistance();
  // Only its precision matters: it must be near the numbers of the view.
  camera->SetClippingRange(0.01 * distance, 100.0 * distance);
  if (spacing == glm::dvec2(0.0))
  {
    const double tangent = std::tan(0.5 * glm::radians(camera->GetViewAngle()));
    const bool wide = camera->GetUseHorizontalViewAngle();
    spacing = glm::dvec2(camera->GetParallelProjection()
        ? 2.0 * camera->GetParallelScale() / size.y
        : 2.0 * tangent * distance / (wide ? size.x : size.y));
    return;
  }
  // Equal steps must give the same bits as the camera of GetViewCamera().
  this->Aspect *= spacing.x == spacing.y ? 1.0 : spacing.x / spacing.y;
  const double half = 0.5 * size.y * spacing.y;
  camera->SetUseHorizontalViewAngle(0);
  camera->SetParallelScale(half);
  if (!camera->GetParallelProjection())
  {
    camera->SetViewAngle(glm::degrees(2.0 * std::atan(half / distance)));
  }
}

double TurnOfViews::Angle(int view) const
{
  return view * this->Settings.angle / this->Settings.views;
}

// Uses the matrices of the view, which include shifts and the camera's user transforms.
void TurnOfViews::Place(vtkImageData* picture) const
{
  const TurnSettings& s = this->Settings;
  const glm::dmat4 toClip = this->WorldToClip(0), toWorld = glm::inverse(toClip);
  const bool inSlab = s.slab && this->First->GetParallelProjection();
  const glm::dvec4 depth =
    toClip * glm::dvec4(inSlab ? s.slabCenter : vector(this->First->GetFocalPoint()), 1.0);
  const auto find = [&](const glm::dvec2& pixel)
  {
    const glm::dvec2 place = 2.0 * (pixel + 0.5) / glm::dvec2(s.size) - 1.0;
    const glm::dvec4 point = toWorld * glm::dvec4(place * depth.w, depth.z, depth.w);
    return glm::dvec3(point) / point.w;
  };
  const glm::dvec3 first = find(glm::dvec2(0.0));
  glm::dvec3 axes[3], spacing(0.0, 0.0, s.slab ? s.slabThickness : 1.0);
  for (int a = 0; a < 2; ++a)
  {
    // Over the whole picture, to reduce the effect of rounding.
    glm::dvec2 end(0.0);
    end[a] = s.size[a];
    const glm::dvec3 side = find(end) - first;
    const double step = glm::length(side) / s.size[a];
    spacing[a] = std::abs(step - s.spacing[a]) < 1e-9 * step ? s.spacing[a] : step;
    axes[a] = glm::normalize(side);
  }
  axes[2] = glm::normalize(glm::cross(axes[0], axes[1]));
  vtkNew<vtkMatrix3x3> direction;
  for (int n = 0; n < 9; ++n)
  {
    direction->SetElement(n / 3, n % 3, axes[n % 3][n / 3]);
  }
  picture->SetSpacing(&spacing.x);
  picture->SetOrigin(&first.x);
  picture->SetDirectionMatrix(direction);
  vtkNew<vtkDoubleArray> angles;
  angles->SetName("ViewAngle");
  for (int n = 0; n < s.views; ++n)
  {
    angles->InsertNextValue(this->Angle(n));
  }
  picture->GetFieldData()->AddArray(angles);
}

std::vector<int> TurnOfViews::Order() const
{
  std::vector<int> order(this->Settings.views);
  std::iota(order.begin(), order.end(), 0);
  const int half = this->Settings.views / 2;
  if (this->Settings.views % 2 == 0 && std::abs(this->Settings.angle) == 360.0)
  {
    for (int n = 0; n < half; ++n)
    {
      order[2 * n] = n;
      order[2 * n + 1] = n + half;
    }
  }
  return order;
}

glm::dmat4 TurnOfViews::WorldToClip(int view) const
{
  vtkNew<vtkCamera> camera;
  this->SetCamera(view, camera);
  return toGlm(camera->GetProjectionTransformMatrix(this->Aspect, -1.0, 1.0)) *
    toGlm(camera->GetViewTransformMatrix());
}

void TurnOfViews::SetCamera(int view, vtkCamera* camera) const
{
  camera->DeepCopy(this->First);
  if (view == 0)
  {
    return; // the order that was given
  }
  const glm::dvec3 up = vector(camera->GetViewUp()), focus = vector(camera->GetFocalPoint());
  const glm::dvec3 axis =
    glm::normalize(glm::length(this->Settings.axis) > 0.0 ? this->Settings.axis : up);
  const double radians = glm::radians(this->Angle(view));
  const glm::dvec3 eye = focus + turned(vector(camera->GetPosition()) - focus, axis, radians);
  const glm::dvec3 newUp = turned(up, axis, radians);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->SetViewUp(newUp.x, newUp.y, newUp.z);
}
}
