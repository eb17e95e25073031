// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TurnOfViews_h
#define TurnOfViews_h

#include "vtkNew.h"
#include "vtkSplattingMIPNamespace.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkCamera;
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * The properties of vtkSplattingMIPProjection. With a camera, direction, up, focal point and
 * diagonal are ignored.
 */
struct TurnSettings
{
  vtkCamera* camera = nullptr;
  glm::dvec3 direction{ 0.0 }, up{ 0.0 }, focalPoint{ 0.0 };
  double diagonal = 1.0; ///< of the volume
  glm::ivec2 size{ 1 };
  glm::dvec2 spacing{ 0.0 }; ///< 0: automatic
  int views = 1;
  glm::dvec3 axis{ 0.0 }; ///< 0: up
  double angle = 360.0;
  bool slab = false;
  glm::dvec3 slabCenter{ 0.0 };
  double slabThickness = 1.0;
};

/**
 * The cameras of a turn about a volume, and the placement of their pixels.
 */
class TurnOfViews
{
public:
  static constexpr int MostPixels = 16384;
  /// The error message for cameras with invalid matrices.
  static const char* const Degenerate;

  /// Returns an error message, or nullptr. The other methods use the last valid settings.
  const char* Set(const TurnSettings& settings);

  const glm::ivec2& Size() const { return this->Settings.size; }
  int Views() const { return this->Settings.views; }

  /// Sets spacing, origin and directions of an image to those of the first view in the world, and
  /// adds the angles of all views; see vtkSplattingMIPProjection.
  void Place(vtkImageData* picture) const;

  /// The order in which views are projected: opposite views, which share rays, in succession, and
  /// the last view last.
  std::vector<int> Order() const;

  glm::dmat4 WorldToClip(int view) const;
  void SetCamera(int view, vtkCamera* camera) const;

private:
  void PlaceCamera();
  void ScaleCamera();
  double Angle(int view) const;

  TurnSettings Settings;
  vtkNew<vtkCamera> First;
  double Aspect = 1.0;
};
}

#endif
