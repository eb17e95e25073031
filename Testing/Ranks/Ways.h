// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Ways.h
 * @brief   ways to show a volume that several ranks and one must agree in
 */
#ifndef Ways_h
#define Ways_h

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkNew.h"
#include "vtkPlane.h"

#include <functional>
#include <string>
#include <vector>

using Mapper = vtkSplattingMIPVolumeMapper;

/// How a mapper shows a volume.
struct Way
{
  std::string name;
  std::function<void(Mapper*)> set;
  int layers; ///< of ghosts; with AutoAdjustSampleDistances off
};

inline void crop(Mapper* mapper)
{
  mapper->CroppingOn();
  mapper->SetCroppingRegionPlanes(6.0, 18.0, -8.0, 6.0, 12.0, 30.0);
  mapper->SetCroppingRegionFlagsToInvertedCross();
}

inline void clip(Mapper* mapper)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(5.0, -7.0, 20.0);
  plane->SetNormal(0.5, 0.4, -0.7);
  mapper->AddClippingPlane(plane);
  mapper->CullBelowWindowOn();
}

/// Ways to show all of the volume.
inline std::vector<Way> waysOfAll()
{
  return {
    { "preview", [](Mapper* m) { m->SetQualityModeToPreview(); }, 0 },
    { "standard", [](Mapper* m) { m->SetQualityModeToStandard(); }, 1 },
    { "high", [](Mapper* m) { m->SetQualityModeToHigh(); }, 2 },
    { "cosine bell",
      [](Mapper* m)
      {
        m->SetQualityModeToHigh();
        m->SetKernelToCosineBell();
        m->SetKernelRadius(1.5);
      },
      2 },
    { "exact", [](Mapper* m) { m->SetQualityModeToExact(); }, 1 },
    { "exact minimum",
      [](Mapper* m)
      {
        m->SetQualityModeToExact();
        m->SetBlendModeToMinimumIntensity();
      },
      1 },
    { "minimum",
      [](Mapper* m)
      {
        m->SetQualityModeToStandard();
        m->SetBlendModeToMinimumIntensity();
      },
      1 },
    { "depth-shaded",
      [](Mapper* m)
      {
        m->SetQualityModeToHigh();
        m->SetMaximumTypeToDepthShaded();
      },
      2 },
    { "signed", // of bytes either extremum is shown
      [](Mapper* m)
      {
        m->SetQualityModeToStandard();
        m->SetMaximumTypeToSigned();
        m->SetSignedOrigin(127.0);
      },
      1 },
    { "exact, signed", // of other types either extremum is shown
      [](Mapper* m)
      {
        m->SetQualityModeToExact();
        m->SetMaximumTypeToSigned();
        m->SetSignedOrigin(12000.0);
      },
      1 },
  };
}

/// Ways to show a part of it.
inline std::vector<Way> waysOfParts()
{
  return {
    { "exact, depth-shaded and cropped", // so that rays are left slices without a sample
      [](Mapper* m)
      {
        m->SetQualityModeToExact();
        m->SetMaximumTypeToDepthShaded();
        m->SetDepthShadingAmbient(-0.2);
        crop(m);
      },
      1 },
    { "cropped",
      [](Mapper* m)
      {
        m->SetQualityModeToStandard();
        crop(m);
      },
      1 },
    { "exact, cropped",
      [](Mapper* m)
      {
        m->SetQualityModeToExact();
        crop(m);
      },
      1 },
    { "clipped",
      [](Mapper* m)
      {
        m->SetQualityModeToHigh();
        clip(m);
      },
      2 },
    { "exact, clipped",
      [](Mapper* m)
      {
        m->SetQualityModeToExact();
        clip(m);
      },
      1 },
  };
}

/// All of them.
inline std::vector<Way> ways()
{
  std::vector<Way> all = waysOfAll();
  const std::vector<Way> parts = waysOfParts();
  all.insert(all.end(), parts.begin(), parts.end());
  return all;
}

#endif
