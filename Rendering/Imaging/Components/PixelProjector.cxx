// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Components/PixelProjector.h"

#include <cmath>

namespace splatting
{
Locator::Sample PixelProjector::Find(
  VolumeIndex& index, CellIndex& cells, const Located& located, const glm::ivec2& pixel)
{
  if (located.images)
  {
    return this->FindInImages(index, located, pixel);
  }
  const View& view = located.view;
  ProjectionSettings settings = located.settings;
  settings.floor = ProjectionSettings().floor; // samples below the window are located, too
  cells.update(
    CellGrid(index.volume(), glm::ivec3(0), view.dimensions, view.showsBoxes), index.range());
  CellProjector projector; // without an observer
  Located alone = located;
  alone.screen = &this->Screen;
  return projector.project(
           cells, view, settings, located.ends, true, { pixel, glm::ivec2(1) }, this->Screen)
    ? Locator(alone).at(pixel)
    : Locator::Sample();
}

Locator::Sample PixelProjector::FindInImages(
  VolumeIndex& index, const Located& located, const glm::ivec2& pixel)
{
  // At the border of the image, rays without a sample may touch the volume by rounding.
  const auto hasSample = [&](const ShearPixel& shear)
  {
    const ShearImage& image = shear.of(*located.images);
    const int u = shear.u, v = shear.v;
    const bool isInside = image.meetsVolume(u - 1, v - 1) && image.meetsVolume(u + 1, v - 1) &&
      image.meetsVolume(u - 1, v + 1) && image.meetsVolume(u + 1, v + 1);
    if (!image.covers(u, v) || std::isnan(valueOf(*located.images, shear)))
    {
      return false;
    }
    if (!isInside)
    {
      this->Project(index, located, shear);
    }
    return isInside || this->Images.front().winners[0] >= 0;
  };
  ShearPixel shown;
  if (!located.geometries->empty())
  {
    findShown(located, pixel, glm::ivec2(1), &shown, hasSample);
  }
  if (shown.image < 0)
  {
    return {};
  }
  this->Project(index, located, shown);
  shown = { 0, 0, 0, shown.minimum };
  Located alone = located;
  alone.images = &this->Images;
  alone.geometries = &this->Geometries;
  return shown.of(this->Images).winners[0] >= 0 ? Locator(alone).at(pixel, shown)
                                                : Locator::Sample();
}

// Projects a pixel of a shear image, with its winner.
void PixelProjector::Project(VolumeIndex& index, const Located& located, const ShearPixel& pixel)
{
  const Cuts& cuts = (*located.cuts)[pixel.image];
  const glm::ivec2 place(pixel.u, pixel.v);
  ShearWarp& geometry = this->Geometries.front();
  (*located.geometries)[pixel.image].takePixel(place, geometry);
  this->PixelCuts.cropping = cuts.cropping;
  this->PixelCuts.intervals.clear();
  if (!cuts.intervals.empty())
  {
    this->PixelCuts.intervals.takePixel(cuts.intervals, place, geometry.width());
  }
  ProjectionSettings settings = located.settings;
  settings.recordLocations = true;
  settings.floor = ProjectionSettings().floor;
  this->Projector.project(index, geometry, settings, this->PixelCuts, this->Images.front());
}
}
