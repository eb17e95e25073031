// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Components/ShearImageOutput.h"

#include "Display/SignedMaximum.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <cstring>

namespace splatting
{
vtkSmartPointer<vtkImageData> makeShearImage(
  const std::vector<const ShearImage*>& components, const ShearWarp& geometry, int type)
{
  const auto output = vtkSmartPointer<vtkImageData>::New();
  const ShearImage& first = *components.front();
  const std::size_t count = components.size(), size = sizeOf(first.type);
  output->SetDimensions(first.width, first.height, 1);
  output->SetOrigin(geometry.columns().at.front(), geometry.rows().at.front(), 0.0);
  output->SetSpacing(geometry.pitch(), geometry.pitch(), 1.0);
  output->AllocateScalars(type, static_cast<int>(count));
  const std::size_t pixels = static_cast<std::size_t>(output->GetNumberOfPoints());
  auto* const scalars = static_cast<unsigned char*>(output->GetScalarPointer());
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(output->GetNumberOfPoints());
  ghosts->Fill(vtkDataSetAttributes::HIDDENPOINT);
  for (std::size_t c = 0; c < count; ++c)
  {
    const ShearImage& projected = *components[c];
    const ShearImage combined = projected.minima.empty() ? ShearImage() : shownValues(projected);
    const ShearImage& image = projected.minima.empty() ? projected : combined;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      std::memcpy(scalars + (pixel * count + c) * size, image.bytes.data() + pixel * size, size);
      const int u = static_cast<int>(pixel % image.width),
                v = static_cast<int>(pixel / image.width);
      const vtkIdType id = static_cast<vtkIdType>(pixel);
      if (image.covers(u, v) &&
        !std::isnan(output->GetPointData()->GetScalars()->GetComponent(id, static_cast<int>(c))))
      {
        ghosts->SetValue(id, 0);
      }
    }
  }
  output->GetPointData()->AddArray(ghosts);
  return output;
}
}
