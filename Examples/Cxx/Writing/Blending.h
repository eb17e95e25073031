// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Blending_h
#define Blending_h

#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <vector>

/**
 * Slices of bytes, and the colours of the bytes.
 */
struct PaletteSlices
{
  vtkSmartPointer<vtkImageData> Bytes;
  vtkSmartPointer<vtkColorTransferFunction> Palette;
};

/**
 * Combine the colours of slices of the same size pixel by pixel, as
 * vtkAbstractSplattingMIPVolumeMapper::PictureBlendings defines: OVER draws each over those before
 * it, with the opacity byte / 255.
 */
vtkSmartPointer<vtkImageData> Blend(const std::vector<PaletteSlices>& layers, int blending);

#endif
