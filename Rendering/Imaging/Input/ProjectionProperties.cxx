// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ProjectionProperties.h"

#include "vtkSplattingMIPProjection.h"

namespace splatting
{
using Names = vtkSplattingMIPProjection;

const char* nameOfQualityMode(int mode)
{
  static const char* const names[] = { "preview", "standard", "high", "exact" };
  return names[mode];
}

const char* nameOfKernel(int kernel)
{
  return kernel == Names::COSINE_BELL ? "cosine bell" : "trilinear";
}

const char* nameOfMaximumType(int type)
{
  static const char* const names[] = { "global", "depth shaded", "local", "signed" };
  return names[type];
}

const char* nameOfVectorMode(int mode)
{
  static const char* const names[] = { "disabled", "magnitude", "component" };
  return names[mode - Names::DISABLED];
}

const char* nameOfAcceleration(int acceleration)
{
  static const char* const names[] = { "auto", "dense", "bricks", "lines", "sorted lines",
    "sorted volume" };
  return names[acceleration];
}
}
