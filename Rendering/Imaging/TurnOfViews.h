// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TurnOfViews_h
#define TurnOfViews_h

#include "vtkNew.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

class vtkCamera;
class vtkImageData;

namespace splatting
{
/**
 * As the properties of vtkSplattingMIPProjection; where there is a camera, direction, up, focal
 * point and diagonal mean nothing.
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
 * The cameras of views that go round a volume, and how pixels lie in them.
 */
class TurnOfViews
{
public:
  static constexpr int MostPixels = 16384;
  /// What is wrong with a camera whose matrices have no meaning.
  static const char* const Degenerate;

  /// Returns what is wrong, or nullptr. What follows is about the last settings without fault.
  const char* Set(const TurnSettings& settings);

  const glm::ivec2& Size() const { return this->Settings.size; }
  int Views() const { return this->Settings.views; }

  /// Gives an image the spacing, origin and directions of the first view in the world and the
  /// angles of all, as vtkSplattingMIPProjection says of its output.
  void Place(vtkImageData* picture) const;

  /// In which order views are to be projected: opposite ones, which share rays, one after the
  /// other, and the last one last.
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
