// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef View_h
#define View_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"
#include "vtkTransform.h"

#include <array>

/**
 * The view of a volume: if all angles are 0, from the patient's front, head up. Angles are in
 * degrees.
 */
struct ViewSettings
{
  std::array<int, 2> Size = { 400, 600 };
  double Azimuth = 20.0;   // the camera goes round to the patient's left
  double Elevation = 10.0; // the camera rises
  double Roll = 0.0;       // the camera turns clockwise
  double Zoom = 1.0;       // 1: the volume's box fits
  double Perspective = 0;  // angle of the volume's sphere, or 0 for parallel rays
};

/**
 * Make the rotation of the camera relative to the front view: x to the right, y away, z up.
 */
vtkSmartPointer<vtkTransform> MakeViewTurn(const ViewSettings& view, double azimuth);

/**
 * Find the parallel scale in which the box of an image fits into the view.
 */
double GetFittingScale(vtkImageData* image, const ViewSettings& view, vtkTransform* turn);

/**
 * Distance of the eye from the centre of an image in a perspective view, and half the height of the
 * view there, at zoom 1.
 */
struct PerspectiveFit
{
  double Distance;
  double HalfHeight;
};

PerspectiveFit FitPerspective(vtkImageData* image, const ViewSettings& view);

#endif
