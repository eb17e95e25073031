// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Locations/SampleLocations.h"

#include "Components/ComponentProjector.h"
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

void SampleLocations::Forget()
{
  this->Frames.clear();
  this->HasLast = false;
  this->Output = nullptr;
}

// Makes a frame independent of projector and cuts.
void SampleLocations::Frame::Copy()
{
  const auto own = [](auto& pointer, auto& copy)
  {
    if (pointer)
    {
      copy = *pointer;
      pointer = &copy;
    }
  };
  Located& from = this->located;
  own(from.geometries, this->geometries);
  if (from.images)
  {
    this->images.assign(from.images->begin(),
      from.images->begin() + static_cast<std::ptrdiff_t>(this->geometries.size()));
    from.images = &this->images;
  }
  own(from.cuts, this->cuts);
  own(from.screen, this->screen);
  own(from.ends.surface, this->surface);
  own(from.ends.depth, this->depth);
}

void SampleLocations::BeginFrame(vtkRenderer* renderer)
{
  if (this->HasLast && this->Frames.front()->shown.Renderer() != renderer)
  {
    this->Frames.front()->Copy();
  }
  this->HasLast = false;
  this->Output = nullptr;
  const auto isGone = [](const std::unique_ptr<Frame>& frame) { return !frame->shown.Renderer(); };
  this->Frames.erase(
    std::remove_if(this->Frames.begin(), this->Frames.end(), isGone), this->Frames.end());
  for (const std::unique_ptr<Frame>& frame : this->Frames)
  {
    if (frame->shown.Renderer() == renderer)
    {
      frame->shown.Drop();
    }
  }
}

// The frame of a renderer, which is moved to the front.
SampleLocations::Frame& SampleLocations::FrameOf(vtkRenderer* renderer)
{
  auto frame = std::find_if(this->Frames.begin(), this->Frames.end(),
    [=](const std::unique_ptr<Frame>& f) { return f->shown.Renderer() == renderer; });
  if (frame == this->Frames.end())
  {
    frame = this->Frames.insert(frame, std::make_unique<Frame>());
  }
  std::rotate(this->Frames.begin(), frame, frame + 1);
  return *this->Frames.front();
}

void SampleLocations::Remember(
  const View& view, const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer)
{
  Frame& frame = this->FrameOf(renderer);
  this->HasLast = true;
  frame.shown.Set(renderer, volume);
  frame.version = this->Source.Version();
  frame.canProject = this->Projector.CanProjectPixels();
  frame.hasWinners = this->Projector.HasWinners();
  Located& located = frame.located;
  located = {};
  located.view = view;
  located.indexToWorld = indexToWorld(grid, volume);
  this->Projector.Describe(this->SceneCuts.Get(), located);
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->GetPosition(&located.camera.x);
  camera->GetDirectionOfProjection(&located.direction.x);
  int width, height;
  renderer->GetTiledSizeAndOrigin(&width, &height, &frame.left, &frame.bottom);
}

// Whether a frame is still shown and its voxels exist.
bool SampleLocations::IsIntact(const Frame& frame) const
{
  return frame.shown.IsShown() && frame.version == this->Source.Version() &&
    this->Source.HasVolumes();
}

bool SampleLocations::Pick(int x, int y, Sample& sample)
{
  return std::any_of(this->Frames.begin(), this->Frames.end(),
    [&](const std::unique_ptr<Frame>& frame)
    {
      return frame->shown.Window() == this->Frames.front()->shown.Window() &&
        this->IsIntact(*frame) &&
        this->PickFrame(*frame, { x - frame->left, y - frame->bottom }, sample);
    });
}

// @param pixel  of the viewport, may be outside
bool SampleLocations::PickFrame(const Frame& frame, const glm::ivec2& pixel, Sample& sample)
{
  const Located& located = frame.located;
  const glm::ivec2& viewport = located.view.viewport;
  if (!(frame.hasWinners || frame.canProject) || pixel.x < 0 || pixel.y < 0 ||
    pixel.x >= viewport.x || pixel.y >= viewport.y)
  {
    return false;
  }
  Picture place;
  place.origin = pixel;
  place.size = glm::ivec2(1);
  place.pixels = { 1u };
  if (located.ends.depth)
  {
    located.ends.depth->hide(place);
  }
  if (!place.pixels.front())
  {
    return false;
  }
  const Locator locator(located);
  const Locator::Sample found =
    frame.hasWinners ? locator.at(pixel) : this->Projector.FindSample(located, pixel);
  sample = { locator.inWorld(found.point), found.voxel, found.value };
  return found.exists;
}

vtkImageData* SampleLocations::Image()
{
  const Frame* const frame = this->Last();
  if (!frame || !frame->shown.IsShown())
  {
    return nullptr;
  }
  if (this->Output || !this->IsIntact(*frame))
  {
    return this->Output;
  }
  const glm::ivec2& viewport = frame->located.view.viewport;
  const int extent[6] = { frame->left, frame->left + viewport.x - 1, frame->bottom,
    frame->bottom + viewport.y - 1, 0, 0 };
  if (!this->HasWinners())
  {
    this->Output = makeLocationImage(nullptr, extent);
    return this->Output;
  }
  const Locator locator(frame->located);
  this->Output = makeLocationImage(&locator, extent);
  // Clears the pixels that the scene hides.
  Picture seen;
  seen.size = viewport;
  seen.pixels.assign(std::size_t(viewport.x) * viewport.y, 1u);
  this->SceneCuts.Hide(seen);
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

void SampleLocations::ColorByDepth(
  Picture& picture, vtkScalarsToColors* colors, const double range[2])
{
  if (!this->HasWinners())
  {
    return;
  }
  const std::vector<glm::dvec3> table = depthColors(colors);
  const Locator locator(this->Last()->located);
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

std::vector<int> SampleLocations::VoxelsOf(const Picture& picture) const
{
  std::vector<int> voxels(3 * picture.pixels.size(), -1);
  if (!this->HasWinners())
  {
    return voxels;
  }
  Locator::Arrays arrays;
  arrays.voxels = voxels.data();
  Locator(this->Last()->located).fill(picture.origin, picture.size, arrays);
  this->SceneCuts.Hide(picture, voxels);
  return voxels;
}

const std::vector<float>& SampleLocations::ClipDepths(const Picture& picture, double opacity)
{
  constexpr float none = 2.0f;
  this->Depths.assign(picture.pixels.size(), none);
  if (!this->HasWinners())
  {
    return this->Depths;
  }
  Locator::Arrays arrays;
  arrays.clipDepths = this->Depths.data();
  Locator(this->Last()->located).fill(picture.origin, picture.size, arrays);
  for (std::size_t n = 0; n < picture.pixels.size(); ++n)
  {
    const auto* const rgba = reinterpret_cast<const unsigned char*>(&picture.pixels[n]);
    const bool isSeen = rgba[3] > 0 && rgba[3] >= 255.0 * opacity;
    this->Depths[n] = isSeen && this->Depths[n] == this->Depths[n] ? this->Depths[n] : none;
  }
  return this->Depths;
}
}
