#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Maximum intensity projections from NumPy to NumPy; needs neither a display nor OpenGL."""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtksplattingmip import vtkSplattingMIPProjection


def mip(volume, spacing=(1.0, 1.0, 1.0), views=1, size=(256, 256)):
    """volume[z, y, x] to pictures[view, row, column], the top row first, values in the same unit."""
    image = vtkImageData()
    image.SetDimensions(volume.shape[::-1])
    image.SetSpacing(spacing)
    image.GetPointData().SetScalars(numpy_to_vtk(volume.ravel()))
    projection = vtkSplattingMIPProjection()
    projection.SetInputData(image)
    projection.SetNumberOfViews(views)
    projection.SetOutputSize(size)
    projection.SetBackgroundValue(volume.min())
    projection.Update()
    return vtk_to_numpy(projection.GetOutput().GetPointData().GetScalars()).reshape(
        views, size[1], size[0])[:, ::-1].copy()


if __name__ == "__main__":
    dot = numpy.full((40, 50, 60), -1000, numpy.int16)  # air, in Hounsfield units
    dot[18:23, 22:27, 27:32] = 700
    pictures = mip(dot, views=4)
    print("pictures:", pictures.shape, pictures.dtype, "from", pictures.min(), "to", pictures.max())
