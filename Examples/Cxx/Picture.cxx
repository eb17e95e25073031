// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Picture.h"

#include "vtkNew.h"
#include "vtkStdString.h"
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"

#include <algorithm>

void DrawLabel(vtkImageData* slices, const std::string& text)
{
  const int* const size = slices->GetDimensions();
  vtkNew<vtkTextProperty> style;
  style->SetFontSize(std::max(8, size[1] / 32));
  vtkNew<vtkImageData> letters;
  int used[2] = { 0, 0 };
  if (text.empty() || !vtkTextRenderer::GetInstance()->RenderString(style, text, letters, used, 72))
  {
    return;
  }
  int extent[6];
  letters->GetExtent(extent);
  const int left = size[0] / 50;
  const int bottom = size[1] - size[1] / 100 - used[1];
  for (int y = std::max(0, -bottom); y < used[1]; ++y)
  {
    for (int x = 0; x < used[0] && left + x < size[0]; ++x)
    {
      const auto* const ink =
        static_cast<unsigned char*>(letters->GetScalarPointer(extent[0] + x, extent[2] + y, 0));
      for (int z = 0; z < size[2]; ++z)
      {
        auto* const pixel =
          static_cast<unsigned char*>(slices->GetScalarPointer(left + x, bottom + y, z));
        *pixel = static_cast<unsigned char>(ink[3] + (255 - ink[3]) * *pixel / 255);
      }
    }
  }
}
