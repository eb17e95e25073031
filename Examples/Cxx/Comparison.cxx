// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Comparison.h"

#include "vtkSMPTools.h"

#include <cstdio>

std::string FormatTime(double milliseconds)
{
  char text[32];
  std::snprintf(text, sizeof(text), milliseconds < 100 ? "%.1f ms" : "%.0f ms", milliseconds);
  return text;
}

Comparison::Comparison(const Volume& volume, const LookSettings& look, const Options& options)
  : Scene(volume, options.Projection, look, options.View, true)
{
  std::printf("\nWhole frame, view to pixels: median of %d frames of %d x %d, turned by one "
              "degree each; %d threads, %s\n",
    MIPScene::NumberOfTimedFrames, options.View.Size[0], options.View.Size[1],
    vtkSMPTools::GetEstimatedNumberOfThreads(), this->Scene.GetSplatting()->GetInstructionSet());
  std::printf("%-10s %12s   vtkFixedPointVolumeRayCastMapper\n", "mode", "splatting");
}

double Comparison::AddMode(int mode)
{
  const bool isPreview = mode == vtkSplattingMIPVolumeMapper::PREVIEW;
  const int interpolation = isPreview ? VTK_NEAREST_INTERPOLATION : VTK_LINEAR_INTERPOLATION;
  double& rayCasting = this->RayCasting[interpolation];
  if (rayCasting == 0.0)
  {
    this->Scene.UseRayCasting(interpolation);
    rayCasting = this->Scene.MeasureFrame("ray casting");
  }
  this->Scene.UseSplatting(mode);
  const double splatting = this->Scene.MeasureFrame(ModeNames[mode]);
  std::printf("%-10s %12s   %12s (%s), %.1f times as long\n", ModeNames[mode].c_str(),
    FormatTime(splatting).c_str(), FormatTime(rayCasting).c_str(), isPreview ? "nearest" : "linear",
    rayCasting / splatting);
  std::fflush(stdout);
  return splatting;
}
