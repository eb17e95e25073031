// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/Blending.h"

#include "vtkAbstractSplattingMIPVolumeMapper.h"
#include "vtkImageMapToColors.h"
#include "vtkNew.h"

#include <algorithm>

namespace
{
using Mapper = vtkAbstractSplattingMIPVolumeMapper;

unsigned char BlendBytes(int below, int above, int opacity, int blending)
{
  const int blended = blending == Mapper::ADD ? std::min(below + above, 255)
    : blending == Mapper::MAXIMUM             ? std::max(below, above)
                                  : (opacity * above + (255 - opacity) * below + 127) / 255;
  return static_cast<unsigned char>(blended);
}
}

vtkSmartPointer<vtkImageData> Blend(const std::vector<PaletteSlices>& layers, int blending)
{
  vtkSmartPointer<vtkImageData> blended;
  for (const PaletteSlices& layer : layers)
  {
    vtkNew<vtkImageMapToColors> paint;
    paint->SetInputData(layer.Bytes);
    paint->SetLookupTable(layer.Palette);
    paint->SetOutputFormatToRGB();
    paint->Update();
    if (!blended)
    {
      blended = paint->GetOutput();
      continue;
    }
    auto* below = static_cast<unsigned char*>(blended->GetScalarPointer());
    const auto* above = static_cast<unsigned char*>(paint->GetOutput()->GetScalarPointer());
    const auto* const bytes = static_cast<unsigned char*>(layer.Bytes->GetScalarPointer());
    for (vtkIdType p = 0; p < layer.Bytes->GetNumberOfPoints(); ++p)
    {
      for (int n = 0; n < 3; ++n, ++below, ++above)
      {
        *below = BlendBytes(*below, *above, bytes[p], blending);
      }
    }
  }
  return blended;
}
