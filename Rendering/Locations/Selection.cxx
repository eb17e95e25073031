// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Locations/Selection.h"

#include "vtkHardwareSelector.h"

#include <cstdint>
#include <cstring>

namespace splatting
{
namespace
{
/// An identifier has 24 bits in this pass; 0 is none.
void chooseIdentifier(vtkHardwareSelector* selector)
{
  switch (selector->GetCurrentPass())
  {
    case vtkHardwareSelector::ACTOR_PASS:
    case vtkHardwareSelector::PROCESS_PASS:
      break; // set by the selector
    case vtkHardwareSelector::COMPOSITE_INDEX_PASS:
      selector->RenderCompositeIndex(1);
      break;
    case vtkHardwareSelector::POINT_ID_LOW24:
    case vtkHardwareSelector::CELL_ID_LOW24:
      selector->SetPropColorValue(vtkIdType(0)); // drawn by the selector as 1
      break;
    default: // the upper bits; black hides what is behind the volume
      selector->SetPropColorValue(0.0f, 0.0f, 0.0f);
  }
}

std::uint32_t opaque(const float rgb[3])
{
  unsigned char bytes[4] = { 0, 0, 0, 255 };
  for (int c = 0; c < 3; ++c)
  {
    bytes[c] = static_cast<unsigned char>(255.0f * rgb[c] + 0.5f);
  }
  std::uint32_t color;
  std::memcpy(&color, bytes, sizeof(color));
  return color;
}

bool isTransparent(std::uint32_t color)
{
  unsigned char bytes[4];
  std::memcpy(bytes, &color, sizeof(color));
  return bytes[3] == 0;
}
}

void drawIdentifiers(vtkHardwareSelector* selector, Picture& picture)
{
  selector->BeginRenderProp();
  chooseIdentifier(selector);
  const std::uint32_t identifier = opaque(selector->GetPropColorValue());
  selector->EndRenderProp();
  for (std::uint32_t& pixel : picture.pixels)
  {
    pixel = isTransparent(pixel) ? 0u : identifier;
  }
}
}
