// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef View_h
#define View_h

#include "vtkMatrix4x4.h"
#include "vtkSmartPointer.h"
#include "vtkTransform.h"

#include <array>

/**
 * From where the volume is seen: with all angles 0 from the patient's front, head up. Degrees.
 */
struct ViewSettings
{
  std::array<int, 2> Size = { 400, 600 };
  double Azimuth = 20.0;   // the camera goes round to the patient's left
  double Elevation = 10.0; // the camera rises
  double Roll = 0.0;       // the camera turns clockwise
  double Zoom = 1.0;       // 1: the volume's box just fits
  double Perspective = 0;  // the angle in which its sphere is seen, or 0 for parallel rays
};

/**
 * The camera's frame as a turn of the front view's: x to the right, y away, z up.
 */
vtkSmartPointer<vtkTransform> MakeViewTurn(const ViewSettings& view, double azimuth);

/**
 * The parallel scale with which a box, oriented as the volume is, fits into the view.
 */
double GetFittingScale(
  const double box[6], vtkMatrix4x4* orientation, const ViewSettings& view, vtkTransform* turn);

/**
 * Of a perspective view: how far the eye is from the middle of a box, and half the height of what
 * is seen there, at zoom 1.
 */
struct PerspectiveFit
{
  double Distance;
  double HalfHeight;
};

PerspectiveFit FitPerspective(
  const double box[6], vtkMatrix4x4* orientation, const ViewSettings& view);

#endif
