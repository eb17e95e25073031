// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PixelProjector.h"

namespace splatting
{
const PixelProjector::Pixel& PixelProjector::Project(VolumeIndex& index,
  ProjectionSettings settings, const ShearPixel& pixel, const std::vector<ShearWarp>& geometries,
  const std::vector<Cuts>& cuts)
{
  const ShearWarp& whole = geometries[pixel.image];
  const Cuts& wholeCuts = cuts[pixel.image];
  const glm::ivec2 place(pixel.u, pixel.v);
  ShearWarp& geometry = this->Alone.Geometries.front();
  whole.takePixel(place, geometry);
  this->Alone.Cuts.cropping = wholeCuts.cropping;
  this->Alone.Cuts.intervals.clear();
  if (!wholeCuts.intervals.empty())
  {
    this->Alone.Cuts.intervals.takePixel(wholeCuts.intervals, place, geometry.width());
  }
  settings.recordLocations = true;
  settings.floor = ProjectionSettings().floor;
  settings.acceleration = Acceleration::Dense;
  // Single pixels must not change the statistics of frames.
  SkipStatistics& statistics = index.statistics(
    geometry.principalAxis(), static_cast<int>(settings.quality), !this->Alone.Cuts.none());
  const SkipStatistics kept = statistics;
  this->Projector.project(index, geometry, settings, this->Alone.Cuts, this->Alone.Images.front());
  statistics = kept;
  return this->Alone;
}
}
