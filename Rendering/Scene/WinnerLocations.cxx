// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/WinnerLocations.h"

#include "ComponentProjector.h"
#include "Input/ScalarSource.h"
#include "LocationArrays.h"
#include "Scene/SceneCuts.h"
#include "Scene/ViewOfVolume.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

namespace
{
double valueOf(const splatting::ShearImage& image, int u, int v)
{
  return splatting::dispatch(image.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      return static_cast<double>(image.row<T>(v)[u]);
    });
}
}

namespace splatting
{
vtkSmartPointer<vtkImageData> makeLocationImage(const Locator* locator, const int extent[6])
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(extent[0], extent[1], extent[2], extent[3], 0, 0);
  const Locator::Arrays arrays = addLocationArrays(image);
  if (locator)
  {
    const int* const size = image->GetDimensions();
    locator->fill({ 0, 0 }, { size[0], size[1] }, arrays);
  }
  return image;
}

std::vector<glm::dvec3> depthColors(vtkScalarsToColors* colors)
{
  constexpr int count = 256;
  std::vector<glm::dvec3> table(count);
  for (int n = 0; n < count; ++n)
  {
    const double share = n / (count - 1.0);
    if (colors)
    {
      const double* const range = colors->GetRange();
      colors->GetColor(range[0] + share * (range[1] - range[0]), &table[n].x);
    }
    else
    {
      constexpr double blue = 2.0 / 3.0;
      const double hsv[3] = { share * blue, 1.0, 1.0 };
      vtkMath::HSVToRGB(hsv, &table[n].x);
    }
  }
  return table;
}

void WinnerLocations::Forget()
{
  this->Known = false;
  this->Output = nullptr;
}

void WinnerLocations::Remember(
  const View& view, const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer)
{
  this->Output = nullptr;
  this->Known = true;
  this->Frame.view = view;
  this->Frame.indexToWorld = indexToWorld(grid, volume);
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->GetPosition(&this->Frame.camera.x);
  camera->GetDirectionOfProjection(&this->Frame.direction.x);
  int width, height;
  renderer->GetTiledSizeAndOrigin(&width, &height, &this->Left, &this->Bottom);
  this->Shown.Set(renderer, volume);
}

bool WinnerLocations::HasWinners() const
{
  return this->Known && !this->Images.empty() && this->Projector.HasWinners();
}

Located WinnerLocations::Describe() const
{
  Located located = this->Frame;
  located.geometries = &this->Images;
  located.cuts = &this->Cuts.OfProjection();
  located.depth = this->Cuts.SceneDepths();
  this->Projector.Describe(located);
  return located;
}

Locator WinnerLocations::Locate() const
{
  return Locator(this->Describe());
}

bool WinnerLocations::Pick(int x, int y, Sample& sample)
{
  const glm::ivec2 pixel(x - this->Left, y - this->Bottom);
  const glm::ivec2& viewport = this->Frame.view.viewport;
  const bool isInside =
    pixel.x >= 0 && pixel.y >= 0 && pixel.x < viewport.x && pixel.y < viewport.y;
  if (!this->Known || !isInside || this->Images.empty() || !this->Shown.IsShown() ||
    !this->Source.HasVolumes())
  {
    return false;
  }
  Picture place;
  place.origin = pixel;
  place.size = glm::ivec2(1);
  place.pixels = { 1u };
  this->Cuts.Hide(place);
  return place.pixels.front() && this->PickRay(pixel, sample);
}

// Only at the image's rim rounding can let rays meet the volume that have no sample.
bool WinnerLocations::HasSample(const ShearImage& image, const ShearPixel& pixel)
{
  const int u = pixel.u, v = pixel.v;
  const bool isInside = image.meetsVolume(u - 1, v - 1) && image.meetsVolume(u + 1, v - 1) &&
    image.meetsVolume(u - 1, v + 1) && image.meetsVolume(u + 1, v + 1);
  const double value = valueOf(image, u, v);
  return image.covers(u, v) && value == value &&
    (isInside ||
      this->Projector.ProjectPixel(pixel, this->Images, this->Cuts.OfProjection())
          .Images.front()
          .winners[0] >= 0);
}

// Of a pixel of the viewport.
bool WinnerLocations::PickRay(const glm::ivec2& pixel, Sample& sample)
{
  const bool hasWinners = this->Projector.HasWinners();
  if (!hasWinners && !this->Projector.CanProjectPixels())
  {
    return false;
  }
  Located located = this->Describe();
  const auto hasSample = [&](const ShearPixel& shear)
  { return this->HasSample((*located.images)[shear.image], shear); };
  ShearPixel shown;
  findShearPixels(*located.images, this->Images, located.settings.reduction, pixel, glm::ivec2(1),
    &shown, hasWinners ? std::function<bool(const ShearPixel&)>() : hasSample);
  if (shown.image < 0)
  {
    return false;
  }
  if (!hasWinners)
  {
    const PixelProjector::Pixel& alone =
      this->Projector.ProjectPixel(shown, this->Images, this->Cuts.OfProjection());
    if (alone.Images.front().winners[0] < 0)
    {
      return false;
    }
    located.images = &alone.Images;
    located.geometries = &alone.Geometries;
    located.cuts = nullptr;
    shown = { 0, 0, 0 };
  }
  const Locator locator(located);
  sample.position = locator.inWorld(locator.point(glm::dvec2(pixel), shown));
  sample.voxel = locator.voxel(glm::dvec2(pixel), shown);
  const double own = this->Projector.ValueOnOwnRay(shown.image, pixel);
  sample.value = own == own ? own : valueOf((*located.images)[shown.image], shown.u, shown.v);
  return true;
}

vtkImageData* WinnerLocations::Image()
{
  if (!this->Known || !this->Shown.IsShown())
  {
    return nullptr;
  }
  if (this->Output || !this->Source.HasVolumes())
  {
    return this->Output;
  }
  const glm::ivec2& viewport = this->Frame.view.viewport;
  const int extent[6] = { this->Left, this->Left + viewport.x - 1, this->Bottom,
    this->Bottom + viewport.y - 1, 0, 0 };
  if (!this->HasWinners())
  {
    this->Output = makeLocationImage(nullptr, extent);
    return this->Output;
  }
  const Locator locator = this->Locate();
  this->Output = makeLocationImage(&locator, extent);
  // What other things hide is not seen.
  Picture seen;
  seen.size = viewport;
  seen.pixels.assign(std::size_t(viewport.x) * viewport.y, 1u);
  this->Cuts.Hide(seen);
  for (vtkIdType n = 0; n < this->Output->GetNumberOfPoints(); ++n)
  {
    for (int a = 0; a < 3 && !seen.pixels[n]; ++a)
    {
      vtkDataArray* const array = this->Output->GetPointData()->GetArray(a);
      for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      {
        array->SetComponent(n, c, a == 0 ? -1.0 : std::nan(""));
      }
    }
  }
  return this->Output;
}

void WinnerLocations::ColorByDepth(
  Picture& picture, vtkScalarsToColors* colors, const double range[2])
{
  if (!this->HasWinners())
  {
    return;
  }
  const std::vector<glm::dvec3> table = depthColors(colors);
  const Locator locator = this->Locate();
  const glm::dvec2 depths =
    range[0] < range[1] ? glm::dvec2(range[0], range[1]) : locator.depthRange();
  this->Depths.resize(picture.pixels.size());
  Locator::Arrays arrays;
  arrays.depths = this->Depths.data();
  locator.fill(picture.origin, picture.size, arrays);
  const double last = static_cast<double>(table.size()) - 1.0;
  const double scale = depths.y > depths.x ? last / (depths.y - depths.x) : 0.0;
  for (std::size_t n = 0; n < picture.pixels.size(); ++n)
  {
    auto* const rgba = reinterpret_cast<unsigned char*>(&picture.pixels[n]);
    const double place = (this->Depths[n] - depths.x) * scale;
    if (!(place == place))
    {
      continue;
    }
    const glm::dvec3& color = table[std::lround(std::clamp(place, 0.0, last))];
    const double value = std::max({ rgba[0], rgba[1], rgba[2] });
    for (int c = 0; c < 3; ++c)
    {
      rgba[c] = static_cast<unsigned char>(std::lround(value * std::clamp(color[c], 0.0, 1.0)));
    }
  }
}

const std::vector<float>& WinnerLocations::ClipDepths(const Picture& picture, double opacity)
{
  constexpr float none = 2.0f;
  this->Depths.assign(picture.pixels.size(), none);
  if (!this->HasWinners())
  {
    return this->Depths;
  }
  Locator::Arrays arrays;
  arrays.clipDepths = this->Depths.data();
  this->Locate().fill(picture.origin, picture.size, arrays);
  for (std::size_t n = 0; n < picture.pixels.size(); ++n)
  {
    const auto* const rgba = reinterpret_cast<const unsigned char*>(&picture.pixels[n]);
    const bool isSeen = rgba[3] > 0 && rgba[3] >= 255.0 * opacity;
    this->Depths[n] = isSeen && this->Depths[n] == this->Depths[n] ? this->Depths[n] : none;
  }
  return this->Depths;
}
}
