// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperRenderer.h"

#include <algorithm>
#include <cmath>

namespace
{
std::uint32_t OpaqueGrey(int level)
{
  const std::uint8_t rgba[4] = { static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(level),
    static_cast<std::uint8_t>(level), 255 };
  std::uint32_t color;
  std::copy_n(rgba, 4, reinterpret_cast<std::uint8_t*>(&color));
  return color;
}

double Red(std::uint32_t color)
{
  return reinterpret_cast<const std::uint8_t*>(&color)[0];
}

/// From the first to the last pixel of each row that has a sample.
std::vector<splatting::Span> FindSpans(const reference::Image<double>& image)
{
  std::vector<splatting::Span> spans(image.height, { image.width, 0 });
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      if (image.isHit(u, v))
      {
        spans[v] = { std::min(spans[v].begin, u), u + 1 };
      }
    }
  }
  return spans;
}

splatting::ShearImage MakeShearImage(const reference::Image<double>& source)
{
  splatting::ShearImage image;
  image.type = splatting::ScalarType::Float32;
  image.width = source.width;
  image.height = source.height;
  image.bytes.resize(source.value.size() * sizeof(float));
  image.spans = FindSpans(source);
  std::transform(source.value.begin(), source.value.end(), image.row<float>(0),
    [](double value) { return static_cast<float>(value); });
  return image;
}
}

//------------------------------------------------------------------------------
PaperRenderer::PaperRenderer()
{
  this->Greys.high = 255.0;
  for (int level = 0; level < 256; ++level)
  {
    this->Greys.colors.push_back(OpaqueGrey(level));
  }
}

//------------------------------------------------------------------------------
PaperPicture PaperRenderer::MakePicture(const splatting::View& view)
{
  this->Render(view);
  PaperPicture picture(view.viewport.x, view.viewport.y);
  for (int y = 0; y < this->Frame.size.y; ++y)
  {
    for (int x = 0; x < this->Frame.size.x; ++x)
    {
      picture.raise(this->Frame.origin.x + x, this->Frame.origin.y + y,
        Red(this->Frame.pixels[std::size_t(y) * this->Frame.size.x + x]));
    }
  }
  return picture;
}

//------------------------------------------------------------------------------
void RayCastRenderer::Render(const splatting::View& view)
{
  this->Cast(this->Volume.Voxels, MakeScreenRays(view), this->Values);
  this->Frame.origin = { 0, 0 };
  this->Frame.size = view.viewport;
  this->Frame.pixels.resize(this->Values.value.size());
  for (std::size_t pixel = 0; pixel < this->Values.value.size(); ++pixel)
  {
    const int level = static_cast<int>(this->Values.value[pixel] + 0.5f);
    this->Frame.pixels[pixel] = this->Values.hit[pixel] ? this->Greys.colors[level] : 0;
  }
}

//------------------------------------------------------------------------------
ProjectiveRenderer::ProjectiveRenderer(const PaperVolume& volume) : Volume(volume)
{
  const std::array<int, 3>& size = volume.Voxels.size;
  this->Index.reset(
    { volume.Voxels.voxels.data(), splatting::ScalarType::UInt8, { size[0], size[1], size[2] } });
}

//------------------------------------------------------------------------------
void PaperRenderer::Show(const std::vector<splatting::ShearImage>& images,
  const splatting::ShearWarp& geometry, const splatting::View& view)
{
  const splatting::InstructionSet best = splatting::bestInstructionSet();
  const std::vector<splatting::ShearWarp> geometries{ geometry };
  this->Warped.set(images, geometries, splatting::Reduction::Maximum, view.viewport, best);
  splatting::colorScreen(this->Warped, this->Greys, best, this->Frame);
}

//------------------------------------------------------------------------------
void ProjectiveRenderer::Render(const splatting::View& view)
{
  const splatting::ShearWarp geometry(view);
  const reference::ShearView shear = ToReference(geometry);
  const splatting::Slices slices = this->Index.slices(shear.axis);
  reference::projectSlices(
    { static_cast<const std::uint8_t*>(slices.voxels), slices.rowStride, slices.sliceStride },
    reference::makeShearGrid(this->Volume.Voxels.size, shear), shear, this->Bytes);
  splatting::ShearImage& image = this->Images.front();
  image.width = this->Bytes.width;
  image.height = this->Bytes.height;
  image.bytes.swap(this->Bytes.value);
  image.spans.clear();
  for (const std::array<int, 2>& range : this->Bytes.range)
  {
    image.spans.push_back({ range[0], range[1] });
  }
  this->Show(this->Images, geometry, view);
}

//------------------------------------------------------------------------------
void ReferenceRenderer::Render(const splatting::View& view)
{
  const splatting::ShearWarp geometry(view);
  const std::vector<splatting::ShearImage> images{ MakeShearImage(
    this->Project(this->Volume, ToReference(geometry))) };
  this->Show(images, geometry, view);
}

//------------------------------------------------------------------------------
reference::ShearView ToReference(const splatting::ShearWarp& geometry)
{
  return { geometry.principalAxis(), { geometry.shear().x, geometry.shear().y } };
}
