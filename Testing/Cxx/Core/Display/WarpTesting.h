// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of the warp share: shear images of functions, and colours that can be counted.
 */
#ifndef WarpTesting_h
#define WarpTesting_h

#include "CoreTesting.h"
#include "Display/ScreenColors.h"
#include "Splat/Warp/Warp.h"

#include <limits>
#include <vector>

namespace coretesting
{
/// A shear image of a float function of the pixel.
template <class F>
splatting::ShearImage imageOf(const splatting::ShearWarp& geometry, F&& f)
{
  // The image has the size of a preview.
  splatting::ProjectionSettings settings;
  settings.quality = splatting::Quality::Preview;
  const auto size = toArray(referenceRays(geometry).volumeSize());
  splatting::ShearImage image = project(reference::Volume<float>(size, 0.0f), geometry, settings);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      // What lies outside has no meaning and must not be read.
      image.row<float>(v)[u] =
        image.covers(u, v) ? static_cast<float>(f(u, v)) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return image;
}

/// Colours that name their entry, from 1 on; 0 is the transparent pixel.
inline splatting::ColorTable countingTable(double low, double high)
{
  splatting::ColorTable table;
  table.low = low;
  table.high = high;
  for (std::uint32_t entry = 0; entry < 65536; ++entry)
  {
    table.colors.push_back(entry + 1);
  }
  return table;
}

/// Of a pixel of the viewport; 0 beside the picture.
inline std::uint32_t colorAt(const splatting::Picture& picture, int x, int y)
{
  const int px = x - picture.origin.x, py = y - picture.origin.y;
  const bool inPicture = px >= 0 && py >= 0 && px < picture.size.x && py < picture.size.y;
  return inPicture ? picture.pixels[std::size_t(py) * picture.size.x + px] : 0;
}
}

/// The picture of shear images' maxima.
inline splatting::Picture pictureOf(const std::vector<splatting::ShearImage>& images,
  const std::vector<splatting::ShearWarp>& geometries, const splatting::ColorTable& table,
  const glm::ivec2& viewport,
  splatting::InstructionSet instructionSet = splatting::bestInstructionSet())
{
  splatting::WarpedScalars warped;
  warped.set(images, geometries, splatting::Reduction::Maximum, viewport, instructionSet);
  splatting::Picture picture;
  splatting::colorScreen(warped, table, instructionSet, picture);
  return picture;
}

#endif
