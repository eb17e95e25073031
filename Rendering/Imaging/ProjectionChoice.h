// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProjectionChoice_h
#define ProjectionChoice_h

#include "Projection/Project.h"

namespace splatting
{
/**
 * How a volume is projected, as the properties of vtkSplattingMIPProjection and
 * vtkSplattingMIPVolumeMapper say it: names, meaning and enumerators are theirs.
 */
struct ProjectionChoice
{
  int blendMode = 1;
  int maximumType = 0;
  double depthShadingAmbient = 0.3;
  double depthShadingChangeRate = 0.7;
  double localMaximumThreshold = 0.0;
  double averageRange[2] = { 0.0, 0.0 };
  int kernel = 0;
  double kernelRadius = 1.0;
  int footprintSampling = 0;
  int shearImageSampling = -1;
  int acceleration = 0;
  double lineTolerance = 0.0;
  bool eliminateInvisible = false;
  bool locations = false;
  bool slab = false;
  double slabThickness = 10.0;
  double slabCenter[3] = { 0.0, 0.0, 0.0 };
  bool cropping = false;
  double croppingPlanes[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
};

/**
 * A sentence that says which choice has no meaning and what to do, or nullptr. What has no effect
 * may be anything.
 */
const char* faultOfChoice(const ProjectionChoice& choice);

/**
 * What the choice means to a projection of a view in a quality mode. What has no effect is as by
 * default, so that its changes project nothing.
 */
splatting::ProjectionSettings settingsOfChoice(
  const ProjectionChoice& choice, int mode, const splatting::View& view);
}

#endif
