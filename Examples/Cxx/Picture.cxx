// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Picture.h"

#include "vtkNew.h"
#include "vtkStdString.h"
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"

#include <algorithm>

void DrawLabel(vtkImageData* picture, const std::string& text, bool isOnPaper)
{
  const int* const size = picture->GetDimensions();
  const double gray = isOnPaper ? 0.0 : 1.0;
  vtkNew<vtkTextProperty> style;
  style->SetColor(gray, gray, gray);
  style->SetFontSize(std::max(8, size[1] / 32));
  vtkNew<vtkImageData> letters;
  int used[2] = { 0, 0 };
  if (!vtkTextRenderer::GetInstance()->RenderString(style, text, letters, used, 72))
  {
    return;
  }
  int extent[6];
  letters->GetExtent(extent);
  const int left = size[0] / 50;
  const int bottom = size[1] - size[1] / 100 - used[1];
  for (int y = 0; y < used[1]; ++y)
  {
    for (int x = 0; x < used[0]; ++x)
    {
      if (left + x >= size[0] || bottom + y < 0 || bottom + y >= size[1])
      {
        continue;
      }
      const auto* const ink =
        static_cast<unsigned char*>(letters->GetScalarPointer(extent[0] + x, extent[2] + y, 0));
      auto* const pixel =
        static_cast<unsigned char*>(picture->GetScalarPointer(left + x, bottom + y, 0));
      for (int c = 0; c < 3; ++c)
      {
        pixel[c] = static_cast<unsigned char>((ink[3] * ink[c] + (255 - ink[3]) * pixel[c]) / 255);
      }
    }
  }
}
