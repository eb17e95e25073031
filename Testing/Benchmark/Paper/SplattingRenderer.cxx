// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/SplattingRenderer.h"

namespace
{
splatting::Acceleration ToAcceleration(PaperEncoding encoding)
{
  using splatting::Acceleration;
  switch (encoding)
  {
    case PaperEncoding::Plain:
      return Acceleration::Dense;
    case PaperEncoding::Lines:
      return Acceleration::Lines;
    case PaperEncoding::SortedLines:
      return Acceleration::SortedLines;
    case PaperEncoding::SortedVolume:
      return Acceleration::SortedVolume;
    case PaperEncoding::Automatic:
      break;
  }
  return Acceleration::Auto;
}

template <class T>
void CopyCovered(const splatting::ShearImage& image, reference::Image<double>& result)
{
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      if (image.covers(u, v))
      {
        result.raise(u, v, image.row<T>(v)[u]);
      }
    }
  }
}
}

//------------------------------------------------------------------------------
SplattingRenderer::SplattingRenderer(
  const PaperVolume& volume, splatting::Quality quality, PaperEncoding encoding, int tolerance)
{
  const std::array<int, 3>& size = volume.Voxels.size;
  this->Index.reset(
    { volume.Voxels.voxels.data(), splatting::ScalarType::UInt8, { size[0], size[1], size[2] } });
  this->Settings.quality = quality;
  this->Settings.acceleration = ToAcceleration(encoding);
  this->Settings.lineTolerance = tolerance;
}

//------------------------------------------------------------------------------
void SplattingRenderer::Render(const splatting::View& view)
{
  const splatting::ShearWarp geometry(view);
  this->Projector.project(this->Index, geometry, this->Settings, {}, this->Images.front());
  this->Show(this->Images, geometry, view);
}

//------------------------------------------------------------------------------
reference::Image<double> SplattingRenderer::Project(const splatting::ShearWarp& geometry)
{
  this->Projector.project(this->Index, geometry, this->Settings, {}, this->Images.front());
  const splatting::ShearImage& image = this->Images.front();
  reference::Image<double> result(image.width, image.height);
  splatting::dispatch(image.type,
    [&](auto* null) { CopyCovered<std::remove_pointer_t<decltype(null)>>(image, result); });
  return result;
}
